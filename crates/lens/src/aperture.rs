//! The part of a surface that is used.

use crate::error::{LensProblem, ProblemKind};
use crate::keys::is_other_aperture;
use crate::numbers::{no_number, number};
use crate::record::Record;
use crate::surface_block::SurfaceBlock;

/// Where something comes from that the caller said.
pub const AS_ASKED_FOR: &str = "as asked for";

/// A circle on a surface, in the frame in which it is given.
#[derive(Debug, Clone, PartialEq)]
pub struct Aperture {
    /// Its radius, mm.
    pub radius: f64,
    /// The radius of its hole, mm; 0 without one.
    pub inner: f64,
    /// x of its middle, mm.
    pub x: f64,
    /// y of its middle, mm.
    pub y: f64,
    /// Where it comes from: a line, or the caller.
    pub origin: String,
}

/// The aperture of a surface; `unit` is the file's unit in mm, `given` a radius in mm that goes
/// before the file's.
pub fn read_aperture(
    block: &SurfaceBlock<'_>,
    unit: f64,
    given: Option<f64>,
) -> Result<Aperture, LensProblem> {
    let [x, y] = match block.only("OBDC")? {
        None => [0.0; 2],
        Some(record) => pair(record)?,
    };
    let (radius, inner, origin) = match given {
        Some(radius) => (radius / unit, 0.0, AS_ASKED_FOR.to_owned()),
        None => of_file(block)?,
    };
    Ok(Aperture {
        radius: radius * unit,
        inner: inner * unit,
        x: x * unit,
        y: y * unit,
        origin,
    })
}

/// Outer and inner radius in the file's unit: the clear aperture, else the semi-diameter.
fn of_file(block: &SurfaceBlock<'_>) -> Result<(f64, f64, String), LensProblem> {
    if let Some(record) = block.records.iter().find(|one| is_other_aperture(one.key)) {
        let key = record.key.to_owned();
        return Err(ProblemKind::ApertureForm { key }.at(record.line));
    }
    for key in ["CLAP", "FLAP"] {
        if let Some(record) = block.only(key)? {
            let [inner, outer] = pair(record)?;
            return ring(record, inner, outer);
        }
    }
    match block.only("DIAM")? {
        Some(record) => ring(record, 0.0, number(record.line, record.words().next())?),
        None => {
            let number = block.number;
            Err(ProblemKind::NoAperture { number }.at(block.line))
        }
    }
}

fn ring(record: &Record<'_>, inner: f64, outer: f64) -> Result<(f64, f64, String), LensProblem> {
    if outer <= 0.0 || inner < 0.0 {
        return Err(no_number(record.line, record.rest, "radius above 0"));
    }
    if inner >= outer {
        return Err(ProblemKind::Hole { inner, outer }.at(record.line));
    }
    let is_worked_out = record.key == "DIAM" && record.words().nth(1) == Some("0");
    let remark = match is_worked_out {
        true => ", as the design program found it from its rays",
        false => "",
    };
    let origin = format!("line {}: {}{remark}", record.line, record.key);
    Ok((outer, inner, origin))
}

fn pair(record: &Record<'_>) -> Result<[f64; 2], LensProblem> {
    let mut words = record.words();
    Ok([
        number(record.line, words.next())?,
        number(record.line, words.next())?,
    ])
}
