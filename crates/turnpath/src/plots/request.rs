//! What is drawn of the machined surface, as it is asked for, and why it may be refused.

use std::path::PathBuf;

use turnpath_report::text::millimetres;

/// What is drawn: machined − wanted along z. Files without a folder of their own go beside the
/// others.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlotRequest {
    /// A map.
    pub map: Option<MapRequest>,
    /// Angles of profiles through the axis, rad, each with its power spectrum.
    pub profiles: Vec<f64>,
    /// Radii of circles, mm.
    pub circles: Vec<CircleRequest>,
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

/// A circle around the axis: its radius, mm.
pub type CircleRequest = f64;

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
    /// The angle of a profile is none.
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
        deg if deg.abs() < LONG => format!("{} deg", (deg * LONG).round() / LONG),
        deg => format!("{deg:.3e} deg"),
    }
}

/// From here on a power of ten reads better than all digits; also the digits that are kept.
const LONG: f64 = 1e6;

fn part_reaches(inner: f64, outer: f64) -> String {
    let outer = millimetres(outer, 3);
    match inner > 0.0 {
        true => format!("from {} to {outer}", millimetres(inner, 3)),
        false => format!("to {outer}"),
    }
}
