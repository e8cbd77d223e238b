//! Zygo MetroPro, `.dat`.
//!
//! A binary header, big-endian, of 834 or 4096 bytes, then the intensities as 16-bit numbers, then
//! the phases as signed 32-bit numbers: rows from the top, each from the left. A phase from
//! 2147483640 on is a hole. A height is phase · S · O · λ / R: S is the scale factor of the
//! interferometer (0.5 for a mirror in one reflection), O the obliquity factor, λ the wavelength,
//! and R the number of phases in a wave, which follows from the resolution.

use crate::cells::cells;
use crate::conventions::Conventions;
use crate::error::{MapError, MapProblem, Place};
use crate::map::{Map, Size, check_length, turn_rows};

/// The first bytes of the three editions of the format.
const MAGIC: [[u8; 4]; 3] = [
    [0x88, 0x1b, 0x03, 0x6f],
    [0x88, 0x1b, 0x03, 0x70],
    [0x88, 0x1b, 0x03, 0x71],
];

/// The smallest phase that is none.
const NO_PHASE: i32 = 2_147_483_640;

/// mm in a metre.
const METRE: f64 = 1e3;

/// Bytes of a phase.
const BYTES: usize = 4;

// Where the header has what is read, in bytes.
const HEADER_SIZE: usize = 6;
const INTENSITY_SIZE: usize = 52;
const FRAMES: usize = 56;
const PHASE_SIZE: usize = 68;
const SCALE: usize = 164;
const WAVELENGTH: usize = 168;
const OBLIQUITY: usize = 176;
const LATERAL: usize = 184;
const RESOLUTION: usize = 218;

/// The shortest header.
const SHORTEST: usize = 834;

/// Whether the file begins as the format does.
pub fn is(bytes: &[u8]) -> bool {
    MAGIC.iter().any(|magic| bytes.starts_with(magic))
}

/// Reads a map.
pub fn read(bytes: &[u8], conventions: &Conventions) -> Result<Map, MapError> {
    conventions.no_z_unit()?;
    if !is(bytes) {
        let what = "the file does not begin with the mark of MetroPro";
        return Err(MapError::at_byte(0, MapProblem::Header(what.into())));
    }
    let header = usize::try_from(u32_at(bytes, HEADER_SIZE)?).unwrap_or(usize::MAX);
    if header < SHORTEST {
        return Err(wrong(
            HEADER_SIZE,
            format!("a header of {header} bytes is too short"),
        ));
    }
    let [columns, rows] = sizes(bytes, PHASE_SIZE)?;
    let size =
        Size::new(columns, rows).map_err(|problem| MapError::at_byte(PHASE_SIZE, problem))?;
    let [width, height] = sizes(bytes, INTENSITY_SIZE)?;
    // Files of some programs have intensities and say that there are no frames of them.
    let frames = usize::from(u16_at(bytes, FRAMES)?).max(1);
    let start = header.saturating_add(2 * width * height * frames);
    let unit = unit(bytes)?;
    let lateral = f64::from(f32_at(bytes, LATERAL)?) * METRE;
    let lateral = Some(lateral).filter(|lateral| lateral.is_finite() && *lateral > 0.0);
    let pitch = conventions.pitch([lateral, lateral]);
    let pitch = pitch.map_err(|error| error.placed(Place::Byte(LATERAL)))?;
    let phases = cells::<BYTES>(bytes, start, size)?;
    let height = |(number, bytes): (usize, &[u8; BYTES])| match i32::from_be_bytes(*bytes) {
        NO_PHASE.. => Ok(f64::NAN),
        phase => check_length(f64::from(phase) * unit)
            .map_err(|problem| MapError::at_byte(start + number * BYTES, problem)),
    };
    let heights: Result<Vec<f64>, MapError> = phases.iter().enumerate().map(height).collect();
    let mut heights = heights?;
    turn_rows(columns, &mut heights);
    Ok(Map::around_origin(size, pitch, heights))
}

/// The height of phase 1, mm.
fn unit(bytes: &[u8]) -> Result<f64, MapError> {
    let mut unit = METRE;
    for (at, what) in [
        (SCALE, "scale factor"),
        (OBLIQUITY, "obliquity factor"),
        (WAVELENGTH, "wavelength"),
    ] {
        let factor = f64::from(f32_at(bytes, at)?);
        if !factor.is_finite() || factor == 0.0 {
            return Err(wrong(at, format!("a {what} of {factor} gives no heights")));
        }
        unit *= factor;
    }
    let phases = match u16_at(bytes, RESOLUTION)? {
        0 => 4096.0,
        1 => 32768.0,
        2 => 131_072.0,
        other => {
            let what = format!("a phase resolution of {other} is unknown: 0, 1 and 2 are known");
            return Err(wrong(RESOLUTION, what));
        }
    };
    Ok(unit / phases)
}

fn wrong(at: usize, what: String) -> MapError {
    MapError::at_byte(at, MapProblem::Header(what.into()))
}

/// Width and height.
fn sizes(bytes: &[u8], at: usize) -> Result<[usize; 2], MapError> {
    Ok([
        usize::from(u16_at(bytes, at)?),
        usize::from(u16_at(bytes, at + 2)?),
    ])
}

fn at<const N: usize>(bytes: &[u8], at: usize) -> Result<[u8; N], MapError> {
    let found = bytes.get(at..).and_then(|rest| rest.first_chunk::<N>());
    let short = || MapProblem::Header("the file ends within its header".into());
    found
        .copied()
        .ok_or_else(|| MapError::at_byte(bytes.len(), short()))
}

fn u16_at(bytes: &[u8], place: usize) -> Result<u16, MapError> {
    at(bytes, place).map(u16::from_be_bytes)
}

fn u32_at(bytes: &[u8], place: usize) -> Result<u32, MapError> {
    at(bytes, place).map(u32::from_be_bytes)
}

fn f32_at(bytes: &[u8], place: usize) -> Result<f32, MapError> {
    at(bytes, place).map(f32::from_be_bytes)
}
