//! Where the parts of a figure stand: curves within their frames, letters beside each other.

use turnpath_drawing::{Figure, Size, draw};
use turnpath_report::{PathSketch, RunReport, Samples, Spokes};

use crate::svg::{Drawn, Part, drawn};
use crate::{report, sketch};

/// Places are rounded to a micrometre of paper.
const ROUNDING: f64 = 2e-3;
/// Half of the largest dot, mm: a dot has its middle at its value.
const HALF_DOT: f64 = 0.28;
/// Between letters of two texts, mm.
const APART: f64 = 0.2;
/// The least sides of a frame, mm.
const FRAME: f64 = 7.0;
/// More than the width of a bar of colours, mm.
const BAR: f64 = 3.5;

/// The whole of a figure, as its SVG has it.
fn parts(figure: Figure, data: (&RunReport, &PathSketch), size: Size) -> Vec<Drawn> {
    drawn(&draw(figure, data, size).unwrap().svg())
}

fn of(parts: &[Drawn], part: Part) -> Vec<&Drawn> {
    parts.iter().filter(|drawn| drawn.part == part).collect()
}

/// All samples of turns but radii.
fn motions(sketch: &mut PathSketch) -> Vec<&mut Samples> {
    let turns = &mut sketch.turns;
    let (x, z) = (&mut turns.x, &mut turns.z);
    vec![
        &mut turns.feed,
        &mut turns.points_per_turn,
        &mut turns.spindle,
        &mut x.velocity,
        &mut x.acceleration,
        &mut x.jerk,
        &mut z.velocity,
        &mut z.acceleration,
        &mut z.jerk,
    ]
}

fn change(samples: &mut Samples, of: impl Fn(f64) -> f64) {
    for value in &mut samples.0 {
        *value = of(*value);
    }
}

/// The report with a spoke of this amplitude, mm.
fn report_with_spoke(amplitude: f64, per_turn: usize) -> RunReport {
    let mut report = report();
    report.path.spokes = Some(Spokes {
        amplitude,
        per_turn,
        from: 1.0,
        to: 2.0,
    });
    report
}

/// Data that go beyond what a usual path has, each with its name.
fn unusual() -> Vec<(&'static str, PathSketch)> {
    let changed = |name, of: &dyn Fn(&mut PathSketch)| {
        let mut sketch = sketch();
        of(&mut sketch);
        (name, sketch)
    };
    let all = |value: f64| {
        move |sketch: &mut PathSketch| {
            motions(sketch).into_iter().for_each(|samples| {
                samples.0[3] = value;
            });
            sketch.turns.radius.0[5] = value;
            sketch.spiral.x.0[5] = value;
            sketch.spiral.errors.0[6] = value;
            sketch.error.harmonics.0[7] = value;
        }
    };
    let shifted = |by: f64| {
        move |sketch: &mut PathSketch| change(&mut sketch.turns.radius, |radius| radius - by)
    };
    vec![
        changed("X crosses the axis by little", &shifted(0.4)),
        changed("X crosses the axis by much", &shifted(9.0)),
        changed("X is negative", &shifted(20.0)),
        changed("motions are negative", &|sketch| {
            motions(sketch)
                .into_iter()
                .for_each(|samples| change(samples, |value| -value));
        }),
        changed("motions have both signs", &|sketch| {
            let last = |samples: &mut Samples| samples.0[39] *= -0.3;
            motions(sketch).into_iter().for_each(last);
        }),
        changed("a value is infinite", &all(f64::INFINITY)),
        changed("a value is no number", &all(f64::NAN)),
        changed("a value is the largest number", &all(f64::MAX)),
        changed("a value is the least number", &all(-f64::MAX)),
        changed("a value is large", &all(1e30)),
        changed("all values are one", &|sketch| {
            motions(sketch)
                .into_iter()
                .for_each(|samples| change(samples, |_| 3e19));
            change(&mut sketch.turns.radius, |_| 0.0);
        }),
    ]
}

