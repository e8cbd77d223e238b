//! The nodes of a lead: by angle during the descent, by angle and time while the spindle changes
//! its speed.

use turnpath_core::DEG;

use super::clock::Clock;
use super::phases::Phases;

/// Angle between neighbouring nodes of the descent, before any segment is halved.
const DESCENT_STEP: f64 = 5.0 * DEG;
/// Part of the descent in which steps can be made finer. Beyond it, the motion that follows the part
/// is smaller by a sixth or more.
const NEAR_THE_PART: f64 = 0.3;
/// Largest angle between nodes at rest height. Programs that wrap C need less than half a
/// revolution.
const SPIN_STEP: f64 = 80.0 * DEG;
/// Fewest segments of the spindle's phase. Its acceleration as played is then right to 0.3 %.
const SPIN_SEGMENTS: f64 = 16.0;
/// Longest segment, s: half of what controllers count to.
const LONGEST: f64 = 2.0;
/// How many segments on either side of a halved one are halved too: in a spline the neighbours of a
/// segment move with it.
const SPREAD: usize = 3;
/// Most nodes of a lead. Limits that need more are a mistake.
pub const MOST_NODES: usize = 2_000_000;

/// Nodes from the join (0) to rest, in ticks of time away from the join. Near the part they are
/// `finer` times as close as elsewhere. `None` where there would be too many.
pub fn place(phases: &Phases, clock: &Clock, finer: u32) -> Option<Vec<f64>> {
    let step = (DESCENT_STEP / phases.speed).min(LONGEST);
    let down = (phases.descent / step).ceil().max(1.0);
    let near = (NEAR_THE_PART * down).ceil() * f64::from(finer);
    let turned = phases.speed * phases.spin / SPIN_STEP;
    let spun = SPIN_SEGMENTS.max(turned).max(phases.spin / LONGEST).ceil();
    // A comparison that also fails for what is no number.
    let few = near + down + spun < MOST_NODES as f64;
    if !few {
        return None;
    }
    let parts = |k: u32| {
        if f64::from(k) < NEAR_THE_PART * down {
            finer
        } else {
            1
        }
    };
    let steps =
        |k: u32| (0..parts(k)).map(move |i| f64::from(k) + f64::from(i) / f64::from(parts(k)));
    let descent = (0..down as u32)
        .flat_map(steps)
        .map(|k| phases.descent * k / down);
    let spin = (0..spun as u32).map(|k| phases.descent + phases.spin * f64::from(k) / spun);
    let end = clock.nearest(phases.all());
    let mut nodes: Vec<f64> = Vec::new();
    for sigma in descent.chain(spin) {
        let ticks = clock.nearest(sigma);
        if ticks < end && nodes.last().is_none_or(|last| *last < ticks) {
            nodes.push(ticks);
        }
    }
    nodes.push(end);
    Some(nodes)
}

/// Halves the chosen segments and their neighbours, where the clock has a tick between the ends.
pub fn halve(nodes: &[f64], chosen: &[bool], clock: &Clock) -> Vec<f64> {
    let mut halved = Vec::with_capacity(2 * nodes.len());
    for (k, pair) in nodes.windows(2).enumerate() {
        halved.push(pair[0]);
        let around = k.saturating_sub(SPREAD)..(k + SPREAD + 1).min(chosen.len());
        if chosen[around].contains(&true) {
            let middle = clock.whole(0.5 * (pair[0] + pair[1]));
            if pair[0] < middle && middle < pair[1] {
                halved.push(middle);
            }
        }
    }
    halved.extend(nodes.last());
    halved
}

#[cfg(test)]
mod tests {
    use super::*;

    const PHASES: Phases = Phases {
        descent: 0.25,
        spin: 1.5,
        speed: 50.0,
    };

    #[test]
    fn nodes_grow_from_the_join_to_rest_on_ticks_and_stay_close() {
        for steps in [None, Some(4_096_000.0), Some(4000.0)] {
            let clock = Clock::new(steps);
            let nodes = place(&PHASES, &clock, 1).unwrap();
            assert_eq!(nodes[0], 0.0);
            assert_eq!(nodes.last(), Some(&clock.nearest(1.75)));
            for pair in nodes.windows(2) {
                assert!(pair[0] < pair[1]);
                let [from, to] = [pair[0], pair[1]].map(|ticks| clock.seconds(ticks));
                let angle = PHASES.turned(to) - PHASES.turned(from);
                let most = if to <= PHASES.descent { 5.0 } else { 80.0 };
                assert!(angle <= (most + 1.0) * DEG, "{angle}");
                assert_eq!(pair[1], clock.whole(pair[1]));
            }
        }
        let endless = Phases {
            descent: f64::INFINITY,
            ..PHASES
        };
        assert_eq!(place(&endless, &Clock::new(None), 1), None);
    }

    #[test]
    fn halves_lie_on_ticks_and_only_where_there_is_one() {
        let clock = Clock::new(Some(10.0));
        let nodes = [0.0, 1.0, 4.0, 6.0];
        let halved = halve(&nodes, &[false, true, false], &clock);
        assert_eq!(halved, [0.0, 1.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(halve(&nodes, &[false; 3], &clock), nodes);
    }
}
