//! The shape of a part by itself: how high, how steep and how curved it is, whatever tool cuts it.

mod figures;
mod tips;

use crate::extreme::{self, Extreme};
use crate::{RadialRange, Result, SurfaceModel};

use figures::{DOMED, FigureRoom, Figures, HOLLOW};
use tips::TipSearch;

/// The extremes of a surface over a part, each with its position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartShape {
    /// Lowest z, mm.
    pub lowest: Extreme,
    /// Highest z, mm; z points to the tool.
    pub highest: Extreme,
    /// Largest angle of the surface to the horizontal, in whatever direction, rad.
    pub steepest: Extreme,
    /// Largest principal curvature, 1/mm; positive in a hollow. On a seam there is none: the figure
    /// is that of the faces beside it.
    pub most_hollow: Extreme,
    /// Smallest principal curvature, 1/mm; negative on a dome.
    pub most_domed: Extreme,
    /// Whether the surface is not smooth where it is most hollow: on the way there the curvature
    /// grows without bound, and the figure is that of the closest place that was looked at.
    pub has_hollow_tip: bool,
    /// The same where it is most domed: at the tip of a cone, for example.
    pub has_domed_tip: bool,
}

/// Looks for the extremes of a surface within `region`: first on a grid, then closer and closer
/// around its highest points.
///
/// # Errors
/// If the surface has no height, slope or curvature somewhere in `region`.
///
/// ```
/// use turnpath_core::{RadialRange, Scalar, Surface, part_shape};
/// struct Saddle;
/// impl Surface for Saddle {
///     fn sag<S: Scalar>(&self, x: S, y: S) -> S {
///         x * y * 0.2
///     }
/// }
/// let region = RadialRange { inner: 0.0, outer: 2.0 };
/// let shape = part_shape::of(&Saddle, region)?;
/// assert!((shape.highest.value - 0.4).abs() < 1e-12);
/// assert!((shape.steepest.value - Scalar::atan(0.4)).abs() < 1e-12);
/// assert!((shape.most_hollow.value - 0.2).abs() < 1e-12);
/// # turnpath_core::Result::Ok(())
/// ```
pub fn of(surface: &dyn SurfaceModel, region: RadialRange) -> Result<PartShape> {
    let mut room = FigureRoom::default();
    let found = extreme::largest(region, &mut |theta, rho, out: &mut [Figures]| {
        room.measure(surface, theta, rho, out)
    })?;
    let [low, highest, steepest, most_hollow, dome] = found;
    let mut tips = TipSearch::new(surface, region);
    let has_hollow_tip = tips.has_tip([HOLLOW, DOMED], most_hollow);
    let has_domed_tip = tips.has_tip([DOMED, HOLLOW], dome);
    let opposite = |extreme: Extreme| Extreme {
        value: -extreme.value,
        ..extreme
    };
    Ok(PartShape {
        lowest: opposite(low),
        highest,
        steepest,
        most_hollow,
        most_domed: opposite(dome),
        has_hollow_tip,
        has_domed_tip,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Scalar, Surface};

    const REGION: RadialRange = RadialRange {
        inner: 0.0,
        outer: 6.0,
    };

    #[track_caller]
    fn near(found: f64, expected: f64) {
        let within = (found - expected).abs() <= 1e-11 * (1.0 + expected.abs());
        assert!(within, "{found}, not {expected}");
    }

    fn shape(surface: &impl Surface) -> PartShape {
        of(surface, REGION).unwrap()
    }

    /// z = cρ²/(1 + sqrt(1 − (1 + K)c²ρ²)).
    struct Conic {
        c: f64,
        k: f64,
    }

    impl Surface for Conic {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, y: S) -> S {
            let square = x.squared() + y.squared();
            let root = (-(square * ((1.0 + self.k) * self.c * self.c)) + 1.0).sqrt();
            square * self.c / (root + 1.0)
        }
    }

    #[test]
    fn a_sphere_is_curved_alike_everywhere() {
        let sphere = shape(&Conic { c: 0.1, k: 0.0 });
        near(sphere.lowest.value, 0.0);
        near(sphere.highest.value, 10.0 - 8.0);
        near(sphere.steepest.value, Scalar::asin(0.6));
        near(sphere.most_hollow.value, 0.1);
        near(sphere.most_domed.value, 0.1);
        let dome = shape(&Conic { c: -0.1, k: 0.0 });
        near(dome.lowest.value, -2.0);
        near(dome.most_hollow.value, -0.1);
        near(dome.most_domed.value, -0.1);
    }

    /// The curvatures of a conicoid are c(1 − Kc²ρ²)^(−3/2) along the radius, with the same root to
    /// the first power across.
    #[test]
    fn a_conicoid_is_most_curved_at_its_vertex_or_at_its_rim() {
        for k in [-2.5, -1.0, 0.7] {
            let (c, found) = (0.08, shape(&Conic { c: 0.08, k }));
            let q = 1.0 - k * c * c * 36.0;
            let rim = [c / (q * Scalar::sqrt(q)), c / Scalar::sqrt(q)];
            near(found.most_hollow.value, c.max(rim[0]).max(rim[1]));
            near(found.most_domed.value, c.min(rim[0]).min(rim[1]));
            let root = Scalar::sqrt(1.0 - (1.0 + k) * c * c * 36.0);
            near(found.highest.value, c * 36.0 / (1.0 + root));
            near(found.highest.rho, 6.0);
            near(found.steepest.value, Scalar::atan(c * 6.0 / root));
        }
    }

    /// A trough along a line that is turned by 0.3 rad.
    struct Cylinder;

    impl Surface for Cylinder {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, y: S) -> S {
            let across = x * Scalar::cos(0.3) + y * Scalar::sin(0.3);
            -(-across.squared() + 100.0).sqrt() + 10.0
        }
    }

    #[test]
    fn a_cylinder_is_curved_across_alone() {
        let cylinder = shape(&Cylinder);
        near(cylinder.most_hollow.value, 0.1);
        near(cylinder.most_domed.value, 0.0);
        near(cylinder.highest.value, 2.0);
        near(cylinder.steepest.value, Scalar::asin(0.6));
        let turned = cylinder.steepest.theta.rem_euclid(std::f64::consts::PI);
        assert!((turned - 0.3).abs() < 1e-6, "{turned}");
    }

    /// A torus about an axis parallel to y: R − sqrt((R − a + sqrt(a² − y²))² − x²).
    struct Torus;

    impl Surface for Torus {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, y: S) -> S {
            let from_axis = (-y.squared() + 8.0 * 8.0).sqrt() + (20.0 - 8.0);
            -(from_axis.squared() - x.squared()).sqrt() + 20.0
        }
    }

    /// The tube is curved by 1/a everywhere, and about the axis by cos φ over the distance from it,
    /// where sin φ = y/a on the tube.
    #[test]
    fn a_torus_has_the_curvatures_of_its_tube_and_of_its_axis() {
        let torus = shape(&Torus);
        near(torus.most_hollow.value, 1.0 / 8.0);
        let cos = Scalar::sqrt(1.0 - 0.75 * 0.75);
        near(torus.most_domed.value, cos / (12.0 + 8.0 * cos));
        near(torus.highest.value, 8.0 - 8.0 * cos);
        near(torus.steepest.value, Scalar::asin(0.75));
    }

    /// z = s·((x − a)² + y²)^½ and the same with the other sign.
    struct Cone {
        slope: f64,
        middle: f64,
    }

    impl Surface for Cone {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, y: S) -> S {
            let square = (x - self.middle).squared() + y.squared();
            let at_tip = square.less(S::constant(1e-50));
            let beside = S::select(at_tip, S::constant(1.0), square).sqrt();
            S::select(at_tip, S::constant(0.0), beside) * self.slope
        }
    }

    /// The same without a slope at its tip.
    struct BareCone {
        slope: f64,
        middle: [f64; 2],
    }

    impl Surface for BareCone {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, y: S) -> S {
            let [to_x, to_y] = self.middle;
            ((x - to_x).squared() + (y - to_y).squared()).sqrt() * self.slope
        }
    }

    /// z = s·ρ^(3/2), whose curvature grows with ρ^(−1/2), and flat within 10⁻¹⁵ mm.
    struct Thorn(f64);

    impl Surface for Thorn {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, y: S) -> S {
            let square = x.squared() + y.squared();
            let at_tip = square.less(S::constant(1e-30));
            let root = S::select(at_tip, S::constant(1.0), square).sqrt();
            S::select(at_tip, S::constant(0.0), root * root.sqrt()) * self.0
        }
    }

    #[test]
    fn a_curvature_that_grows_slowly_without_bound_is_a_tip_too() {
        let found = of(&Thorn(0.01), REGION).unwrap();
        assert!(found.has_hollow_tip && !found.has_domed_tip);
        let found = of(&Thorn(-0.1), REGION).unwrap();
        assert!(!found.has_hollow_tip && found.has_domed_tip);
    }

    /// z = s·|x + ty − a|^(3/2), an edge whose curvature has no bound.
    struct Edge {
        scale: f64,
        turn: f64,
        at: f64,
    }

    impl Surface for Edge {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, y: S) -> S {
            let across = x + y * self.turn - self.at;
            let square = across.squared();
            let on_edge = square.less(S::constant(1e-30));
            let root = S::select(on_edge, S::constant(1.0), square).sqrt();
            S::select(on_edge, S::constant(0.0), root * root.sqrt()) * self.scale
        }
    }

    /// Along the edge itself the curvature does not grow.
    #[test]
    fn an_edge_is_a_tip_whatever_its_direction() {
        for (turn, at) in [(0.0, 0.31234), (1.0, 0.31234), (0.37, 0.3)] {
            for scale in [0.01, -0.01] {
                let found = of(&Edge { scale, turn, at }, REGION).unwrap();
                let tips = (found.has_hollow_tip, found.has_domed_tip);
                assert_eq!(tips, (scale > 0.0, scale < 0.0), "{turn} {at}");
            }
        }
    }

    /// The search comes to the tip itself, where there is no slope.
    #[test]
    fn a_tip_without_a_slope_stops_no_search() {
        for middle in [[1.0, 0.0], [0.1, 0.0], [2.5, -1.0]] {
            for slope in [0.01, 0.3] {
                let found = of(&BareCone { slope, middle }, REGION).unwrap();
                assert!(found.has_hollow_tip && !found.has_domed_tip, "{middle:?}");
            }
        }
    }

    #[test]
    fn a_tip_has_no_curvature() {
        let tips = |surface: &dyn SurfaceModel| {
            let found = of(surface, REGION).unwrap();
            (found.has_hollow_tip, found.has_domed_tip)
        };
        for middle in [0.0, 1.0, 2.3] {
            for slope in [0.3, 0.001] {
                assert_eq!(tips(&Cone { slope, middle }), (true, false), "{middle}");
                let slope = -slope;
                assert_eq!(tips(&Cone { slope, middle }), (false, true), "{middle}");
            }
        }
        assert_eq!(tips(&Conic { c: 0.1, k: 0.0 }), (false, false));
        assert_eq!(
            tips(&Conic {
                c: -0.08,
                k: -300.0
            }),
            (false, false)
        );
        assert_eq!(tips(&Torus), (false, false));
        assert_eq!(tips(&Cylinder), (false, false));
    }

    /// A hole keeps out what lies in it.
    #[test]
    fn only_the_ring_of_a_part_with_a_hole_counts() {
        let ring = RadialRange {
            inner: 3.0,
            outer: 6.0,
        };
        let found = of(&Conic { c: 0.1, k: 0.0 }, ring).unwrap();
        near(found.lowest.value, 10.0 - Scalar::sqrt(91.0));
        near(found.lowest.rho, 3.0);
    }

    #[test]
    fn a_part_beyond_its_surface_is_an_error_with_the_place() {
        let error = of(&Conic { c: 0.2, k: 0.0 }, REGION).unwrap_err();
        assert!(error.to_string().contains("at x = "), "{error}");
    }
}