/// Curves and words on a curve lie in a frame.
fn stays_inside(parts: &[Drawn], what: &str) {
    let frames = of(parts, Part::Frame);
    for (part, room) in [(Part::Curve, ROUNDING), (Part::Dots, HALF_DOT)] {
        for curve in of(parts, part) {
            let inside = |frame: &&Drawn| curve.is_in(frame.least, frame.most, room);
            assert!(frames.iter().any(inside), "{what}: {curve:?} in {frames:?}");
        }
    }
    let letters = of(parts, Part::Letters).into_iter();
    for words in letters.filter(|words| words.label.contains(" nm") && !words.label.contains('/')) {
        let inside = |frame: &&Drawn| words.is_in(frame.least, frame.most, 0.0);
        assert!(frames.iter().any(inside), "{what}: {words:?} in {frames:?}");
    }
}

#[test]
fn no_curve_leaves_its_frame_whatever_the_data() {
    let report = report_with_spoke(1e-3, 200);
    for (name, sketch) in unusual() {
        for figure in Figure::ALL {
            for size in [figure.least(), figure.size()] {
                let what = format!("{}, {size:?}, {name}", figure.name());
                let parts = parts(figure, (&report, &sketch), size);
                stays_inside(&parts, &what);
                assert!(!of(&parts, Part::Letters).is_empty(), "{what}");
            }
        }
    }
}

#[test]
fn the_radius_goes_beyond_the_axis_where_x_does() {
    let mut across = sketch();
    change(&mut across.turns.radius, |radius| radius - 2.0);
    for figure in [Figure::Feed, Figure::Axes] {
        let parts = parts(figure, (&report(), &across), figure.size());
        let (frames, curves) = (of(&parts, Part::Frame), of(&parts, Part::Curve));
        let frame = frames[0];
        let curve = curves[0];
        // The curve begins and ends beside the frame: neither clipped nor far from it.
        for gap in [
            curve.least[0] - frame.least[0],
            frame.most[0] - curve.most[0],
        ] {
            assert!(
                gap > 0.005 * frame.size()[0] && gap < 0.02 * frame.size()[0],
                "{gap}"
            );
        }
        let numbers: Vec<&str> = parts.iter().map(|part| part.label.as_str()).collect();
        assert!(
            numbers.contains(&"−2") || numbers.contains(&"−2.0"),
            "{numbers:?}"
        );
    }
}

/// Data of these sizes: of the part, of motions and of errors, as factors.
fn scaled([part, motion, error]: [f64; 3]) -> PathSketch {
    let mut sketch = sketch();
    let by = |factor: f64| move |value: f64| factor * value;
    motions(&mut sketch)
        .into_iter()
        .for_each(|samples| change(samples, by(motion)));
    let spiral = &mut sketch.spiral;
    for samples in [&mut sketch.turns.radius, &mut spiral.x, &mut spiral.y] {
        change(samples, by(part));
    }
    change(&mut spiral.errors, by(error));
    change(&mut sketch.error.harmonics, by(error));
    if let Some(map) = &mut sketch.error.map {
        map.half *= part;
        change(&mut map.errors, by(error));
    }
    sketch
}

/// Letters stand apart from each other, on the sheet and outside of frames, unless they are words in a
/// frame; and frames are large enough.
fn is_legible(parts: &[Drawn], [width, height]: [f64; 2], what: &str) {
    let letters = of(parts, Part::Letters);
    for (at, one) in letters.iter().enumerate() {
        assert!(
            one.is_in([0.3, 0.3], [width - 0.3, height - 0.3], 0.0),
            "{what}: {one:?} is cut"
        );
        for other in &letters[at + 1..] {
            assert!(
                one.is_apart(other, APART),
                "{what}: {one:?} touches {other:?}"
            );
        }
        for frame in of(parts, Part::Frame) {
            let is_apart = one.is_apart(frame, 0.1) || one.is_in(frame.least, frame.most, 0.0);
            assert!(is_apart, "{what}: {one:?} touches {frame:?}");
        }
    }
    let frames = of(parts, Part::Frame);
    // The bar of colours is a frame too.
    for frame in frames.iter().filter(|frame| frame.size()[0] > BAR) {
        let is_large = frame.size().iter().all(|side| *side >= FRAME);
        assert!(is_large, "{what}: {frame:?}");
        assert!(numbers_beside(frame, &letters) >= 2, "{what}: {frame:?}");
    }
    let lowest = frames.iter().map(|frame| frame.most[1]).fold(0.0, f64::max);
    for frame in frames
        .iter()
        .filter(|frame| frame.most[1] == lowest && frame.size()[0] > BAR)
    {
        assert!(numbers_below(frame, &letters) >= 2, "{what}: {frame:?}");
    }
}

