//! Leads: smooth at every point, from rest to rest, and nowhere below the first touch.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::common::solvers::{Area, Disjoint, Exact, Resting, Spline};
use crate::common::{Bare, K, MemorySink, RIM, Saddle, Task, even, feed_of, inward, straight};
use turnpath_core::toolpath::{ControlPoint, PathBlock, Section, Segment, SegmentShape};
use turnpath_core::{
    Axis, Centres, Compensator, Cut, Dependence, Derivative, Direction, Machine, Misfit, Nodes,
    Part, Radial, Result, Scalar, Tool, Velocities, VelocitySolver,
};
use turnpath_pipeline::{AxisLimits, LeadLimits, LeadSettings, Leads, Outcome};
use turnpath_verify::{AxesMotion, FirstTouch, Subject, Touch};

const NOSE: f64 = 1.0;
const STEPS: f64 = 4_096_000.0;

/// Nose centres normal to the saddle: X moves to and fro with C. The host fits series and rates.
struct Normal;

impl Compensator for Normal {
    fn radial(&self) -> Radial {
        Radial::Contact
    }

    fn centre(&self, _: Cut<'_>, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()> {
        for (i, (theta, rho)) in theta.iter().zip(rho).enumerate() {
            let sin = Scalar::sin(2.0 * theta);
            let (g, slope) = (K * rho * rho * sin, 2.0 * K * rho * sin);
            let w = (1.0 + slope * slope).sqrt();
            out.foot[i] = *rho;
            out.x[i] = rho - NOSE * slope / w;
            out.z[i] = g + NOSE / w;
        }
        Ok(())
    }
}

/// The exact rates, and straight lines.
struct Straight;

impl VelocitySolver for Straight {
    fn dependence(&self) -> Dependence {
        Dependence::Local
    }

    fn segments(&self) -> SegmentShape {
        SegmentShape::Linear
    }

    fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
        Exact.solve(nodes, out)
    }
}

fn settings(clearance: f64) -> LeadSettings {
    LeadSettings {
        clearance,
        limits: LeadLimits::default(),
    }
}

fn task() -> Task {
    Task {
        feed: inward(70.3),
        lead: Some(settings(0.5)),
        rpm: 300.0,
        refined: true,
        ..Task::default()
    }
}

fn outward() -> Task {
    Task {
        feed: feed_of(vec![straight(70.3, 0.0, RIM / 70.3)]),
        direction: Direction::Outward,
        ..task()
    }
}

#[track_caller]
fn with_leads(task: &Task) -> (MemorySink, Outcome, Leads) {
    let (sink, outcome) = task.run_whole().unwrap_or_else(|error| panic!("{error}"));
    let leads = outcome.lead.unwrap();
    (sink, outcome, leads)
}

fn touch_of(compensator: &dyn Compensator) -> FirstTouch {
    let subject = Subject {
        surface: Arc::new(Saddle),
        part: Part {
            aperture_radius: RIM,
            inner_radius: 0.0,
        },
        tool: Tool {
            nose_radius: NOSE,
            included_angle: None,
            clearance_angle: None,
            misfit: Misfit::Refuse,
        },
        compensates_nose: compensator.compensates_nose(),
    };
    FirstTouch::new(subject).unwrap()
}

/// The smallest played − first touch, mm, at 37 instants of every segment except those between
/// cutting points; `shape` is that of the segments.
fn smallest_clearance(task: &Task, sink: &MemorySink, shape: SegmentShape) -> f64 {
    let touch = touch_of(task.compensator.as_ref());
    let cut = sink.section(Section::Cutting);
    let (mut theta, mut x, mut z) = (Vec::new(), Vec::new(), Vec::new());
    let points: Vec<_> = sink.points.points().collect();
    for (k, pair) in points.windows(2).enumerate() {
        if cut.contains(&k) && cut.contains(&(k + 1)) {
            continue;
        }
        let segment = match shape {
            SegmentShape::Cubic => Segment::between(&pair[0], &pair[1]),
            SegmentShape::Linear => Segment::straight(&pair[0], &pair[1]),
        };
        for i in 0..=36 {
            let s = f64::from(i) / 36.0;
            theta.push(segment.c.value(s).rem_euclid(TAU));
            x.push(segment.x.value(s));
            z.push(segment.z.value(s));
        }
    }
    let mut touches: Vec<Touch> = Vec::new();
    touch.find(&theta, &x, &mut touches).unwrap();
    let each = z.iter().zip(&touches).map(|(z, touch)| z - touch.z);
    each.fold(f64::INFINITY, f64::min)
}

