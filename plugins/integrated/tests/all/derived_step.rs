//! The step that `equal-angle` derives, against closed forms and published counts.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::models::model;
use turnpath_core::{
    Compensator, DEG, Direction, Machine, NM, NodeList, ParamValue, Params, Part, Path,
    RadialRange, Result, Revolutions, Sampler, Scalar, SpindleLaw, SpiralLaw, Strategy,
    SurfaceModel, Task, Tolerance, Tool, ToolLocus,
};
use turnpath_integrated::EqualAngle;
use turnpath_nose_radius::{Normal, Uncompensated, ZDirection};
use turnpath_surfaces::{Astigmatic, Conic, OffAxisParaboloid, SinusoidalArray};

/// The part of the tolerance that a derived step aims at.
const AIM: f64 = 0.98;

/// A part with a constant feed inward.
struct Case {
    surface: Arc<dyn SurfaceModel>,
    compensator: Arc<dyn Compensator>,
    rim: f64,
    revolutions: f64,
    nose_radius: f64,
    tolerance: f64,
}

impl Case {
    /// AST-5 on its contact path: z = 0.08 ρ² sin 2θ, 101 revolutions.
    fn saddle(compensator: Arc<dyn Compensator>) -> Self {
        Self {
            surface: model::<Astigmatic>(&Params::new().with("k", 0.08)),
            compensator,
            rim: 2.5,
            revolutions: 101.0,
            nose_radius: 1.0,
            tolerance: 100.0 * NM,
        }
    }

