//! Schedules on a part whose motion has a closed form: z = k ρ² sin 2θ, nose radius taken as 0, one
//! feed.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

#[path = "../../../tests/support/models.rs"]
mod models;

use std::f64::consts::TAU;
use std::sync::Arc;

use models::model;
use turnpath_core::{
    AxisLimits, Direction, Machine, Misfit, NM, Params, Part, Path, RadialRange, Result,
    SpindleAsk, SpindleLaw, SpindleStrategy, SpiralLaw, Strategy, StrategyError, Task, Tolerance,
    Tool, ToolLocus,
};
use turnpath_nose_radius::Uncompensated;
use turnpath_spindle::{PerRevolution, SurfaceSpeed};
use turnpath_surfaces::Astigmatic;

const K: f64 = 0.08;
const RIM: f64 = 2.5;
/// The largest speed, rad/s.
const SPEED: f64 = 100.0;

const MACHINE: Machine = Machine {
    x: AxisLimits {
        velocity: None,
        acceleration: None,
        jerk: None,
    },
    z: AxisLimits {
        velocity: Some(30.0),
        acceleration: Some(500.0),
        jerk: Some(5e4),
    },
    c: AxisLimits {
        velocity: None,
        acceleration: Some(100.0),
        jerk: Some(1000.0),
    },
};

/// The law of a strategy over so many revolutions from the rim to the axis.
fn plan(
    strategy: &dyn SpindleStrategy,
    machine: Machine,
    turns: f64,
    factors: &[f64],
) -> Result<SpindleLaw> {
    let tool = Tool {
        nose_radius: 1.0,
        included_angle: None,
        clearance_angle: None,
        misfit: Misfit::Refuse,
    };
    let task = Task {
        part: Part {
            aperture_radius: RIM,
            inner_radius: 0.0,
        },
        tool,
        tolerance: Tolerance {
            interpolation: 100.0 * NM,
            residual: 100.0 * NM,
        },
        range: RadialRange {
            inner: 0.0,
            outer: RIM,
        },
        direction: Direction::Inward,
        spindle_speed: SPEED,
        machine,
    };
    let surface = model::<Astigmatic>(&Params::new().with("k", K));
    let locus = ToolLocus::new(surface, Arc::new(Uncompensated), tool);
    let mut law = SpiralLaw::new();
    law.push(turns, [RIM, -RIM / turns, 0.0, 0.0, 0.0, 0.0]);
    let path = Path {
        task: &task,
        locus: &locus,
        law: &law,
        spindle: &SpindleLaw::constant(SPEED),
    };
    let ask = SpindleAsk {
        speed: SPEED,
        factors,
    };
    strategy.plan(&path, &ask)
}

/// Velocity, acceleration and jerk of C and of Z at a time, by differences of the closed form.
fn motion(law: &SpindleLaw, turns: f64, t: f64) -> [[f64; 3]; 2] {
    let h = 2e-4;
    let at = |k: f64| {
        let n = law.revolutions_at(t + k * h, 0.5 * turns);
        let rho = RIM * (1.0 - n / turns);
        let (sin, _) = turnpath_core::Scalar::sin_cos(2.0 * TAU * n);
        [TAU * n, K * rho * rho * sin]
    };
    let [a, b, c, d, e] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(at);
    [0, 1].map(|axis| {
        let [a, b, c, d, e] = [a, b, c, d, e].map(|p| p[axis]);
        [
            (d - b) / (2.0 * h),
            (d - 2.0 * c + b) / (h * h),
            (e - 2.0 * d + 2.0 * b - a) / (2.0 * h * h * h),
        ]
    })
}

#[test]
fn all_limits_hold_and_one_of_them_binds_nearly_everywhere() {
    let turns = 90.3;
    let law = plan(&PerRevolution, MACHINE, turns, &[]).unwrap();
    let limits = [MACHINE.c, MACHINE.z].map(|axis| {
        [axis.velocity, axis.acceleration, axis.jerk].map(|limit| limit.unwrap_or(SPEED))
    });
    let end = law.time_at(turns);
    let count = 6000;
    let mut most = [[0.0_f64; 3]; 2];
    for i in 1..count {
        let found = motion(&law, turns, end * f64::from(i) / f64::from(count));
        for axis in 0..2 {
            for k in 0..3 {
                let ratio = found[axis][k].abs() / limits[axis][k];
                most[axis][k] = most[axis][k].max(ratio);
                // Differences of positions near 600 rad are good to a thousandth of a jerk.
                assert!(
                    ratio <= 1.003,
                    "axis {axis}, order {}: {ratio} at {i}",
                    k + 1
                );
            }
        }
    }
    assert!(most[1][1] > 0.99, "{most:?}");
    let constant = TAU * turns / (500.0 / (4.0 * K * RIM * RIM)).sqrt();
    assert!(end < 0.56 * constant, "{end} s of {constant} s");
}

