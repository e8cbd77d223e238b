//! Spindle strategies: the factors that the host asks for, and the machine's limits.

use turnpath_core::{Path, SpindleAsk, SpindleLaw};
use turnpath_pipeline::Outcome;

use crate::chain::TrialChain;
use crate::fault::FaultKind;
use crate::laws::straight;

/// Turns of the law that is asked about.
const TURNS: f64 = 40.0;
/// The factor that is asked for in the middle third of the path.
const SLOW: f64 = 0.5;
/// By how much a speed may exceed what was asked for, or a peak its limit, as a part of it: rounding,
/// and the host's own measure of "held".
const SLACK: f64 = 1e-6;

/// Checks the spindle strategy of a chain; `outcome` is that of a whole path.
pub fn check(chain: &TrialChain, outcome: &Outcome) -> Vec<FaultKind> {
    if !chain.chain.spindle.strategy.follows_factors() {
        return Vec::new();
    }
    let mut faults: Vec<FaultKind> = factors(chain).err().into_iter().collect();
    let figures = outcome
        .figures
        .axes
        .against(&chain.task().machine, outcome.certain.as_ref());
    let exceeded = figures
        .into_iter()
        .filter(|figure| figure.ratio() > 1.0 + SLACK);
    faults.extend(exceeded.map(|figure| FaultKind::Limit {
        limit: figure.limit,
        ratio: figure.ratio(),
    }));
    faults
}

/// The law keeps to the factor of every half turn.
fn factors(chain: &TrialChain) -> Result<(), FaultKind> {
    let task = chain.task();
    let (law, speed) = (straight(task, TURNS), task.spindle_speed);
    let path = Path {
        task,
        locus: &chain.preparation.locus,
        law: &law,
        spindle: &SpindleLaw::constant(speed),
    };
    let halves = (2.0 * TURNS) as usize;
    let middle = halves / 3..2 * halves / 3;
    let factor = |half: usize| if middle.contains(&half) { SLOW } else { 1.0 };
    let factors: Vec<f64> = (0..halves).map(factor).collect();
    let ask = SpindleAsk {
        speed,
        factors: &factors,
    };
    let planned = chain.chain.spindle.strategy.plan(&path, &ask);
    let spindle = planned.map_err(|error| FaultKind::Call {
        call: "plan",
        error,
    })?;
    for (half, asked) in factors.iter().enumerate() {
        for part in [0.1, 0.5, 0.9] {
            let n = 0.5 * (half as f64 + part);
            let found = spindle.speed_at(n) / speed;
            let fits = (0.0..=asked * (1.0 + SLACK)).contains(&found);
            if !fits {
                let asked = *asked;
                return Err(FaultKind::Factor { n, asked, found });
            }
        }
    }
    Ok(())
}
