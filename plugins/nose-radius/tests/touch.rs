//! What a tool centre along z is for: the nose touches the section, and cuts into it nowhere.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

mod common;

use std::sync::Arc;

use common::centres;
use proptest::prelude::*;
use turnpath_core::{Params, Scalar, Strategy, Surface, Tool, ToolLocus};
use turnpath_nose_radius::{Normal, ZDirection};
use turnpath_surfaces::{SinusoidalArray, Toric};

const NOSE: f64 = 1.0;

/// A toric with a lens array on it; the radial curvature stays below 0.8 /mm.
#[derive(Clone)]
struct Rippled(Toric, SinusoidalArray);

impl Surface for Rippled {
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        self.0.sag(x, y) + self.1.sag(x, y)
    }
}

fn rippled() -> Rippled {
    let toric = Params::new()
        .with("radius_rotation", 8.0)
        .with("radius_base", -12.0);
    let mut array = Params::new()
        .with("amplitude_x", 0.01)
        .with("amplitude_y", 0.02)
        .with("frequency_x", 0.7)
        .with("frequency_y", 0.5);
    array.set("form", turnpath_core::ParamValue::Text("sum".into()));
    Rippled(
        Toric::new(&toric).unwrap(),
        SinusoidalArray::new(&array).unwrap(),
    )
}

fn tool() -> Tool {
    Tool {
        nose_radius: NOSE,
        included_angle: None,
        clearance_angle: None,
        misfit: turnpath_core::Misfit::Refuse,
    }
}

/// Height of the section and of the nose's lower side at `offset` from the centre.
fn clearance(surface: &Rippled, theta: f64, x: f64, z: f64, offset: f64) -> f64 {
    let (sin, cos) = Scalar::sin_cos(theta);
    let rho = x + offset;
    z - (NOSE * NOSE - offset * offset).sqrt() - surface.sag(rho * cos, rho * sin)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

    #[test]
    fn the_nose_touches_at_its_foot_and_clears_the_rest(
        theta in 0.0..6.3f64,
        rho in 0.0..4.0f64,
    ) {
        let surface = rippled();
        let locus = ToolLocus::new(Arc::new(surface.clone()), Arc::new(ZDirection), tool());
        let at = centres(&locus, &[theta], &[rho]);
        let gap = |offset| clearance(&surface, theta, at.x[0], at.z[0], offset);
        prop_assert!(gap(at.foot[0] - at.x[0]).abs() < 1e-15);
        for i in -1000..=1000 {
            prop_assert!(gap(f64::from(i) * 1e-3) > -1e-15);
        }
    }

    #[test]
    fn along_the_normal_and_then_along_z_the_nose_stays(
        theta in 0.0..6.3f64,
        rho in 0.0..4.0f64,
    ) {
        let surface = Arc::new(rippled());
        let off = ToolLocus::new(surface.clone(), Arc::new(Normal), tool());
        let off = centres(&off, &[theta], &[rho]);
        let down = ToolLocus::new(surface, Arc::new(ZDirection), tool());
        let down = centres(&down, &[theta], &off.x);
        prop_assert!((down.z[0] - off.z[0]).abs() < 2e-15);
        prop_assert!((down.foot[0] - rho).abs() < 1e-14);
    }

    #[test]
    fn a_point_does_not_depend_on_its_batch(
        points in prop::collection::vec((0.0..6.3f64, -1.0..4.0f64), 1..600),
    ) {
        let locus = ToolLocus::new(Arc::new(rippled()), Arc::new(ZDirection), tool());
        let (theta, rho): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
        let all = centres(&locus, &theta, &rho);
        let last = theta.len() - 1;
        let alone = centres(&locus, &theta[last..], &rho[last..]);
        prop_assert_eq!((all.z[last], all.foot[last]), (alone.z[0], alone.foot[0]));
    }
}