/// However little the spindle may change its speed. The constant speed is that at which Z's
/// acceleration at the rim is the limit.
#[test]
fn no_schedule_is_slower_than_the_fastest_constant_speed() {
    let turns = 90.3;
    let constant = TAU * turns / (500.0 / (4.0 * K * RIM * RIM)).sqrt();
    let mut machine = MACHINE;
    for acceleration in [100.0, 1.0, 1e-3] {
        for jerk in [1000.0, 10.0, 1.0, 1e-3, 1e-6] {
            machine.c.acceleration = Some(acceleration);
            machine.c.jerk = Some(jerk);
            let law = plan(&PerRevolution, machine, turns, &[]).unwrap();
            let part = law.time_at(turns) / constant;
            assert!(
                part <= 1.001,
                "{acceleration} rad/s², {jerk} rad/s³: {part}"
            );
            if acceleration > 99.0 && jerk > 9.0 {
                assert!(part <= 0.65, "{jerk} rad/s³: {part}");
            }
        }
    }
}

/// What the played path asks for, a part of the speed in some half turns, is kept there.
#[test]
fn the_factors_of_the_played_path_are_kept() {
    let turns = 40.0;
    let mut factors = vec![1.0; 80];
    factors[30] = 0.2;
    factors[31] = 0.15;
    let law = plan(&PerRevolution, MACHINE, turns, &factors).unwrap();
    let free = plan(&PerRevolution, MACHINE, turns, &[]).unwrap();
    for i in 0..=100 {
        let n = 15.0 + f64::from(i) / 100.0;
        let factor = if n < 15.5 { 0.2 } else { 0.15 };
        assert!(law.speed_at(n) <= factor * SPEED * (1.0 + 1e-9), "at {n}");
    }
    assert!(law.time_at(turns) > free.time_at(turns));
    assert!(free.speed_at(15.2) > 0.2 * SPEED);
}

/// A path of any length is planned, and its speed is constant where leads join.
#[test]
fn short_paths_and_paths_that_end_within_a_turn_have_steady_ends() {
    for turns in [0.2, 0.7, 1.0, 1.49, 3.3, 7.77, 25.0] {
        let law = plan(&PerRevolution, MACHINE, turns, &[]).unwrap();
        assert!(law.as_time().end() >= turns - 1e-9);
        let steady = turns.min(0.5);
        for part in [0.0, 0.3, 0.7, 1.0] {
            for [from, n] in [[0.0, steady * part], [turns, turns - steady * part]] {
                let ratio = law.speed_at(n) / law.speed_at(from);
                assert!((ratio - 1.0).abs() < 1e-10, "{turns} revolutions, at {n}");
            }
        }
    }
}

#[test]
fn the_surface_speed_is_kept_between_its_bounds_without_any_limit() {
    let params = Params::new()
        .with("cutting_speed", 60.0)
        .with("lowest", 30.0);
    let strategy = SurfaceSpeed::new(&params).unwrap();
    let turns = 90.0;
    let law = plan(&strategy, Machine::default(), turns, &[]).unwrap();
    for n in [10.0, 40.0, 60.0, 85.0] {
        let rho = RIM * (1.0 - n / turns);
        let wanted = (60.0 / rho).clamp(30.0, SPEED);
        let ratio = law.speed_at(n) / wanted;
        assert!((0.95..=1.0 + 1e-9).contains(&ratio), "{ratio} at {n}");
    }
}

#[test]
fn a_limit_that_is_missing_is_named() {
    let named = |machine: Machine, key: &str| {
        let error = plan(&PerRevolution, machine, 20.0, &[]).unwrap_err();
        assert!(matches!(&error, StrategyError::Parameter { .. }), "{error}");
        assert!(error.to_string().contains(key), "{error}");
    };
    let mut machine = MACHINE;
    machine.c.acceleration = None;
    named(machine, "c_acceleration");
    machine = MACHINE;
    machine.z = AxisLimits::default();
    named(machine, "z_acceleration");
    let strategy = SurfaceSpeed::new(
        &Params::new()
            .with("cutting_speed", 60.0)
            .with("lowest", 200.0),
    );
    let error = plan(&strategy.unwrap(), MACHINE, 20.0, &[]).unwrap_err();
    assert!(error.to_string().contains("lowest"), "{error}");
}
