//! A program of one recipe: its post, and how it is laid out.

use std::io::{self, Cursor, Read};
use std::path::{Path, PathBuf};

use turnpath_core::toolpath::{ControlPoint, PathBlock, Section, SectionBlock};

use crate::carry::{CarriedPoints, carried, carry, leads_into_cut, turns_left_out};
use crate::compression::Compression;
use crate::ordinary_file;
use crate::post::Post;
use crate::program_error::ProgramError;
use crate::program_format::{
    APPROACH_MARK, Chords, DEPTHS_MARK, END_MARK, END_OF_DEPTHS_MARK, ProgramFormat, RETREAT_MARK,
    mark,
};
use crate::program_reader::ProgramReader;
use crate::read_error::ReadError;
use crate::text_file::{self, OpenFile};
use crate::trail::Move;
use crate::travel::{Extent, Travel};

/// A post with the format of one recipe.
#[derive(Debug, Clone, Copy)]
pub struct Layout {
    /// The post.
    pub post: &'static Post,
    /// The format.
    pub format: ProgramFormat,
}

/// Lines of a program.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Lines {
    /// The text.
    pub text: Vec<u8>,
    /// The control points in it: more than those of the path where segments were divided.
    pub points: usize,
    /// From where to where they go; `None` without points.
    pub extent: Option<Extent>,
}

/// Room for the lines of a point, bytes: most need less, and where more is needed the text grows.
const BYTES_OF_POINT: usize = 96;

/// The text in the file at `path`.
pub(crate) fn open_file(compression: Compression, path: &Path) -> io::Result<OpenFile> {
    text_file::open(compression, ordinary_file::open(path)?)
}

impl Layout {
    /// A part of the path as program lines. This needs no file, so several parts can be formatted in
    /// parallel.
    ///
    /// # Errors
    /// When a program cannot carry the path.
    pub fn lines(&self, stretch: &SectionBlock<'_>) -> Result<Lines, ProgramError> {
        let Self { post, format } = self;
        let mut text = Vec::with_capacity(BYTES_OF_POINT * stretch.points.len());
        let opening = format!("{} {}\n", post.comment, mark(stretch.section));
        let mut opening = stretch.opens_section.then_some(opening);
        // Lines between a lead-in and the cut belong to the lead-in: the cut begins at its first point.
        if let Some(opening) = opening.take_if(|_| !leads_into_cut(stretch)) {
            text.extend_from_slice(opening.as_bytes());
        }
        let mut in_time = Ok(());
        let mut extent: Option<Extent> = None;
        let points = carry(format, stretch, &mut |step| {
            if let Some(opening) = opening.take_if(|_| step.reaches_point()) {
                text.extend_from_slice(opening.as_bytes());
            }
            let here = match step {
                Move::Start(digits) => {
                    post.dialect.write_first(&mut text, format, digits);
                    Some(Extent::of(digits, stretch.section))
                }
                Move::Segment { segment, .. } => {
                    if in_time.is_ok() {
                        in_time = post.dialect.check_time(format, segment);
                    }
                    post.dialect.write_segment(&mut text, format, segment);
                    Some(Extent::of(&segment.to, stretch.section))
                }
                Move::Segments(segments) => {
                    if in_time.is_ok() {
                        in_time = post.dialect.write_segments(&mut text, format, segments);
                    }
                    Extent::of_segments(segments, stretch.section)
                }
            };
            extent = match (extent, here) {
                (Some(before), Some(here)) => Some(before.and(here)),
                (before, here) => before.or(here),
            };
        })?;
        in_time.map(|()| Lines {
            text,
            points,
            extent,
        })
    }

    /// The lines between the header and a path of this extent.
    pub(crate) fn approach(&self, extent: Option<&Extent>) -> Vec<u8> {
        let moves = extent.map(|extent| extent.approach(&self.format));
        let approach = self.marked_travel(APPROACH_MARK, &moves.unwrap_or_default());
        [self.depth_lines(DEPTHS_MARK, 0), approach].concat()
    }

    /// The lines that begin a loop over depths, or those that end it, behind their mark.
    fn depth_lines(&self, mark: &str, which: usize) -> Vec<u8> {
        let Self { post, format } = self;
        let depths = format.depths.as_ref();
        let lines = depths.and_then(|depths| post.dialect.depth_lines(format, depths));
        let lines = lines.and_then(|lines| lines.into_iter().nth(which));
        let text = lines.map(|lines| format!("{} {mark}\n{lines}", post.comment));
        text.unwrap_or_default().into_bytes()
    }

    fn marked_travel(&self, mark: &str, moves: &[Travel]) -> Vec<u8> {
        if moves.is_empty() {
            return Vec::new();
        }
        let mut text = format!("{} {mark}\n", self.post.comment).into_bytes();
        text.extend(self.travel_lines(moves));
        text
    }

    /// The lines of moves before or after a path.
    pub(crate) fn travel_lines(&self, moves: &[Travel]) -> Vec<u8> {
        let mut text = Vec::new();
        for one in moves {
            self.post
                .dialect
                .write_travel(&mut text, &self.format, *one);
        }
        text
    }

