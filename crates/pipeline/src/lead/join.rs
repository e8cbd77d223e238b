//! Where a lead joins the cut, and how the cut as played moves there.

use std::f64::consts::TAU;

use turnpath_core::toolpath::{ControlPoint, Cubic, PathBlock, Segment};
use turnpath_verify::{AxesMotion, Meter};

use crate::plan::Plan;
use crate::{PipelineError, Result};

/// One of the two leads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LeadKind {
    /// From rest to the cut.
    In,
    /// From the cut to rest.
    Out,
}

impl LeadKind {
    /// The sign of the time away from the join in the path's time.
    pub fn sign(self) -> f64 {
        match self {
            Self::In => -1.0,
            Self::Out => 1.0,
        }
    }

    /// Its name in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::In => "lead-in",
            Self::Out => "lead-out",
        }
    }
}

/// How the cut moves where a lead joins it.
#[derive(Debug, Clone, Copy)]
pub struct Join {
    /// The control point.
    pub point: ControlPoint,
    /// Accelerations of C, X and Z there, of the cut's own segment as played, rad/s² and mm/s².
    pub acceleration: [f64; 3],
    /// ρ of the law, mm.
    pub rho: f64,
    /// dρ/dt of the law, mm/s.
    pub rho_rate: f64,
    /// d²ρ/dt² of the law, mm/s².
    pub rho_bend: f64,
    /// Z above the first touch, mm. Where the compensator is right it is only a rounding.
    pub above_touch: f64,
    /// Largest |played − first touch| of the cut's own segment there, mm.
    pub error: f64,
    /// How the cut moves near the join.
    pub cut: AxesMotion,
}

impl Join {
    /// The join with a cut whose first or last points are `pair`, in order of time.
    pub fn new(
        plan: &Plan<'_>,
        kind: LeadKind,
        pair: &[ControlPoint; 2],
        cut: AxesMotion,
    ) -> Result<Self> {
        let segment = Segment::between(&pair[0], &pair[1]);
        let (point, s) = match kind {
            LeadKind::In => (pair[0], 0.0),
            LeadKind::Out => (pair[1], 1.0),
        };
        if !(point.vc > 0.0 && point.vc.is_finite()) {
            return Err(PipelineError::Lead {
                which: kind.name(),
                what: format!("C turns by {} rad/s where it would join the cut", point.vc),
            });
        }
        let per_time = (segment.duration * segment.duration).recip();
        let bend = |axis: &Cubic| axis.bend(s) * per_time;
        let n = match kind {
            LeadKind::In => plan.on_time(0.0).0,
            LeadKind::Out => plan.on_time(plan.law.end()).0,
        };
        let series = match kind {
            LeadKind::In => plan.law.series(n),
            LeadKind::Out => plan.law.series_before(n),
        };
        let turning = plan.spindle.speed_at(n) / TAU;
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

    /// The same join later by `time`, s, and with C farther on by so many revolutions.
    pub fn shifted(mut self, turns: f64, time: f64) -> Self {
        self.point.c += TAU * turns;
        self.point.t += time;
        self
    }
}

/// The largest played error of the cut's segment between two points, mm.
fn error(plan: &Plan<'_>, pair: &[ControlPoint; 2]) -> Result<f64> {
    let points = PathBlock::of(plan.segment_shape(), *pair);
    let errors = Meter::segment_errors(&plan.preparation.touch, &points);
    let errors = errors.map_err(PipelineError::Measure)?;
    Ok(errors.into_iter().fold(0.0, f64::max))
}

/// Z of a point above the first touch there, mm.
fn above_touch(plan: &Plan<'_>, point: &ControlPoint) -> Result<f64> {
    let mut touches = Vec::new();
    let touch = &plan.preparation.touch;
    touch
        .find(&[point.c.rem_euclid(TAU)], &[point.x], &mut touches)
        .map_err(PipelineError::Measure)?;
    let z = touches.first().map_or(f64::NAN, |touch| touch.z);
    Ok(point.z - z)
}