/// The smallest control point − first touch, mm, over the points that do not cut.
fn smallest_at_points(task: &Task, sink: &MemorySink) -> f64 {
    let touch = touch_of(task.compensator.as_ref());
    let cut = sink.section(Section::Cutting);
    let all = sink.points.points().enumerate();
    let of_leads: Vec<_> = all.filter(|(k, _)| !cut.contains(k)).collect();
    let of = |value: fn(&ControlPoint) -> f64| -> Vec<f64> {
        of_leads.iter().map(|(_, point)| value(point)).collect()
    };
    let mut touches: Vec<Touch> = Vec::new();
    let theta = of(|point| point.c.rem_euclid(TAU));
    touch
        .find(&theta, &of(|point| point.x), &mut touches)
        .unwrap();
    let each = of_leads
        .iter()
        .zip(&touches)
        .map(|((_, point), touch)| point.z - touch.z);
    each.fold(f64::INFINITY, f64::min)
}

type Column = fn(&PathBlock) -> (&Vec<f64>, &Vec<f64>);

/// Checks by the Hermite formula on the points alone: outside of the cut the accelerations on both
/// sides of every point agree, and at the path's ends they are zero.
fn check_smooth(sink: &MemorySink) {
    let cut = sink.section(Section::Cutting);
    let axes: [Column; 3] = [|p| (&p.c, &p.vc), |p| (&p.x, &p.vx), |p| (&p.z, &p.vz)];
    let t = &sink.points.t;
    let end = t.len() - 1;
    for axis in axes {
        let (p, v) = axis(&sink.points);
        let bends = |k: usize| {
            let h = t[k + 1] - t[k];
            let chord = 6.0 * (p[k + 1] - p[k]) / (h * h);
            let at_start = chord - (4.0 * v[k] + 2.0 * v[k + 1]) / h;
            let at_end = (2.0 * v[k] + 4.0 * v[k + 1]) / h - chord;
            // The rounding of doubles of this size.
            let rounding = 40.0 * f64::EPSILON * p[k].abs().max(1.0) / (h * h);
            (at_start, at_end, rounding)
        };
        let all: Vec<_> = (0..end).map(bends).collect();
        let largest = all
            .iter()
            .fold(0.0f64, |m, b| m.max(b.0.abs()).max(b.1.abs()));
        let bound = 1e-9 * largest;
        assert!(all[0].0.abs() <= bound + all[0].2, "{} at rest", all[0].0);
        assert!(all[end - 1].1.abs() <= bound + all[end - 1].2);
        assert_eq!((v[0], v[end]), (0.0, 0.0));
        for k in 1..end {
            let within_cut = cut.start < k && k + 1 < cut.end;
            let (before, after) = (all[k - 1], all[k]);
            let jump = (before.1 - after.0).abs();
            let allowed = bound + before.2 + after.2;
            assert!(within_cut || jump <= allowed, "{k}: {jump} of {largest}");
        }
    }
}

