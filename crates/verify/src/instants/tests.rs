//! Instants of a batch against the first touch at each position alone.

use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use turnpath_core::toolpath::{ControlPoint, Segment};
use turnpath_core::{Misfit, Part, Scalar, Surface, Tool};

use super::*;
use crate::subject::Subject;

const NOSE_RADIUS: f64 = 0.8;
const RIM: f64 = 6.0;

/// Waves in two directions, or a plane without a height beyond a line.
enum Shape {
    Waves { height: f64 },
    Half { to_x: f64 },
}

impl Surface for Shape {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        match self {
            Self::Waves { height } => ((x * 1.3).sin() + (y * 0.9).cos()) * *height,
            Self::Half { to_x } => ((-x) + *to_x).sqrt() * 0.0 + x * 0.05,
        }
    }
}

fn touch(surface: impl Surface + 'static, misfit: Misfit, compensates_nose: bool) -> FirstTouch {
    let tool = Tool {
        nose_radius: NOSE_RADIUS,
        included_angle: None,
        clearance_angle: None,
        misfit,
    };
    FirstTouch::new(Subject {
        surface: Arc::new(surface),
        part: Part {
            aperture_radius: RIM,
            inner_radius: 0.0,
        },
        tool,
        compensates_nose,
    })
    .unwrap()
}

/// A spiral of so many segments of `step` rad, inward from the rim across the axis.
fn spiral(segments: usize, step: f64, shape: SegmentShape) -> PathBlock {
    let mut points = PathBlock {
        shape,
        ..PathBlock::default()
    };
    for i in 0..=segments {
        let share = i as f64 / segments as f64;
        points.push(ControlPoint {
            t: i as f64,
            c: 1000.0 * TAU + 0.3 + step * i as f64,
            x: RIM - (RIM + 0.5) * share,
            z: 0.1 * Scalar::sin(0.4 * i as f64),
            vc: step,
            vx: -(RIM + 0.5) / segments as f64,
            vz: 0.04 * Scalar::cos(0.4 * i as f64),
        });
    }
    points
}

/// The largest differences of errors and feet from those of each position alone, mm, and how many touches there are.
fn differences(touch: &FirstTouch, points: &PathBlock) -> ([f64; 2], usize) {
    let mut instants = InstantBatch::default();
    let mut largest = [0.0_f64; 2];
    let mut count = 0;
    let mut compare = |segment: &Segment, s: f64, found: [f64; 2]| {
        let mut touches = Vec::new();
        let (theta, x) = (segment.c.value(s).rem_euclid(TAU), segment.x.value(s));
        touch.find(&[theta], &[x], &mut touches).unwrap();
        let alone = [segment.z.value(s) - touches[0].z, touches[0].foot];
        for ((largest, found), alone) in largest.iter_mut().zip(found).zip(alone) {
            assert_eq!(found.is_nan(), alone.is_nan(), "X = {x}");
            *largest = largest.max((found - alone).abs());
        }
        count += usize::from(!alone[0].is_nan());
    };
    for batch in batches(0..points.len() - 1) {
        instants.play(points, batch.clone(), touch).unwrap();
        for (index, number) in batch.enumerate() {
            let segment = points.segment(number).unwrap();
            for k in 0..INSTANTS {
                let found = [instants.error(index, k), instants.foot(index, k)];
                compare(&segment, k as f64 / INSTANTS as f64, found);
            }
            let [first, end] = instants.end_errors(index);
            assert_eq!(first.to_bits(), instants.error(index, 0).to_bits());
            let mut ends = Vec::new();
            let theta = segment.c.value(1.0).rem_euclid(TAU);
            touch
                .find(&[theta], &[segment.x.value(1.0)], &mut ends)
                .unwrap();
            let alone = segment.z.value(1.0) - ends[0].z;
            assert_eq!(end.is_nan(), alone.is_nan());
            assert!(end.is_nan() || (end - alone).abs() < 1e-9);
        }
    }
    (largest, count)
}

#[test]
fn each_instant_has_the_touch_of_its_position_alone() {
    let gentle = || Shape::Waves { height: 0.02 };
    let steep = || Shape::Waves { height: 0.9 };
    let touches = [
        touch(gentle(), Misfit::Refuse, true),
        touch(steep(), Misfit::CutWhatFits, true),
        touch(gentle(), Misfit::Refuse, false),
    ];
    assert_eq!(
        touches.each_ref().map(FirstTouch::has_single_maximum),
        [true, false, true]
    );
    for touch in &touches {
        for (segments, step) in [(1, 0.1), (3, 1.9), (127, 0.006), (129, 0.4), (257, 0.7)] {
            for shape in [SegmentShape::Cubic, SegmentShape::Linear] {
                let points = spiral(segments, step, shape);
                let ([error, foot], count) = differences(touch, &points);
                // C is 1000 turns: its last bit is 1e-12 rad. A foot is good to 1e-8 of the radius, by both ways.
                assert!(
                    error < 2e-12 && foot < 2e-8 * NOSE_RADIUS,
                    "{segments}: {error} {foot}"
                );
                assert_eq!(count, segments * INSTANTS);
            }
        }
    }
}

#[test]
fn where_the_surface_ends_touches_end() {
    let touch = touch(Shape::Half { to_x: 2.0 }, Misfit::Refuse, true);
    let ([error, _], count) = differences(&touch, &spiral(300, 0.02, SegmentShape::Cubic));
    assert!(error < 1e-7 && count > 1000, "{error} {count}");
}

#[test]
fn batches_are_of_nearly_one_size_and_miss_no_segment() {
    for count in [0, 1, 127, 128, 129, 256, 300, 1000] {
        let all: Vec<Range<usize>> = batches(0..count).collect();
        assert!(
            all.iter()
                .all(|batch| batch.len() <= BATCH && !batch.is_empty())
        );
        let numbers: Vec<usize> = all.iter().cloned().flatten().collect();
        assert_eq!(numbers, (0..count).collect::<Vec<_>>());
        let sizes = || all.iter().map(Range::len);
        let [least, most] = [sizes().min(), sizes().max()];
        assert!(most.unwrap_or(0) - least.unwrap_or(0) <= all.len());
    }
}

/// A surface that counts the places at which it is asked.
struct Counted(Arc<AtomicUsize>);

impl Surface for Counted {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        self.0.fetch_add(1, Ordering::Relaxed);
        ((x * 1.3).sin() + (y * 0.9).cos()) * 0.02
    }
}

#[test]
fn an_instant_behind_others_asks_the_surface_once() {
    let asked = Arc::new(AtomicUsize::new(0));
    let touch = touch(Counted(asked.clone()), Misfit::Refuse, true);
    let points = spiral(128, 0.006, SegmentShape::Cubic);
    asked.store(0, Ordering::Relaxed);
    InstantBatch::default()
        .play(&points, 0..128, &touch)
        .unwrap();
    let per_segment = asked.load(Ordering::Relaxed) as f64 / 128.0;
    // Three times or four at the control point and for the first instants, once for the others.
    assert!(per_segment < 2.0 * INSTANTS as f64, "{per_segment}");
}
