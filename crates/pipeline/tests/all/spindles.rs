//! Spindles that change their speed: the path is that of the law, wherever time is asked for, and
//! strategies that follow the limits of the machine hold them.

use std::f64::consts::TAU;
use std::sync::{Arc, Mutex};

use crate::common::{RIM, Task, inward};
use turnpath_core::toolpath::{Section, Segment};
use turnpath_core::{
    AxisLimits, Machine, Path, PiecewisePolynomial, Result, SpindleAsk, SpindleLaw,
    SpindleStrategy, quintic,
};
use turnpath_pipeline::{LeadLimits, LeadSettings};

/// Revolutions of the path.
const TURNS: f64 = 200.0;
/// The speed that is asked for, rpm.
const RPM: f64 = 120.0;
/// The part of it at which the path ends.
const SLOW: f64 = 0.5;

/// From the full speed to a part of it, over the middle half of the path.
struct Slowing;

impl SpindleStrategy for Slowing {
    fn plan(&self, path: &Path<'_>, ask: &SpindleAsk<'_>) -> Result<SpindleLaw> {
        assert_eq!(path.law.end(), TURNS);
        Ok(slowing(ask.speed))
    }
}

fn slowing(speed: f64) -> SpindleLaw {
    let (quarter, fast, slow) = (0.25 * TURNS, TAU / speed, TAU / speed / SLOW);
    let mut time = PiecewisePolynomial::new();
    time.push(quarter, [0.0, fast, 0.0, 0.0, 0.0, 0.0]);
    let from = quarter * fast;
    let to = from + quarter * (fast + slow);
    time.push(
        2.0 * quarter,
        quintic([from, fast, 0.0], [to, slow, 0.0], 2.0 * quarter),
    );
    time.push(quarter, [to, slow, 0.0, 0.0, 0.0, 0.0]);
    SpindleLaw::from_time(time)
}

fn task() -> Task {
    Task {
        feed: inward(TURNS),
        spindle: Arc::new(Slowing),
        rpm: RPM,
        ..Task::default()
    }
}

#[test]
fn points_lie_at_the_time_of_the_law_with_its_speed() {
    let law = slowing(RPM / 60.0 * TAU);
    let (path, outcome) = task().path();
    for i in 0..path.len() {
        let n = path.c[i] / TAU;
        assert!((path.t[i] - law.time_at(n)).abs() < 1e-10);
        assert!((path.vc[i] - law.speed_at(n)).abs() < 1e-10);
        // dX/dt of the feed.
        assert!((path.vx[i] + RIM / TURNS * law.speed_at(n) / TAU).abs() < 1e-12);
    }
    assert!((outcome.cutting_time - law.time_at(TURNS)).abs() < 1e-9);
}

/// Where time has steps, a node lies where the law is at that time.
#[test]
fn nodes_on_steps_of_time_lie_on_the_law() {
    let law = slowing(RPM / 60.0 * TAU);
    let (path, _) = Task {
        time_steps: Some(2500.0),
        ..task()
    }
    .path();
    for i in 0..path.len() {
        assert!((law.time_at(path.c[i] / TAU) - path.t[i]).abs() < 1e-11);
    }
}

/// A changing speed adds an error of C between nodes, which refinement halves away like any other.
#[test]
fn refinement_holds_the_tolerance_under_a_changing_speed() {
    let (_, outcome) = Task {
        refined: true,
        interpolation: 2e-6,
        ..task()
    }
    .path();
    assert!(outcome.added_by_refine > 0);
    assert!(outcome.figures.playback.max() <= 2e-6);
}