    fn with_path<T>(&self, call: impl FnOnce(&Path<'_>) -> T) -> T {
        let tool = Tool {
            nose_radius: self.nose_radius,
            included_angle: None,
            clearance_angle: None,
            misfit: turnpath_core::Misfit::Refuse,
        };
        let part = Part {
            aperture_radius: self.rim,
            inner_radius: 0.0,
        };
        let task = Task {
            part,
            tool,
            tolerance: Tolerance {
                interpolation: self.tolerance,
                residual: self.tolerance,
            },
            range: RadialRange {
                inner: 0.0,
                outer: self.rim,
            },
            direction: Direction::Inward,
            spindle_speed: 52.0,
            machine: Machine::default(),
        };
        let locus = ToolLocus::new(self.surface.clone(), self.compensator.clone(), tool);
        let mut law = SpiralLaw::new();
        let rate = -self.rim / self.revolutions;
        law.push(self.revolutions, [self.rim, rate, 0.0, 0.0, 0.0, 0.0]);
        call(&Path {
            task: &task,
            locus: &locus,
            law: &law,
            spindle: &SpindleLaw::constant(52.0),
        })
    }

    fn derived(&self) -> Result<f64> {
        let sampler = EqualAngle::new(&Params::new().with("max_step", 45.0 * DEG))?;
        let block = Revolutions {
            start: 0.0,
            end: 1.0,
        };
        let mut nodes = NodeList::default();
        self.with_path(|path| sampler.plan(path)?.place(path, block, &mut nodes))?;
        Ok(TAU * nodes.revolutions()[1])
    }

    /// The step at which L⁴/384·`sharpness` is the aim.
    fn step_for(&self, sharpness: f64) -> f64 {
        Scalar::powf(384.0 * AIM * self.tolerance / sharpness, 0.25)
    }

    fn largest(&self, places: u32, fourth: impl Fn(f64, f64) -> f64) -> f64 {
        let spread = f64::from(places);
        let at = |k: u32| {
            let n = self.revolutions * f64::from(k) / spread;
            let rho = self.rim * (1.0 - n / self.revolutions);
            fourth(TAU * n, rho).abs()
        };
        (0..=places).map(at).fold(0.0, f64::max)
    }
}

/// On the contact path φ = kρ² sin 2θ with ρ linear in θ: its fourth derivative by Leibniz' rule.
#[test]
fn on_the_saddles_contact_path_the_step_is_that_of_the_closed_form() {
    let case = Case::saddle(Arc::new(Uncompensated));
    let rate = -case.rim / case.revolutions / TAU;
    let largest = case.largest(400_000, |theta, rho| {
        let (s, c) = Scalar::sin_cos(2.0 * theta);
        0.08 * (rho * rho * 16.0 * s
            - 4.0 * 2.0 * rho * rate * 8.0 * c
            - 6.0 * 2.0 * rate * rate * 4.0 * s)
    });
    let (found, closed) = (case.derived().unwrap(), case.step_for(largest));
    assert!((found / closed - 1.0).abs() < 1e-6, "{found} for {closed}");
}

/// The nose adds a wave of 4θ, so a compensated path takes smaller steps than its contact path.
#[test]
fn compensation_makes_the_step_smaller() {
    let contact = Case::saddle(Arc::new(Uncompensated)).derived().unwrap();
    for compensator in [
        Arc::new(ZDirection) as Arc<dyn Compensator>,
        Arc::new(Normal),
    ] {
        let found = Case::saddle(compensator).derived().unwrap();
        assert!(found < 0.95 * contact, "{found} for {contact}");
    }
}

/// A lattice of a tenth of a millimetre on a rim of 20 mm has 1257 waves on a revolution, three and
/// a half in each degree. Along the circle at x = y the product's waves of both axes add up.
#[test]
fn the_search_meets_ripples_narrower_than_a_degree() {
    let (amplitude, frequency) = (1e-5, 10.0);
    let mut params = Params::new()
        .with("amplitude_x", amplitude)
        .with("amplitude_y", amplitude)
        .with("frequency_x", frequency)
        .with("frequency_y", frequency);
    params.set("form", ParamValue::Text("product".into()));
    let case = Case {
        surface: model::<SinusoidalArray>(&params),
        rim: 20.0,
        revolutions: 1000.0,
        tolerance: 10.0 * NM,
        ..Case::saddle(Arc::new(Uncompensated))
    };
    // sin a sin b with a' = −b' = kρ/√2 is a cosine of 2kρ/√2 and a constant. At the axes only one
    // wave of kρ is left, with twice the amplitude and a quarter of the fourth power.
    let along = TAU * frequency * case.rim * std::f64::consts::SQRT_2;
    let sharpness = 0.5 * amplitude * along * along * along * along;
    let (found, closed) = (case.derived().unwrap(), case.step_for(sharpness));
    assert!((found / closed - 1.0).abs() < 0.01, "{found} for {closed}");
}

/// The off-axis paraboloid OAP-213 at 10 nm: 619 thousand points over the 11,684.8 revolutions of
/// an adaptive feed, and the points that the lower aim adds.
#[test]
fn the_off_axis_paraboloid_takes_the_published_count() {
    let params = Params::new()
        .with("vertex_radius", 915.0)
        .with("off_axis_distance", 915.0);
    let case = Case {
        surface: model::<OffAxisParaboloid>(&params),
        rim: 106.5,
        revolutions: 11_684.8,
        nose_radius: 1.04,
        tolerance: 10.0 * NM,
        ..Case::saddle(Arc::new(ZDirection))
    };
    let points = case.revolutions * TAU / case.derived().unwrap() * Scalar::powf(AIM, 0.25);
    assert!((points / 619e3 - 1.0).abs() < 2e-3, "{points}");
}

#[test]
fn where_nothing_bends_the_step_is_the_largest_one() {
    let params = Params::new().with("radius", 1e12).with("conic", 0.0);
    let case = Case {
        surface: model::<Conic>(&params),
        ..Case::saddle(Arc::new(ZDirection))
    };
    assert_eq!(case.derived().unwrap(), 45.0 * DEG);
}

#[test]
fn if_the_surface_ends_the_error_names_the_position() {
    let params = Params::new().with("radius", 2.0).with("conic", 0.0);
    let case = Case {
        surface: model::<Conic>(&params),
        ..Case::saddle(Arc::new(Uncompensated))
    };
    let error = case.derived().unwrap_err().to_string();
    assert!(error.contains("no step can be found at x = 2."), "{error}");
}

#[test]
fn the_sampler_places_the_step_that_it_derived() {
    let case = Case::saddle(Arc::new(ZDirection));
    let step = case.derived().unwrap();
    let sampler = EqualAngle::new(&Params::new().with("max_step", 45.0 * DEG)).unwrap();
    let mut nodes = NodeList::default();
    let block = Revolutions {
        start: 0.0,
        end: 101.0,
    };
    case.with_path(|path| sampler.plan(path)?.place(path, block, &mut nodes))
        .unwrap();
    assert_eq!(nodes.len(), (101.0 * TAU / step).ceil() as usize);
}