/// The numbers of the y axis of a frame.
fn numbers_beside(frame: &Drawn, letters: &[&Drawn]) -> usize {
    let is_beside = |one: &&&Drawn| {
        let gap = frame.least[0] - one.most[0];
        let is_level = one.least[1] > frame.least[1] - 1.0 && one.most[1] < frame.most[1] + 1.0;
        (1.0..2.5).contains(&gap) && is_level
    };
    letters.iter().filter(is_beside).count()
}

/// The numbers of its x axis.
fn numbers_below(frame: &Drawn, letters: &[&Drawn]) -> usize {
    let is_below = |one: &&&Drawn| {
        let gap = one.least[1] - frame.most[1];
        let middle = (one.least[0] + one.most[0]) / 2.0;
        (1.0..2.5).contains(&gap) && middle > frame.least[0] - 0.5 && middle < frame.most[0] + 0.5
    };
    letters.iter().filter(is_below).count()
}

/// The sizes of a figure that are looked at: its least one, its own, and others from there on.
fn sizes(figure: Figure) -> Vec<[f64; 2]> {
    let least = match figure {
        Figure::Axes => [60.0, 45.0],
        Figure::Feed => [45.0, 45.0],
        Figure::Map | Figure::Spiral | Figure::Spectrum => [45.0, 40.0],
    };
    let mut sizes = vec![least];
    for sides in [
        [60.0, 45.0],
        [85.0, 60.0],
        [85.0, 95.0],
        [120.0, 80.0],
        [170.0, 105.0],
    ] {
        sizes.push(sides);
        sizes.push([sides[0], least[1]]);
        sizes.push([least[0], sides[1]]);
    }
    sizes.extend([[1200.0, 45.0], [60.0, 1200.0], [400.0, 300.0]]);
    sizes
}

#[test]
fn letters_stand_apart_at_all_sizes_that_are_allowed() {
    // From a part of 0.3 mm to one of 1.2 m, and from rest to more than any machine does.
    let factors = [
        [1.0, 1.0, 1.0],
        [0.013, 0.017, 0.011],
        [0.19, 0.3, 0.21],
        [0.41, 13.0, 17.0],
        [8.3, 230.0, 310.0],
        [50.0, 1.7e4, 2.3e4],
        [1.0, 1e-9, 1e-9],
    ];
    for factors in factors {
        let sketch = scaled(factors);
        let report = report_with_spoke(6e-6 * factors[2], 200);
        for figure in Figure::ALL {
            for sides in sizes(figure) {
                let size = Size::new(sides[0], sides[1]).unwrap();
                let parts = parts(figure, (&report, &sketch), size);
                let what = format!("{} {sides:?} {factors:?}", figure.name());
                is_legible(&parts, sides, &what);
            }
        }
    }
}

/// At the size of the example in docs/commands.md no word is short.
#[test]
fn six_motions_have_their_titles_in_the_width_of_a_column() {
    let size = Size::new(85.0, 60.0).unwrap();
    let drawing = draw(Figure::Axes, (&report(), &sketch()), size).unwrap();
    let parts = drawn(&drawing.svg());
    assert_eq!(of(&parts, Part::Frame).len(), 6);
    let acceleration = |part: &&Drawn| part.label.contains("acceleration");
    let widths = parts.iter().filter(acceleration).map(|part| part.size()[0]);
    // Each word alone is 17 mm long.
    assert_eq!(widths.filter(|width| *width > 25.0).count(), 2);
}
