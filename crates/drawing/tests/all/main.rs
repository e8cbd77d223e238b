//! Drawings against the data that they show, read out of the files as a viewer has them.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

mod layout;
mod pixels;
mod svg;

use turnpath_drawing::{Dots, Drawing, DrawingError, Figure, Size, draw};
use turnpath_report::{
    AxisSketch, EdgeSketch, ErrorMap, ErrorSketch, PathSketch, RadialMean, RunReport, Samples,
    SpiralSketch, TurnSketch, from_json, unit,
};

use pixels::Sheet;
use svg::{Group, Ticks};

/// Cells along each side of the map.
const CELLS: usize = 60;
/// Half of its side, mm.
const HALF: f64 = 12.0;
/// A colour says a value to this part of the scale: 256 rows of the bar and 8 bits.
const SHARE: f64 = 0.012;
/// From the lowest to the highest value of the map, nm, at the least.
const SCALE: f64 = 60.0;

/// The error at a place, nm: no line through the axis mirrors it.
fn error_at(x: f64, y: f64) -> f64 {
    2.0 * x + 3.0 * y + 0.1 * x * y + 5.0
}

fn middle(index: usize) -> f64 {
    HALF * ((2 * index + 1) as f64 / CELLS as f64 - 1.0)
}

fn sketch() -> PathSketch {
    let cells = (0..CELLS).flat_map(|row| (0..CELLS).map(move |column| (row, column)));
    let error = |(row, column): (usize, usize)| {
        let (x, y) = (middle(column), -middle(row));
        let on_part = x * x + y * y < HALF * HALF;
        match on_part {
            true => error_at(x, y) / unit::nm::PER,
            false => f64::NAN,
        }
    };
    let turns = 40;
    let along = |of: &dyn Fn(f64) -> f64| (0..turns).map(|turn| of(f64::from(turn))).collect();
    let axis = |size: f64| AxisSketch {
        velocity: along(&|turn| size * turn),
        acceleration: along(&|turn| 10.0 * size * turn),
        jerk: along(&|turn| 5000.0 * size * turn),
    };
    PathSketch {
        error: ErrorSketch {
            map: Some(ErrorMap {
                cells: CELLS,
                half: HALF,
                errors: cells.map(error).collect(),
            }),
            radial_mean: None::<RadialMean>,
            harmonics: (0..100).map(|k| 1e-6 * f64::from(k % 7)).collect(),
        },
        profiles: Vec::new(),
        spiral: SpiralSketch {
            x: along(&|turn| 0.3 * turn),
            y: along(&|turn| -0.2 * turn),
            errors: along(&|turn| 1e-6 * turn),
        },
        turns: TurnSketch {
            radius: along(&|turn| 0.3 * turn),
            feed: along(&|turn| 0.01 + 1e-4 * turn),
            points_per_turn: along(&|turn| 100.0 + turn),
            spindle: along(&|_| 50.0),
            errors: along(&|_| 1e-6),
            x: axis(0.01),
            z: axis(3.0),
        },
        edges: EdgeSketch {
            residual: Samples::default(),
            rim: Samples::default(),
            hole: Samples::default(),
        },
    }
}

fn report() -> RunReport {
    from_json(include_str!("../../../report/tests/data/summary.json")).unwrap()
}

fn drawing(figure: Figure) -> Drawing {
    draw(figure, (&report(), &sketch()), figure.size()).unwrap()
}

fn dots() -> Dots {
    Dots::per_inch(300).unwrap()
}

/// Ten cells of the part, by row and column.
fn places() -> [(usize, usize); 10] {
    std::array::from_fn(|k| {
        let (row, column) = (15 + 3 * k, 12 + (17 * k) % 37);
        let (x, y) = (middle(column), middle(row));
        assert!(x * x + y * y < 0.9 * HALF * HALF);
        (row, column)
    })
}

/// The largest difference of the values that the colours at ten places stand for from those of the
/// data, nm; `mirror` is 1, or −1 to look at the place on the other side of the x axis.
fn largest_difference(value_at: impl Fn(f64, f64) -> f64, mirror: f64) -> f64 {
    let differences = places().into_iter().map(|(row, column)| {
        let (x, y) = (middle(column), -middle(row));
        (value_at(x, mirror * y) - error_at(x, y)).abs()
    });
    differences.fold(0.0, f64::max)
}

#[test]
fn colours_of_the_svg_are_the_values_of_the_map() {
    let text = drawing(Figure::Map).svg();
    let (map, bar) = (Group::of(&text, "map"), Group::of(&text, "bar-error"));
    let (picture, scale) = (map.picture(), bar.picture());
    let [x_ticks, y_ticks] = ["x-x", "y-y"].map(|axis| Group::of(&text, axis).ticks());
    let values = bar.ticks();
    let value_at = |x: f64, y: f64| {
        // From mm of the part to mm of the sheet, to a pixel of the picture, to its row of the bar.
        let (x, y) = (
            Ticks::across(&x_ticks).place(x),
            Ticks::down(&y_ticks).place(y),
        );
        let row = scale.row_of(picture.colour(x, y));
        Ticks::down(&values).value(row)
    };
    assert!(largest_difference(value_at, 1.0) < SHARE * SCALE);
    assert!(
        largest_difference(value_at, -1.0) > 0.2 * SCALE,
        "a mirrored map is told apart"
    );
}

