//! Two neighbouring passes at one angle, half a feed to either side of a radius, and the feed with
//! which their cusp has a given height.
//!
//! A large feed spans so much of the profile that the curvature at one place does not describe it.
//! So the noses are placed as the compensator places them, and the tip between them is compared
//! with the nearest place of the profile.

use crate::profile::{Profile, profile_at};
use crate::{Centres, Compensator, Cut, Result};

/// Most rounds of the search for a feed. It takes one to three, and some five where a nose rolls over a
/// ridge.
const ROUNDS: usize = 16;
/// A feed that changes by less than this part of itself is found.
const SETTLED: f64 = 1e-8;
/// The largest factor by which one round changes a feed. Where the nose fills a hollow, cusps say
/// little about it.
const LARGEST_STEP: f64 = 2.0;
/// Evaluations of the profile on the way to the place nearest to a tip. The tip is so near that the
/// first step leaves a thousandth of the way.
const FOOT_ROUNDS: usize = 3;

/// A surface, a tool and the compensator that places it.
#[derive(Clone, Copy)]
pub struct Neighbours<'a> {
    /// Surface and tool.
    pub cut: Cut<'a>,
    /// Places the tool.
    pub compensator: &'a dyn Compensator,
}

/// A feed that is searched for at one (θ, ρ).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeedSearch {
    /// C angle, rad.
    pub theta: f64,
    /// The radius in the middle of both passes, mm.
    pub rho: f64,
    /// The largest feed, mm.
    pub cap: f64,
    /// The feed, mm: a first value, and then the one that [`Neighbours::search`] found.
    pub feed: f64,
}

impl Neighbours<'_> {
    /// Finds the feeds whose cusps are `residual` high, mm.
    ///
    /// Where a pass has no place, or where the passes do not meet, or where the feed does not settle,
    /// the last feed stays whose cusp was at most `residual`. If there was none, the first value
    /// stays.
    pub fn search(&self, residual: f64, searches: &mut [FeedSearch]) {
        let mut open: Vec<OpenSearch> = searches.iter().enumerate().map(OpenSearch::new).collect();
        for _ in 0..ROUNDS {
            if open.is_empty() {
                break;
            }
            let passes: Vec<FeedSearch> = open.iter().map(|search| search.pass).collect();
            let cusps = self.cusps_of_any(&passes);
            let mut next = Vec::new();
            for (mut search, cusp) in open.into_iter().zip(&cusps) {
                let goes_on = search.goes_on(*cusp, residual);
                if let Some(found) = searches.get_mut(search.number) {
                    found.feed = search.found;
                }
                if goes_on {
                    next.push(search);
                }
            }
            open = next;
        }
    }

    /// The heights of the cusps, mm; NaN where there is none. A place that the surface refuses does
    /// not spoil the others.
    fn cusps_of_any(&self, passes: &[FeedSearch]) -> Vec<f64> {
        if let Ok(cusps) = self.cusps(passes) {
            return cusps;
        }
        let alone = |pass: &FeedSearch| {
            let cusp = self.cusps(std::slice::from_ref(pass));
            cusp.map_or(f64::NAN, |cusp| cusp.first().copied().unwrap_or(f64::NAN))
        };
        passes.iter().map(alone).collect()
    }

    fn cusps(&self, passes: &[FeedSearch]) -> Result<Vec<f64>> {
        let theta: Vec<f64> = passes.iter().map(|pass| pass.theta).collect();
        let aside = |side: f64| passes.iter().map(move |pass| pass.rho + side * pass.feed);
        let first = self.noses(&theta, &aside(-0.5).collect::<Vec<_>>())?;
        let second = self.noses(&theta, &aside(0.5).collect::<Vec<_>>())?;
        let radius = self.cut.tool.nose_radius;
        let tips: Vec<[f64; 2]> = first
            .iter()
            .zip(&second)
            .map(|(one, two)| tip(one.centre, two.centre, radius))
            .collect();
        let between = first.iter().zip(&second);
        let feet = between.map(|(one, two)| 0.5 * (one.foot + two.foot));
        self.heights(&theta, &tips, feet.collect())
    }

    /// The noses at each (θ, ρ).
    fn noses(&self, theta: &[f64], rho: &[f64]) -> Result<Vec<Nose>> {
        let blank = || vec![f64::NAN; theta.len()];
        let (mut x, mut z, mut foot) = (blank(), blank(), blank());
        let places = Centres {
            x: &mut x,
            z: &mut z,
            foot: &mut foot,
        };
        self.compensator.centre(self.cut, theta, rho, places)?;
        let nose = |((x, z), foot): ((f64, f64), f64)| Nose {
            centre: [x, z],
            foot,
        };
        let places = x.into_iter().zip(z).zip(foot);
        let mut noses: Vec<Nose> = places.map(nose).collect();
        if !self.compensator.compensates_nose() {
            let mut profiles = vec![Profile::default(); theta.len()];
            profile_at(self.cut.surface, theta, rho, &mut profiles)?;
            for (nose, profile) in noses.iter_mut().zip(&profiles) {
                let along = self.cut.tool.nose_radius / profile.slant();
                nose.centre[0] -= along * profile.slope;
                nose.centre[1] += along;
            }
        }
        Ok(noses)
    }

    /// The distances of the tips from the profile, mm; positive above it. `feet` are first values
    /// of the nearest places.
    fn heights(&self, theta: &[f64], tips: &[[f64; 2]], mut feet: Vec<f64>) -> Result<Vec<f64>> {
        let mut profiles = vec![Profile::default(); tips.len()];
        let mut heights = vec![f64::NAN; tips.len()];
        for _ in 0..FOOT_ROUNDS {
            profile_at(self.cut.surface, theta, &feet, &mut profiles)?;
            let places = profiles.iter().zip(tips);
            for ((profile, tip), (foot, height)) in places.zip(feet.iter_mut().zip(&mut heights)) {
                let (aside, above) = (tip[0] - *foot, tip[1] - profile.height);
                let distance = (aside * aside + above * above).sqrt();
                *height = if above < 0.0 { -distance } else { distance };
                let slope = profile.slope;
                *foot += (aside + above * slope) / (1.0 + slope * slope - above * profile.second);
            }
        }
        Ok(heights)
    }
}

