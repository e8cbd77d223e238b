//! Leads against a flat part, where clearance is Z itself.

use crate::common::{Plane, touch_on};
use turnpath_core::toolpath::{ControlPoint, PathBlock, SegmentShape};
use turnpath_verify::{FirstTouch, LeadMeter};

fn flat() -> FirstTouch {
    touch_on(Plane { slope: 0.0 }, 2.0, 0.0, false)
}

/// z(t) at constant C and X, exact at every point.
fn block(x: f64, t: &[f64], z: fn(f64) -> f64, rate: fn(f64) -> f64) -> PathBlock {
    let mut block = PathBlock::default();
    for t in t {
        block.push(ControlPoint {
            t: *t,
            c: 7.0 * t,
            vc: 7.0,
            x,
            z: z(*t),
            vz: rate(*t),
            ..ControlPoint::default()
        });
    }
    block
}

#[test]
fn the_smallest_clearance_lies_between_points_where_the_path_dips_there() {
    // z = (t − 1)² − 1/4 is below the part from 0.5 to 1.5.
    let dip = block(
        1.0,
        &[0.0, 2.0],
        |t| (t - 1.0) * (t - 1.0) - 0.25,
        |t| 2.0 * (t - 1.0),
    );
    let found = LeadMeter::measure(&flat(), &dip).unwrap();
    assert!((found.figures.clearance + 0.25).abs() < 1e-12);
    assert!((found.figures.at_c - 7.0).abs() < 1e-12);
    assert_eq!(found.per_segment.len(), 1);
}

#[test]
fn beyond_the_rim_there_is_nothing_to_touch() {
    let below = block(3.5, &[0.0, 1.0], |_| -5.0, |_| 0.0);
    let found = LeadMeter::measure(&flat(), &below).unwrap();
    assert_eq!(found.figures.clearance, f64::INFINITY);
}

#[test]
fn jumps_are_reported_in_leads_and_at_joins_and_not_within_the_cut() {
    let cubic = |t: &[f64]| block(1.0, t, |t| t * t * t, |t| 3.0 * t * t);
    let parabola = |t: &[f64]| block(1.0, t, |t| t * t, |t| 2.0 * t);
    let touch = flat();
    let mut meter = LeadMeter::default();
    meter.append(&LeadMeter::measure(&touch, &cubic(&[0.0, 0.5, 1.0])).unwrap());
    let jump = |meter: &LeadMeter| meter.figures().unwrap().jumps.z;
    assert!(jump(&meter) < 1e-12);
    // The acceleration jumps from 6t = 6 to 2. The jump to the next block of the cut does not
    // count.
    meter.append_cut(&parabola(&[1.0, 1.5]));
    assert!((jump(&meter) - 4.0).abs() < 1e-12);
    meter.append_cut(&cubic(&[1.5, 2.0]));
    assert!((jump(&meter) - 4.0).abs() < 1e-12);
    // The acceleration jumps from 12 to 2 where the lead-out begins.
    meter.append(&LeadMeter::measure(&touch, &parabola(&[2.0, 3.0])).unwrap());
    assert!((jump(&meter) - 10.0).abs() < 1e-12);
    assert_eq!(meter.figures().unwrap().segments, 3);
    assert!(LeadMeter::default().figures().is_none());
}

#[test]
fn straight_leads_blend_into_the_cut_and_out_of_it_and_not_into_each_other() {
    let lines = |t: &[f64], z: fn(f64) -> f64| PathBlock {
        shape: SegmentShape::Linear,
        ..block(1.0, t, z, |_| 0.0)
    };
    let touch = flat();
    let mut meter = LeadMeter::default();
    let acceleration = |meter: &LeadMeter| meter.figures().unwrap().axes.z.acceleration;
    // The rate of Z is −2, and −1 on the first line of the cut: over 0.75 s.
    meter.append(&LeadMeter::measure(&touch, &lines(&[0.0, 0.5, 1.0], |t| 9.0 - 2.0 * t)).unwrap());
    assert_eq!(acceleration(&meter).amount, 0.0);
    meter.append_cut(&lines(&[1.0, 2.0], |t| 8.0 - t));
    assert!((acceleration(&meter).amount - 1.0 / 0.75).abs() < 1e-12);
    assert_eq!(acceleration(&meter).at_c, 7.0);
    // Within the cut it is 50 mm/s². That is no motion of a lead.
    meter.append_cut(&lines(&[2.0, 3.0], |t| 6.0 + 49.0 * (t - 2.0)));
    meter.append_cut(&lines(&[3.0, 4.0], |t| 55.0 - 2.0 * (t - 3.0)));
    assert!((acceleration(&meter).amount - 1.0 / 0.75).abs() < 1e-12);
    // From −2 to 0.5, over 1 s.
    meter.append(
        &LeadMeter::measure(&touch, &lines(&[4.0, 5.0], |t| 53.0 + 0.5 * (t - 4.0))).unwrap(),
    );
    assert!((acceleration(&meter).amount - 2.5).abs() < 1e-12);
    assert_eq!(acceleration(&meter).at_c, 28.0);
    assert_eq!(meter.figures().unwrap().axes.z.velocity.amount, 2.0);
}
