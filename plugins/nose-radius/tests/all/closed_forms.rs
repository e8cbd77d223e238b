//! Tool centres and rates against closed forms: planes, spheres, cylinders, up and down.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::common::{centres, rates};
use turnpath_core::{
    CentreBuffers, Compensator, Params, Scalar, Strategy, Surface, Tool, ToolLocus,
};
use turnpath_nose_radius::{Normal, Uncompensated, ZDirection};

const NOSE: f64 = 0.75;
/// Largest difference from a closed form, mm.
const CLOSE: f64 = 1e-10;

fn tool() -> Tool {
    Tool {
        nose_radius: NOSE,
        included_angle: None,
        clearance_angle: None,
        misfit: turnpath_core::Misfit::Refuse,
    }
}

fn locus<C: Strategy + Compensator + 'static>(surface: impl Surface + 'static) -> ToolLocus {
    let compensator = C::new(&Params::new()).unwrap();
    ToolLocus::new(Arc::new(surface), Arc::new(compensator), tool())
}

/// More points than one batch, over all angles, from beyond the axis to 2 mm.
fn places() -> (Vec<f64>, Vec<f64>) {
    (0..700)
        .map(|i| (i as f64 * 0.37, -0.2 + 2.2 * (i as f64 * 0.618).fract()))
        .unzip()
}

fn close(found: f64, closed: f64, what: &str) {
    assert!(
        (found - closed).abs() < CLOSE,
        "{what}: {found} for {closed}"
    );
}

/// z = slope_x·x + slope_y·y.
struct Plane {
    slope_x: f64,
    slope_y: f64,
}

impl Surface for Plane {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        x * self.slope_x + y * self.slope_y
    }
}

/// A sphere through the origin. The radius is positive if the sphere is concave.
struct Sphere {
    radius: f64,
}

impl Surface for Sphere {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let q = (x.squared() + y.squared()) / self.radius;
        q / ((-q / self.radius + 1.0).sqrt() + 1.0)
    }
}

/// A cylinder along y through the origin. The radius is positive if the cylinder is concave.
struct Cylinder {
    radius: f64,
}

impl Surface for Cylinder {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, _: S) -> S {
        let q = x.squared() / self.radius;
        q / ((-q / self.radius + 1.0).sqrt() + 1.0)
    }
}

#[test]
fn on_a_plane_the_centre_lies_one_radius_above() {
    let (theta, rho) = places();
    let flat = || Plane {
        slope_x: 0.0,
        slope_y: 0.0,
    };
    for locus in [locus::<ZDirection>(flat()), locus::<Normal>(flat())] {
        let found = centres(&locus, &theta, &rho);
        for (i, rho) in rho.iter().enumerate() {
            assert_eq!((found.x[i], found.z[i], found.foot[i]), (*rho, NOSE, *rho));
        }
    }
    let found = centres(&locus::<Uncompensated>(flat()), &theta, &rho);
    assert_eq!(found.x, rho);
    assert!(found.z.iter().all(|z| *z == 0.0));
}

#[test]
fn on_a_tilted_plane_the_centre_lies_one_radius_along_the_normal() {
    let (theta, rho) = places();
    let plane = || Plane {
        slope_x: 0.4,
        slope_y: -0.3,
    };
    let down = centres(&locus::<ZDirection>(plane()), &theta, &rho);
    let off = centres(&locus::<Normal>(plane()), &theta, &rho);
    for (i, (theta, rho)) in theta.iter().zip(&rho).enumerate() {
        let (sin, cos) = Scalar::sin_cos(*theta);
        let slope = 0.4 * cos - 0.3 * sin;
        let w = (1.0 + slope * slope).sqrt();
        close(down.z[i], rho * slope + NOSE * w, "z-direction Z");
        close(down.foot[i], rho + NOSE * slope / w, "z-direction foot");
        close(off.x[i], rho - NOSE * slope / w, "normal X");
        close(off.z[i], rho * slope + NOSE / w, "normal Z");
    }
}

