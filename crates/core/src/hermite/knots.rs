//! The knots of the laws within a block, and what jumps there.

use super::bound::Jumps;
use super::phi::PhiEvaluator;
use crate::{CentreSeries, Pace, Result, Revolutions, Series, angle, per_radian};

/// Number of knots that are evaluated together.
const BATCH: usize = 256;

/// A knot of the law: |φ⁗| before and after it, and the jumps there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Knot {
    /// Position of the knot, in revolutions.
    pub(super) n: f64,
    /// |φ⁗| of the piece that ends, mm/rad⁴.
    pub(super) before: f64,
    /// |φ⁗| of the piece that begins, mm/rad⁴.
    pub(super) after: f64,
    /// The jumps of φ's lower derivatives.
    pub(super) jumps: Jumps,
}

impl PhiEvaluator<'_> {
    /// The knots of both laws within `block`.
    pub(super) fn knots(&mut self, block: Revolutions) -> Result<Vec<Knot>> {
        let (law, Revolutions { start, end }) = (self.path.law, block);
        let mut places: Vec<f64> = law.knots(start, end).collect();
        if let Some(spindle) = self.clock.spindle() {
            places.extend(spindle.as_time().knots(start, end));
            places.sort_by(f64::total_cmp);
            places.dedup();
        }
        let mut knots = Vec::with_capacity(places.len());
        for batch in places.chunks(BATCH) {
            self.evaluate(batch)?;
            let (after, paces) = (self.sides(batch), self.paces.clone());
            self.evaluate_before(batch)?;
            let before = self.sides(batch);
            for (i, (before, after)) in before.into_iter().zip(after).enumerate() {
                let mut knot = Knot::between(batch[i], before, after, self.sharpest);
                knot.jumps.third += self.jump_of_c(i, &paces);
                knots.push(knot);
            }
        }
        Ok(knots)
    }

    /// One side of every knot of the last evaluation.
    fn sides(&self, n: &[f64]) -> Vec<Side> {
        n.iter()
            .enumerate()
            .map(|(i, n)| {
                let measure = self.x_weight(*n);
                let x = self.in_time(i, self.x[i]);
                let phi = self.phi(i);
                Side {
                    of_c: self.of_c(i, 24.0 * phi[4].abs()),
                    series: [
                        phi,
                        self.in_time(i, self.z[i]),
                        x.map(|c| if c == 0.0 { 0.0 } else { c * measure }),
                    ],
                }
            })
            .collect()
    }

    /// What the jump of C's third derivative can add to that of φ at knot `i`. `after` are the
    /// paces after the knots.
    fn jump_of_c(&self, i: usize, after: &[(Pace, f64)]) -> f64 {
        let (Some((before, speed)), Some((after, _))) = (self.paces.get(i), after.get(i)) else {
            return 0.0;
        };
        let phi = 24.0 * self.phi(i)[4].abs();
        self.turn_of_slope(i, phi) * before.jump_of_c(after) * speed * speed * speed
    }

    /// Evaluates at knots with the pieces that end there. The slopes are already known.
    fn evaluate_before(&mut self, knots: &[f64]) -> Result<()> {
        let law = self.path.law;
        let theta: Vec<Series> = knots
            .iter()
            .map(|n| [angle(*n), 1.0, 0.0, 0.0, 0.0])
            .collect();
        let rho: Vec<Series> = knots
            .iter()
            .map(|n| per_radian(law.series_before(*n)))
            .collect();
        let out = CentreSeries {
            x: &mut self.x,
            z: &mut self.z,
        };
        self.path.locus.series(&theta, &rho, out)?;
        self.find_paces(knots, Pace::before);
        Ok(())
    }
}

/// One side of a knot.
struct Side {
    /// The series of φ, of Z, and of X in φ's measure.
    series: [Series; 3],
    /// What C's own error can add to |φ⁗|, mm/rad⁴.
    of_c: f64,
}

impl Knot {
    /// Builds a knot from φ, Z and X on both sides. A jump counts as the largest jump of the three.
    /// The jumps of Z and X cancel in φ at the knot's own slope, but the slope differs elsewhere on
    /// the step.
    fn between(n: f64, before: Side, after: Side, sharpest: f64) -> Self {
        let jump = |k: usize, factorial: f64| {
            let of = |which: usize| (after.series[which][k] - before.series[which][k]).abs();
            factorial * of(0).max(of(1)).max(of(2))
        };
        let fourth = |Side { series, of_c }: &Side| {
            let [phi, _, x] = series;
            let larger = phi[4].abs().max(x[4].abs());
            (24.0 * larger + of_c).min(sharpest)
        };
        Self {
            n,
            before: fourth(&before),
            after: fourth(&after),
            jumps: Jumps {
                first: jump(1, 1.0),
                second: jump(2, 2.0),
                third: jump(3, 6.0),
            },
        }
    }
}
