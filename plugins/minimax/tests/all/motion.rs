//! What the nodes ask of Z: no step is a sliver, and Z is shaken no more than with `atpg`.

use crate::common::{Case, ast_5, atpg, ats_law, largest_error, minimax, motion_of_z, nodes};
use turnpath_core::{NodeList, Sampler, SpiralLaw};
use turnpath_nose_radius::{Normal, ZDirection};

/// By how much Z's acceleration may exceed that with `atpg`.
const ACCELERATION: f64 = 1.05;
/// By how much its jerk may. Where X decides, both samplers take nearly the same steps.
const JERK: f64 = 1.01;
/// The shortest step of `atpg` here is a last one before a border; a step that the path itself asks
/// for is some 4 deg.
const SHORTEST_DEG: f64 = 2.0;

/// The shortest step, deg.
fn shortest(blocks: &[NodeList]) -> f64 {
    let steps = blocks.iter().flat_map(|block| {
        let pairs = block.revolutions().windows(2);
        pairs.map(|n| 360.0 * (n[1] - n[0]))
    });
    steps.fold(f64::INFINITY, f64::min)
}

fn check(case: &Case, truth: &Case, law: &SpiralLaw) {
    let of = |sampler: &dyn Sampler| nodes(case, law, sampler);
    let [acceleration, jerk] = motion_of_z(case, law, &of(&atpg(45.0)));
    for states in [1.0, 3.0, 7.0, 25.0] {
        let blocks = of(&minimax(states, 45.0));
        let worst = largest_error((case, truth), law, &blocks, law.end());
        let part = worst / case.task.tolerance.interpolation;
        assert!(part <= 0.99, "{states} states: {part} of the tolerance");
        let step = shortest(&blocks);
        assert!(
            step >= SHORTEST_DEG,
            "{states} states: a step of {step} deg"
        );
        let found = motion_of_z(case, law, &blocks);
        let ratios = [found[0] / acceleration, found[1] / jerk];
        assert!(ratios[0] <= ACCELERATION, "{states} states: {ratios:?}");
        assert!(ratios[1] <= JERK, "{states} states: {ratios:?}");
    }
}

/// The feed `ats` and the compensator move X within the turn, and X's own error makes the steps much
/// shorter than Z's tolerance asks.
#[test]
fn is_that_of_atpg_where_x_moves_within_the_turn() {
    let truth = ast_5(ZDirection);
    for case in [ast_5(ZDirection), ast_5(Normal)] {
        check(&case, &truth, &ats_law(&case));
    }
}
