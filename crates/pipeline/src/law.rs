//! The spiral law: the feed strategy gives it piece by piece; the host checks it and keeps it
//! whole.
//!
//! A piece takes 56 bytes. A law with one feed for each radius has some hundred pieces, whatever
//! the part. A law that changes with the angle has some pieces for every revolution.

use std::mem;

use turnpath_core::law_limits::room_beyond;
use turnpath_core::{
    Continuation, Direction, FeedPiece, Locus, RadialRange, Setup, SpiralLaw, Task,
};

use crate::observer::{Observer, stop_if_cancelled};
use crate::path_size::{MOST_PIECES, MOST_REVOLUTIONS};
use crate::planning_locus::PlanningLocus;
use crate::size::check_law;
use crate::{Chain, Result};

/// Angles of a revolution at which each turn must lie beyond the one before.
const CHECKED_ANGLES: usize = 72;
/// Positions at which a law is evaluated in one call. More of them take more memory, and fewer more calls.
const POSITIONS: u64 = 1024;
/// Largest jump of ρ where two pieces meet, mm: a nanometre, far above rounding.
const LARGEST_JUMP: f64 = 1e-6;
/// How much of the range a law may leave uncovered at either end, mm.
const SLACK: f64 = 1e-5;

/// Plans the law and checks it.
pub fn plan(
    chain: &Chain,
    task: &Task,
    locus: &dyn Locus,
    observer: &dyn Observer,
) -> Result<SpiralLaw> {
    let locus = &PlanningLocus(locus);
    let setup = Setup { task, locus };
    let failed = |error| chain.feed.failed("while planning the law", error);
    let mut plan = chain.feed.strategy.plan(setup).map_err(failed)?;
    let mut law = SpiralLaw::new();
    let mut check = SpiralCheck::new(task);
    let mut pieces: Vec<FeedPiece> = Vec::new();
    loop {
        stop_if_cancelled(observer)?;
        pieces.clear();
        let onward = plan
            .extend(setup, &mut pieces)
            .map_err(|error| chain.feed.failed(after(&law), error))?;
        if pieces.is_empty() && onward == Continuation::More {
            let what = format!("no piece, {}", after(&law));
            return Err(chain.feed.bad_answer(what));
        }
        check_law(&law, pieces.len(), task, locus)?;
        for piece in &pieces {
            add(&mut law, piece).map_err(|what| chain.feed.bad_answer(what))?;
        }
        check_law(&law, 0, task, locus)?;
        check
            .follow(&law)
            .map_err(|what| chain.feed.bad_answer(what))?;
        if onward == Continuation::End {
            break;
        }
    }
    covers(&law, task).map_err(|what| chain.feed.bad_answer(what))?;
    Ok(law)
}

fn after(law: &SpiralLaw) -> String {
    format!("after {:.3} revolutions", law.end())
}

/// What is wrong with a law, if anything is.
type CheckResult = std::result::Result<(), String>;

/// Appends a piece that begins where the law ends.
fn add(law: &mut SpiralLaw, piece: &FeedPiece) -> CheckResult {
    if law.pieces().len() >= MOST_PIECES {
        return Err(format!("more than {MOST_PIECES} pieces, {}", after(law)));
    }
    let numbers = piece.coefficients.iter().all(|c| c.is_finite());
    if !(numbers && piece.length.is_finite() && piece.length > 0.0) {
        let FeedPiece {
            length,
            coefficients,
        } = piece;
        let what = format!("a piece of {length} revolutions with coefficients {coefficients:?}");
        return Err(format!("{what}, {}", after(law)));
    }
    let (before, here) = (law.value(law.end()), piece.coefficients[0]);
    if (here - before).abs() > LARGEST_JUMP {
        let jump = format!("a jump from ρ = {before} mm to {here} mm");
        return Err(format!("{jump}, {}", after(law)));
    }
    law.push(piece.length, piece.coefficients);
    Ok(())
}

/// Checks that the law begins and ends at the two ends of the range, or beyond.
fn covers(law: &SpiralLaw, task: &Task) -> CheckResult {
    if law.pieces().is_empty() {
        return Err("a law without pieces".to_owned());
    }
    let (start, end) = (law.value(0.0), law.value(law.end()));
    let RadialRange { inner, outer } = task.range;
    let (low, high) = match task.direction {
        Direction::Outward => (start, end),
        Direction::Inward => (end, start),
    };
    // No number is refused too.
    let covers = low <= inner + SLACK && high >= outer - SLACK;
    if !covers {
        return Err(format!(
            "the law runs from ρ = {start} mm to {end} mm and leaves some of the part uncut; it must \
             cover {inner} mm to {outer} mm"
        ));
    }
    Ok(())
}

/// Follows a law while it grows. Every turn must lie beyond the one before, at every angle, and
/// none may lie far beyond the range. So a law that does not end is refused.
struct SpiralCheck {
    outward: f64,
    allowed: std::ops::RangeInclusive<f64>,
    ring: Vec<f64>,
    next: u64,
    /// Revolutions at which the law is checked together, and its values there.
    n: Vec<f64>,
    rho: Vec<f64>,
}

impl SpiralCheck {
    fn new(task: &Task) -> Self {
        let RadialRange { inner, outer } = task.range;
        let beyond = room_beyond(task);
        Self {
            outward: match task.direction {
                Direction::Outward => 1.0,
                Direction::Inward => -1.0,
            },
            allowed: inner - beyond..=outer + beyond,
            ring: Vec::with_capacity(CHECKED_ANGLES),
            next: 0,
            n: Vec::new(),
            rho: Vec::new(),
        }
    }

    /// Checks what the law has gained since the last call.
    fn follow(&mut self, law: &SpiralLaw) -> CheckResult {
        if law.end() > MOST_REVOLUTIONS {
            return Err(format!(
                "a law of more than {MOST_REVOLUTIONS:e} revolutions"
            ));
        }
        while !law.pieces().is_empty() {
            let n = (self.next..self.next + POSITIONS).map(|i| i as f64 / CHECKED_ANGLES as f64);
            self.n.clear();
            self.n.extend(n.take_while(|n| *n <= law.end()));
            if self.n.is_empty() {
                break;
            }
            self.rho.resize(self.n.len(), f64::NAN);
            law.values(&self.n, &mut self.rho);
            let (places, values) = (mem::take(&mut self.n), mem::take(&mut self.rho));
            for (n, rho) in places.iter().zip(&values) {
                self.check(*n, *rho)?;
                self.next += 1;
            }
            (self.n, self.rho) = (places, values);
        }
        Ok(())
    }

    /// Checks one point. The comparisons also fail for what is no number.
    fn check(&mut self, n: f64, rho: f64) -> CheckResult {
        let context = || {
            format!(
                "at {:.1} deg, turn {:.0}",
                360.0 * (n - n.floor()),
                n.floor()
            )
        };
        if !self.allowed.contains(&rho) {
            return Err(format!("{}, ρ = {rho} mm lies far off the part", context()));
        }
        let slot = (self.next % CHECKED_ANGLES as u64) as usize;
        match self.ring.get_mut(slot) {
            None => self.ring.push(rho),
            Some(last) if (rho - *last) * self.outward > 0.0 => *last = rho,
            Some(last) => {
                return Err(format!(
                    "{} lies at ρ = {rho} mm, not beyond the one before at {last} mm",
                    context()
                ));
            }
        }
        Ok(())
    }
}
