//! The sphere, or the plane, that a surface lies nearest to.

use nalgebra::{Matrix4, Vector4};

/// Steps of Gauss and Newton from the paraboloid. On a hemisphere's cap of half its radius the fifth
/// changes nothing.
const STEPS: usize = 8;

/// A sphere through which a surface goes as nearly as it can: κ/2 (x² + y² + z²) − z + a + bx + cy = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BestSphere {
    /// κ, a, b, c: 1/mm, mm, and two slopes.
    terms: Vector4<f64>,
}

impl BestSphere {
    /// The sphere with the least mean square of its distance from the places along z; `None` where they
    /// are too few, or on one line. Each place is (x, y, z), mm.
    pub fn of(places: &[[f64; 3]]) -> Option<Self> {
        let mut sphere = Self {
            terms: Vector4::zeros(),
        };
        for _ in 0..STEPS {
            let (mut normal, mut right) = (Matrix4::zeros(), Vector4::zeros());
            for [x, y, z] in places {
                let height = sphere.height(*x, *y);
                let lift = 1.0 - sphere.curvature() * height;
                let square = x * x + y * y + height * height;
                let slopes = Vector4::new(0.5 * square, 1.0, *x, *y) / lift;
                normal += slopes * slopes.transpose();
                right += slopes * (z - height);
            }
            sphere.terms += normal.lu().solve(&right)?;
        }
        sphere
            .terms
            .iter()
            .all(|term| term.is_finite())
            .then_some(sphere)
    }

    /// κ, 1/mm: positive where the sphere is hollow towards the tool, 0 for a plane.
    pub fn curvature(&self) -> f64 {
        self.terms[0]
    }

    /// The radius, mm, with the sign of the curvature.
    pub fn radius(&self) -> f64 {
        let [k, a, b, c] = [self.terms[0], self.terms[1], self.terms[2], self.terms[3]];
        // (x + b/κ)² + (y + c/κ)² + (z − 1/κ)² = (1 + b² + c²)/κ² − 2a/κ.
        let square = 1.0 + b * b + c * c - 2.0 * a * k;
        square.max(0.0).sqrt() / k
    }

    /// The height at a place, mm; not a number beyond the sphere.
    pub fn height(&self, x: f64, y: f64) -> f64 {
        let [k, a, b, c] = [self.terms[0], self.terms[1], self.terms[2], self.terms[3]];
        let level = a + b * x + c * y + 0.5 * k * (x * x + y * y);
        2.0 * level / (1.0 + (1.0 - 2.0 * k * level).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Places on a square of 21² within a circle of 10 mm.
    fn places(z: impl Fn(f64, f64) -> f64) -> Vec<[f64; 3]> {
        let axis = |i: i32| f64::from(i);
        let square = (-10..=10).flat_map(|i| (-10..=10).map(move |j| (axis(i), axis(j))));
        let circle = square.filter(|(x, y)| x * x + y * y <= 100.0);
        circle.map(|(x, y)| [x, y, z(x, y)]).collect()
    }

    /// A sphere of 25 mm, its centre beside the axis.
    fn sphere(x: f64, y: f64) -> f64 {
        27.0 - (625.0 - (x - 3.0) * (x - 3.0) - (y + 1.0) * (y + 1.0)).sqrt()
    }

    #[test]
    fn a_sphere_beside_the_axis_is_found_exactly() {
        let found = BestSphere::of(&places(sphere)).unwrap();
        assert!((found.radius() - 25.0).abs() < 1e-9, "{}", found.radius());
        for [x, y, z] in places(sphere) {
            assert!((found.height(x, y) - z).abs() < 1e-11);
        }
    }

    #[test]
    fn a_tilted_plane_has_no_curvature() {
        let found = BestSphere::of(&places(|x, y| 0.5 + 0.1 * x - 0.02 * y)).unwrap();
        assert!(found.curvature().abs() < 1e-14, "{}", found.curvature());
        assert!((found.height(3.0, -4.0) - 0.88).abs() < 1e-12);
    }

    #[test]
    fn no_other_sphere_lies_nearer_to_a_saddle_on_a_sphere() {
        let places = places(|x, y| sphere(x, y) + 1e-3 * (x * x - y * y) + 1e-4 * x * x * x);
        let found = BestSphere::of(&places).unwrap();
        let square = |sphere: &BestSphere| -> f64 {
            let square = |[x, y, z]: &[f64; 3]| {
                let off = z - sphere.height(*x, *y);
                off * off
            };
            places.iter().map(square).sum()
        };
        let least = square(&found);
        for (term, step) in [(0, 1e-7), (1, 1e-5), (2, 1e-6), (3, 1e-6)] {
            for sign in [-1.0, 1.0] {
                let mut other = found;
                other.terms[term] += sign * step;
                assert!(square(&other) > least, "{term}");
            }
        }
    }

    #[test]
    fn too_few_places_have_no_sphere() {
        assert_eq!(BestSphere::of(&[[0.0, 0.0, 1.0]]), None);
    }
}
