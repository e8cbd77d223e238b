//! Reads a motion program back into control points, and says at which line something is wrong.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use turnpath_core::DEG;
use turnpath_core::toolpath::{ControlPoint, Section};

use super::format::{END_MARK, LONGEST, PmacFormat, QUANTA_PER_MS, QUANTA_PER_S, TURN_DEG, mark};
use super::scan::{Axis, PLACES, Word, split_comment, words};
use crate::path_reader::{Counted, ReadPath};
use crate::{ReadError, read_csv};

/// 10⁻¹² of a unit.
const ONE: i128 = 10i128.pow(PLACES);
/// A revolution in 10⁻¹² deg.
const TURN: i128 = TURN_DEG as i128 * ONE;
/// Longest line that is read: far beyond any of a program, so that a file which is none does not
/// fill the memory.
const LONGEST_LINE: u64 = 1 << 16;
/// Bytes that are read in one go.
const BUFFER: usize = 1 << 18;
/// The path's axes by their index.
const NAMES: [&str; 3] = ["C", "X", "Z"];

/// A program's path, read point by point.
///
/// Times are counted as the controller counts them, positions summed exactly; so a program in
/// distances gives the same points as one in places.
pub struct PmacReader {
    lines: BufReader<File>,
    path: PathBuf,
    format: PmacFormat,
    line: u64,
    modes: Modes,
    axes: Axes,
    elapsed: i64,
    section: Option<Section>,
    ended: bool,
    counted: Counted,
}

/// What stands until another statement changes it.
struct Modes {
    /// Places or distances for each axis, once the program has said it: what a controller takes
    /// before is what ran last on it.
    absolute: [Option<bool>; 3],
    /// A segment's time in quanta.
    time: Option<i64>,
}

/// Where the axes stand, in 10⁻¹² of the program's units.
#[derive(Default)]
struct Axes {
    /// As the program says; C unwrapped.
    place: Option<[i128; 3]>,
    velocity: [i128; 3],
}

/// The axis words of one line.
type Line = [Option<(i128, Option<i128>)>; 3];

impl PmacReader {
    /// Opens a program that is laid out so.
    ///
    /// # Errors
    /// When there is no such file.
    pub fn open(path: impl Into<PathBuf>, format: PmacFormat) -> Result<Self, ReadError> {
        let path = path.into();
        let file = match File::open(&path) {
            Ok(file) => file,
            Err(error) => return Err(ReadError::File { path, error }),
        };
        let modes = Modes {
            absolute: [None; 3],
            time: None,
        };
        Ok(Self {
            lines: BufReader::with_capacity(BUFFER, file),
            path,
            format,
            line: 0,
            modes,
            axes: Axes::default(),
            elapsed: 0,
            section: None,
            ended: false,
            counted: Counted::default(),
        })
    }

    /// Messages name this file instead of the one that is read.
    pub fn named(self, path: impl AsRef<Path>) -> Self {
        Self {
            path: path.as_ref().to_owned(),
            ..self
        }
    }

    fn wrong(&self, what: String) -> ReadError {
        ReadError::Line {
            path: self.path.clone(),
            line: self.line.max(1),
            what,
        }
    }

    /// The next line into `text`; whether there was one.
    fn read_line(&mut self, text: &mut Vec<u8>) -> Result<bool, ReadError> {
        text.clear();
        let mut limited = (&mut self.lines).take(LONGEST_LINE);
        let read = limited.read_until(b'\n', text);
        let read = read.map_err(|error| ReadError::File {
            path: self.path.clone(),
            error,
        })?;
        self.line += u64::from(read > 0);
        if read as u64 == LONGEST_LINE {
            return Err(self.wrong("this line is longer than any of a program".to_owned()));
        }
        Ok(read > 0)
    }

    /// What is missing where the file ends too early.
    fn not_whole(&self) -> ReadError {
        self.wrong(match self.section {
            None => format!(
                "there is no path: the line `; {}` is missing",
                mark(Section::Cutting)
            ),
            Some(_) => {
                format!("the program ends without the line `; {END_MARK} --`: it is not whole")
            }
        })
    }

    /// A comment may be a mark.
    fn see_comment(&mut self, comment: &[u8]) -> Result<(), String> {
        let text = String::from_utf8_lossy(comment).trim().to_ascii_lowercase();
        if !text.starts_with("--") {
            return Ok(());
        }
        let sections = [Section::LeadIn, Section::Cutting, Section::LeadOut];
        if let Some(section) = sections.into_iter().find(|section| text == mark(*section)) {
            if self.section.is_some_and(|last| section <= last) {
                return Err(format!(
                    "`; {text}` does not belong behind what came before"
                ));
            }
            self.section = Some(section);
        } else if self.section.is_some() && text.starts_with(END_MARK) {
            self.ended = true;
            let digits: String = text.chars().filter(char::is_ascii_digit).collect();
            let points: u64 = digits
                .parse()
                .map_err(|_| "the end mark must say how many points the path has".to_owned())?;
            if points != self.counted.count() {
                let count = self.counted.count();
                return Err(format!(
                    "the path has {count} points, and its end says {points}"
                ));
            }
        }
        Ok(())
    }

