//! The sampler `fft-adaptive`: eq. 1 and 4, and the critical step from a spectrum.

use turnpath_plugin::hermite::MAX_STEP;
use turnpath_plugin::prelude::*;

use crate::chord::Chord;
use crate::harmonics::Harmonics;
use crate::printed::step_from;
use crate::revolution::Revolution;
use crate::rule::Rule;

/// A node that lies closer to the revolution's end than this part of its step is left out.
const SLACK: f64 = 1e-3;

/// The curvature that decides the length of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Curvature {
    /// The largest curvature on the step.
    Step,
    /// The curvature at the step's start, on the circle through it.
    Start,
}

/// Steps whose chord stays within the interpolation tolerance, and at least two steps in the
/// shortest wave that is as high as the tolerance.
#[derive(Clone)]
pub struct FftAdaptiveSampler {
    chord: Chord,
    curvature: Curvature,
    max_step: f64,
    harmonics: Harmonics,
}

const CHORD: Param<Choice> = Param::choice(
    "chord",
    &["full", "half"],
    "full: eq. 1 as printed, the chord whose sagitta is tolerance.interpolation; half: half \
             of it",
)
.default("full");
const CURVATURE: Param<Choice> = Param::choice(
            "curvature",
            &["step", "start"],
            "step: the largest curvature on the step, along the spiral; start: the curvature at \
             the step's start, along the circle of that radius, as printed; from inflections such a \
             step passes over crests",
        )
        .default("step");

impl Strategy for FftAdaptiveSampler {
    const NAME: &'static str = "fft-adaptive";
    const SUMMARY: &'static str = "steps whose chord stays within the tolerance, and never longer \
        than half the shortest wave that is as high as it";
    const SOURCE: &'static str = "Zhong, Tong, Chen and Jiang, Development of an adaptive toolpath \
        planning strategy for diamond face turning of freeform surfaces (no DOI is known), \
        eq. 1 and 4; the printed rule is curvature = \"start\"";
    const PARAMS: &'static [ParamInfo] = &[CHORD.info(), CURVATURE.info(), MAX_STEP.info()];

    fn new(params: &Params) -> Result<Self> {
        let curvature = match params.get(CURVATURE) {
            "start" => Curvature::Start,
            _ => Curvature::Step,
        };
        Ok(Self {
            chord: Chord::from_word(params.get(CHORD)),
            curvature,
            max_step: params.get(MAX_STEP),
            harmonics: Harmonics::default(),
        })
    }
}

impl SamplerPlan for FftAdaptiveSampler {
    fn place(&self, path: &Path<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()> {
        for turn in block.turns() {
            let longest = self.critical_step(path, turn.start)?;
            let rule = Rule::new(path.task, self.chord, longest);
            match self.curvature {
                Curvature::Step => {
                    let revolution = Revolution::evaluate(path, turn, rule)?;
                    walk(turn, nodes, |n| Ok(revolution.step_over(n)))?;
                }
                Curvature::Start => walk(turn, nodes, |n| step_from(path, turn, n, &rule))?,
            }
        }
        Ok(())
    }
}

/// Appends nodes from the turn's start on. Each lies one step (rad) after the node before.
fn walk(turn: Turn, nodes: &mut NodeList, mut step: impl FnMut(f64) -> Result<f64>) -> Result<()> {
    let mut n = turn.start;
    while n < turn.end {
        nodes.push(n);
        let step = step(n)? / TAU;
        n = if turn.end - n < (1.0 + SLACK) * step {
            turn.end
        } else {
            n + step
        };
    }
    Ok(())
}

impl FftAdaptiveSampler {
    /// Δθ_ct = π/k, rad: two steps in a period of the highest harmonic of the tool centre on the
    /// circle of the revolution's starting radius. It is never more than `max_step`.
    fn critical_step(&self, path: &Path<'_>, start: f64) -> Result<f64> {
        let rho = path.radius_at(start);
        let tolerance = path.task.tolerance.interpolation;
        let highest = self
            .harmonics
            .highest(tolerance, |z| heights(path, rho, z))?;
        let critical = match highest {
            0 => f64::INFINITY,
            k => PI / k as f64,
        };
        Ok(critical.min(self.max_step))
    }
}

/// The tool centre's Z on the circle of radius `rho`, at even angles.
fn heights(path: &Path<'_>, rho: f64, z: &mut [f64]) -> Result<()> {
    let count = z.len();
    let theta: Vec<f64> = (0..count).map(|j| TAU * j as f64 / count as f64).collect();
    let mut room = vec![f64::NAN; 2 * count];
    let (x, foot) = room.split_at_mut(count);
    let rho = vec![rho; count];
    path.locus.centre(&theta, &rho, Centres { x, z, foot })
}
