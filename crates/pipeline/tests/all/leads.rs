//! Leads: smooth at every point, from rest to rest, and nowhere below the first touch.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::common::solvers::{Area, Disjoint, Exact, Resting, Spline};
use crate::common::{Bare, Job, K, Kept, RIM, Saddle, even, feed_of, inward, straight};
use turnpath_core::toolpath::{ControlPoint, PathBlock, Section, Segment, SegmentShape};
use turnpath_core::{
    Axis, Centres, Compensator, Cut, Dependence, Derivative, Direction, Machine, Misfit, Nodes,
    Part, Radial, Result, Scalar, Tool, Velocities, VelocitySolver,
};
use turnpath_pipeline::{AxisLimits, LeadLimits, LeadSettings, Leads, Outcome};
use turnpath_verify::{AxesMotion, FirstTouch, Subject, Touch};

const NOSE: f64 = 1.0;
const STEPS: f64 = 4_096_000.0;

/// Nose centres normal to the saddle: X moves to and fro with C. Series and rates are the host's.
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

fn job() -> Job {
    Job {
        feed: inward(70.3),
        lead: Some(settings(0.5)),
        rpm: 300.0,
        refined: true,
        ..Job::default()
    }
}

fn outward() -> Job {
    Job {
        feed: feed_of(vec![straight(70.3, 0.0, RIM / 70.3)]),
        direction: Direction::Outward,
        ..job()
    }
}

