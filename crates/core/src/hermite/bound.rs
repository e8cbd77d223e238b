//! How long a step may be: the error of cubic Hermite interpolation, across knots too.
//!
//! On a step of length L the error at x is E(x) = ∫ K(x, t) φ⁗(t) dt. Peano's kernel K is ≥ 0, and
//! its integral is at most L⁴/384 (eq. 10 of Wang et al. 2019). If a derivative of φ jumps within
//! the step, φ⁗ holds a delta or a derivative of a delta there. The integral then takes the kernel
//! or a derivative of the kernel at the knot. With J_m the jump of the m-th derivative, and with
//! the largest absolute values of K, ∂K/∂t and ∂²K/∂t² over all x and t,
//!
//! |E| ≤ L⁴/384 max|φ⁗| + L³/192 Σ|J₃| + 0.016152 L² Σ|J₂| + 4/27 L Σ|J₁|.
//!
//! Here max|φ⁗| takes both sides of each knot. If the pieces of a law join almost as smoothly as
//! they are inside, a knot costs next to nothing. At any other knot the sampler ends its step.

/// max |∂K/∂t| for L = 1. It lies at x = 0.566, t = 0.767 (and mirrored), and is rounded up.
const SECOND: f64 = 0.016_152;

/// Σ|J_m| over the knots within a step. The m-th derivatives are in mm/rad^m.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Jumps {
    /// The sum for the first derivative.
    pub first: f64,
    /// The sum for the second derivative.
    pub second: f64,
    /// The sum for the third derivative.
    pub third: f64,
}

impl Jumps {
    /// The sums with the jumps of one more knot.
    pub fn and(self, other: Self) -> Self {
        Self {
            first: self.first + other.first,
            second: self.second + other.second,
            third: self.third + other.third,
        }
    }
}

/// What a step's error bound is computed from.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Bound {
    /// max |φ⁗|, mm/rad⁴.
    pub fourth: f64,
    /// The jumps at the knots.
    pub jumps: Jumps,
}

impl Bound {
    /// The bound of the error on a step of `length` rad, mm.
    pub fn error(&self, length: f64) -> f64 {
        let Jumps {
            first,
            second,
            third,
        } = self.jumps;
        let inner = third / 192.0 + length * self.fourth / 384.0;
        length * (4.0 / 27.0 * first + length * (SECOND * second + length * inner))
    }

    /// The length of a step without knots whose error is `allowed`, rad.
    pub fn natural_length(&self, allowed: f64) -> f64 {
        (384.0 * allowed / self.fourth).sqrt().sqrt()
    }

    /// The largest length in [`shorter`, `longer`] whose error is at most `allowed`, or `shorter`
    /// if there is none.
    pub fn length_between(&self, allowed: f64, shorter: f64, longer: f64) -> f64 {
        if self.jumps == Jumps::default() {
            return self.natural_length(allowed).clamp(shorter, longer);
        }
        let (mut below, mut above) = (shorter, longer);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (below + above);
            if self.error(middle) <= allowed {
                below = middle;
            } else {
                above = middle;
            }
        }
        below
    }
}

/// Number of bisections within a cell of samples: to less than a millionth of the cell.
const HALVINGS: usize = 20;

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest error of the Hermite cubic for (x − c)₊^m/m! on the unit step.
    fn worst(power: usize) -> f64 {
        const PLACES: usize = 400;
        let raised = |u: f64, n: usize| (0..n).fold(1.0, |product, _| product * u);
        let factorial = [1.0, 1.0, 2.0, 6.0];
        let place = |i: usize| i as f64 / PLACES as f64;
        let mut worst: f64 = 0.0;
        for c in (0..PLACES).map(place) {
            let value = |x: f64| raised((x - c).max(0.0), power) / factorial[power];
            let (end, slope) = (
                value(1.0),
                raised(1.0 - c, power - 1) / factorial[power - 1],
            );
            for x in (0..=PLACES).map(place) {
                let cubic = end * x * x * (3.0 - 2.0 * x) + slope * x * x * (x - 1.0);
                worst = worst.max((value(x) - cubic).abs());
            }
        }
        worst
    }

    #[test]
    fn the_constants_are_the_largest_errors_of_unit_jumps() {
        let with = |first, second, third| Bound {
            fourth: 0.0,
            jumps: Jumps {
                first,
                second,
                third,
            },
        };
        for (bound, power) in [
            (with(1.0, 0.0, 0.0), 1),
            (with(0.0, 1.0, 0.0), 2),
            (with(0.0, 0.0, 1.0), 3),
        ] {
            let ratio = worst(power) / bound.error(1.0);
            assert!((0.999..=1.0 + 1e-12).contains(&ratio), "{power}: {ratio}");
        }
    }

    #[test]
    fn a_length_between_keeps_the_bound() {
        let jumps = Jumps {
            third: 1e-4,
            ..Jumps::default()
        };
        let bound = Bound { fourth: 0.1, jumps };
        let length = bound.length_between(1e-6, 0.01, 1.0);
        assert!(bound.error(length) <= 1e-6 && bound.error(length) > 0.99e-6);
        assert_eq!(bound.length_between(1e-16, 0.01, 1.0), 0.01);
    }
}
