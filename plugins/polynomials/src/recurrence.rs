//! Families of polynomials p_0, p_1, …, each from the two before it.

use turnpath_plugin::prelude::*;

/// p_0 is a constant, and p_{k+1} = (constant + slope·w)·p_k − back·p_{k−1} + lift.
#[derive(Debug, Clone, PartialEq)]
pub struct Family {
    first: f64,
    steps: Vec<Step>,
}

/// The step from p_k to p_{k+1}.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Step {
    /// The constant part of the factor of p_k.
    pub constant: f64,
    /// The part of that factor that goes with w.
    pub slope: f64,
    /// The factor of p_{k−1}.
    pub back: f64,
    /// What is added.
    pub lift: f64,
}

impl Family {
    /// The polynomials from p_0 = `first` on.
    pub fn new(first: f64, steps: impl IntoIterator<Item = Step>) -> Self {
        let steps = steps.into_iter().collect();
        Self { first, steps }
    }

    /// Σ c_k·p_k(w). The family must have as many polynomials as there are coefficients.
    #[inline(always)]
    pub fn sum<S: Scalar>(&self, coefficients: &[f64], w: S) -> S {
        let mut sum = S::constant(0.0);
        let mut walk = Walk::new(self);
        for k in 0..coefficients.len() {
            sum = with_term(sum, coefficients.get(k), walk.here);
            walk.go_on(self.steps.get(k), w);
        }
        sum
    }

    /// The sums of two lists of coefficients.
    #[inline(always)]
    pub fn sums<S: Scalar>(&self, first: &[f64], second: &[f64], w: S) -> (S, S) {
        let mut sums = (S::constant(0.0), S::constant(0.0));
        let mut walk = Walk::new(self);
        for k in 0..first.len().max(second.len()) {
            sums.0 = with_term(sums.0, first.get(k), walk.here);
            sums.1 = with_term(sums.1, second.get(k), walk.here);
            walk.go_on(self.steps.get(k), w);
        }
        sums
    }
}

/// A walk over the polynomials of a family. A closure for each of them might become a function of its own,
/// which knows no wide registers.
#[derive(Clone, Copy)]
struct Walk<S> {
    before: S,
    here: S,
}

impl<S: Scalar> Walk<S> {
    #[inline(always)]
    fn new(family: &Family) -> Self {
        Self {
            before: S::constant(0.0),
            here: S::constant(family.first),
        }
    }

    /// Goes on to the next polynomial; without a step it stays.
    #[inline(always)]
    fn go_on(&mut self, step: Option<&Step>, w: S) {
        if let Some(step) = step {
            let Self { before, here } = *self;
            let next = here * (w * step.slope + step.constant) - before * step.back + step.lift;
            *self = Self {
                before: here,
                here: next,
            };
        }
    }
}

#[inline(always)]
fn with_term<S: Scalar>(sum: S, coefficient: Option<&f64>, p: S) -> S {
    match coefficient {
        None | Some(0.0) => sum,
        Some(coefficient) => sum + p * *coefficient,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_family_gives_each_polynomial_from_the_two_before_it() {
        // 1, w, w² + 1 − 2 + 3
        let first = Step {
            slope: 1.0,
            ..Step::default()
        };
        let second = Step {
            slope: 1.0,
            back: 2.0,
            lift: 3.0,
            constant: 0.0,
        };
        let family = Family::new(1.0, [first, second]);
        assert_eq!(family.sum(&[0.0, 0.0, 1.0], 5.0), 26.0);
        assert_eq!(family.sum(&[10.0, 0.0, 1.0], 5.0), 36.0);
        assert_eq!(
            family.sums(&[1.0, 2.0], &[0.0, 0.0, 1.0], 5.0),
            (11.0, 26.0)
        );
        assert_eq!(family.sum(&[], 5.0), 0.0);
    }
}
