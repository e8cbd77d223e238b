//! Centres along z against opencamlib's drop-cutter, which drops a ball on a mesh of the section.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::sync::Arc;

use crate::common::centres;
use turnpath_core::ToolLocus;
use turnpath_nose_radius::ZDirection;

#[test]
fn centres_along_z_agree_with_a_drop_cutter_within_the_error_of_its_mesh() {
    let mut seen = 0;
    for case in crate::reference::cases() {
        let locus = ToolLocus::new(case.surface.clone(), Arc::new(ZDirection), case.tool);
        let found = centres(&locus, &case.theta, &case.x);
        assert_eq!(found.x, case.x);
        case.assert_agrees(found.z.iter().copied());
        seen += 1;
    }
    assert_eq!(seen, 35);
}