/// Checks what holds for every path with leads.
#[track_caller]
fn check(task: &Task) -> (MemorySink, Outcome, Leads) {
    let (sink, outcome, leads) = with_leads(task);
    let path = &sink.points;
    let cut = sink.section(Section::Cutting);
    assert_eq!(cut.len() as u64, outcome.control_points);
    assert_eq!((path.len() - cut.len()) as u64, leads.points);
    assert!(path.t.windows(2).all(|pair| pair[0] < pair[1]));
    assert_eq!((path.t[0], path.c[0]), (0.0, 0.0));
    // Whole revolutions before the cut.
    let turns = path.c[cut.start] / TAU;
    assert!((turns - turns.round()).abs() < 1e-13, "{turns}");
    assert_eq!(turns.round(), leads.turns_in);
    assert!((path.t[cut.start] - leads.in_time).abs() < 1e-12);
    let all = leads.in_time + outcome.cutting_time + leads.out_time;
    assert!((path.t[path.len() - 1] - all).abs() < 1e-6);
    let cubic = task.velocity.segments() == SegmentShape::Cubic;
    if cubic {
        check_smooth(&sink);
        // C never turns back.
        assert!(path.vc.iter().all(|vc| *vc >= 0.0));
    }
    let lowest = smallest_at_points(task, &sink);
    assert!(lowest >= -2e-8, "{lowest}");
    let smallest = smallest_clearance(task, &sink, task.velocity.segments());
    let missed = outcome.figures.playback.max().max(task.interpolation);
    assert!(smallest >= -missed, "{smallest}");
    let reported = leads.figures.clearance;
    assert!(
        (smallest - reported).abs() <= 0.1 * missed,
        "{reported} {smallest}"
    );
    // At rest the tool is clear of the whole part.
    let clearance = task.lead.unwrap().clearance;
    for end in [0, path.len() - 1] {
        let highest = K * RIM * RIM
            + if task.compensator.compensates_nose() {
                NOSE
            } else {
                0.0
            };
        let above = path.z[end] - highest;
        assert!(above >= clearance - 1e-3, "{above}");
        assert!(above <= clearance + 0.1, "{above}");
    }
    (sink, outcome, leads)
}

#[test]
fn leads_are_smooth_clear_the_part_and_begin_and_end_at_rest() {
    let normal: Arc<dyn Compensator> = Arc::new(Normal);
    for task in [
        task(),
        outward(),
        Task {
            compensator: normal.clone(),
            ..task()
        },
        Task {
            compensator: normal,
            velocity: Arc::new(Spline { overlap: 64 }),
            ..outward()
        },
    ] {
        for time_steps in [None, Some(STEPS)] {
            check(&Task {
                time_steps,
                ..task.clone()
            });
        }
    }
}

#[test]
fn solvers_of_every_kind_are_joined_as_they_play() {
    let solvers: [Arc<dyn VelocitySolver>; 6] = [
        Arc::new(Exact),
        Arc::new(Spline { overlap: 64 }),
        Arc::new(Area),
        Arc::new(Disjoint),
        Arc::new(Resting),
        Arc::new(Straight),
    ];
    for velocity in solvers {
        for tolerance in [1e-4, 1e-6] {
            // A coarse solver ends coarsely too, and its lead need not be finer.
            check(&Task {
                velocity: velocity.clone(),
                interpolation: tolerance,
                sampler: even(120.0),
                ..task()
            });
        }
    }
}

#[test]
fn a_lead_in_shifts_the_cut_and_changes_nothing_else() {
    for time_steps in [None, Some(STEPS)] {
        let with = Task {
            time_steps,
            ..task()
        };
        let (sink, outcome, _) = with_leads(&with);
        let (alone, before) = Task { lead: None, ..with }.path();
        let cut = sink.section(Section::Cutting);
        assert_eq!(cut.len(), alone.len());
        assert_eq!(outcome.revolutions, before.revolutions);
        assert_eq!(outcome.cutting_time, before.cutting_time);
        let same = |a: f64, b: f64, bound: f64| assert!((a - b).abs() <= bound, "{a} {b}");
        let (t0, c0) = (sink.points.t[cut.start], sink.points.c[cut.start]);
        for (k, point) in alone.points().enumerate() {
            let moved = sink.points.get(cut.start + k).unwrap();
            same(moved.t - t0, point.t, 1e-13);
            same(moved.c - c0, point.c, 1e-12);
            same(moved.x, point.x, 0.0);
            same(moved.z, point.z, 0.0);
            if let Some(steps) = time_steps {
                let ticks = moved.t * steps;
                assert!((ticks - ticks.round()).abs() < 1e-6);
                assert_eq!(moved.t, ticks.round() / steps);
            }
        }
    }
}