/// A nose at its place.
struct Nose {
    centre: [f64; 2],
    foot: f64,
}

/// The lower crossing of two circles; NaN where they do not meet.
///
/// The measurement finds this crossing with code of its own. The two share nothing on purpose: a
/// fault here would otherwise hide from the measurement.
fn tip(one: [f64; 2], two: [f64; 2], radius: f64) -> [f64; 2] {
    let (dx, dz) = (two[0] - one[0], two[1] - one[1]);
    let squared = 0.25 * (dx * dx + dz * dz);
    let part = ((radius * radius - squared) / squared).sqrt() * 0.5;
    let side = if dx < 0.0 { -part } else { part };
    [
        0.5 * (one[0] + two[0]) + side * dz,
        0.5 * (one[1] + two[1]) - side * dx,
    ]
}

/// A search on its way.
struct OpenSearch {
    /// Which search it is.
    number: usize,
    /// The place, with the feed that is tried.
    pass: FeedSearch,
    /// The feed that stays if the search ends, mm.
    found: f64,
    /// The feed that was tried before, mm, and the root of its cusp.
    before: Option<(f64, f64)>,
    /// The largest feed whose cusp was at most the residual, and the smallest one whose cusp was higher, mm.
    bracket: [f64; 2],
}

impl OpenSearch {
    fn new((number, pass): (usize, &FeedSearch)) -> Self {
        Self {
            number,
            pass: *pass,
            found: pass.feed,
            before: None,
            bracket: [0.0, f64::INFINITY],
        }
    }

    /// Takes the cusp of the feed that was tried, and chooses the next feed. Gives whether the search goes
    /// on.
    fn goes_on(&mut self, cusp: f64, residual: f64) -> bool {
        if cusp.is_nan() {
            return false;
        }
        let feed = self.pass.feed;
        let next = self.next(cusp, residual).min(self.pass.cap);
        let has_settled = (next - feed).abs() <= SETTLED * feed;
        if has_settled {
            self.found = next;
        } else if cusp <= residual {
            self.found = feed;
        }
        self.pass.feed = next;
        !has_settled
    }

    /// A better feed, from this cusp and the one before it.
    fn next(&mut self, cusp: f64, residual: f64) -> f64 {
        let feed = self.pass.feed;
        let [low, high] = &mut self.bracket;
        if cusp <= residual {
            *low = low.max(feed);
        } else {
            *high = high.min(feed);
        }
        let (low, high) = (*low, *high);
        let root = cusp.max(0.0).sqrt();
        let by_square = feed * step_by_square(cusp, residual);
        let Some(before) = self.before.replace((feed, root)) else {
            return by_square;
        };
        // Cusps grow nearly with the square of the feed, and so their roots with the feed.
        let rate = (root - before.1) / (feed - before.0);
        let secant = feed + (residual.sqrt() - root) / rate;
        let is_bracketed = secant >= low && secant <= high.min(LARGEST_STEP * feed);
        match (is_bracketed, high.is_finite()) {
            (true, _) => secant,
            (false, true) => 0.5 * (low + high),
            (false, false) => by_square,
        }
    }
}

