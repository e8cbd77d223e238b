//! Shapes of surfaces, in mm.

use std::collections::BTreeMap;

use crate::base::Base;

/// Coefficients under the power of their term, in mm^(1−power).
pub type Powers = BTreeMap<u32, f64>;

/// The shape of a surface: its height z(x, y) in mm. Coefficients that are 0 are left out.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A body of revolution: a conicoid and Σ A_i ρⁱ.
    Radial {
        /// The conicoid.
        base: Base,
        /// A_i, in mm^(1−i).
        terms: Powers,
    },
    /// A conic section along x, another along y, under one root.
    Biconic {
        /// Along x.
        x: Base,
        /// Along y.
        y: Base,
    },
    /// A curve along y, turned about an axis parallel to y.
    Toroid {
        /// Distance of that axis, mm; `None`: not turned, a cylinder.
        rotation: Option<f64>,
        /// The curve's conic section.
        base: Base,
        /// The curve's Σ A_i yⁱ, in mm^(1−i).
        terms: Powers,
    },
    /// A conicoid and Σ c_ij (x/r)ⁱ (y/r)ʲ.
    Polynomial {
        /// The conicoid.
        base: Base,
        /// r, mm.
        normalization_radius: f64,
        /// c_ij, mm.
        coefficients: BTreeMap<(u32, u32), f64>,
    },
    /// A conicoid, Σ A_i ρⁱ, and Σ c_j Z_j(ρ/r, θ): Noll's numbers, each term with an RMS of 1.
    Zernike {
        /// The conicoid.
        base: Base,
        /// A_i, in mm^(1−i).
        terms: Powers,
        /// r, mm.
        normalization_radius: f64,
        /// c_j, mm.
        coefficients: BTreeMap<u32, f64>,
    },
}

impl Shape {
    /// Whether every turn about the z axis leaves the shape as it is.
    pub fn is_of_revolution(&self) -> bool {
        matches!(self, Self::Radial { .. })
    }

    /// Whether the shape is a plane at z = 0.
    pub fn is_plane(&self) -> bool {
        match self {
            Self::Radial { base, terms } => base.radius.is_none() && terms.is_empty(),
            Self::Biconic { x, y } => x.radius.is_none() && y.radius.is_none(),
            Self::Toroid {
                rotation,
                base,
                terms,
            } => rotation.is_none() && base.radius.is_none() && terms.is_empty(),
            Self::Polynomial {
                base, coefficients, ..
            } => base.radius.is_none() && coefficients.is_empty(),
            Self::Zernike {
                base,
                terms,
                coefficients,
                ..
            } => base.radius.is_none() && terms.is_empty() && coefficients.is_empty(),
        }
    }

    /// The same surface seen from behind, turned about the y axis: z(x, y) becomes −z(−x, y).
    pub fn seen_from_behind(self) -> Self {
        match self {
            Self::Radial { base, terms } => Self::Radial {
                base: base.seen_from_behind(),
                terms: negative(terms),
            },
            Self::Biconic { x, y } => Self::Biconic {
                x: x.seen_from_behind(),
                y: y.seen_from_behind(),
            },
            Self::Toroid {
                rotation,
                base,
                terms,
            } => Self::Toroid {
                rotation: rotation.map(|radius| -radius),
                base: base.seen_from_behind(),
                terms: negative(terms),
            },
            Self::Polynomial {
                base,
                normalization_radius,
                coefficients,
            } => Self::Polynomial {
                base: base.seen_from_behind(),
                normalization_radius,
                coefficients: signed(coefficients, |(i, _)| is_even_in_x(i)),
            },
            Self::Zernike {
                base,
                terms,
                normalization_radius,
                coefficients,
            } => Self::Zernike {
                base: base.seen_from_behind(),
                terms: negative(terms),
                normalization_radius,
                coefficients: signed(coefficients, noll_is_even_in_x),
            },
        }
    }
}

fn negative(terms: Powers) -> Powers {
    signed(terms, |_| true)
}

/// The coefficients of −z(−x, y): those of terms that are even in x change their sign.
fn signed<K: Ord + Copy>(
    coefficients: BTreeMap<K, f64>,
    is_even: impl Fn(K) -> bool,
) -> BTreeMap<K, f64> {
    let sign = |key| if is_even(key) { -1.0 } else { 1.0 };
    let all = coefficients.into_iter();
    all.map(|(key, value)| (key, sign(key) * value)).collect()
}

fn is_even_in_x(power: u32) -> bool {
    power.is_multiple_of(2)
}

/// Whether a Zernike term is even in x. With θ → π − θ, cos mθ takes the factor (−1)^m and sin mθ
/// the factor −(−1)^m. In Noll's list even numbers are cosines, and odd ones with m > 0 are sines.
fn noll_is_even_in_x(number: u32) -> bool {
    let m = noll_order(number);
    let is_cosine = m == 0 || number.is_multiple_of(2);
    is_cosine == m.is_multiple_of(2)
}

/// The order m of the angle of a term in Noll's list. Degree n has the numbers from n(n + 1)/2 + 1
/// on; among them |m| grows by twos, and each m above 0 takes two numbers.
fn noll_order(number: u32) -> u32 {
    let mut n = 0;
    let mut first = 1;
    while number > first + n {
        first += n + 1;
        n += 1;
    }
    let place = number.saturating_sub(first);
    match n.is_multiple_of(2) {
        true => 2 * place.div_ceil(2),
        false => 2 * (place / 2) + 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The list of docs/surfaces.md and the next degrees, from Noll 1976, table I.
    #[test]
    fn orders_of_nolls_list() {
        let orders: Vec<u32> = (1..=22).map(noll_order).collect();
        let published = [
            0, 1, 1, 0, 2, 2, 1, 1, 3, 3, 0, 2, 2, 4, 4, 1, 1, 3, 3, 5, 5, 0,
        ];
        assert_eq!(orders, published);
    }

    #[test]
    fn terms_that_a_mirror_at_x_leaves_as_they_are() {
        // 1, y, ρ², cos 2θ, y's coma, sin 3θ; not x, sin 2θ, x's coma, cos 3θ.
        let even: Vec<u32> = (1..=11).filter(|j| noll_is_even_in_x(*j)).collect();
        assert_eq!(even, [1, 3, 4, 6, 7, 9, 11]);
    }

    #[test]
    fn seen_from_behind_twice_a_shape_is_what_it_was() {
        let base = Base {
            radius: Some(-40.0),
            conic: -0.5,
        };
        let shape = Shape::Zernike {
            base,
            terms: Powers::from([(4, 1e-6)]),
            normalization_radius: 10.0,
            coefficients: (1..=15).map(|j| (j, 1e-3 * f64::from(j))).collect(),
        };
        assert_eq!(shape.clone().seen_from_behind().seen_from_behind(), shape);
    }
}
