//! A program of every post reads back as the path that the controller plays.

use turnpath_core::toolpath::{ControlPoint, PathBlock, Section, SectionBlock, Segment};
use turnpath_core::{DEG, Params};
use turnpath_files::Draft;

use crate::{Chords, Layout, Lines, Post, ProgramFormat, ProgramWriter, ReadPath, TimeAxis};

mod around_path;
#[cfg(feature = "zst")]
mod compressed;
mod damage;
mod depths;
mod drift;
mod extremes;
mod modes;
mod numbers;
mod parts;
mod round_trips;
mod rounding;
mod travel;
mod whole;

/// A path from random steps: time in s, angle in deg, the rest in the units used inside.
pub(crate) fn path_of(steps: &[[f64; 6]]) -> Vec<ControlPoint> {
    let mut point = ControlPoint {
        vc: 50.0,
        x: 2.5,
        vz: -1.0 / 3.0,
        ..ControlPoint::default()
    };
    let mut points = vec![point];
    for [dt, dc, x, z, vx, vz] in steps {
        point = ControlPoint {
            t: point.t + dt,
            c: point.c + dc * DEG,
            x: *x,
            z: *z,
            vc: dc * DEG / dt,
            vx: *vx,
            vz: *vz,
        };
        points.push(point);
    }
    points
}

/// The program's lines, made of blocks that end at `ends`.
pub(crate) fn lines(layout: &Layout, points: &[ControlPoint], ends: &[usize]) -> Lines {
    lines_in_sections(layout, points, ends, 0..points.len())
}

/// The same for a path whose cutting section is `cut`, with leads around it.
fn lines_in_sections(
    layout: &Layout,
    points: &[ControlPoint],
    cuts: &[usize],
    cut: std::ops::Range<usize>,
) -> Lines {
    let ends = [cut.start, cut.end, points.len()];
    let mut cuts: Vec<usize> = cuts.iter().copied().chain(ends).collect();
    cuts.sort_unstable();
    let mut all = Lines::default();
    let mut begin = 0;
    for end in cuts {
        if end <= begin {
            continue;
        }
        let (section, opens_section) = match begin {
            _ if begin >= cut.end => (Section::LeadOut, begin == cut.end),
            _ if begin >= cut.start => (Section::Cutting, begin == cut.start),
            _ => (Section::LeadIn, begin == 0),
        };
        let mut block = PathBlock::default();
        points[begin..end]
            .iter()
            .for_each(|point| block.push(*point));
        let stretch = SectionBlock {
            section,
            opens_section,
            before: &points[begin.saturating_sub(2)..begin],
            points: &block,
        };
        let lines = layout.lines(&stretch).unwrap();
        all.text.extend(lines.text);
        all.points += lines.points;
        all.extent = match (all.extent, lines.extent) {
            (Some(before), Some(next)) => Some(before.and(next)),
            (before, next) => before.or(next),
        };
        begin = end;
    }
    all
}

pub(crate) fn program(layout: &Layout, points: &[ControlPoint]) -> String {
    assembled(layout, &lines(layout, points, &[]))
}

pub(crate) fn assembled(layout: &Layout, lines: &Lines) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("path.pmc");
    let mut writer = ProgramWriter::begin(Draft::begin(&path).unwrap(), *layout).unwrap();
    writer.append(lines).unwrap();
    let path_text = writer.close().unwrap();
    let whole = path_text.assemble(["OPEN PROG 1 CLEAR\n", "CLOSE\n"]);
    whole.unwrap().prove().unwrap().complete().unwrap();
    std::fs::read_to_string(path).unwrap()
}

pub(crate) fn read(layout: &Layout, text: &[u8]) -> Result<Vec<ControlPoint>, String> {
    Ok(read_sections(layout, text)?.0)
}

/// The points before the first fault, and the fault.
pub(crate) fn read_to_fault(layout: &Layout, text: &[u8]) -> (Vec<ControlPoint>, Option<String>) {
    let mut reader = layout.read(text, "p");
    let mut points = Vec::new();
    loop {
        match reader.next_point() {
            Ok(Some((point, _))) => points.push(point),
            Ok(None) => return (points, None),
            Err(error) => return (points, Some(error.to_string())),
        }
    }
}

fn read_sections(
    layout: &Layout,
    text: &[u8],
) -> Result<(Vec<ControlPoint>, Vec<Section>), String> {
    let mut reader = layout.read(text, "p");
    let (mut points, mut sections) = (Vec::new(), Vec::new());
    while let Some((point, section)) = reader.next_point().map_err(|error| error.to_string())? {
        points.push(point);
        sections.push(section);
    }
    Ok((points, sections))
}

