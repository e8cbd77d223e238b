//! A lens file, and one surface out of it.

use crate::aperture::{AS_ASKED_FOR, Aperture, read_aperture};
use crate::error::{LensError, LensProblem, ProblemKind};
use crate::keys::{is_of_surface, is_other_aperture};
use crate::numbers::number;
use crate::record::{Record, records, shown};
use crate::shape::Shape;
use crate::shape_reader::{ReadShape, read_shape};
use crate::side::{Side, cut_from};
use crate::surface_block::SurfaceBlock;
use crate::system_lines::SystemLines;
use crate::text::decode;

/// What the caller says of the surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Selection {
    /// Its number; without it the only one that is bent.
    pub number: Option<usize>,
    /// The side of the tool; without it the side without material.
    pub side: Option<Side>,
    /// The radius of the part, mm; without it that of the aperture in the file.
    pub radius: Option<f64>,
}

/// Something that the reader should know, and its line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// The line.
    pub line: usize,
    /// What stands there, and what became of it.
    pub text: String,
}

/// A surface of a design, as the tool sees it.
#[derive(Debug, Clone, PartialEq)]
pub struct DesignSurface {
    /// Its number in the design.
    pub number: usize,
    /// Its type, as the file has it.
    pub kind: String,
    /// Its line.
    pub line: usize,
    /// Its comment.
    pub comment: Option<String>,
    /// The title of the design.
    pub title: Option<String>,
    /// Where the tool stands. On the side of −z, x and z are those of the design with their signs
    /// changed.
    pub side: Side,
    /// Why it stands there.
    pub side_origin: &'static str,
    /// The shape, z to the tool.
    pub shape: Shape,
    /// The aperture, in the same frame.
    pub aperture: Aperture,
    /// What does not change the shape, and may matter.
    pub notes: Vec<Note>,
}

/// The text of a lens file.
#[derive(Debug, Clone)]
pub struct LensText(String);

/// The lines of a file, sorted.
struct Lines<'a> {
    system: SystemLines<'a>,
    blocks: Vec<SurfaceBlock<'a>>,
}

impl LensText {
    /// The text of a file's bytes: UTF-16 with its mark, UTF-8, or an ANSI code page.
    ///
    /// # Errors
    /// When they are no text.
    pub fn new(bytes: &[u8]) -> Result<Self, LensError> {
        Ok(Self(decode(bytes)?))
    }

    /// One surface of the design.
    ///
    /// # Errors
    /// When the file has no such surface, when something in it could change the surface and is not
    /// known, or when the file does not say what the selection leaves out.
    pub fn surface(&self, selection: &Selection) -> Result<DesignSurface, LensError> {
        let lines = Lines::sort(&self.0)?;
        let block = lines.choose(selection.number)?;
        let mut problems = lines.system.problems();
        problems.extend(lines.system.cut_off(&self.0));
        if block.number + 1 == lines.blocks.len() {
            let number = block.number;
            problems.push(ProblemKind::LastSurface { number }.at(block.line));
        }
        let unit = keep(lines.unit(), &mut problems).unwrap_or(1.0);
        problems.extend(block_problems(block));
        let shape = match read_shape(block, unit) {
            Ok(shape) => Some(shape),
            Err(found) => {
                problems.extend(found);
                None
            }
        };
        let aperture = read_aperture(block, unit, selection.radius);
        let aperture = keep(aperture, &mut problems);
        let side = match selection.side {
            Some(side) => Some((side, AS_ASKED_FOR)),
            None => keep(cut_from(&lines.blocks, block), &mut problems),
        };
        if let (Some(shape), Some(aperture)) = (&shape, &aperture) {
            problems.extend(zernike_problem(shape, aperture));
        }
        match (shape, aperture, side) {
            (Some(shape), Some(aperture), Some(side)) if problems.is_empty() => {
                Ok(lines.seen_from(block, shape.shape, aperture, side))
            }
            _ => Err(LensError::new(problems)),
        }
    }
}

fn keep<T>(read: Result<T, LensProblem>, problems: &mut Vec<LensProblem>) -> Option<T> {
    read.map_err(|problem| problems.push(problem)).ok()
}

/// What a surface's own lines have that is not known or not fixed.
fn block_problems(block: &SurfaceBlock<'_>) -> Vec<LensProblem> {
    let problem = |record: &Record<'_>| {
        let kind = match record.key {
            "PPAR" => ProblemKind::Solve { key: "PPAR" },
            "PKUP" => ProblemKind::Solve { key: "PKUP" },
            "IGNR" if record.words().next() != Some("0") => ProblemKind::Ignored,
            key if is_of_surface(key) => return None,
            key => ProblemKind::UnknownKey { key: shown(key) },
        };
        Some(kind.at(record.line))
    };
    block.records.iter().filter_map(problem).collect()
}

/// Zernike terms that end within the part would leave a step on it.
fn zernike_problem(read: &ReadShape, aperture: &Aperture) -> Option<LensProblem> {
    let (radius, line) = read.end?;
    let reach = aperture.radius + (aperture.x * aperture.x + aperture.y * aperture.y).sqrt();
    (reach > radius).then(|| ProblemKind::ZernikeEnd { radius, reach }.at(line))
}