/// The spindle is at its full speed where the lead-in ends, and at its last one where the lead-out
/// begins.
#[test]
fn leads_join_the_speed_of_their_end() {
    let lead = LeadSettings {
        clearance: 1.0,
        limits: LeadLimits::within(Machine::default()),
    };
    let (sink, outcome) = Task {
        lead: Some(lead),
        ..task()
    }
    .run_whole()
    .unwrap_or_else(|error| panic!("{error}"));
    let leads = outcome.lead.unwrap_or_else(|| panic!("there are leads"));
    assert!(leads.in_time > 0.0 && leads.out_time > 0.0);
    let path = &sink.points;
    let speed = RPM / 60.0 * TAU;
    let largest = path.vc.iter().copied().fold(0.0, f64::max);
    // A lead turns C by a hundred-thousandth faster for a moment, also at a constant speed.
    assert!((largest / speed - 1.0).abs() < 1e-5, "{largest} rad/s");
    assert_eq!((path.vc[0], path.vc[path.len() - 1]), (0.0, 0.0));
    let out = sink.section(Section::LeadOut);
    let fastest = path.vc[out].iter().copied().fold(0.0, f64::max) / speed;
    assert!(
        (fastest / SLOW - 1.0).abs() < 2e-5,
        "{fastest} of the speed"
    );
    let cut = sink.section(Section::Cutting);
    for joint in [cut.start, cut.end - 1] {
        let accelerations = [joint - 1, joint].map(|from| {
            let [from, to] = [from, from + 1].map(|index| path.get(index));
            let (from, to) = (from.unwrap_or_default(), to.unwrap_or_default());
            let segment = Segment::between(&from, &to);
            let at = if from.t < path.t[joint] { 1.0 } else { 0.0 };
            segment.c.bend(at) / (segment.duration * segment.duration)
        });
        let step = (accelerations[1] - accelerations[0]).abs();
        assert!(step < 1e-3 * speed, "{step} rad/s²");
    }
}

/// The part of the asked speed that the slowest half turn needs, for the whole path.
#[derive(Default)]
struct Slowest {
    calls: Mutex<Vec<Vec<f64>>>,
}

impl SpindleStrategy for Slowest {
    fn plan(&self, _: &Path<'_>, ask: &SpindleAsk<'_>) -> Result<SpindleLaw> {
        self.calls
            .lock()
            .unwrap_or_else(|_| panic!("another call panicked"))
            .push(ask.factors.to_vec());
        let least = ask.factors.iter().copied().fold(1.0, f64::min);
        Ok(SpindleLaw::constant(least * ask.speed))
    }

    fn follows_factors(&self) -> bool {
        true
    }
}

/// z = 2K·xy at radius ρ is K ρ² sin 2θ: its largest acceleration is 4 K ρ² ω².
#[test]
fn a_strategy_that_follows_the_factors_meets_the_limit() {
    let limit = 2.0;
    let spindle = Arc::new(Slowest::default());
    let machine = Machine {
        z: AxisLimits {
            acceleration: Some(limit),
            ..AxisLimits::default()
        },
        ..Machine::default()
    };
    let (_, outcome) = Task {
        spindle: spindle.clone(),
        rpm: 240.0,
        machine,
        ..task()
    }
    .path();
    let z = outcome.figures.axes.z.acceleration.amount;
    assert!(z <= 1.001 * limit && z > 0.99 * limit, "{z} mm/s²");
    let calls = spindle
        .calls
        .lock()
        .unwrap_or_else(|_| panic!("a call panicked"));
    assert!((2..=4).contains(&calls.len()), "{} calls", calls.len());
    assert!(calls[0].is_empty());
    let factors = &calls[1];
    assert_eq!(factors.len(), 2 * TURNS as usize);
    // Only the rim is too fast: the acceleration falls with the square of the radius.
    let asked = 240.0 / 60.0 * TAU;
    for (half, factor) in factors.iter().enumerate() {
        let rho = RIM * (1.0 - half as f64 / factors.len() as f64);
        let allowed = (limit / (4.0 * crate::common::K * rho * rho)).sqrt() / asked;
        assert!(
            (factor / allowed.min(1.0) - 1.0).abs() < 0.02,
            "{factor} at {rho}"
        );
    }
}

/// Without limits there is nothing to follow.
#[test]
fn without_limits_a_strategy_is_asked_once() {
    let spindle = Arc::new(Slowest::default());
    let _ = Task {
        spindle: spindle.clone(),
        ..task()
    }
    .path();
    let calls = spindle
        .calls
        .lock()
        .unwrap_or_else(|_| panic!("a call panicked"));
    assert_eq!(calls.as_slice(), [Vec::<f64>::new()]);
}
