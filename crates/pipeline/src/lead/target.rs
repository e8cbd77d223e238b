//! Where a lead wants the axes to be, at any time away from its join.

use std::f64::consts::TAU;

use turnpath_core::{CentreBuffers, Locus};
use turnpath_verify::Touch;

use super::join::{Join, Side};
use super::phases::Phases;
use crate::plan::Plan;
use crate::{PipelineError, Result};

/// Angles of a revolution over which X at rest is the mean of the locus'.
const ANGLES: usize = 72;
/// Largest way, in nose radii, by which ρ drifts on beyond the cut while its rate goes to rest.
/// That of a spiral is a feed or two; a law that moves X to and fro would go on for millimetres.
const LARGEST_DRIFT: f64 = 0.25;

/// ρ beyond the cut: its rate goes from the law's own to rest, with the law's own second
/// derivative where it begins and none where it ends.
#[derive(Debug, Clone, Copy)]
struct Drift {
    from: f64,
    rate: f64,
    bend: f64,
    time: f64,
}

impl Drift {
    fn new(side: Side, join: &Join, longest: f64, nose_radius: f64) -> Self {
        let (rate, bend) = (side.sign() * join.rho_rate, join.rho_bend);
        let largest = LARGEST_DRIFT * nose_radius;
        // |rate|/2 time + |bend|/12 time² = largest.
        let half = 0.5 * rate.abs();
        let by_way = 2.0 * largest / (half + (half * half + bend.abs() * largest / 3.0).sqrt());
        Self {
            from: join.rho,
            rate,
            bend,
            time: longest.min(by_way),
        }
    }

    fn rho(&self, sigma: f64) -> f64 {
        let s = (sigma / self.time).min(1.0);
        let by_rate = s * (1.0 - s * s * (1.0 - 0.5 * s));
        let by_bend = s * s * (0.5 - s * (2.0 / 3.0 - 0.25 * s));
        self.from + self.time * (self.rate * by_rate + self.bend * self.time * by_bend)
    }
}

/// The way of a lead.
pub struct Target<'a> {
    plan: &'a Plan<'a>,
    side: Side,
    join: &'a Join,
    phases: Phases,
    drift: Drift,
    /// Where X rests, mm.
    pub rest_x: f64,
    /// Where Z rests, mm.
    pub rest_z: f64,
}

/// C, X and Z at some instants.
pub struct Places {
    pub c: Vec<f64>,
    pub x: Vec<f64>,
    pub z: Vec<f64>,
}

impl<'a> Target<'a> {
    /// The way from or to rest at height `rest_z`; X may drift on for `drift` s.
    pub fn new(
        plan: &'a Plan<'a>,
        side: Side,
        join: &'a Join,
        phases: Phases,
        rest_z: f64,
        drift: f64,
    ) -> Result<Self> {
        let nose_radius = plan.prepared.task.tool.nose_radius;
        let drift = Drift::new(side, join, phases.descent.min(drift), nose_radius);
        let mut target = Self {
            plan,
            side,
            join,
            phases,
            drift,
            rest_x: f64::NAN,
            rest_z,
        };
        let theta: Vec<f64> = (0..ANGLES)
            .map(|i| TAU * i as f64 / ANGLES as f64)
            .collect();
        let rho = vec![drift.rho(phases.descent); ANGLES];
        let around = target.locus_x(&theta, &rho)?;
        target.rest_x = around.iter().sum::<f64>() / ANGLES as f64;
        Ok(target)
    }

    /// C at rest, rad.
    pub fn rest_c(&self) -> f64 {
        match self.side {
            // The path begins at 0, and whole revolutions lie before the cut.
            Side::In => 0.0,
            Side::Out => self.c(self.phases.all()),
        }
    }

    fn c(&self, sigma: f64) -> f64 {
        self.join.point.c + self.side.sign() * self.phases.turned(sigma)
    }

    /// Where the axes are to be at times away from the join, s, on a way that begins higher by
    /// `raised` mm.
    pub fn places(&self, sigma: &[f64], raised: f64) -> Result<Places> {
        let c: Vec<f64> = sigma.iter().map(|sigma| self.c(*sigma)).collect();
        let theta: Vec<f64> = c.iter().map(|c| c.rem_euclid(TAU)).collect();
        let rho: Vec<f64> = sigma.iter().map(|sigma| self.drift.rho(*sigma)).collect();
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
                which: self.side.name(),
                what: format!(
                    "the tool has no place at C = {:.3} deg, ρ = {:.6} mm, where it would leave \
                     the cut: the surface ends there",
                    c[k] / turnpath_core::DEG,
                    rho[k]
                ),
            });
        }
        Ok(Places { c, x, z })
    }

    /// X and Z if the tool went on touching the part where it joined the cut, at the same ρ.
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
        let mut room = CentreBuffers::default();
        room.resize(theta.len());
        let answer = self
            .plan
            .prepared
            .locus
            .centre(theta, rho, room.as_centres());
        let place = || format!("in the {}", self.side.name());
        answer.map_err(|error| self.plan.chain.compensator.failed(place(), error))?;
        Ok(room.x)
    }

    fn touches(&self, theta: &[f64], x: &[f64]) -> Result<Vec<Touch>> {
        let mut touches = Vec::new();
        let touch = &self.plan.prepared.touch;
        touch
            .find(theta, x, &mut touches)
            .map_err(PipelineError::Measure)?;
        Ok(touches)
    }
}

/// From `from` to `to`, which it is exactly at 1.
fn between(from: f64, to: f64, part: f64) -> f64 {
    if part >= 1.0 {
        return to;
    }
    from + part * (to - from)
}
