//! Reads a motion program back into control points. An error names the line.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use turnpath_core::DEG;
use turnpath_core::toolpath::{ControlPoint, Section};

use super::format::{END_MARK, LONGEST, PmacFormat, QUANTA_PER_MS, QUANTA_PER_S, TURN_DEG, mark};
use super::scan::{Axis, PLACES, Word, split_comment, words};
use crate::ordinary_file;
use crate::path_reader::{ReadCount, ReadPath};
use crate::read_error::ReadError;
use crate::turn::check_turn;

/// 10⁻¹² of a unit.
const ONE: i128 = 10i128.pow(PLACES);
/// A revolution in 10⁻¹² deg.
const TURN: i128 = TURN_DEG as i128 * ONE;
/// Longest line that is read, bytes: far longer than any line of a program, so that a file that is no
/// program does not fill the memory.
const LONGEST_LINE: u64 = 1 << 16;
/// Size of the buffer, bytes.
const BUFFER: usize = 1 << 18;
/// The names of the path's axes, by their index.
const NAMES: [&str; 3] = ["C", "X", "Z"];

/// Reads a program's path point by point, from a file or from any other [`Read`].
///
/// Times are counted as the controller counts them, and positions are summed exactly. So a program
/// with distances gives the same points as one with positions.
pub struct PmacReader<R = File> {
    lines: BufReader<R>,
    path: PathBuf,
    format: PmacFormat,
    line: u64,
    modes: Modes,
    axes: Axes,
    elapsed: i64,
    section: Option<Section>,
    ended: bool,
    read_count: ReadCount,
}

/// The settings that apply until another statement changes them.
struct Modes {
    /// Whether each axis has positions instead of distances. `None` until the program sets it, because
    /// a controller begins with the mode of the program before.
    absolute: [Option<bool>; 3],
    /// The time of a segment in quanta.
    time: Option<i64>,
}

/// The state of the axes, in 10⁻¹² of the program's units.
#[derive(Default)]
struct Axes {
    /// The program's positions, C unwrapped; `None` before the first point.
    position: Option<[i128; 3]>,
    velocity: [i128; 3],
}

/// Position and velocity of each axis that one line moves.
type Line = [Option<(i128, Option<i128>)>; 3];

impl PmacReader {
    /// Opens a program with this layout.
    ///
    /// # Errors
    /// When the file cannot be opened.
    pub fn open(path: impl Into<PathBuf>, format: PmacFormat) -> Result<Self, ReadError> {
        let path = path.into();
        match ordinary_file::open(&path) {
            Ok(file) => Ok(Self::from_reader(file, path, format)),
            Err(error) => Err(ReadError::File { path, error }),
        }
    }
}

impl<R: Read> PmacReader<R> {
    /// Reads a program with this layout from `reader`, for example from bytes in memory. Errors name
    /// `path`.
    pub fn from_reader(reader: R, path: impl Into<PathBuf>, format: PmacFormat) -> Self {
        let modes = Modes {
            absolute: [None; 3],
            time: None,
        };
        Self {
            lines: BufReader::with_capacity(BUFFER, reader),
            path: path.into(),
            format,
            line: 0,
            modes,
            axes: Axes::default(),
            elapsed: 0,
            section: None,
            ended: false,
            read_count: ReadCount::default(),
        }
    }

    /// Errors name this file instead of the one that is read.
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

