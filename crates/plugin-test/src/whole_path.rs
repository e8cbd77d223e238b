//! Whole paths: made on one thread and on several, compared bit by bit, and measured.

use std::convert::Infallible;

use turnpath_core::NM;
use turnpath_core::toolpath::{PathBlock, SectionBlock};
use turnpath_pipeline::{
    AIM, DraftSink, Outcome, PathOptions, RunError, SilentObserver, Sink, make_unmeasured, run,
};

use crate::chain::TrialChain;
use crate::fault::FaultKind;
use crate::place::{AlongPath, OnPart};
use crate::trial::{Promise, Trial};

/// Threads of the second path: more than most strategies are tried with, on any machine.
const THREADS: usize = 4;
/// How far a measured figure may exceed its tolerance, as a factor: as much as in the verdict of a run.
const ALLOWANCE: f64 = 1.001;

/// The points of a path.
#[derive(Default)]
struct Points(PathBlock);

impl Sink for Points {
    type Block = PathBlock;
    type Error = Infallible;

    fn encode(&self, block: &SectionBlock<'_>) -> Result<PathBlock, Infallible> {
        Ok(block.points.clone())
    }

    fn take(&mut self, _: usize, block: PathBlock) -> Result<(), Infallible> {
        block.points().for_each(|point| self.0.push(point));
        Ok(())
    }
}

impl DraftSink for Points {
    fn drop_draft(&mut self) {
        *self = Self::default();
    }
}

/// Makes the path on one thread, and again on several by strategies that are made anew. Gives the
/// figures of the path before refinement and after it.
pub fn check(first: &TrialChain, anew: &TrialChain) -> Result<[Outcome; 2], FaultKind> {
    let bare = PathOptions {
        refine: false,
        covers_centre: true,
        ..PathOptions::default()
    };
    let mut path = Points::default();
    let before = on_threads(1, || measured(first, bare, &mut path))?;
    let again = unmeasured(THREADS, anew, bare)?;
    if let Err(fault) = same(&path.0, &again, "by a strategy that is made anew") {
        // The strategy itself may give other answers on several threads.
        same(
            &path.0,
            &unmeasured(THREADS, first, bare)?,
            "on several threads",
        )?;
        return Err(fault);
    }
    // Refinement would find nothing to halve: it looks at both.
    let (figures, tolerance) = (&before.figures, first.task().tolerance);
    let holds = figures.playback.max() <= AIM * tolerance.interpolation
        && figures.residual.max <= tolerance.residual;
    if holds {
        return Ok([before.clone(), before]);
    }
    let refined = PathOptions {
        refine: true,
        ..bare
    };
    let after = on_threads(THREADS, || measured(first, refined, &mut Points::default()))?;
    Ok([before, after])
}

fn measured(
    trial: &TrialChain,
    options: PathOptions,
    points: &mut Points,
) -> Result<Outcome, RunError<Infallible>> {
    let (chain, preparation) = (&trial.chain, &trial.preparation);
    run(chain, preparation, options, points, &SilentObserver)
}

fn unmeasured(
    threads: usize,
    trial: &TrialChain,
    options: PathOptions,
) -> Result<PathBlock, FaultKind> {
    let (chain, preparation) = (&trial.chain, &trial.preparation);
    let mut points = Points::default();
    on_threads(threads, || {
        make_unmeasured(chain, preparation, options, &mut points, &SilentObserver)
    })?;
    Ok(points.0)
}

fn on_threads<T: Send>(
    threads: usize,
    work: impl FnOnce() -> Result<T, RunError<Infallible>> + Send,
) -> Result<T, FaultKind> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let answer = match pool {
        Ok(pool) => pool.install(work),
        // A system that starts no thread: the present ones do the work.
        Err(_) => work(),
    };
    answer.map_err(|error| match error {
        RunError::Pipeline(error) => FaultKind::Path(error),
        RunError::Sink(never) => match never {},
    })
}

/// Whether two paths have the same bits.
fn same(first: &PathBlock, second: &PathBlock, when: &'static str) -> Result<(), FaultKind> {
    let columns = |path: &PathBlock| {
        let PathBlock {
            t,
            c,
            x,
            z,
            vc,
            vx,
            vz,
            ..
        } = path.clone();
        [t, c, x, z, vc, vx, vz]
    };
    if first.len() != second.len() {
        return Err(FaultKind::Repeat {
            what: "the number of control points".to_owned(),
            when,
            first: first.len() as f64,
            second: second.len() as f64,
        });
    }
    let names = ["t", "C", "X", "Z", "vC", "vX", "vZ"];
    let pairs = columns(first).into_iter().zip(columns(second));
    for (name, (first, second)) in names.into_iter().zip(pairs) {
        let differs = |(one, other): (&f64, &f64)| one.to_bits() != other.to_bits();
        if let Some(i) = first.iter().zip(&second).position(differs) {
            return Err(FaultKind::Repeat {
                what: format!("{name} of control point {i}"),
                when,
                first: first[i],
                second: second[i],
            });
        }
    }
    Ok(())
}

/// The interpolation tolerance holds after refinement, and before it where that is promised.
pub fn holds_as_played(
    trial: &Trial,
    chain: &TrialChain,
    [before, after]: &[Outcome; 2],
) -> Vec<FaultKind> {
    let tolerance = chain.task().tolerance.interpolation;
    let mut cases = vec![("after", after)];
    if trial.promises(Promise::Tolerance) {
        cases.push(("before", before));
    }
    let mut faults = Vec::new();
    for (when, outcome) in cases {
        let played = outcome.figures.playback;
        if played.max() > tolerance * ALLOWANCE {
            faults.push(FaultKind::Played {
                when,
                place: AlongPath {
                    c: played.at_c,
                    x: played.at_x,
                },
                error: played.max(),
                tolerance,
            });
        }
    }
    faults
}

/// The highest cusp is within the residual where that is promised.
pub fn holds_residual(trial: &Trial, chain: &TrialChain, outcome: &Outcome) -> Option<FaultKind> {
    let tolerance = chain.task().tolerance.residual;
    let residual = outcome.figures.residual;
    let exceeded = trial.promises(Promise::Residual)
        && residual
            .highest()
            .is_none_or(|height| height > tolerance * ALLOWANCE);
    exceeded.then_some(FaultKind::Residual {
        place: OnPart {
            theta: residual.at_theta,
            rho: residual.at_rho,
        },
        height: residual.max,
        tolerance,
    })
}

/// What the path came to, for whoever reads the answer of a check.
pub fn figures([before, after]: &[Outcome; 2]) -> String {
    format!(
        "{} points, {:.3} nm as played; refinement adds {}; highest cusp {:.3} nm; {:.1} revolutions in {:.3} s",
        before.control_points,
        before.figures.playback.max() / NM,
        after.added_by_refine,
        after.figures.residual.max / NM,
        after.revolutions,
        after.cutting_time,
    )
}
