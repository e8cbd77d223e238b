//! A tool centre along z: the nose touches the section and cuts into it nowhere.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::sync::Arc;

use crate::common::centres;
use proptest::prelude::*;
use turnpath_core::{Params, Scalar, Strategy, Surface, Tool, ToolLocus};
use turnpath_nose_radius::{Normal, ZDirection};
use turnpath_surfaces::{SinusoidalArray, Toric};

const NOSE: f64 = 1.0;

/// A toric with a lens array on it. The radial curvature stays below 0.8 /mm.
#[derive(Clone)]
struct Rippled(Toric, SinusoidalArray);

impl Surface for Rippled {
    const IN_WIDE_REGISTERS: bool = false;

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
    fn along_the_normal_and_then_along_z_the_nose_stays_in_place(
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

/// Waves along x that are too narrow for the nose. Their hollows have radii down to 0.25 mm.
#[derive(Clone, Copy)]
struct Waves;

impl Surface for Waves {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, _: S) -> S {
        (x * 20.0).cos() * 0.01
    }
}

/// The highest position of the nose on the waves, by brute force.
fn first_touch_on_waves(theta: f64, x: f64, reach: f64) -> f64 {
    let (_, cos) = Scalar::sin_cos(theta);
    let place = |i: i32| f64::from(i) * 1e-5 * reach;
    let height = |d: f64| Waves.sag((x + d) * cos, 0.0) + (NOSE * NOSE - d * d).sqrt();
    (-100_000..=100_000)
        .map(|i| height(place(i)))
        .fold(f64::NEG_INFINITY, f64::max)
}

fn cuts_what_fits(included_angle: Option<f64>) -> Tool {
    Tool {
        included_angle,
        misfit: turnpath_core::Misfit::CutWhatFits,
        ..tool()
    }
}

#[test]
fn over_waves_too_narrow_for_the_nose_it_stops_at_the_first_touch() {
    for included_angle in [None, Some(0.1)] {
        let tool = cuts_what_fits(included_angle);
        let locus = ToolLocus::new(Arc::new(Waves), Arc::new(ZDirection), tool);
        for i in 0..60 {
            let (theta, x) = (0.1 * f64::from(i), 0.037 * f64::from(i));
            let z = centres(&locus, &[theta], &[x]).z[0];
            let exact = first_touch_on_waves(theta, x, tool.reach());
            assert!(z >= exact - 1e-15 && z < exact + 2e-10, "{z} {exact}");
        }
    }
}

/// A lattice of hollows. Where a seam begins between a nose of 3 mm and one of the hollows, two
/// maxima lie within a fraction of a degree of the edge.
#[derive(Clone, Copy)]
struct Lattice;

impl Surface for Lattice {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let wave = std::f64::consts::TAU;
        ((x * wave).cos() + (y * wave).cos()) * 0.01
    }
}

#[test]
fn where_a_seam_begins_there_is_a_centre_and_a_series() {
    let tool = Tool {
        nose_radius: 3.0,
        ..cuts_what_fits(None)
    };
    let locus = ToolLocus::new(Arc::new(Lattice), Arc::new(ZDirection), tool);
    let near = |i: i32| f64::from(i) * 2e-5;
    for i in -40..40 {
        let theta: Vec<f64> = (-40..40).map(|j| 0.3284 + near(i + j)).collect();
        let rho: Vec<f64> = (-40..40).map(|j| 0.5816 + near(j)).collect();
        let found = centres(&locus, &theta, &rho);
        assert!(found.z.iter().chain(&found.foot).all(|z| z.is_finite()));
        let curve = |values: &[f64], rate: f64| -> Vec<turnpath_core::Series> {
            values.iter().map(|v| [*v, rate, 0.0, 0.0, 0.0]).collect()
        };
        let [x, z] = crate::common::series(&locus, &curve(&theta, 1.0), &curve(&rho, 0.003));
        assert!(x.iter().chain(&z).flatten().all(|c| c.is_finite()));
    }
}

#[test]
fn where_the_nose_fits_the_first_touch_is_the_only_one() {
    let find = |tool| {
        let locus = ToolLocus::new(Arc::new(rippled()), Arc::new(ZDirection), tool);
        let theta: Vec<f64> = (0..600).map(|i| 0.1 * f64::from(i)).collect();
        let rho: Vec<f64> = (0..600).map(|i| 0.005 * f64::from(i)).collect();
        centres(&locus, &theta, &rho)
    };
    let (only, first) = (find(tool()), find(cuts_what_fits(None)));
    for i in 0..600 {
        assert!((only.z[i] - first.z[i]).abs() < 1e-15);
        assert!((only.foot[i] - first.foot[i]).abs() < 1e-12);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

    #[test]
    fn a_first_touch_does_not_depend_on_its_batch(
        points in prop::collection::vec((0.0..6.3f64, -1.0..4.0f64), 1..600),
    ) {
        let locus = ToolLocus::new(Arc::new(Waves), Arc::new(ZDirection), cuts_what_fits(None));
        let (theta, rho): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
        let all = centres(&locus, &theta, &rho);
        let last = theta.len() - 1;
        let alone = centres(&locus, &theta[last..], &rho[last..]);
        prop_assert_eq!((all.z[last], all.foot[last]), (alone.z[0], alone.foot[0]));
    }
}