#[track_caller]
fn made(job: &Job) -> (Kept, Outcome, Leads) {
    let (kept, outcome) = job.run_whole().unwrap_or_else(|error| panic!("{error}"));
    let leads = outcome.lead.unwrap();
    (kept, outcome, leads)
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

/// Smallest played − first touch, mm, in 37 instants of every segment but those between cutting
/// points; the shape of the segments is told.
fn smallest_clearance(job: &Job, kept: &Kept, shape: SegmentShape) -> f64 {
    let touch = touch_of(job.compensator.as_ref());
    let cut = kept.section(Section::Cutting);
    let (mut theta, mut x, mut z) = (Vec::new(), Vec::new(), Vec::new());
    let points: Vec<_> = kept.points.points().collect();
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

/// Smallest control point − first touch, mm, of the points that do not cut.
fn smallest_at_points(job: &Job, kept: &Kept) -> f64 {
    let touch = touch_of(job.compensator.as_ref());
    let cut = kept.section(Section::Cutting);
    let all = kept.points.points().enumerate();
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

/// Accelerations of all points that are not within the cut agree on both sides, by the Hermite
/// formula on the points alone, and are zero at the path's ends.
fn check_smooth(kept: &Kept) {
    let cut = kept.section(Section::Cutting);
    let axes: [Column; 3] = [|p| (&p.c, &p.vc), |p| (&p.x, &p.vx), |p| (&p.z, &p.vz)];
    let t = &kept.points.t;
    let end = t.len() - 1;
    for axis in axes {
        let (p, v) = axis(&kept.points);
        let bends = |k: usize| {
            let h = t[k + 1] - t[k];
            let chord = 6.0 * (p[k + 1] - p[k]) / (h * h);
            let at_start = chord - (4.0 * v[k] + 2.0 * v[k + 1]) / h;
            let at_end = (2.0 * v[k] + 4.0 * v[k + 1]) / h - chord;
            // What doubles of this size leave of it.
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

/// All that every path with leads keeps.
#[track_caller]
fn check(job: &Job) -> (Kept, Outcome, Leads) {
    let (kept, outcome, leads) = made(job);
    let path = &kept.points;
    let cut = kept.section(Section::Cutting);
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
    let cubic = job.velocity.segments() == SegmentShape::Cubic;
    if cubic {
        check_smooth(&kept);
        // C never turns back.
        assert!(path.vc.iter().all(|vc| *vc >= 0.0));
    }
    let lowest = smallest_at_points(job, &kept);
    assert!(lowest >= -2e-8, "{lowest}");
    let smallest = smallest_clearance(job, &kept, job.velocity.segments());
    let missed = outcome.figures.playback.max().max(job.interpolation);
    assert!(smallest >= -missed, "{smallest}");
    let told = leads.figures.clearance;
    assert!((smallest - told).abs() <= 0.1 * missed, "{told} {smallest}");
    // At rest the tool is clear of the whole part.
    let clearance = job.lead.unwrap().clearance;
    for end in [0, path.len() - 1] {
        let highest = K * RIM * RIM
            + if job.compensator.compensates_nose() {
                NOSE
            } else {
                0.0
            };
        let above = path.z[end] - highest;
        assert!(above >= clearance - 1e-3, "{above}");
        assert!(above <= clearance + 0.1, "{above}");
    }
    (kept, outcome, leads)
}

#[test]
fn leads_are_smooth_clear_the_part_and_begin_and_end_at_rest() {
    let normal: Arc<dyn Compensator> = Arc::new(Normal);
    for job in [
        job(),
        outward(),
        Job {
            compensator: normal.clone(),
            ..job()
        },
        Job {
            compensator: normal,
            velocity: Arc::new(Spline { overlap: 64 }),
            ..outward()
        },
    ] {
        for time_steps in [None, Some(STEPS)] {
            check(&Job {
                time_steps,
                feed: job.feed.clone(),
                compensator: job.compensator.clone(),
                velocity: job.velocity.clone(),
                sampler: job.sampler.clone(),
                ..job
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
            // A solver that is coarse ends so too: nobody asks the lead to be finer.
            check(&Job {
                velocity: velocity.clone(),
                interpolation: tolerance,
                sampler: even(120.0),
                ..job()
            });
        }
    }
}

#[test]
fn the_cut_is_the_same_only_later_and_farther_on() {
    for time_steps in [None, Some(STEPS)] {
        let with = Job {
            time_steps,
            ..job()
        };
        let (kept, outcome, _) = made(&with);
        let (alone, before) = Job { lead: None, ..with }.made();
        let cut = kept.section(Section::Cutting);
        assert_eq!(cut.len(), alone.len());
        assert_eq!(outcome.revolutions, before.revolutions);
        assert_eq!(outcome.cutting_time, before.cutting_time);
        let same = |a: f64, b: f64, bound: f64| assert!((a - b).abs() <= bound, "{a} {b}");
        let (t0, c0) = (kept.points.t[cut.start], kept.points.c[cut.start]);
        for (k, point) in alone.points().enumerate() {
            let moved = kept.points.get(cut.start + k).unwrap();
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
fn stretches_tell_sections_and_the_two_points_before() {
    let (kept, ..) = made(&Job {
        feed: inward(200.0),
        ..job()
    });
    let sections: Vec<Section> = kept.stretches.iter().map(|stretch| stretch.0).collect();
    use Section::{Cutting, LeadIn, LeadOut};
    assert_eq!(
        sections,
        [LeadIn, Cutting, Cutting, Cutting, Cutting, LeadOut]
    );
    let before: Vec<usize> = kept.stretches.iter().map(|stretch| stretch.2).collect();
    assert_eq!(before, [0, 2, 2, 2, 2, 2]);
    let opens: Vec<bool> = kept.stretches.iter().map(|stretch| stretch.3).collect();
    assert_eq!(opens, [true, true, false, false, false, true]);
}

#[test]
fn limits_are_kept_beyond_what_the_cut_asks_for() {
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
        let job = Job {
            lead: Some(LeadSettings {
                clearance: 0.5,
                limits,
            }),
            feed: inward(20.0),
            ..job()
        };
        let (_, outcome, leads) = check(&job);
        let (asked, cut) = (leads.figures.axes, outcome.figures.axes);
        for (asked, cut, limit) in [
            (asked.c, cut.c, limits.c),
            (asked.x, cut.x, limits.x),
            (asked.z, cut.z, limits.z),
        ] {
            assert!(asked.velocity.amount <= limit.velocity + 1.25 * cut.velocity.amount);
            assert!(
                asked.acceleration.amount <= limit.acceleration + 1.25 * cut.acceleration.amount
            );
            let jerk = limit.jerk.unwrap_or(f64::INFINITY);
            assert!(asked.jerk.amount <= jerk + 1.25 * cut.jerk.amount);
        }
    }
}

#[test]
fn a_law_that_ends_in_full_motion_lets_x_drift_no_farther_than_a_part_of_the_nose() {
    // 0.2 mm a revolution inward, and a turn more and less at either end.
    let job = Job {
        feed: inward(10.0),
        ..job()
    };
    let (kept, ..) = check(&job);
    let x = &kept.points.x;
    assert!(x[0] > RIM && x[0] < RIM + 0.3, "{}", x[0]);
    let last = x[x.len() - 1];
    assert!(last < 0.0 && last > -0.3, "{last}");
}

#[test]
fn a_lead_that_cannot_keep_its_limits_is_made_and_its_motion_told() {
    let still = AxisLimits {
        velocity: 1e-9,
        acceleration: 1e-9,
        jerk: None,
    };
    let slow_z = LeadLimits {
        z: still,
        ..LeadLimits::default()
    };
    let slow_c = LeadLimits {
        c: still,
        ..LeadLimits::default()
    };
    let slow_x = LeadLimits {
        x: still,
        ..LeadLimits::default()
    };
    for limits in [slow_z, slow_c, slow_x] {
        let lead = Some(LeadSettings {
            clearance: 0.5,
            limits,
        });
        let (_, _, leads) = check(&Job {
            feed: inward(20.0),
            lead,
            ..job()
        });
        let asked = leads.figures.axes;
        assert!(asked.c.acceleration.amount > 1e-9);
        assert!(asked.x.velocity.amount > 1e-9 && asked.z.velocity.amount > 1e-9);
    }
}

/// A machine can just do what the cut asks for at a speed a hundredth higher; in jerk two hundredths:
/// the acceleration that the cut plays at its end is not the way's, and within a step it must become
/// that.
#[test]
fn a_lead_keeps_what_the_cut_just_keeps() {
    let asked = |axes: &AxesMotion, derivative| axes.peak(Axis::Z, derivative).unwrap().amount;
    for first in [job(), outward()] {
        let (_, outcome, _) = made(&first);
        for derivative in Derivative::ALL {
            let slower = match derivative {
                Derivative::Jerk => 0.98,
                _ => 0.99,
            };
            let slack = Scalar::powf(slower, f64::from(derivative.order()));
            let limit = asked(&outcome.figures.axes, derivative) / slack;
            let mut machine = Machine::default();
            *machine.limit_mut(Axis::Z, derivative) = Some(limit);
            let job = Job {
                lead: Some(LeadSettings {
                    clearance: 0.5,
                    limits: LeadLimits::within(machine),
                }),
                feed: first.feed.clone(),
                direction: first.direction,
                ..job()
            };
            let (_, _, leads) = check(&job);
            let most = asked(&leads.figures.axes, derivative);
            assert!(most <= 1.001 * limit, "{derivative:?}: {most} of {limit}");
        }
    }
}

/// Coarse cubics ask for less jerk than the way itself and get to it with a jolt, so a limit of what
/// they ask for cannot be kept. Those of velocity and acceleration can.
#[test]
fn a_limit_that_cannot_be_kept_lets_no_other_go() {
    let coarse = || Job {
        sampler: even(9.0),
        refined: false,
        interpolation: 1e-2,
        ..job()
    };
    let asked = |axes: &AxesMotion, derivative| axes.peak(Axis::Z, derivative).unwrap().amount;
    let (_, outcome, _) = made(&coarse());
    let mut machine = Machine::default();
    for derivative in Derivative::ALL {
        let limit = asked(&outcome.figures.axes, derivative);
        *machine.limit_mut(Axis::Z, derivative) = Some(1.02 * limit);
    }
    let (_, _, leads) = made(&Job {
        lead: Some(LeadSettings {
            clearance: 5.0,
            limits: LeadLimits::within(machine),
        }),
        ..coarse()
    });
    let share = |derivative| {
        let limit = machine.limit(Axis::Z, derivative).unwrap();
        asked(&leads.figures.axes, derivative) / limit
    };
    assert!(share(Derivative::Jerk) > 1.001);
    let kept = [Derivative::Velocity, Derivative::Acceleration].map(share);
    assert!(kept.iter().all(|share| *share <= 1.001), "{kept:?}");
}

#[test]
fn without_a_lead_nothing_is_told_of_one() {
    let (kept, outcome) = Job {
        lead: None,
        ..job()
    }
    .run_whole()
    .unwrap();
    assert_eq!(outcome.lead, None);
    assert_eq!(kept.section(Section::LeadIn).len(), 0);
    assert!(Bare.compensates_nose() != Normal.compensates_nose());
}