#[test]
fn pixels_of_the_png_are_the_values_of_the_map() {
    let drawing = drawing(Figure::Map);
    let (text, sheet) = (drawing.svg(), Sheet::read(&drawing.png(dots()).unwrap()));
    let bar = Group::of(&text, "bar-error");
    let [x_ticks, y_ticks] = ["x-x", "y-y"].map(|axis| Group::of(&text, axis).ticks());
    let (scale, values) = (bar.picture(), bar.ticks());
    let value_at = |x: f64, y: f64| {
        let (x, y) = (
            Ticks::across(&x_ticks).place(x),
            Ticks::down(&y_ticks).place(y),
        );
        let at = sheet.place_of(sheet.colour(x, y), scale.middle(), scale.ends());
        Ticks::down(&values).value(at)
    };
    // Besides, a pixel lies beside the middle of its cell.
    assert!(largest_difference(value_at, 1.0) < 2.0 * SHARE * SCALE);
    assert!(largest_difference(value_at, -1.0) > 0.2 * SCALE);
}

#[test]
fn a_png_says_its_size_and_has_its_pixels() {
    for figure in Figure::ALL {
        let bytes = drawing(figure).png(dots()).unwrap();
        let sheet = Sheet::read(&bytes);
        let [width, height] = figure.size().pixels(dots()).unwrap();
        assert_eq!((sheet.width, sheet.height), (width, height));
        // 300 dots an inch.
        assert_eq!(sheet.per_metre, 11_811);
        assert!(sheet.ink() > 0.01, "{}: hardly any ink", figure.name());
        for edge in sheet.edges() {
            assert_eq!(edge, [255; 3], "{}: something is cut off", figure.name());
        }
    }
}

#[test]
fn the_same_data_give_the_same_bytes() {
    for figure in Figure::ALL {
        let (one, other) = (drawing(figure), drawing(figure));
        assert_eq!(one.svg(), other.svg());
        assert_eq!(one.png(dots()).unwrap(), other.png(dots()).unwrap());
    }
}

/// Letters are outlines, so the file names no font and has no text that would need one.
#[test]
fn an_svg_needs_no_font_and_loads_nothing() {
    for figure in Figure::ALL {
        let text = drawing(figure).svg();
        for word in ["<text", "font", "http:", "https:", "url("] {
            let without_namespace = text.replacen("http://www.w3.org/2000/svg", "", 1);
            assert!(
                !without_namespace.contains(word),
                "{}: {word}",
                figure.name()
            );
        }
    }
}

#[test]
fn curves_lie_where_their_axes_say() {
    let text = drawing(Figure::Feed).svg();
    let x = Group::of(&text, "x-radius-(mean-X)").ticks();
    let y = Group::of(&text, "y-feed").ticks();
    let (last, most) = (0.3 * 39.0, 1000.0 * (0.01 + 1e-4 * 39.0));
    let [right, top] = [Ticks::across(&x).place(last), Ticks::down(&y).place(most)];
    // Places of ticks are rounded to a micrometre of paper.
    let is_there = |[x, y]: [f64; 2]| (x - right).abs() < 0.02 && (y - top).abs() < 0.02;
    let ends = svg::ends_of_lines(&text);
    assert!(
        ends.iter().any(|end| is_there(*end)),
        "no curve ends at {right}, {top}: {ends:?}"
    );
}

#[test]
fn limits_of_the_machine_are_dashed_lines() {
    let mut report = report();
    let limits = |report: &RunReport| {
        let drawing = draw(Figure::Axes, (report, &sketch()), Figure::Axes.size());
        drawing
            .unwrap()
            .svg()
            .matches("aria-label=\"limit\"")
            .count()
    };
    let expected = report.path.machine.as_ref().map_or(0, |machine| {
        let slides = machine
            .limits
            .iter()
            .filter(|one| one.limit.axis != turnpath_core::Axis::C);
        slides.count()
    });
    assert!(expected > 0);
    assert_eq!(limits(&report), expected);
    report.path.machine = None;
    assert_eq!(limits(&report), 0);
}

#[test]
fn a_figure_without_room_for_its_letters_is_refused() {
    let size = Size::new(50.0, 50.0).unwrap();
    let refused = draw(Figure::Axes, (&report(), &sketch()), size);
    let figure = Figure::Axes;
    assert_eq!(refused, Err(DrawingError::Small { figure, size }));
    assert!(draw(Figure::Map, (&report(), &sketch()), size).is_ok());
}

#[test]
fn an_empty_sketch_gives_empty_frames() {
    let none = PathSketch {
        error: ErrorSketch {
            map: None,
            radial_mean: None,
            harmonics: Samples::default(),
        },
        spiral: SpiralSketch {
            x: Samples::default(),
            y: Samples::default(),
            errors: Samples::default(),
        },
        turns: TurnSketch {
            radius: Samples::default(),
            ..sketch().turns
        },
        ..sketch()
    };
    for figure in Figure::ALL {
        for size in [figure.least(), figure.size()] {
            let drawing = draw(figure, (&report(), &none), size).unwrap();
            assert!(drawing.svg().contains("<path"));
            drawing.png(dots()).unwrap();
        }
    }
}
