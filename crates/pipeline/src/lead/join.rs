//! Where a lead joins the cut: what the cut, as played, does there.

use std::f64::consts::TAU;

use turnpath_core::toolpath::{ControlPoint, Cubic, PathBlock, Segment};
use turnpath_verify::{AxesMotion, Meter};

use crate::plan::Plan;
use crate::{PipelineError, Result};

/// Which of the two leads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// From rest to the cut.
    In,
    /// From the cut to rest.
    Out,
}

impl Side {
    /// Which way the time away from the join runs against the path's.
    pub fn sign(self) -> f64 {
        match self {
            Self::In => -1.0,
            Self::Out => 1.0,
        }
    }

    /// As people say it.
    pub fn name(self) -> &'static str {
        match self {
            Self::In => "lead-in",
            Self::Out => "lead-out",
        }
    }
}

/// The cut where a lead joins it.
#[derive(Debug, Clone, Copy)]
pub struct Join {
    /// The control point.
    pub point: ControlPoint,
    /// Accelerations of C, X and Z there, of the cut's own segment as played.
    pub acceleration: [f64; 3],
    /// ρ, mm, and its first two derivatives in time by the law.
    pub rho: f64,
    /// mm/s.
    pub rho_rate: f64,
    /// mm/s².
    pub rho_bend: f64,
    /// Z above the first touch, mm: none but a rounding where the compensator is right.
    pub above_touch: f64,
    /// Largest |played − first touch| of the cut's own segment there, mm.
    pub error: f64,
    /// How the cut moves near the join.
    pub cut: AxesMotion,
}

impl Join {
    /// The join with a cut that begins or ends with the points `pair`, in order of time.
    pub fn new(
        plan: &Plan<'_>,
        side: Side,
        pair: &[ControlPoint; 2],
        cut: AxesMotion,
    ) -> Result<Self> {
        let segment = Segment::between(&pair[0], &pair[1]);
        let (point, s) = match side {
            Side::In => (pair[0], 0.0),
            Side::Out => (pair[1], 1.0),
        };
        if !(point.vc > 0.0 && point.vc.is_finite()) {
            return Err(PipelineError::Lead {
                which: side.name(),
                what: format!("C turns by {} rad/s where it would join the cut", point.vc),
            });
        }
        let per_time = (segment.duration * segment.duration).recip();
        let bend = |axis: &Cubic| axis.bend(s) * per_time;
        let n = match side {
            Side::In => plan.on_time(0.0).0,
            Side::Out => plan.on_time(plan.law.end()).0,
        };
        let series = match side {
            Side::In => plan.law.series(n),
            Side::Out => plan.law.series_before(n),
        };
        let turning = plan.prepared.task.spindle.speed_at(n) / TAU;
        Ok(Self {
            point,
            acceleration: [bend(&segment.c), bend(&segment.x), bend(&segment.z)],
            rho: series[0],
            rho_rate: series[1] * turning,
            rho_bend: 2.0 * series[2] * turning * turning,
            above_touch: above_touch(plan, &point)?,
            error: error(plan, pair)?,
            cut,
        })
    }

    /// The same cut, later by `time` and with C farther on by so many revolutions.
    pub fn shifted(mut self, turns: f64, time: f64) -> Self {
        self.point.c += TAU * turns;
        self.point.t += time;
        self
    }
}

/// The played error of the cut's segment between two points.
fn error(plan: &Plan<'_>, pair: &[ControlPoint; 2]) -> Result<f64> {
    let mut points = PathBlock {
        shape: plan.chain.velocity.strategy.segments(),
        ..PathBlock::default()
    };
    pair.iter().for_each(|point| points.push(*point));
    let errors = Meter::segment_errors(&plan.prepared.touch, &points);
    let errors = errors.map_err(PipelineError::Measure)?;
    Ok(errors.into_iter().fold(0.0, f64::max))
}

fn above_touch(plan: &Plan<'_>, point: &ControlPoint) -> Result<f64> {
    let mut touches = Vec::new();
    let touch = &plan.prepared.touch;
    touch
        .find(&[point.c.rem_euclid(TAU)], &[point.x], &mut touches)
        .map_err(PipelineError::Measure)?;
    let z = touches.first().map_or(f64::NAN, |touch| touch.z);
    Ok(point.z - z)
}
