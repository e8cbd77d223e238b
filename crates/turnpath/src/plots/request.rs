//! What is drawn of the machined surface, as it is asked for, and why it may be refused.

use std::ops::RangeInclusive;
use std::path::PathBuf;

use turnpath_report::text::millimetres;

/// Points along each side of a grid: fewer make no grid, and more fill the memory.
pub const GRID_POINTS: RangeInclusive<usize> = 2..=20_000;

/// Refuses a grid of too few or too many points along each side.
pub fn check_grid(count: usize) -> Result<(), PlotError> {
    match GRID_POINTS.contains(&count) {
        true => Ok(()),
        false => Err(PlotError::GridPoints { count }),
    }
}

/// What is drawn: machined − wanted along z. Files without a folder of their own go beside the
/// others.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlotRequest {
    /// A map.
    pub map: Option<MapRequest>,
    /// Angles of profiles through the axis, rad, each with its power spectrum.
    pub profiles: Vec<f64>,
    /// Radii of circles, mm.
    pub circles: Vec<f64>,
    /// Whether the power spectra of the played X and Z are written.
    pub spectrum: bool,
}

/// A map of the surface error.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MapRequest {
    /// Its file; the ending chooses the form, `.gsf` or `.xyz`.
    pub file: PathBuf,
    /// Cells along each side; on a polar grid as many rings of as many angles.
    pub cells: usize,
    /// How the cells lie.
    pub grid: MapGrid,
}

/// How the cells of a map lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapGrid {
    /// Squares over the square around the part.
    Cartesian,
    /// Rings and angles.
    Polar,
}

/// Why a plot cannot be drawn as it is asked for.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlotError {
    /// The map's file has an ending that stands for no form.
    #[error(
        "the map {}: a map ends in .gsf (Gwyddion Simple Field) or .xyz (lines of x, y, z)",
        file.display()
    )]
    MapForm {
        /// The file.
        file: PathBuf,
    },
    /// The form of a map has no polar grid.
    #[error("a .gsf map has a Cartesian grid; for a polar one choose .xyz")]
    PolarGsf,
    /// A grid has too few or too many points.
    #[error(
        "a grid has {} to {} points along each side, not {count}",
        GRID_POINTS.start(),
        GRID_POINTS.end()
    )]
    GridPoints {
        /// Points along each side.
        count: usize,
    },
    /// The angle of a profile lies beyond a whole turn.
    #[error("the profile at {}: an angle lies between -360 deg and 360 deg", degrees(*angle))]
    ProfileAngle {
        /// The angle, rad.
        angle: f64,
    },
    /// A circle does not lie on the part.
    #[error(
        "the circle of {radius} mm does not lie on the part, which reaches {}",
        part_reaches(*inner, *outer)
    )]
    CircleOffPart {
        /// The circle's radius, mm.
        radius: f64,
        /// The radius of the hole, mm; 0 without one.
        inner: f64,
        /// The radius of the aperture, mm.
        outer: f64,
    },
    /// Two plots would be one file: names hold no more digits than one can read.
    #[error("two plots would be one file, {}: ask for one of them", file.display())]
    SameFile {
        /// The file.
        file: PathBuf,
    },
    /// A result beside the plot lists a file of this name, whose bytes are to stay.
    #[error("{} is a file of a result: choose another name or another folder", file.display())]
    InResult {
        /// The file.
        file: PathBuf,
    },
    /// Plots are files, and the outputs have no folder.
    #[error("maps, profiles, circles and spectra need an output folder")]
    NoFolder,
    /// Plots are measured on `toolpath.csv`, which the recipe does not write.
    #[error(
        "maps, profiles, circles and spectra are measured on toolpath.csv, which this recipe does \
         not write: add \"csv\" to `data` in [output]"
    )]
    NoToolPath,
}

/// An angle in rad as it was most likely given.
fn degrees(angle: f64) -> String {
    match angle.to_degrees() {
        deg if deg.abs() < LONG_ANGLE => format!("{} deg", (deg * DIGITS).round() / DIGITS),
        deg => format!("{deg:.3e} deg"),
    }
}

/// Angles from which a power of ten reads better than all digits, deg.
const LONG_ANGLE: f64 = 1e6;
/// Digits after the point that are kept: the rest is rounding of the conversion.
const DIGITS: f64 = 1e6;

fn part_reaches(inner: f64, outer: f64) -> String {
    let outer = millimetres(outer, 3);
    match inner > 0.0 {
        true => format!("from {} to {outer}", millimetres(inner, 3)),
        false => format!("to {outer}"),
    }
}