#[test]
fn blocks_carry_their_section_and_the_two_points_before() {
    let (sink, ..) = with_leads(&Task {
        feed: inward(200.0),
        ..task()
    });
    let sections: Vec<Section> = sink.deliveries.iter().map(|block| block.section).collect();
    use Section::{Cutting, LeadIn, LeadOut};
    assert_eq!(
        sections,
        [LeadIn, Cutting, Cutting, Cutting, Cutting, LeadOut]
    );
    let before: Vec<usize> = sink.deliveries.iter().map(|block| block.before).collect();
    assert_eq!(before, [0, 2, 2, 2, 2, 2]);
    let opens: Vec<bool> = sink
        .deliveries
        .iter()
        .map(|block| block.opens_section)
        .collect();
    assert_eq!(opens, [true, true, false, false, false, true]);
}

#[test]
fn leads_exceed_their_limits_by_the_motion_of_the_cut_at_most() {
    let limit = |velocity, acceleration, jerk| AxisLimits {
        velocity,
        acceleration,
        jerk,
    };
    for limits in [
        LeadLimits {
            c: limit(1e9, 3.0, None),
            ..LeadLimits::default()
        },
        LeadLimits {
            z: limit(0.5, 1.0, None),
            ..LeadLimits::default()
        },
        LeadLimits {
            c: limit(1e9, 50.0, Some(40.0)),
            z: limit(20.0, 200.0, Some(30.0)),
            ..LeadLimits::default()
        },
    ] {
        let task = Task {
            lead: Some(LeadSettings {
                clearance: 0.5,
                limits,
            }),
            feed: inward(20.0),
            ..task()
        };
        let (_, outcome, leads) = check(&task);
        let (lead, cut) = (leads.figures.axes, outcome.figures.axes);
        for (lead, cut, limit) in [
            (lead.c, cut.c, limits.c),
            (lead.x, cut.x, limits.x),
            (lead.z, cut.z, limits.z),
        ] {
            assert!(lead.velocity.amount <= limit.velocity + 1.25 * cut.velocity.amount);
            assert!(
                lead.acceleration.amount <= limit.acceleration + 1.25 * cut.acceleration.amount
            );
            let jerk = limit.jerk.unwrap_or(f64::INFINITY);
            assert!(lead.jerk.amount <= jerk + 1.25 * cut.jerk.amount);
        }
    }
}

#[test]
fn a_law_that_ends_in_full_motion_lets_x_overshoot_by_a_part_of_the_nose_at_most() {
    // 0.2 mm a revolution inward, and some of that beyond either end.
    let task = Task {
        feed: inward(10.0),
        ..task()
    };
    let (sink, ..) = check(&task);
    let x = &sink.points.x;
    assert!(x[0] > RIM && x[0] < RIM + 0.3, "{}", x[0]);
    let last = x[x.len() - 1];
    assert!(last < 0.0 && last > -0.3, "{last}");
}

/// Limits that nothing keeps, of one axis each.
fn hopeless_limits() -> [LeadLimits; 3] {
    let still = AxisLimits {
        velocity: 1e-9,
        acceleration: 1e-9,
        jerk: None,
    };
    let others = LeadLimits::default;
    [
        LeadLimits {
            z: still,
            ..others()
        },
        LeadLimits {
            c: still,
            ..others()
        },
        LeadLimits {
            x: still,
            ..others()
        },
    ]
}

