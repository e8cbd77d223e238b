//! The spiral law: asked for piece by piece, checked, kept whole.
//!
//! A piece takes 56 bytes. Laws with one value a radius have some hundred pieces whatever the
//! part; one that changes with the angle has some for every revolution.

use turnpath_core::{Direction, Job, Locus, Onward, Setup, SpiralLaw, Stretch};

use crate::{Chain, Result};

/// Angles of a revolution at which the next turn must lie beyond the last.
const CHECKED_ANGLES: usize = 72;
/// More revolutions than any job has: a law that gets here does not end.
const MOST_REVOLUTIONS: f64 = 1e8;

/// Plans the law and checks it.
pub fn plan(chain: &Chain, job: &Job, locus: &dyn Locus) -> Result<SpiralLaw> {
    let setup = Setup { job, locus };
    let failed = |error| chain.feed.failed("while planning the law", error);
    let mut plan = chain.feed.strategy.plan(setup).map_err(failed)?;
    let mut law = SpiralLaw::new();
    let mut pieces: Vec<Stretch> = Vec::new();
    loop {
        pieces.clear();
        let place = |law: &SpiralLaw| format!("after {:.3} revolutions", law.end());
        let onward = plan
            .extend(setup, &mut pieces)
            .map_err(|error| chain.feed.failed(place(&law), error))?;
        for piece in &pieces {
            let numbers = piece.coefficients.iter().all(|c| c.is_finite());
            if !(numbers && piece.length.is_finite() && piece.length > 0.0) {
                return Err(chain.feed.bad_answer(format!("{piece:?}, {}", place(&law))));
            }
            law.push(piece.length, piece.coefficients);
        }
        if pieces.is_empty() && onward == Onward::More {
            return Err(chain.feed.bad_answer(format!("no piece, {}", place(&law))));
        }
        if law.end() > MOST_REVOLUTIONS {
            let what = format!("a law of more than {MOST_REVOLUTIONS:e} revolutions");
            return Err(chain.feed.bad_answer(what));
        }
        if onward == Onward::Done {
            break;
        }
    }
    check(&law, job.direction).map_err(|what| chain.feed.bad_answer(what))?;
    Ok(law)
}

/// Every turn lies beyond the last, at every angle.
fn check(law: &SpiralLaw, direction: Direction) -> std::result::Result<(), String> {
    if law.pieces().is_empty() {
        return Err("a law without pieces".to_owned());
    }
    let outward = if direction == Direction::Outward {
        1.0
    } else {
        -1.0
    };
    let step = 1.0 / CHECKED_ANGLES as f64;
    let mut ring: Vec<f64> = Vec::with_capacity(CHECKED_ANGLES);
    let count = (law.end() / step).floor() as u64;
    for i in 0..=count {
        let n = (i as f64 * step).min(law.end());
        let (slot, rho) = ((i % CHECKED_ANGLES as u64) as usize, law.value(n));
        match ring.get_mut(slot) {
            None => ring.push(rho),
            Some(last) => {
                // A comparison that also fails for what is no number.
                if (rho - *last) * outward > 0.0 {
                    *last = rho;
                    continue;
                }
                let angle = 360.0 * (n - n.floor());
                return Err(format!(
                    "at {angle:.1} deg, turn {:.0} lies at ρ = {rho} mm, not beyond the one \
                     before at {last} mm",
                    n.floor()
                ));
            }
        }
    }
    Ok(())
}
