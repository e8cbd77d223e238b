//! Functions of (θ, ρ) to second order, and their compositions.

use turnpath_plugin::prelude::*;

/// A value with its partial derivatives up to the second, `t` for θ and `r` for the radius.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jet {
    /// The function itself.
    pub value: f64,
    /// ∂/∂θ.
    pub t: f64,
    /// ∂/∂ρ.
    pub r: f64,
    /// ∂²/∂θ².
    pub tt: f64,
    /// ∂²/∂θ∂ρ.
    pub tr: f64,
    /// ∂²/∂ρ².
    pub rr: f64,
}

impl Jet {
    /// The radius itself.
    pub fn radius(rho: f64) -> Self {
        Self {
            value: rho,
            t: 0.0,
            r: 1.0,
            tt: 0.0,
            tr: 0.0,
            rr: 0.0,
        }
    }

    /// The sum `self` + `scale`·`other`.
    pub fn plus(&self, scale: f64, other: &Self) -> Self {
        Self {
            value: self.value + scale * other.value,
            t: self.t + scale * other.t,
            r: self.r + scale * other.r,
            tt: self.tt + scale * other.tt,
            tr: self.tr + scale * other.tr,
            rr: self.rr + scale * other.rr,
        }
    }

    /// The composition: a function of (θ, a), where a is itself a function of (θ, ρ).
    pub fn through(&self, a: &Self) -> Self {
        Self {
            value: self.value,
            t: self.t + self.r * a.t,
            r: self.r * a.r,
            tt: self.tt + (2.0 * self.tr + self.rr * a.t) * a.t + self.r * a.tt,
            tr: (self.tr + self.rr * a.t) * a.r + self.r * a.tr,
            rr: self.rr * a.r * a.r + self.r * a.rr,
        }
    }

    /// The inverse: a as a function of (θ, ρ), where `self` is ρ as a function of (θ, a), at the
    /// given a.
    pub fn inverse(&self, at: f64) -> Self {
        let r = 1.0 / self.r;
        let t = -self.t * r;
        Self {
            value: at,
            t,
            r,
            tt: -(self.tt + (2.0 * self.tr + self.rr * t) * t) * r,
            tr: -(self.tr + self.rr * t) * r * r,
            rr: -self.rr * r * r * r,
        }
    }

    /// The jet as a number for formulas.
    pub fn to_dual(self) -> Dual<Dual<f64>> {
        let dual = |value, dx, dy| Dual { value, dx, dy };
        Dual {
            value: dual(self.value, self.t, self.r),
            dx: dual(self.t, self.tt, self.tr),
            dy: dual(self.r, self.tr, self.rr),
        }
    }

    /// The jet of a formula's result.
    pub fn from_dual(of: Dual<Dual<f64>>) -> Self {
        Self {
            value: of.value.value,
            t: of.value.dx,
            r: of.value.dy,
            tt: of.dx.dx,
            tr: of.dx.dy,
            rr: of.dy.dy,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: &Jet, b: &Jet) {
        let numbers = |j: &Jet| [j.value, j.t, j.r, j.tt, j.tr, j.rr];
        for (a, b) in numbers(a).into_iter().zip(numbers(b)) {
            assert!((a - b).abs() < 1e-12, "{a} {b}");
        }
    }

    /// a = ρ² sin θ, F = exp(θ a), against the formula of the whole.
    #[test]
    fn one_function_through_another_is_the_formula_of_both() {
        let (theta, rho) = (0.3, 1.1);
        let variables = |a: f64| {
            let t = Dual::variable_x(Dual::variable_x(theta));
            (t, Dual::variable_y(Dual::variable_y(a)))
        };
        let (t, r) = variables(rho);
        let a = r.squared() * t.sin();
        let whole = Jet::from_dual((t * a).exp());
        let a = Jet::from_dual(a);
        let (t, inner) = variables(a.value);
        let outer = Jet::from_dual((t * inner).exp());
        close(&outer.through(&a), &whole);
    }

    #[test]
    fn a_function_through_its_inverse_is_the_radius() {
        let rho = Jet {
            value: 2.0,
            t: 0.3,
            r: 0.7,
            tt: -0.2,
            tr: 0.9,
            rr: 0.4,
        };
        close(&rho.through(&rho.inverse(5.0)), &Jet::radius(2.0));
    }
}
