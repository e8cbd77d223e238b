//! How a tolerance of form is divided between cusps and interpolation.

use crate::part::Tolerance;

/// The part of a tolerance of form that cusps get. With r for cusps and e for interpolation, which
/// errs to both sides, r + 2e makes up the form. The points of a path grow as r^−½ e^−¼, since turns
/// go with the root of r and points a turn with the fourth root of e. They are fewest at r = 2/3 and
/// e = 1/6 of the form.
const CUSPS: f64 = 2.0 / 3.0;

/// A tolerance of form with the tolerances that a recipe gives beside it. Those are upper bounds of
/// their shares: what a bound cuts off goes to the other share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FormBudget {
    /// Peak to valley of the machined surface, mm.
    form: f64,
    interpolation: f64,
    residual: f64,
}

impl FormBudget {
    /// The budget of a form, mm, with the bounds that are given, mm.
    pub const fn new(form: f64, interpolation: Option<f64>, residual: Option<f64>) -> Self {
        const fn bound(given: Option<f64>) -> f64 {
            match given {
                Some(given) => given,
                None => f64::INFINITY,
            }
        }
        Self {
            form,
            interpolation: bound(interpolation),
            residual: bound(residual),
        }
    }

    /// The form, mm.
    pub fn form(&self) -> f64 {
        self.form
    }

    /// The shares of the whole form.
    pub fn first(&self) -> Tolerance {
        self.shares(self.form)
    }

    /// The shares of a sum r + 2e, mm. The sum may be larger than the form, where paths leave less
    /// than their tolerances allow.
    pub fn shares(&self, sum: f64) -> Tolerance {
        let residual = self.residual.min(CUSPS * sum);
        let interpolation = self.interpolation.min(0.5 * (sum - residual));
        Tolerance {
            interpolation,
            residual: self.residual.min(sum - 2.0 * interpolation),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shares(budget: &FormBudget, sum: f64) -> [f64; 2] {
        let Tolerance {
            interpolation,
            residual,
        } = budget.shares(sum);
        [residual, interpolation]
    }

    #[track_caller]
    fn assert_near(found: [f64; 2], expected: [f64; 2]) {
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
        }
    }

    /// Points a path as r^−½ e^−¼ on r + 2e = 1, at all e of a fine grid.
    #[test]
    fn no_other_division_of_a_form_has_fewer_points() {
        let points = |residual: f64, interpolation: f64| {
            1.0 / (residual.sqrt() * interpolation.sqrt().sqrt())
        };
        let [residual, interpolation] = shares(&FormBudget::new(1.0, None, None), 1.0);
        let fewest = points(residual, interpolation);
        for i in 1..1000 {
            let e = 0.5 * f64::from(i) / 1000.0;
            assert!(points(1.0 - 2.0 * e, e) >= fewest * (1.0 - 1e-12), "{e}");
        }
    }

    #[test]
    fn what_a_bound_cuts_off_goes_to_the_other_share() {
        assert_near(
            shares(&FormBudget::new(150.0, None, None), 150.0),
            [100.0, 25.0],
        );
        let fine = FormBudget::new(150.0, None, Some(50.0));
        assert_near(shares(&fine, 150.0), [50.0, 50.0]);
        let smooth = FormBudget::new(150.0, Some(10.0), None);
        assert_near(shares(&smooth, 150.0), [130.0, 10.0]);
        let both = FormBudget::new(150.0, Some(10.0), Some(50.0));
        assert_near(shares(&both, 150.0), [50.0, 10.0]);
        assert_near(shares(&both, 15.0), [10.0, 2.5]);
    }
}