fn assert_made_and_reported(limits: LeadLimits) {
    let lead = Some(LeadSettings {
        clearance: 0.5,
        limits,
    });
    let (_, _, leads) = check(&Task {
        feed: inward(20.0),
        lead,
        ..task()
    });
    let axes = leads.figures.axes;
    assert!(axes.c.acceleration.amount > 1e-9);
    assert!(axes.x.velocity.amount > 1e-9 && axes.z.velocity.amount > 1e-9);
}

#[test]
fn a_lead_that_cannot_keep_its_limits_is_made_and_its_motion_reported() {
    let [of_z, ..] = hopeless_limits();
    assert_made_and_reported(of_z);
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_a_lead_that_cannot_keep_its_limits_of_any_axis_is_made_and_its_motion_reported() {
    hopeless_limits()
        .into_iter()
        .for_each(assert_made_and_reported);
}

/// The machine can just make the cut at a speed that is higher by a hundredth, or for jerk by two
/// hundredths: the cut as played ends with another acceleration than the course of the lead has, and
/// within one step the one must become the other.
#[test]
fn a_lead_keeps_what_the_cut_just_keeps() {
    let peak = |axes: &AxesMotion, derivative| axes.peak(Axis::Z, derivative).unwrap().amount;
    for first in [task(), outward()] {
        let (_, outcome, _) = with_leads(&first);
        for derivative in Derivative::ALL {
            let slower = match derivative {
                Derivative::Jerk => 0.98,
                _ => 0.99,
            };
            let slack = Scalar::powf(slower, f64::from(derivative.order()));
            let limit = peak(&outcome.figures.axes, derivative) / slack;
            let mut machine = Machine::default();
            *machine.limit_mut(Axis::Z, derivative) = Some(limit);
            let task = Task {
                lead: Some(LeadSettings {
                    clearance: 0.5,
                    limits: LeadLimits::within(machine),
                }),
                feed: first.feed.clone(),
                direction: first.direction,
                ..task()
            };
            let (_, _, leads) = check(&task);
            let most = peak(&leads.figures.axes, derivative);
            assert!(most <= 1.001 * limit, "{derivative:?}: {most} of {limit}");
        }
    }
}

/// Coarse cubics have less jerk than the course of a lead and join it with a jolt, so a limit of their
/// own jerk cannot be kept. Limits of their velocity and acceleration can be kept.
#[test]
fn a_limit_that_cannot_be_kept_leaves_the_others_kept() {
    let coarse = || Task {
        sampler: even(9.0),
        refined: false,
        interpolation: 1e-2,
        ..task()
    };
    let peak = |axes: &AxesMotion, derivative| axes.peak(Axis::Z, derivative).unwrap().amount;
    let (_, outcome, _) = with_leads(&coarse());
    let mut machine = Machine::default();
    for derivative in Derivative::ALL {
        let limit = peak(&outcome.figures.axes, derivative);
        *machine.limit_mut(Axis::Z, derivative) = Some(1.02 * limit);
    }
    let (_, _, leads) = with_leads(&Task {
        lead: Some(LeadSettings {
            clearance: 5.0,
            limits: LeadLimits::within(machine),
        }),
        ..coarse()
    });
    let share = |derivative| {
        let limit = machine.limit(Axis::Z, derivative).unwrap();
        peak(&leads.figures.axes, derivative) / limit
    };
    assert!(share(Derivative::Jerk) > 1.001);
    let shares = [Derivative::Velocity, Derivative::Acceleration].map(share);
    assert!(shares.iter().all(|share| *share <= 1.001), "{shares:?}");
}

#[test]
fn a_path_without_leads_reports_none() {
    let (sink, outcome) = Task {
        lead: None,
        ..task()
    }
    .run_whole()
    .unwrap();
    assert_eq!(outcome.lead, None);
    assert_eq!(sink.section(Section::LeadIn).len(), 0);
    assert!(Bare.compensates_nose() != Normal.compensates_nose());
}
