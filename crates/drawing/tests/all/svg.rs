//! Reads an SVG as far as the tests need it.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use crate::pixels::{Sheet, difference};

/// Where lines end, mm.
pub fn ends_of_lines(svg: &str) -> Vec<[f64; 2]> {
    let lines = svg.lines().filter(|line| line.contains("stroke="));
    let end = |line: &str| {
        let (_, last) = attribute_of(line, "d")?.rsplit_once('L')?;
        let (x, y) = last.trim_end_matches('Z').split_once(' ')?;
        Some([x.parse().ok()?, y.parse().ok()?])
    };
    lines.filter_map(end).collect()
}

/// A group of an SVG.
pub struct Group<'a>(&'a str);

/// A tick: its place on the sheet, mm, and what stands at it.
pub struct Tick {
    place: [f64; 2],
    value: f64,
}

/// A picture with its place on the sheet, mm.
pub struct Picture {
    pixels: Sheet,
    area: [f64; 4],
}

impl<'a> Group<'a> {
    pub fn of(svg: &'a str, name: &str) -> Self {
        let begin = format!("<g id=\"{name}\">");
        let (_, rest) = svg
            .split_once(&begin)
            .unwrap_or_else(|| panic!("no {begin}"));
        Self(rest.split_once("</g>").unwrap().0)
    }

    pub fn picture(&self) -> Picture {
        let (_, image) = self.0.split_once("<image").unwrap();
        let (_, data) = image.split_once("base64,").unwrap();
        let png = STANDARD.decode(data.split_once('"').unwrap().0).unwrap();
        Picture {
            pixels: Sheet::read(&png),
            area: ["x", "y", "width", "height"].map(|name| attribute(image, name).parse().unwrap()),
        }
    }

    /// The ticks with numbers.
    pub fn ticks(&self) -> Vec<Tick> {
        let lines = self.0.lines().filter(|line| line.contains("stroke="));
        let tick = |line: &str| {
            let value = attribute_of(line, "aria-label")?.replace('−', "-");
            let steps = attribute(line, "d");
            let (x, y) = steps[1..]
                .split_once('L')
                .unwrap()
                .0
                .split_once(' ')
                .unwrap();
            Some(Tick {
                place: [x.parse().unwrap(), y.parse().unwrap()],
                value: value.parse().ok()?,
            })
        };
        lines.filter_map(tick).collect()
    }
}

fn attribute_of<'a>(element: &'a str, name: &str) -> Option<&'a str> {
    let (_, rest) = element.split_once(&format!(" {name}=\""))?;
    Some(rest.split_once('"')?.0)
}

fn attribute<'a>(element: &'a str, name: &str) -> &'a str {
    attribute_of(element, name).unwrap_or_else(|| panic!("no {name} in {element}"))
}

/// The even scale that ticks stand for.
pub struct Ticks {
    /// A place on the sheet, mm, and the value there.
    from: (f64, f64),
    to: (f64, f64),
}

impl Ticks {
    pub fn across(ticks: &[Tick]) -> Self {
        Self::along(ticks, 0)
    }

    pub fn down(ticks: &[Tick]) -> Self {
        Self::along(ticks, 1)
    }

    fn along(ticks: &[Tick], axis: usize) -> Self {
        assert!(ticks.len() > 1, "{} ticks", ticks.len());
        let end = |tick: &Tick| (tick.place[axis], tick.value);
        Self {
            from: end(&ticks[0]),
            to: end(&ticks[ticks.len() - 1]),
        }
    }

    /// Where a value lies on the sheet, mm.
    pub fn place(&self, value: f64) -> f64 {
        let share = (value - self.from.1) / (self.to.1 - self.from.1);
        self.from.0 + share * (self.to.0 - self.from.0)
    }

    /// The value at a place of the sheet.
    pub fn value(&self, place: f64) -> f64 {
        let share = (place - self.from.0) / (self.to.0 - self.from.0);
        self.from.1 + share * (self.to.1 - self.from.1)
    }
}

