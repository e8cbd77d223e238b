//! The interference check on surfaces whose extremes have a closed form.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::sync::Arc;

use crate::models::model;
use turnpath_core::interference::Conflict;
use turnpath_core::{Compensator, Cut, DEG, Params, RadialRange, Scalar, SurfaceModel, Tool};
use turnpath_nose_radius::{Normal, ZDirection};
use turnpath_surfaces::{Astigmatic, Conic};

const K: f64 = 0.08;
const REGION: RadialRange = RadialRange {
    inner: 0.0,
    outer: 2.5,
};

fn tool(nose_radius: f64) -> Tool {
    Tool {
        nose_radius,
        included_angle: Some(120.0 * DEG),
        clearance_angle: Some(30.0 * DEG),
        misfit: turnpath_core::Misfit::Refuse,
    }
}

fn saddle() -> Arc<dyn SurfaceModel> {
    model::<Astigmatic>(&Params::new().with("k", K))
}

/// g = kρ² sin 2θ: κ = 2k at the centre, |g_ρ| = 2kρ on the ridges, |g_θ|/ρ = 2kρ between them.
#[test]
fn extremes_of_the_saddle_are_those_of_the_closed_form() {
    let (surface, tool) = (saddle(), tool(1.0));
    let cut = Cut {
        surface: &*surface,
        tool: &tool,
    };
    for compensator in [&ZDirection as &dyn Compensator, &Normal] {
        let found = compensator.interference(cut, REGION).unwrap();
        let steepest = Scalar::atan(2.0 * K * REGION.outer);
        assert!((found.curvature.value - 2.0 * K).abs() < 1e-14);
        assert!((found.largest_nose_radius() - 6.25).abs() < 1e-11);
        assert!((found.contact_angle().value - steepest).abs() < 1e-14);
        assert!((found.cut_angle().value - steepest).abs() < 1e-14);
        assert!((found.cut_angle().value / DEG - 21.8).abs() < 0.01);
        assert!((found.cut_angle().rho - REGION.outer).abs() < 1e-12);
        assert!(found.conflicts(&tool).is_empty());
    }
}

/// The profile of a conic has the radius of curvature (r² − kρ²)^{3/2}/r². With k > 0 it is most
/// curved at the rim.
#[test]
fn a_nose_larger_than_the_hollow_is_in_conflict() {
    let params = Params::new().with("radius", 4.0).with("conic", 0.5);
    let surface = model::<Conic>(&params);
    let narrow = RadialRange {
        inner: 0.0,
        outer: 1.0,
    };
    for (nose_radius, conflicts) in [(3.81, 0), (3.82, 1)] {
        let tool = tool(nose_radius);
        let cut = Cut {
            surface: &*surface,
            tool: &tool,
        };
        let found = ZDirection.interference(cut, narrow).unwrap();
        let least = (16.0f64 - 0.5).sqrt() * (16.0 - 0.5) / 16.0;
        assert!((found.largest_nose_radius() - least).abs() < 1e-12);
        let listed = found.conflicts(&tool);
        assert_eq!(listed.len(), conflicts, "{listed:?}");
    }
}

#[test]
fn the_check_lists_every_misfit_with_a_value_that_would_do() {
    let tool = Tool {
        nose_radius: 7.0,
        included_angle: Some(40.0 * DEG),
        clearance_angle: Some(20.0 * DEG),
        misfit: turnpath_core::Misfit::Refuse,
    };
    let surface = saddle();
    let cut = Cut {
        surface: &*surface,
        tool: &tool,
    };
    let found = ZDirection.interference(cut, REGION).unwrap();
    let steepest = Scalar::atan(0.4);
    match found.conflicts(&tool)[..] {
        [
            Conflict::NoseRadius { largest, .. },
            Conflict::IncludedAngle { least, .. },
            Conflict::Clearance {
                least: clearance, ..
            },
        ] => {
            assert!((largest - 6.25).abs() < 1e-10);
            assert!((least - 2.0 * steepest).abs() < 1e-12);
            assert!((clearance - steepest).abs() < 1e-12);
        }
        ref other => panic!("{other:?}"),
    }
}