/// The point of the played path at a time near a control point: on the cubic that ends there.
fn played(before: &ControlPoint, point: &ControlPoint, time: f64) -> ControlPoint {
    let segment = Segment::between(before, point);
    let (s, h) = ((time - before.t) / segment.duration, segment.duration);
    ControlPoint {
        t: time,
        c: segment.c.value(s),
        x: segment.x.value(s),
        z: segment.z.value(s),
        vc: segment.c.slope(s) / h,
        vx: segment.x.slope(s) / h,
        vz: segment.z.slope(s) / h,
    }
}

/// Half a unit of the last digit, and the rounding error of a double of this size.
fn half_unit(decimals: u32, size: f64) -> f64 {
    0.5 / 10u64.pow(decimals) as f64 * (1.0 + 1e-6) + 1e-12 * size.abs()
}

/// By how much a velocity may differ beyond its digits where a post writes it as coefficients of twelve
/// decimals, over a segment of some seconds.
fn coefficient_rounding(layout: &Layout, duration: f64) -> f64 {
    match layout.post.writes_velocities() {
        true => 0.0,
        false => 1e-12 / duration,
    }
}

fn assert_same(layout: &Layout, points: &[ControlPoint], read: &[ControlPoint]) {
    let format = &layout.format;
    let half_step = 0.5001 / format.steps_per_s as f64;
    assert_eq!(points.len(), read.len());
    // The writer and this test compute a cubic's slope in different orders, from times and positions
    // after many turns. The rounding error of the difference of two positions, divided by the time
    // between them, is far smaller than a digit.
    let velocity = |speed: f64, position: f64, duration: f64, instant: f64| {
        let per = if format.per_minute { 60.0 } else { 1.0 };
        let rounding = 1e-12 * (position.abs() + 600.0) / duration;
        let of_instant = 12.0 * 600.0 / (duration * duration) * f64::EPSILON * instant;
        let of_coefficients = coefficient_rounding(layout, duration);
        // A program of straight lines has no velocities.
        let not_said = if format.chords.is_some() {
            f64::INFINITY
        } else {
            0.0
        };
        not_said
            + half_unit(format.velocity_decimals, speed * per) / per
            + rounding
            + of_instant
            + of_coefficients
    };
    let held = |size: f64| format.held_rounding(size.abs() + 2.0).unwrap_or(0.0);
    let position = |size: f64| half_unit(format.position_decimals, size) + held(size);
    // The controller holds C within a turn, whatever its size on the path. Reversed, 4 deg is 356 deg.
    let angle = |size: f64| {
        let said = if format.c_wrapped { 360.0 } else { size };
        half_unit(format.position_decimals, size) + held(said)
    };
    for (k, (written, read)) in points.iter().zip(read).enumerate() {
        assert!(
            (read.t - written.t).abs() <= half_step,
            "{written:?} {read:?}"
        );
        let expected = match k {
            0 => *written,
            _ => played(&points[k - 1], written, read.t),
        };
        let duration = match k {
            // The first point has no segment before it; its velocity is that of the first one.
            0 if points.len() > 1 => points[1].t - written.t,
            0 => f64::INFINITY,
            _ => written.t - points[k - 1].t,
        };
        for (expected, read, bound) in [
            (expected.c / DEG, read.c / DEG, angle(expected.c / DEG)),
            (expected.x, read.x, position(expected.x)),
            (expected.z, read.z, position(expected.z)),
            (
                expected.vc / DEG,
                read.vc / DEG,
                velocity(expected.vc / DEG, expected.c / DEG, duration, written.t),
            ),
            (
                expected.vx,
                read.vx,
                velocity(expected.vx, expected.x, duration, written.t),
            ),
            (
                expected.vz,
                read.vz,
                velocity(expected.vz, expected.z, duration, written.t),
            ),
        ] {
            assert!(
                (expected - read).abs() <= bound,
                "point {k}: {expected} {read} {bound}"
            );
        }
    }
}

/// A post with its defaults, with one line for each segment and none too slow, and axes without an end. What
/// chords, slow lines and ends are is tested with the dialects that have them.
pub(crate) fn plain(post: &'static Post) -> Layout {
    let format = post.format(&Params::new(), 0.0, f64::INFINITY);
    let chords = format.chords.map(|chords| Chords {
        shortest: 1,
        slowest: None,
        ..chords
    });
    let time_axis = format.time_axis.map(|axis| TimeAxis {
        limit_um: i64::MAX,
        ..axis
    });
    let format = ProgramFormat {
        chords,
        time_axis,
        c_limit: None,
        ..format
    };
    Layout { post, format }
}