    /// The lines between the last segment of a path of so many points and the footer: what the dialect
    /// writes there, and the end mark.
    pub(crate) fn end(&self, points: u64, extent: Option<&Extent>) -> Vec<u8> {
        let mut text = Vec::new();
        self.post.dialect.write_last(&mut text, &self.format);
        let moves = extent.map(|extent| extent.retreat(&self.format));
        text.extend(self.marked_travel(RETREAT_MARK, &moves.unwrap_or_default()));
        text.extend(self.depth_lines(END_OF_DEPTHS_MARK, 1));
        let mark = format!("{} {END_MARK}: {points} points --\n", self.post.comment);
        text.extend_from_slice(mark.as_bytes());
        text
    }

    /// A part of the path as a reader finds it in the program: on the controller's times, and in the
    /// program's digits. C is unwrapped, and begins [`Layout::turns_left_out`] later.
    ///
    /// # Errors
    /// When a program cannot carry the path.
    pub fn carried(&self, stretch: &SectionBlock<'_>) -> Result<CarriedPoints, ProgramError> {
        carried(&self.format, stretch)
    }

    /// Whole turns of C, rad, that a program leaves out before the path's first point: not zero only
    /// if its C is wrapped.
    ///
    /// # Errors
    /// When a program cannot carry the point.
    pub fn turns_left_out(&self, first: &ControlPoint) -> Result<f64, ProgramError> {
        turns_left_out(&self.format, first)
    }

    /// Opens a program of this layout. What its name ends with says whether it is compressed.
    ///
    /// # Errors
    /// When the file cannot be opened.
    pub fn open(&self, path: impl Into<PathBuf>) -> Result<ProgramReader<OpenFile>, ReadError> {
        let path = path.into();
        let folder = path.parent().map(Path::to_owned).unwrap_or_default();
        let own = path.clone();
        self.open_as(path, &own, Box::new(move |name| folder.join(name)))
    }

    /// Opens the program `path` of this layout, which is at `place` under another name. Its parts are the
    /// files that `places` gives for the names of their files.
    ///
    /// # Errors
    /// When the file cannot be opened.
    pub fn open_as(
        &self,
        path: impl Into<PathBuf>,
        place: &Path,
        places: Box<dyn Fn(&str) -> PathBuf + Send + Sync>,
    ) -> Result<ProgramReader<OpenFile>, ReadError> {
        let path = path.into();
        let compression = Compression::of_file(&path);
        match open_file(compression, place) {
            Ok(file) => Ok(self
                .read(file, path)
                .with_parts(Box::new(move |name| open_file(compression, &places(name))))),
            Err(error) => Err(ReadError::File { path, error }),
        }
    }

    /// Reads a program of this layout from `reader`, for example from bytes in memory. Errors name
    /// `path`.
    pub fn read<R: Read>(&self, reader: R, path: impl Into<PathBuf>) -> ProgramReader<R> {
        ProgramReader::new(reader, path.into(), self.post, &self.format)
    }

    /// Reads a program of one or several files in memory. The first one is the main program. What its name
    /// ends with says whether the files are compressed.
    ///
    /// # Errors
    /// When this build does not read files that are compressed so.
    pub fn read_files(
        &self,
        files: Vec<(String, Vec<u8>)>,
    ) -> Result<ProgramReader<OpenFile>, ReadError> {
        let (name, bytes) = files.first().cloned().unwrap_or_default();
        let compression = Compression::of_file(Path::new(&name));
        let text = move |bytes: Vec<u8>| text_file::open(compression, Cursor::new(bytes));
        let open = move |name: &str| -> io::Result<OpenFile> {
            let found = files.iter().find(|(file, _)| file == name);
            let bytes = found.map(|(_, bytes)| bytes.clone());
            text(bytes.ok_or_else(|| io::Error::from(io::ErrorKind::NotFound))?)
        };
        match text(bytes) {
            Ok(main) => Ok(self.read(main, name).with_parts(Box::new(open))),
            Err(error) => Err(ReadError::File {
                path: name.into(),
                error,
            }),
        }
    }

    /// The same layout with one line for each segment, of any time.
    fn without_limits(&self) -> Self {
        let chords = self.format.chords.map(|chords| Chords {
            deviation: f64::INFINITY,
            shortest: 1,
            slowest: None,
            ..chords
        });
        let format = ProgramFormat {
            shortest: 1,
            chords,
            ..self.format
        };
        Self { format, ..*self }
    }

    /// A rough estimate of the bytes of a program with so many points. It is made from invented points
    /// in the middle of the path, which have all digits and one common time. If every point has a time
    /// of its own, the program may be larger by half.
    pub fn expected_bytes(&self, radius: f64, time: f64, c: f64, points: f64) -> f64 {
        let half = |end: f64| 0.5 * end * (1.0 + 1e-7 / 3.0);
        let (speed, step) = (c / time, time / points.max(1.0));
        let point = |k: u32| {
            let t = half(time) + f64::from(k) * step;
            ControlPoint {
                t,
                c: speed * t,
                x: half(radius),
                z: half(radius),
                vc: speed,
                vx: -half(radius) / time,
                vz: half(radius) * speed,
            }
        };
        let layout = self.without_limits();
        let mut block = PathBlock::default();
        block.push(point(1));
        block.push(point(2));
        let stretch = SectionBlock {
            section: Section::Cutting,
            opens_section: false,
            before: &[point(0)],
            points: &block,
        };
        let bytes = layout.lines(&stretch).map_or(0, |lines| lines.text.len());
        points * bytes as f64 / 2.0
    }
}