impl<'a> Lines<'a> {
    fn sort(text: &'a str) -> Result<Self, LensError> {
        let (mut system, mut blocks) = (Vec::new(), Vec::<SurfaceBlock<'_>>::new());
        let mut is_within = false;
        for record in records(text) {
            if record.key == "SURF" {
                blocks.push(begun(&record, blocks.len())?);
                is_within = true;
                continue;
            }
            is_within = is_within && (record.indented || is_of_surface(record.key));
            match blocks.last_mut().filter(|_| is_within) {
                Some(block) => block.records.push(record),
                None => system.push(record),
            }
        }
        let (Some(first), Some(last)) = (blocks.first(), blocks.last()) else {
            return Err(ProblemKind::NoSurfaces.of_file().into());
        };
        let system = SystemLines::new(system, (first.line, last.line));
        Ok(Self { system, blocks })
    }

    /// The surface of this number, or the only one that is bent.
    fn choose(&self, number: Option<usize>) -> Result<&SurfaceBlock<'a>, LensError> {
        if let Some(number) = number {
            let last = self.blocks.len().saturating_sub(1);
            let missing = || ProblemKind::NoSuchSurface { number, last }.of_file();
            return Ok(self.blocks.get(number).ok_or_else(missing)?);
        }
        let bent: Vec<&SurfaceBlock<'_>> = self.blocks.iter().filter(|one| one.is_bent()).collect();
        match bent.as_slice() {
            [only] => Ok(*only),
            [] => Err(ProblemKind::NoShape.of_file().into()),
            several => {
                let list = several
                    .iter()
                    .take(MOST_LISTED)
                    .map(|one| row(one))
                    .collect();
                Err(ProblemKind::SeveralShapes { list }.of_file().into())
            }
        }
    }

    /// The file's unit, mm.
    fn unit(&self) -> Result<f64, LensProblem> {
        let mut records = self.system.of("UNIT");
        let record = records
            .next()
            .ok_or_else(|| ProblemKind::NoUnit.of_file())?;
        if let Some(second) = records.next() {
            let key = "UNIT".to_owned();
            return Err(ProblemKind::Twice { key }.at(second.line));
        }
        let name = record.words().next().unwrap_or_default();
        Ok(match name.to_ascii_uppercase().as_str() {
            "MM" => 1.0,
            "CM" => 10.0,
            "IN" | "INCH" => 25.4,
            "METER" | "M" => 1e3,
            _ => {
                let name = shown(name);
                return Err(ProblemKind::Unit { name }.at(record.line));
            }
        })
    }

    fn seen_from(
        &self,
        block: &SurfaceBlock<'a>,
        shape: Shape,
        mut aperture: Aperture,
        (side, side_origin): (Side, &'static str),
    ) -> DesignSurface {
        let shape = match side {
            Side::PlusZ => shape,
            Side::MinusZ => {
                // 0 keeps its sign.
                aperture.x = 0.0 - aperture.x;
                shape.seen_from_behind()
            }
        };
        let notes = self.notes(block, &aperture);
        let title = self.system.of("NAME").next();
        let title = title.map(Record::text).filter(|text| !text.is_empty());
        DesignSurface {
            number: block.number,
            kind: block.kind().0,
            line: block.line,
            comment: block.comment().map(str::to_owned),
            title: title.map(str::to_owned),
            side,
            side_origin,
            shape,
            aperture,
            notes,
        }
    }

    /// Whether the part reaches beyond its aperture.
    fn reaches_beyond(&self, record: &Record<'_>, aperture: &Aperture) -> bool {
        let radius = number(record.line, record.words().next());
        let in_mm = radius.and_then(|radius| Ok(radius * self.unit()?));
        in_mm.is_ok_and(|radius| radius > aperture.radius * (1.0 + ROUNDING))
    }

    fn notes(&self, block: &SurfaceBlock<'a>, aperture: &Aperture) -> Vec<Note> {
        let earlier = self.blocks.get(..block.number).unwrap_or_default();
        let breaks = earlier.iter().filter(|one| one.is_break());
        let breaks = breaks.filter_map(|one| {
            let numbers = one.break_numbers();
            let numbers: Vec<String> = numbers
                .iter()
                .map(|(name, value)| format!("{name} {value}"))
                .collect();
            let text = format!(
                "surface {} is a break of coordinates ({}): it places the surface in the design \
                 and is not part of its shape",
                one.number,
                numbers.join(", ")
            );
            let line = one.line;
            (!numbers.is_empty()).then_some(Note { line, text })
        });
        let is_given = aperture.origin == AS_ASKED_FOR;
        let of_edge = block.records.iter().filter(|record| match record.key {
            "OBSC" => true,
            "CLAP" | "FLAP" => is_given,
            "MEMA" => self.reaches_beyond(record, aperture),
            key => is_other_aperture(key),
        });
        let of_edge = of_edge.map(|record| Note {
            line: record.line,
            text: format!("{} {} is not in the recipe", record.key, shown(record.rest)),
        });
        let settings = self.system.unknown_settings().map(|record| Note {
            line: record.line,
            text: format!(
                "{} is not known: it stands before the surfaces, so it is taken to change no shape",
                shown(record.key)
            ),
        });
        breaks.chain(of_edge).chain(settings).collect()
    }
}

/// Part of a radius that is rounding.
const ROUNDING: f64 = 1e-9;

/// Most surfaces that a message lists.
const MOST_LISTED: usize = 30;

/// A surface in a list.
fn row(block: &SurfaceBlock<'_>) -> String {
    let (kind, _) = block.kind();
    let comment = block.comment().map(shown);
    let comment = comment.map_or_else(String::new, |comment| format!(", \"{comment}\""));
    let kind = shown(&kind);
    format!(
        "surface {} (line {}): {kind}{comment}",
        block.number, block.line
    )
}

/// A surface that begins with this line.
fn begun<'a>(record: &Record<'a>, expected: usize) -> Result<SurfaceBlock<'a>, LensProblem> {
    let word = record.words().next().unwrap_or_default();
    if word.parse() == Ok(expected) {
        return Ok(SurfaceBlock {
            number: expected,
            line: record.line,
            records: Vec::new(),
        });
    }
    let found = shown(word);
    Err(ProblemKind::SurfaceNumber { found, expected }.at(record.line))
}