/// The factor from a feed with this cusp to the one that leaves `residual`, if cusps grow with the square of
/// the feed.
fn step_by_square(cusp: f64, residual: f64) -> f64 {
    match cusp > residual / (LARGEST_STEP * LARGEST_STEP) {
        true => (residual / cusp).sqrt().max(1.0 / LARGEST_STEP),
        false => LARGEST_STEP,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Misfit, Radial, Scalar, Surface, Tool};

    /// A flat part that ends at a rim.
    struct Disc {
        rim: f64,
    }

    impl Surface for Disc {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, y: S) -> S {
            // NaN beyond the rim.
            (-(x.squared() + y.squared()) + self.rim * self.rim).sqrt() * 0.0
        }
    }

    /// The path of a point.
    struct Bare;

    impl Compensator for Bare {
        fn radial(&self) -> Radial {
            Radial::Centre
        }

        fn compensates_nose(&self) -> bool {
            false
        }

        fn centre(&self, cut: Cut<'_>, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()> {
            let mut profiles = vec![Profile::default(); rho.len()];
            profile_at(cut.surface, theta, rho, &mut profiles)?;
            out.x.copy_from_slice(rho);
            out.foot.copy_from_slice(rho);
            for (z, profile) in out.z.iter_mut().zip(&profiles) {
                *z = profile.height;
            }
            Ok(())
        }
    }

    /// Feeds that begin at a tenth of the one that is right, on a flat under a nose of 1 mm.
    fn found(rho: f64, residual: f64) -> f64 {
        let tool = Tool {
            nose_radius: 1.0,
            included_angle: None,
            clearance_angle: None,
            misfit: Misfit::Refuse,
        };
        let neighbours = Neighbours {
            cut: Cut {
                surface: &Disc { rim: 5.0 },
                tool: &tool,
            },
            compensator: &Bare,
        };
        let mut searches = [FeedSearch {
            theta: 0.3,
            rho,
            cap: 1.9,
            feed: 0.05,
        }];
        neighbours.search(residual, &mut searches);
        searches[0].feed
    }

    #[test]
    fn on_a_flat_the_search_finds_the_closed_form() {
        let residual = 31e-3f64;
        let exact = 2.0 * (2.0 * residual - residual * residual).sqrt();
        let feed = found(2.0, residual);
        assert!((feed / exact - 1.0).abs() < 1e-9, "{feed} for {exact}");
    }

    /// The rounds try 0.05, 0.1, 0.2 and 0.4 mm. With the last one a pass lies beyond the rim.
    #[test]
    fn beside_a_rim_the_last_feed_stays_whose_cusp_was_seen() {
        assert!((found(4.85, 31e-3) - 0.2).abs() < 1e-15);
        // Here even the first pass has no place.
        assert!((found(4.99, 31e-3) - 0.05).abs() < 1e-15);
    }

    /// The feed that a search finds where cusps follow a law of the feed, and its rounds. It begins at
    /// 0.02 mm.
    fn search_by(law: impl Fn(f64) -> f64, residual: f64) -> (f64, usize) {
        let pass = FeedSearch {
            theta: 0.0,
            rho: 1.0,
            cap: 0.4,
            feed: 0.02,
        };
        let mut search = OpenSearch::new((0, &pass));
        let goes_on = |_: &usize| search.goes_on(law(search.pass.feed), residual);
        let rounds = (1..=ROUNDS).take_while(goes_on).count() + 1;
        (search.found, rounds)
    }

    /// Over a ridge cusps are nearly zero up to some feed, and then they grow faster than the square.
    #[test]
    fn the_search_settles_in_few_rounds_whatever_the_law_of_the_cusps() {
        let residual = 2e-4;
        let check = |law: &dyn Fn(f64) -> f64, wanted: f64, most: usize| {
            let (feed, rounds) = search_by(law, residual);
            assert!((feed / wanted - 1.0).abs() < 1e-8, "{feed} for {wanted}");
            assert!(rounds <= most, "{rounds} rounds to {wanted}");
        };
        check(&|feed| 0.5 * feed * feed, 0.02, 1);
        check(&|feed| 0.2 * feed * feed, 1e-3f64.sqrt(), 2);
        // By the square alone these take more than sixteen.
        check(&|feed| 5e-3 * feed, 0.04, 8);
        check(&|feed| 0.02 * feed, 0.01, 8);
        check(&|feed| (feed - 0.018).max(0.0) * 0.02, 0.028, 8);
        check(
            &|feed| 1e-6 + (feed - 0.015).squared(),
            0.015 + 1.99e-4f64.sqrt(),
            8,
        );
        check(
            &|feed| 200.0 * feed.squared().squared(),
            1e-6f64.sqrt().sqrt(),
            8,
        );
    }

    #[test]
    fn a_feed_does_not_exceed_the_cap() {
        assert_eq!(search_by(|_| 0.0, 2e-4).0, 0.4);
        assert_eq!(search_by(|feed| 1e-4 * feed, 2e-4).0, 0.4);
    }

    /// Cusps that jump over the residual: the search ends below the jump.
    #[test]
    fn where_cusps_jump_the_feed_below_the_jump_stays() {
        let (feed, _) = search_by(|feed| if feed < 0.03 { 1e-4 } else { 3e-4 }, 2e-4);
        assert!(feed < 0.03 && feed > 0.0299, "{feed}");
    }
}
