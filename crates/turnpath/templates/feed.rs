//! An Archimedean spiral whose pitch changes evenly from turn to turn, and which closes by itself.
//!
//! Between the two pitches p₀ and p₁ the law is ρ = ρ₀ ± (p₀ m + (p₁ − p₀) m²/2T) over T turns. Before
//! and after it the tool comes from rest to the pitch, and from the pitch to rest, within 1.25 turns:
//! the first and the last pass then lie within 0.38 of a pitch of the end of the range at every angle.
#![forbid(unsafe_code)]
use turnpath_plugin::prelude::*;

const PITCH_INNER: Param<Option<Feed>> = Param::feed(
    "pitch_inner",
    "pitch at the inner end; left out: the largest that holds the residual",
)
.positive()
.optional();
const PITCH_OUTER: Param<Option<Feed>> = Param::feed(
    "pitch_outer",
    "pitch at the rim; left out: the largest that holds the residual",
)
.positive()
.optional();

/// Turns from rest to the pitch. The pass after a whole turn lies 0.38 of a pitch from the end.
const EASE: f64 = 1.25;
/// Radii and angles at which the pitch that holds the residual is asked for.
const RADII: usize = 64;
const ANGLES: usize = 72;
/// The part of that pitch that is used: the residual's feed changes between radii that are asked for.
const AIM: f64 = 0.99;
/// Fewest pitches within the range: a spiral of less has no room to come to its pitch.
const FEWEST: f64 = 4.0;

struct EvenPitch {
    inner: Option<f64>,
    outer: Option<f64>,
}

impl Strategy for EvenPitch {
    const NAME: &'static str = "even-pitch";
    const SUMMARY: &'static str = "a pitch that changes evenly from the inner end to the rim";
    const PARAMS: &'static [ParamInfo] = &[PITCH_INNER.info(), PITCH_OUTER.info()];

    fn new(p: &Params) -> Result<Self> {
        Ok(Self {
            inner: p.get(PITCH_INNER),
            outer: p.get(PITCH_OUTER),
        })
    }
}

impl FeedStrategy for EvenPitch {
    fn plan(&self, setup: Setup<'_>) -> Result<Box<dyn FeedPlan>> {
        let held = held_pitches(setup)?;
        let most = (setup.task.range.outer - setup.task.range.inner) / FEWEST;
        let inner = self.inner.unwrap_or(held[0]).min(most);
        let outer = self.outer.unwrap_or(held[1]).min(most);
        Ok(Box::new(Spiral { inner, outer }))
    }
}

/// Two pitches such that the pitch between them nowhere exceeds the one that holds the residual.
fn held_pitches(setup: Setup<'_>) -> Result<[f64; 2]> {
    let RadialRange { inner, outer } = setup.task.range;
    let share = |i: usize| i as f64 / (RADII - 1) as f64;
    let theta: Vec<f64> = (0..ANGLES)
        .map(|i| TAU * i as f64 / ANGLES as f64)
        .collect();
    let mut least = Vec::with_capacity(RADII);
    for i in 0..RADII {
        let rho = vec![inner + (outer - inner) * share(i); ANGLES];
        let mut feed = vec![f64::NAN; ANGLES];
        let (residual, radial) = (setup.task.tolerance.residual, setup.locus.radial());
        setup
            .locus
            .residual_feed(residual, radial, &theta, &rho, &mut feed)?;
        least.push(feed.into_iter().fold(f64::INFINITY, f64::min));
    }
    let (first, last) = (least[0], least[RADII - 1]);
    // p dp is the same on every turn, so that p² is even along the radius.
    let pitch = |i: usize| (first * first + (last * last - first * first) * share(i)).sqrt();
    let over = (0..RADII).map(|i| pitch(i) / least[i]).fold(1.0, f64::max);
    Ok([first, last].map(|pitch| AIM * pitch / over))
}

struct Spiral {
    inner: f64,
    outer: f64,
}

impl FeedPlan for Spiral {
    /// The whole law in one call: from rest, the spiral, to rest.
    fn extend(&mut self, setup: Setup<'_>, pieces: &mut Vec<FeedPiece>) -> Result<Continuation> {
        let RadialRange { inner, outer } = setup.task.range;
        let (from, to, first, last) = match setup.task.direction {
            Direction::Outward => (inner, outer, self.inner, self.outer),
            Direction::Inward => (outer, inner, -self.outer, -self.inner),
        };
        // While the pitch is reached, the mean feed is half of it.
        let eased = 0.5 * EASE * (first + last);
        let turns = 2.0 * (to - from - eased) / (first + last);
        let change = (last - first) / turns;
        let begin = from + 0.5 * EASE * first;
        let end = to - 0.5 * EASE * last;
        pieces.push(FeedPiece::between(
            [from, 0.0, 0.0],
            [begin, first, change],
            EASE,
        ));
        pieces.push(FeedPiece {
            length: turns,
            coefficients: [begin, first, 0.5 * change, 0.0, 0.0, 0.0],
        });
        pieces.push(FeedPiece::between(
            [end, last, change],
            [to, 0.0, 0.0],
            EASE,
        ));
        Ok(Continuation::End)
    }
}

turnpath_plugin::export!(feeds: [EvenPitch]);

#[cfg(test)]
mod tests {
    use turnpath_plugin_test::{Promise, Trial, check};

    #[test]
    fn conforms() {
        check!(Trial::of("even-pitch").promising(Promise::Residual));
    }
}
