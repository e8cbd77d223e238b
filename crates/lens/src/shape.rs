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
    /// A conicoid, Σ A_i ρⁱ, and Σ c_j Z_j(ρ/r, θ).
    Zernike {
        /// The list that numbers the terms.
        list: ZernikeList,
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

/// The list that numbers Zernike terms, and their size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ZernikeList {
    /// Noll's, each term with an RMS of 1 over the disc.
    Noll,
    /// The Fringe list, each term with a largest height of 1.
    Fringe,
}

impl ZernikeList {
    /// Whether a term is even in x. With θ → π − θ, cos mθ takes the factor (−1)^m and sin mθ the
    /// factor −(−1)^m.
    fn is_even_in_x(self, number: u32) -> bool {
        let (order, is_cosine) = match self {
            // Even numbers are cosines, and odd ones with m > 0 are sines.
            Self::Noll => (noll_order(number), number.is_multiple_of(2)),
            Self::Fringe => fringe_order(number),
        };
        (order == 0 || is_cosine) == order.is_multiple_of(2)
    }
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
                list,
                base,
                terms,
                normalization_radius,
                coefficients,
            } => Self::Zernike {
                list,
                base: base.seen_from_behind(),
                terms: negative(terms),
                normalization_radius,
                coefficients: signed(coefficients, |number| list.is_even_in_x(number)),
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

/// The order m of the angle of a term in the Fringe list, and whether the term is a cosine. The terms
/// with n + |m| = 2g have the numbers from g² + 1 on; |m| falls from g to 0, cosine before sine.
fn fringe_order(number: u32) -> (u32, bool) {
    let place = number.saturating_sub(1);
    let group = place.isqrt();
    let within = place - group * group;
    (group - within / 2, within.is_multiple_of(2))
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
        let even: Vec<u32> = (1..=11)
            .filter(|j| ZernikeList::Noll.is_even_in_x(*j))
            .collect();
        assert_eq!(even, [1, 3, 4, 6, 7, 9, 11]);
        // 1, y, ρ², cos 2θ, y's coma, ρ⁴, sin 3θ.
        let even: Vec<u32> = (1..=11)
            .filter(|j| ZernikeList::Fringe.is_even_in_x(*j))
            .collect();
        assert_eq!(even, [1, 3, 4, 5, 8, 9, 11]);
    }

    /// The list of the University of Arizona, as the manuals of design programs print it.
    #[test]
    fn orders_of_the_fringe_list() {
        let orders: Vec<(u32, bool)> = (1..=18).map(fringe_order).collect();
        let published = [0, 1, -1, 0, 2, -2, 1, -1, 0, 3, -3, 2, -2, 1, -1, 0, 4, -4];
        let published = published.map(|m: i32| (m.unsigned_abs(), m >= 0));
        assert_eq!(orders, published);
        // ρ¹⁰ and ρ¹² stand at the ends of their groups.
        assert_eq!([fringe_order(36), fringe_order(49)], [(0, true), (0, true)]);
    }

    #[test]
    fn seen_from_behind_twice_a_shape_is_what_it_was() {
        let base = Base {
            radius: Some(-40.0),
            conic: -0.5,
        };
        for list in [ZernikeList::Noll, ZernikeList::Fringe] {
            let shape = Shape::Zernike {
                list,
                base,
                terms: Powers::from([(4, 1e-6)]),
                normalization_radius: 10.0,
                coefficients: (1..=15).map(|j| (j, 1e-3 * f64::from(j))).collect(),
            };
            assert_eq!(shape.clone().seen_from_behind().seen_from_behind(), shape);
        }
    }
}
