//! The course of a lead: where the axes are at any time away from the join.

use std::f64::consts::TAU;

use turnpath_core::{CentreBuffers, Locus, even_angles};
use turnpath_verify::Touch;

use super::join::{Join, LeadKind};
use super::phases::Phases;
use crate::plan::Plan;
use crate::{PipelineError, Result};

/// Angles of a revolution over which X of the locus is averaged to give X at rest.
const ANGLES: usize = 72;
/// Largest distance, in nose radii, by which ρ overshoots the cut while its rate goes to rest. A
/// spiral overshoots by a feed or two; a law that moves X to and fro would do so by millimetres.
const LARGEST_OVERSHOOT: f64 = 0.25;

/// ρ beyond the cut. Its rate goes from the law's own to rest. Its second derivative begins as the
/// law's own and ends as zero.
#[derive(Debug, Clone, Copy)]
struct Overshoot {
    from: f64,
    rate: f64,
    bend: f64,
    time: f64,
}

impl Overshoot {
    fn new(kind: LeadKind, join: &Join, longest: f64, nose_radius: f64) -> Self {
        let (rate, bend) = (kind.sign() * join.rho_rate, join.rho_bend);
        let largest = LARGEST_OVERSHOOT * nose_radius;
        // |rate|/2 time + |bend|/12 time² = largest.
        let half = 0.5 * rate.abs();
        let by_distance =
            2.0 * largest / (half + (half * half + bend.abs() * largest / 3.0).sqrt());
        Self {
            from: join.rho,
            rate,
            bend,
            time: longest.min(by_distance),
        }
    }

    fn rho(&self, sigma: f64) -> f64 {
        let s = (sigma / self.time).min(1.0);
        let by_rate = s * (1.0 - s * s * (1.0 - 0.5 * s));
        let by_bend = s * s * (0.5 - s * (2.0 / 3.0 - 0.25 * s));
        self.from + self.time * (self.rate * by_rate + self.bend * self.time * by_bend)
    }
}

/// The course of a lead.
pub struct Course<'a> {
    plan: &'a Plan<'a>,
    kind: LeadKind,
    join: &'a Join,
    phases: Phases,
    overshoot: Overshoot,
    /// Where X rests, mm.
    pub rest_x: f64,
    /// Where Z rests, mm.
    pub rest_z: f64,
}

/// Positions of the axes at some instants.
pub struct AxisPositions {
    /// C, rad.
    pub c: Vec<f64>,
    /// X, mm.
    pub x: Vec<f64>,
    /// Z, mm.
    pub z: Vec<f64>,
}

impl<'a> Course<'a> {
    /// The course from or to rest at height `rest_z`, mm. ρ may overshoot the cut for at most
    /// `overshoot` s.
    pub fn new(
        plan: &'a Plan<'a>,
        kind: LeadKind,
        join: &'a Join,
        phases: Phases,
        rest_z: f64,
        overshoot: f64,
    ) -> Result<Self> {
        let nose_radius = plan.preparation.task.tool.nose_radius;
        let overshoot = Overshoot::new(kind, join, phases.descent.min(overshoot), nose_radius);
        let mut course = Self {
            plan,
            kind,
            join,
            phases,
            overshoot,
            rest_x: f64::NAN,
            rest_z,
        };
        let theta: Vec<f64> = even_angles(ANGLES).collect();
        let rho = vec![overshoot.rho(phases.descent); ANGLES];
        let around = course.locus_x(&theta, &rho)?;
        course.rest_x = around.iter().sum::<f64>() / ANGLES as f64;
        Ok(course)
    }

    /// C at rest, rad.
    pub fn rest_c(&self) -> f64 {
        match self.kind {
            // The path begins at C = 0, and turns by whole revolutions before the cut.
            LeadKind::In => 0.0,
            LeadKind::Out => self.c(self.phases.all()),
        }
    }

    fn c(&self, sigma: f64) -> f64 {
        self.join.point.c + self.kind.sign() * self.phases.turned(sigma)
    }

    /// Where the axes are at times away from the join, s, on a course that begins higher by `raised`
    /// mm.
    pub fn positions(&self, sigma: &[f64], raised: f64) -> Result<AxisPositions> {
        let c: Vec<f64> = sigma.iter().map(|sigma| self.c(*sigma)).collect();
        let theta: Vec<f64> = c.iter().map(|c| c.rem_euclid(TAU)).collect();
        let rho: Vec<f64> = sigma
            .iter()
            .map(|sigma| self.overshoot.rho(*sigma))
            .collect();
        let mut x = self.locus_x(&theta, &rho)?;
        for (x, sigma) in x.iter_mut().zip(sigma) {
            *x = between(*x, self.rest_x, self.phases.lifted(*sigma));
        }
        let touches = self.touches(&theta, &x)?;
        let height = |(sigma, touch): (&f64, &Touch)| {
            let lifted = self.phases.lifted(*sigma);
            let above = (self.join.above_touch + raised) * (1.0 - lifted);
            between(touch.z, self.rest_z, lifted) + above
        };
        let z: Vec<f64> = sigma.iter().zip(&touches).map(height).collect();
        if let Some(k) = (0..z.len()).find(|k| !(x[*k].is_finite() && z[*k].is_finite())) {
            return Err(PipelineError::Lead {
                which: self.kind.name(),
                what: format!(
                    "the tool has no position at C = {:.3} deg, ρ = {:.6} mm, where it would leave \
                     the cut: the surface ends there",
                    c[k] / turnpath_core::DEG,
                    rho[k]
                ),
            });
        }
        Ok(AxisPositions { c, x, z })
    }

    /// X and Z of a tool that goes on touching the part at the ρ of the join.
    pub fn on_the_part(&self, sigma: &[f64]) -> Result<[Vec<f64>; 2]> {
        let theta: Vec<f64> = sigma
            .iter()
            .map(|sigma| self.c(*sigma).rem_euclid(TAU))
            .collect();
        let x = self.locus_x(&theta, &vec![self.join.rho; theta.len()])?;
        let touches = self.touches(&theta, &x)?;
        Ok([x, touches.iter().map(|touch| touch.z).collect()])
    }

    /// X of the locus.
    fn locus_x(&self, theta: &[f64], rho: &[f64]) -> Result<Vec<f64>> {
        let mut centres = CentreBuffers::default();
        centres.resize(theta.len());
        let answer = self
            .plan
            .preparation
            .locus
            .centre(theta, rho, centres.as_centres());
        let context = || format!("in the {}", self.kind.name());
        answer.map_err(|error| self.plan.chain.compensator.failed(context(), error))?;
        Ok(centres.x)
    }

    fn touches(&self, theta: &[f64], x: &[f64]) -> Result<Vec<Touch>> {
        let mut touches = Vec::new();
        let touch = &self.plan.preparation.touch;
        touch
            .find(theta, x, &mut touches)
            .map_err(PipelineError::Measure)?;
        Ok(touches)
    }
}

/// The value at `part` of the distance from `from` to `to`; exactly `to` at 1.
fn between(from: f64, to: f64, part: f64) -> f64 {
    if part >= 1.0 {
        return to;
    }
    from + part * (to - from)
}
