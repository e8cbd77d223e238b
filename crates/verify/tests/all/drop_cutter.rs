//! First touches against opencamlib's drop-cutter: a ball dropped on a mesh of the section.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use crate::reference::Case;
use turnpath_core::Part;
use turnpath_verify::{FirstTouch, Subject};

fn touch_of(case: &Case) -> FirstTouch {
    let part = Part {
        aperture_radius: case.aperture_radius,
        inner_radius: 0.0,
    };
    FirstTouch::new(Subject {
        surface: case.surface.clone(),
        part,
        tool: case.tool,
        compensates_nose: true,
    })
    .unwrap()
}

/// The cases cover the search without a scan, where the nose fits, and the scan, where the nose
/// rides on two flanks.
#[test]
fn first_touches_agree_with_a_drop_cutter_within_its_meshs_error() {
    let cases = crate::reference::cases();
    assert_eq!(cases.len(), 35);
    for case in cases {
        let touch = touch_of(&case);
        assert_eq!(touch.has_single_maximum(), case.fits, "{}", case.name);
        let mut found = Vec::new();
        touch.find(&case.theta, &case.x, &mut found).unwrap();
        case.assert_agrees(found.iter().map(|touch| touch.z));
    }
}
