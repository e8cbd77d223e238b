//! Equal angles across blocks: one sequence, however the path is divided.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use crate::models::model;
use proptest::prelude::{ProptestConfig, prop_assert, prop_assert_eq, proptest};
use std::sync::Arc;
use turnpath_core::{
    DEG, Direction, Machine, NodeList, Params, Part, Path, RadialRange, Revolutions, Sampler,
    SpindleLaw, SpiralLaw, Strategy, Task, Tolerance, Tool, ToolLocus,
};
use turnpath_integrated::EqualAngle;
use turnpath_nose_radius::Uncompensated;
use turnpath_surfaces::Astigmatic;

fn task() -> Task {
    Task {
        part: Part {
            aperture_radius: 2.5,
            inner_radius: 0.0,
        },
        tool: Tool {
            nose_radius: 1.0,
            included_angle: None,
            clearance_angle: None,
            misfit: turnpath_core::Misfit::Refuse,
        },
        tolerance: Tolerance {
            interpolation: 1e-4,
            residual: 1e-4,
        },
        range: RadialRange {
            inner: 0.0,
            outer: 2.5,
        },
        direction: Direction::Inward,
        spindle_speed: 52.0,
        machine: Machine::default(),
    }
}

/// The nodes of a path of so many revolutions, sampled in blocks.
fn nodes(step: f64, revolutions: f64, block: f64) -> Vec<f64> {
    let task = task();
    let surface = model::<Astigmatic>(&Params::new().with("k", 0.08));
    let locus = ToolLocus::new(surface, Arc::new(Uncompensated), task.tool);
    let mut law = SpiralLaw::new();
    law.push(revolutions, [2.5, -2.5 / revolutions, 0.0, 0.0, 0.0, 0.0]);
    let params = Params::new()
        .with("step", step)
        .with("max_step", 90.0 * DEG);
    let sampler = EqualAngle::new(&params).unwrap();
    let path = Path {
        task: &task,
        locus: &locus,
        law: &law,
        spindle: &SpindleLaw::constant(52.0),
    };
    let plan = sampler.plan(&path).unwrap();
    let mut nodes = NodeList::default();
    let mut start = 0.0;
    while start < revolutions {
        let end = (start + block).min(revolutions);
        plan.place(&path, Revolutions { start, end }, &mut nodes)
            .unwrap();
        start = end;
    }
    nodes.revolutions().to_vec()
}

#[test]
fn six_degrees_are_sixty_nodes_a_revolution() {
    let nodes = nodes(6.0 * DEG, 100.0, 64.0);
    assert_eq!(nodes.len(), 6000);
    assert_eq!(nodes[60 * 64], 64.0);
    assert_eq!(nodes[5999], 5999.0 / 60.0);
}

#[test]
fn no_node_lies_beside_the_paths_end() {
    let nodes = nodes(9.0 * DEG, 10.0 + 1e-12, 64.0);
    assert_eq!(nodes.len(), 400);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

    #[test]
    fn blocks_have_no_effect(step in 0.5..90.0f64, revolutions in 0.1..200.0f64, block in 1u32..80) {
        let whole = nodes(step * DEG, revolutions, 1e9);
        prop_assert_eq!(&whole, &nodes(step * DEG, revolutions, f64::from(block)));
        prop_assert_eq!(whole[0], 0.0);
        for (k, n) in whole.iter().enumerate() {
            prop_assert!((n * 360.0 - k as f64 * step).abs() < 1e-9);
        }
        let last = whole[whole.len() - 1];
        prop_assert!(last < revolutions && revolutions - last <= step / 360.0 * 1.00001);
    }
}