#[test]
fn on_a_sphere_the_centre_lies_on_a_sphere_of_the_radius_less_the_nose() {
    let (theta, rho) = places();
    for radius in [3.5, 20.0, -3.5, -20.0, 1e6] {
        let sphere = || Sphere { radius };
        let smaller = radius - NOSE;
        let down = centres(&locus::<ZDirection>(sphere()), &theta, &rho);
        let off = centres(&locus::<Normal>(sphere()), &theta, &rho);
        let along =
            |x: f64| NOSE + x * x / smaller / (1.0 + (1.0 - (x / smaller) * (x / smaller)).sqrt());
        for (i, rho) in rho.iter().enumerate() {
            close(down.x[i], *rho, "z-direction X");
            close(down.z[i], along(*rho), "z-direction Z");
            close(down.foot[i], rho * radius / smaller, "z-direction foot");
            close(off.x[i], rho * smaller / radius, "normal X");
            close(off.z[i], along(rho * smaller / radius), "normal Z");
            close(off.foot[i], *rho, "normal foot");
        }
    }
}

/// The oblique section of a cylinder is an ellipse. From a contact at ρ on the ellipse the centre
/// follows in closed form. At that X the descent along z must end at that Z and that contact.
#[test]
fn on_a_cylinder_the_centre_lies_one_radius_along_the_ellipses_normal() {
    for radius in [3.0, -3.0, 40.0, -40.0] {
        let (theta, rho) = places();
        let mut closed = CentreBuffers::default();
        closed.resize(theta.len());
        for (i, (theta, rho)) in theta.iter().zip(&rho).enumerate() {
            let cos = Scalar::cos(*theta);
            let inner = (radius * radius - rho * rho * cos * cos).sqrt() * radius.signum();
            let slope = rho * cos * cos / inner;
            let w = (1.0 + slope * slope).sqrt();
            closed.x[i] = rho - NOSE * slope / w;
            closed.z[i] = radius - inner + NOSE / w;
            closed.foot[i] = *rho;
        }
        let off = centres(&locus::<Normal>(Cylinder { radius }), &theta, &rho);
        let down = centres(&locus::<ZDirection>(Cylinder { radius }), &theta, &closed.x);
        for (found, which) in [(&off, "normal"), (&down, "z-direction")] {
            for i in 0..theta.len() {
                close(found.x[i], closed.x[i], which);
                close(found.z[i], closed.z[i], which);
                close(found.foot[i], closed.foot[i], which);
            }
        }
    }
}

#[test]
fn where_the_edge_ends_the_nose_touches_with_the_end_of_the_edge() {
    let slope = 1.0;
    let blunt = Tool {
        included_angle: Some(TAU / 6.0),
        ..tool()
    };
    let plane = Plane {
        slope_x: slope,
        slope_y: 0.0,
    };
    let locus = ToolLocus::new(Arc::new(plane), Arc::new(ZDirection), blunt);
    let found = centres(&locus, &[0.0, TAU / 2.0], &[1.0, 1.0]);
    let reach = 0.5 * NOSE;
    let rise = (NOSE * NOSE - reach * reach).sqrt();
    close(found.foot[0], 1.0 + reach, "foot uphill");
    close(found.z[0], slope * (1.0 + reach) + rise, "Z uphill");
    close(found.foot[1], 1.0 - reach, "foot downhill");
    close(found.z[1], -slope * (1.0 - reach) + rise, "Z downhill");
}

#[test]
fn where_the_surface_has_no_value_the_centre_has_none() {
    let sphere = || Sphere { radius: 2.0 };
    let rho = [0.5, 3.0, 1.0];
    for locus in [locus::<ZDirection>(sphere()), locus::<Normal>(sphere())] {
        let found = centres(&locus, &[0.0; 3], &rho);
        assert!(found.z[1].is_nan());
        assert!(found.z[0].is_finite() && found.z[2].is_finite());
    }
}

/// On a sphere Z = h(X) at every angle. The rates of X follow from the derivative of the closed
/// form.
#[test]
fn rates_on_a_sphere_are_those_of_the_closed_form() {
    let (theta, rho) = places();
    for radius in [3.5, -3.5] {
        let smaller = radius - NOSE;
        let sphere = || Sphere { radius };
        for (locus, x_per_rho) in [
            (locus::<ZDirection>(sphere()), 1.0),
            (locus::<Normal>(sphere()), smaller / radius),
        ] {
            let found = rates(&locus, &theta, &rho);
            for (i, rho) in rho.iter().enumerate() {
                let x = rho * x_per_rho;
                close(found[0][i], 0.0, "X_θ");
                close(found[1][i], x_per_rho, "X_ρ");
                close(found[2][i], 0.0, "Z_θ");
                let slope = x / (smaller * smaller - x * x).sqrt() * smaller.signum();
                close(found[3][i], slope, "Z_X");
            }
        }
    }
}
