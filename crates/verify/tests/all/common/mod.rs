//! Surfaces with closed forms, and paths over them that are made from closed forms alone.
#![allow(dead_code, reason = "each test uses what it needs")]
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

use std::f64::consts::TAU;
use std::sync::Arc;

use turnpath_core::toolpath::{ControlPoint, PathBlock};
use turnpath_core::{DEG, Part, Scalar, Surface, Tool};
use turnpath_verify::{FirstTouch, Meter, PathFigures, Subject, Touch};

/// 500 revolutions a minute, in rad/s.
pub const SPEED: f64 = 500.0 / 60.0 * TAU;
/// AST-5.
pub const AST5: Astigmatic = Astigmatic { k: 0.08 };

/// z = 2 k x y.
#[derive(Clone, Copy)]
pub struct Astigmatic {
    pub k: f64,
}

impl Surface for Astigmatic {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        x * y * (2.0 * self.k)
    }
}

/// z = slope · x.
pub struct Plane {
    pub slope: f64,
}

impl Surface for Plane {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, _: S) -> S {
        x * self.slope
    }
}

/// The lower half of a ball, cut from inside (positive radius), or its upper half (negative
/// radius).
pub struct Ball {
    pub radius: f64,
}

impl Surface for Ball {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let root = (-(x.squared() + y.squared()) + self.radius * self.radius).sqrt();
        if self.radius > 0.0 {
            -root + self.radius
        } else {
            root + self.radius
        }
    }
}

/// z = ρ²/(2 radius).
pub struct Paraboloid {
    pub radius: f64,
}

impl Surface for Paraboloid {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        (x.squared() + y.squared()) * (0.5 / self.radius)
    }
}

/// A trough along y.
pub struct Trough {
    pub radius: f64,
}

impl Surface for Trough {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, _: S) -> S {
        -(-x.squared() + self.radius * self.radius).sqrt() + self.radius
    }
}

/// A groove along y with a rounded bottom: z = slope · sqrt(x² + width²).
pub struct Groove {
    pub slope: f64,
    pub width: f64,
}

impl Surface for Groove {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, _: S) -> S {
        (x.squared() + self.width * self.width).sqrt() * self.slope
    }
}

/// z = height · sin(wave number · x).
pub struct Waves {
    pub height: f64,
    pub wave_number: f64,
}

impl Surface for Waves {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, _: S) -> S {
        (x * self.wave_number).sin() * self.height
    }
}

/// The plane z = 0 with a disc around (x, y) that has no height.
pub struct Pocket {
    pub x: f64,
    pub y: f64,
    pub radius: f64,
}

impl Surface for Pocket {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let off = (x - self.x).squared() + (y - self.y).squared();
        (off - self.radius * self.radius).sqrt() * 0.0
    }
}

/// The search for touches of a nose on a surface.
pub fn touch_on(
    surface: impl Surface + 'static,
    aperture_radius: f64,
    nose_radius: f64,
    compensates_nose: bool,
) -> FirstTouch {
    let tool = Tool {
        nose_radius,
        included_angle: None,
        clearance_angle: None,
        misfit: turnpath_core::Misfit::Refuse,
    };
    touch_of(surface, aperture_radius, tool, compensates_nose)
}

/// The search for touches of a tool on a surface.
pub fn touch_of(
    surface: impl Surface + 'static,
    aperture_radius: f64,
    tool: Tool,
    compensates_nose: bool,
) -> FirstTouch {
    FirstTouch::new(Subject {
        surface: Arc::new(surface),
        part: Part {
            aperture_radius,
            inner_radius: 0.0,
        },
        tool,
        compensates_nose,
    })
    .expect("a surface with heights")
}

/// The touch at each X, all at one angle.
pub fn touches(touch: &FirstTouch, theta: f64, x: &[f64]) -> Vec<Touch> {
    let mut found = Vec::new();
    let theta = vec![theta; x.len()];
    touch.find(&theta, x, &mut found).expect("an answer");
    found
}

/// All figures of a path measured in one piece.
pub fn figures(touch: &FirstTouch, points: &PathBlock) -> PathFigures {
    let mut meter = Meter::new(touch.clone());
    let block = Meter::measure(touch, points).expect("figures");
    meter.append(block).expect("figures");
    meter.figures().expect("figures")
}

/// Z, ∂Z/∂θ and ∂Z/∂X of a nose over k ρ² sin 2θ, with its foot from Newton's method.
pub fn astigmatic_locus(surface: Astigmatic, nose: f64, theta: f64, x: f64) -> [f64; 3] {
    let (sin, cos) = Scalar::sin_cos(2.0 * theta);
    let bend = 2.0 * surface.k * sin;
    let mut foot = x;
    for _ in 0..50 {
        let w = (1.0 + bend * bend * foot * foot).sqrt();
        foot -= (foot - nose * bend * foot / w - x) / (1.0 - nose * bend / (w * w * w));
    }
    let w = (1.0 + bend * bend * foot * foot).sqrt();
    let height = 0.5 * bend * foot * foot + nose / w;
    [height, 2.0 * surface.k * foot * foot * cos, bend * foot]
}

/// A path over an astigmatic surface with exact velocities, in steps of `step` rad. `law` gives X
/// and dX/dθ at θ.
pub fn astigmatic_path(
    surface: Astigmatic,
    nose: f64,
    steps: usize,
    step: f64,
    law: impl Fn(f64) -> (f64, f64),
) -> PathBlock {
    let mut points = PathBlock::default();
    for i in 0..=steps {
        let theta = step * i as f64;
        let (x, rate) = law(theta);
        let [z, z_theta, z_x] = astigmatic_locus(surface, nose, theta, x);
        points.push(ControlPoint {
            t: theta / SPEED,
            c: theta,
            x,
            z,
            vc: SPEED,
            vx: rate * SPEED,
            vz: (z_theta + z_x * rate) * SPEED,
        });
    }
    points
}

/// A spiral in steps of 6 deg whose Z does not matter; `x` gives X as a function of revolutions.
pub fn bare_spiral(turns: f64, x: impl Fn(f64) -> f64) -> PathBlock {
    let mut points = PathBlock::default();
    for i in 0..=(turns * 60.0) as usize {
        let n = i as f64 / 60.0;
        points.push(ControlPoint {
            t: n * TAU / SPEED,
            c: 6.0 * DEG * i as f64,
            x: x(n),
            z: 0.0,
            vc: SPEED,
            vx: (x(n + 1e-5) - x(n - 1e-5)) / 2e-5 * SPEED / TAU,
            vz: 0.0,
        });
    }
    points
}