    /// The control point that a line's code ends at, if it moves.
    fn see_code(&mut self, code: &[u8]) -> Result<Option<ControlPoint>, String> {
        let code = std::str::from_utf8(code).map_err(|_| "this is no text".to_owned())?;
        let mut line: Line = [None; 3];
        for word in words(code)? {
            let moved = line.iter().any(Option::is_some);
            match word {
                Word::Move(axis, position, velocity) => put(&mut line, axis, position, velocity)?,
                _ if moved => return Err("a mode stands behind a move on its line".to_owned()),
                Word::Absolute(absolute, axes) => {
                    for (mode, chosen) in self.modes.absolute.iter_mut().zip(axes) {
                        *mode = if chosen { Some(absolute) } else { *mode };
                    }
                }
                Word::Time(ms) => self.modes.time = Some(quanta(ms)?),
            }
        }
        if line.iter().all(Option::is_none) {
            return Ok(None);
        }
        self.go(&line)?;
        Ok(Some(self.point()))
    }

    /// Moves the axes to the end of a segment.
    fn go(&mut self, line: &Line) -> Result<(), String> {
        let time = self
            .modes
            .time
            .ok_or("a move without a `PVT` time before it")?;
        let [Some(c), Some(x), Some(z)] = self.modes.absolute else {
            return Err("a move before `ABS` or `INC` has said how to read it".to_owned());
        };
        let absolute = [c, x, z];
        let Some(last) = self.axes.place else {
            self.axes.place = Some(first_place(line, absolute)?);
            self.axes.velocity = velocities(line);
            return Ok(());
        };
        let mut place = last;
        for (k, word) in line.iter().enumerate() {
            let Some((position, _)) = word else { continue };
            place[k] = match absolute[k] {
                false => last[k] + position,
                true if k == 0 && self.format.c_wrapped => last[k] + nearest(position - last[k]),
                true => *position,
            };
        }
        self.axes.place = Some(place);
        self.axes.velocity = velocities(line);
        self.elapsed += time;
        Ok(())
    }

    /// Where the axes stand, as a control point.
    fn point(&self) -> ControlPoint {
        let format = &self.format;
        let (sign, per) = (format.c_sign(), format.velocity_time());
        let unit = |value: i128| value as f64 / ONE as f64;
        let [c, x, z] = self.axes.place.unwrap_or_default().map(unit);
        let [vc, vx, vz] = self.axes.velocity.map(|v| unit(v) / per);
        ControlPoint {
            t: self.elapsed as f64 / QUANTA_PER_S,
            c: sign * c * DEG,
            x,
            z: z + format.z_above,
            vc: sign * vc * DEG,
            vx,
            vz,
        }
    }
}

impl ReadPath for PmacReader {
    fn next_point(&mut self) -> Result<Option<(ControlPoint, Section)>, ReadError> {
        let mut text = Vec::new();
        while !self.ended {
            if !self.read_line(&mut text)? {
                return Err(self.not_whole());
            }
            let (code, comment) = split_comment(&text);
            if let Some(comment) = comment {
                self.see_comment(comment).map_err(|what| self.wrong(what))?;
            }
            // What stands before the path is the header's.
            let Some(section) = self.section else {
                continue;
            };
            let point = self.see_code(code).map_err(|what| self.wrong(what))?;
            if let Some(point) = point {
                read_csv::check_turn(self.counted.last(), &point, section)
                    .map_err(|what| self.wrong(what))?;
                self.counted.see(point, section);
                return Ok(Some((point, section)));
            }
        }
        Ok(None)
    }

    fn counted(&self) -> &Counted {
        &self.counted
    }

    fn counted_mut(&mut self) -> &mut Counted {
        &mut self.counted
    }
}

fn put(line: &mut Line, axis: Axis, position: i128, velocity: Option<i128>) -> Result<(), String> {
    let k = match axis {
        Axis::C => 0,
        Axis::X => 1,
        Axis::Z => 2,
    };
    if line[k].is_some() {
        return Err(format!("{} stands twice on this line", NAMES[k]));
    }
    line[k] = Some((position, velocity));
    Ok(())
}

/// A time in the controller's steps.
fn quanta(ms: i128) -> Result<i64, String> {
    let steps = (ms * i128::from(QUANTA_PER_MS) + ONE / 2).div_euclid(ONE);
    i64::try_from(steps)
        .ok()
        .filter(|steps| (1..=LONGEST).contains(steps))
        .ok_or_else(|| {
            let ms = ms as f64 / ONE as f64;
            format!("a segment cannot take {ms} ms: 1/4096 ms to 4095.9998 ms")
        })
}

/// The first point must say where all axes are.
fn first_place(line: &Line, absolute: [bool; 3]) -> Result<[i128; 3], String> {
    let mut place = [0; 3];
    for (k, word) in line.iter().enumerate() {
        let Some((position, _)) = word else {
            return Err(format!("the first point does not say {}", NAMES[k]));
        };
        if !absolute[k] {
            return Err("the first point must be a place: `ABS`".to_owned());
        }
        place[k] = *position;
    }
    Ok(place)
}

/// An axis without a velocity ends at rest.
fn velocities(line: &Line) -> [i128; 3] {
    line.map(|word| word.and_then(|(_, velocity)| velocity).unwrap_or(0))
}

/// An angle as the way of less than half a revolution that ends there.
fn nearest(angle: i128) -> i128 {
    (angle + TURN / 2).rem_euclid(TURN) - TURN / 2
}