impl Picture {
    /// The colour at a place of the sheet.
    pub fn colour(&self, x: f64, y: f64) -> [u8; 3] {
        let [left, top, width, height] = self.area;
        let column = (x - left) / width * f64::from(self.pixels.width);
        let row = (y - top) / height * f64::from(self.pixels.height);
        self.pixels.pixel(column as u32, row as u32)
    }

    /// Where on the sheet the bar has the colour that comes nearest.
    pub fn row_of(&self, colour: [u8; 3]) -> f64 {
        let rows = 0..self.pixels.height;
        let row = rows
            .min_by_key(|row| difference(self.pixels.pixel(0, *row), colour))
            .unwrap();
        let share = (f64::from(row) + 0.5) / f64::from(self.pixels.height);
        self.area[1] + share * self.area[3]
    }

    /// The middle of the picture across, mm.
    pub fn middle(&self) -> f64 {
        self.area[0] + self.area[2] / 2.0
    }

    /// Its upper and its lower end, mm.
    pub fn ends(&self) -> [f64; 2] {
        [self.area[1], self.area[1] + self.area[3]]
    }
}

/// Whose line or area a path is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// A title, a number, or other words.
    Letters,
    Frame,
    /// A curve, a stem or a limit.
    Curve,
    Dots,
}

/// A path with the rectangle that it lies in, mm.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    pub part: Part,
    pub label: String,
    /// The least x and y, and the largest.
    pub least: [f64; 2],
    pub most: [f64; 2],
}

/// All paths but ticks.
pub fn drawn(svg: &str) -> Vec<Drawn> {
    let paths = svg.lines().filter(|line| line.starts_with("<path"));
    paths.filter_map(drawn_by).collect()
}

fn drawn_by(line: &str) -> Option<Drawn> {
    const BLACK: &str = "#000000";
    let steps = attribute(line, "d");
    let (fill, stroke) = (attribute(line, "fill"), attribute_of(line, "stroke"));
    let part = match (fill, stroke) {
        (BLACK, None) => Part::Letters,
        (_, None) => Part::Dots,
        (_, Some(BLACK)) if steps.ends_with('Z') => Part::Frame,
        (_, Some(BLACK)) => return None,
        (_, Some(_)) => Part::Curve,
    };
    let numbers = steps.split(|c: char| c.is_ascii_alphabetic() || c == ' ');
    let numbers = numbers.filter(|number| !number.is_empty());
    let numbers: Vec<f64> = numbers
        .map(|number| number.parse().unwrap_or(f64::NAN))
        .collect();
    let bound = |axis: usize, of: fn(f64, f64) -> f64| {
        let side = numbers.chunks_exact(2).map(|place| place[axis]);
        side.reduce(|one, other| match one.is_nan() || other.is_nan() {
            true => f64::NAN,
            false => of(one, other),
        })
    };
    Some(Drawn {
        part,
        label: attribute_of(line, "aria-label").unwrap_or("").to_owned(),
        least: [bound(0, f64::min)?, bound(1, f64::min)?],
        most: [bound(0, f64::max)?, bound(1, f64::max)?],
    })
}

impl Drawn {
    /// Whether it lies in a rectangle that is larger by `room` on all sides.
    pub fn is_in(&self, least: [f64; 2], most: [f64; 2], room: f64) -> bool {
        (0..2).all(|i| self.least[i] >= least[i] - room && self.most[i] <= most[i] + room)
    }

    /// Whether it stands at least so far from another one.
    pub fn is_apart(&self, other: &Self, distance: f64) -> bool {
        (0..2).any(|i| {
            self.least[i] >= other.most[i] + distance || other.least[i] >= self.most[i] + distance
        })
    }

    pub fn size(&self) -> [f64; 2] {
        [self.most[0] - self.least[0], self.most[1] - self.least[1]]
    }
}