    /// Reads the next line into `text`; `false` at the end of the file.
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
            return Err(self.wrong("this line is longer than any line of a program".to_owned()));
        }
        Ok(read > 0)
    }

    /// The error of a file that ends too early.
    fn incomplete(&self) -> ReadError {
        self.wrong(match self.section {
            None => format!(
                "there is no path: the line `; {}` is missing",
                mark(Section::Cutting)
            ),
            Some(_) => {
                format!("the program ends without the line `; {END_MARK} --`: it is not complete")
            }
        })
    }

    /// Reads a comment, which may be a mark.
    fn read_comment(&mut self, comment: &[u8]) -> Result<(), String> {
        let text = String::from_utf8_lossy(comment).trim().to_ascii_lowercase();
        if !text.starts_with("--") {
            return Ok(());
        }
        let sections = [Section::LeadIn, Section::Cutting, Section::LeadOut];
        if let Some(section) = sections.into_iter().find(|section| text == mark(*section)) {
            if self.section.is_some_and(|last| section <= last) {
                return Err(format!(
                    "`; {text}` is out of order: the sections are lead-in, cutting, lead-out"
                ));
            }
            self.section = Some(section);
        } else if self.section.is_some() && text.starts_with(END_MARK) {
            self.ended = true;
            let digits: String = text.chars().filter(char::is_ascii_digit).collect();
            let points: u64 = digits
                .parse()
                .map_err(|_| "the end mark must give the number of points".to_owned())?;
            if points != self.read_count.points() {
                let count = self.read_count.points();
                return Err(format!(
                    "the path has {count} points, but its end mark says {points}"
                ));
            }
        }
        Ok(())
    }

    /// Reads a line's code; the control point that it moves to, if it moves.
    fn read_code(&mut self, code: &[u8]) -> Result<Option<ControlPoint>, String> {
        let code = std::str::from_utf8(code).map_err(|_| "this is not text".to_owned())?;
        let mut line: Line = [None; 3];
        for word in words(code)? {
            let moved = line.iter().any(Option::is_some);
            match word {
                Word::Move(axis, position, velocity) => {
                    add_move(&mut line, axis, position, velocity)?
                }
                _ if moved => return Err("a mode follows a move on the same line".to_owned()),
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
        self.move_axes(&line)?;
        Ok(Some(self.point()))
    }

    /// Moves the axes to the end of a segment.
    fn move_axes(&mut self, line: &Line) -> Result<(), String> {
        let time = self
            .modes
            .time
            .ok_or("a move without a `PVT` time before it")?;
        let [Some(c), Some(x), Some(z)] = self.modes.absolute else {
            return Err("a move before `ABS` or `INC`".to_owned());
        };
        let absolute = [c, x, z];
        let Some(last) = self.axes.position else {
            self.axes.position = Some(first_position(line, absolute)?);
            self.axes.velocity = velocities(line);
            return Ok(());
        };
        let mut target = last;
        for (k, word) in line.iter().enumerate() {
            let Some((position, _)) = word else { continue };
            target[k] = match absolute[k] {
                false => last[k] + position,
                true if k == 0 && self.format.c_wrapped => last[k] + nearest(position - last[k]),
                true => *position,
            };
        }
        self.axes.position = Some(target);
        self.axes.velocity = velocities(line);
        self.elapsed += time;
        Ok(())
    }

    /// The state of the axes as a control point.
    fn point(&self) -> ControlPoint {
        let format = &self.format;
        let (sign, per) = (format.c_sign(), format.velocity_time());
        let unit = |value: i128| value as f64 / ONE as f64;
        let [c, x, z] = self.axes.position.unwrap_or_default().map(unit);
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

impl<R: Read> ReadPath for PmacReader<R> {
    fn next_point(&mut self) -> Result<Option<(ControlPoint, Section)>, ReadError> {
        let mut text = Vec::new();
        while !self.ended {
            if !self.read_line(&mut text)? {
                return Err(self.incomplete());
            }
            let (code, comment) = split_comment(&text);
            if let Some(comment) = comment {
                self.read_comment(comment)
                    .map_err(|what| self.wrong(what))?;
            }
            // The lines before the path belong to the header.
            let Some(section) = self.section else {
                continue;
            };
            let point = self.read_code(code).map_err(|what| self.wrong(what))?;
            if let Some(point) = point {
                check_turn(self.read_count.last(), &point, section)
                    .map_err(|what| self.wrong(what))?;
                self.read_count.add(point, section);
                return Ok(Some((point, section)));
            }
        }
        Ok(None)
    }

    fn read_count(&self) -> &ReadCount {
        &self.read_count
    }

    fn read_count_mut(&mut self) -> &mut ReadCount {
        &mut self.read_count
    }
}

fn add_move(
    line: &mut Line,
    axis: Axis,
    position: i128,
    velocity: Option<i128>,
) -> Result<(), String> {
    let k = match axis {
        Axis::C => 0,
        Axis::X => 1,
        Axis::Z => 2,
    };
    if line[k].is_some() {
        return Err(format!("{} appears twice on this line", NAMES[k]));
    }
    line[k] = Some((position, velocity));
    Ok(())
}

/// A time in the controller's time steps.
fn quanta(ms: i128) -> Result<i64, String> {
    let steps = (ms * i128::from(QUANTA_PER_MS) + ONE / 2).div_euclid(ONE);
    i64::try_from(steps)
        .ok()
        .filter(|steps| (1..=LONGEST).contains(steps))
        .ok_or_else(|| {
            let ms = ms as f64 / ONE as f64;
            format!("a segment cannot take {ms} ms, only 1/4096 ms to 4095.9998 ms")
        })
}

/// The position of the first point, which must give all axes.
fn first_position(line: &Line, absolute: [bool; 3]) -> Result<[i128; 3], String> {
    let mut first = [0; 3];
    for (k, word) in line.iter().enumerate() {
        let Some((position, _)) = word else {
            return Err(format!("the first point does not give {}", NAMES[k]));
        };
        if !absolute[k] {
            return Err("the first point must be a position: write `ABS` before it".to_owned());
        }
        first[k] = *position;
    }
    Ok(first)
}

/// The velocities of a line. An axis without a velocity ends at rest.
fn velocities(line: &Line) -> [i128; 3] {
    line.map(|word| word.and_then(|(_, velocity)| velocity).unwrap_or(0))
}

/// An angle, wrapped to less than half a revolution.
fn nearest(angle: i128) -> i128 {
    (angle + TURN / 2).rem_euclid(TURN) - TURN / 2
}
