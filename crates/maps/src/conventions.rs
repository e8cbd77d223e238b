//! What the person who has a file knows of it.

use crate::error::{MapError, MapProblem};
use crate::format::Format;
use crate::map::check_pitch;

/// Where the origin of a map lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Origin {
    /// Where the file puts it, or in the middle if the file does not say.
    #[default]
    File,
    /// In the middle of the map.
    Middle,
}

/// What the person who has a file knows of it. What is given goes before what the file says.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Conventions {
    /// The format, if not as the file's name and first bytes say.
    pub format: Option<Format>,
    /// The unit of x, y and pitches in the file, mm.
    pub xy_unit: Option<f64>,
    /// The unit of heights in the file, mm.
    pub z_unit: Option<f64>,
    /// Distance of neighbouring columns, mm.
    pub pitch_x: Option<f64>,
    /// Distance of neighbouring rows, mm.
    pub pitch_y: Option<f64>,
    /// Where the origin lies.
    pub origin: Origin,
}

impl Conventions {
    /// The unit of x and y, from the file if it is not given.
    pub(crate) fn xy_unit(&self, of_file: Option<f64>) -> Result<f64, MapError> {
        let unit = self.xy_unit.or(of_file);
        unit.ok_or_else(|| MapError::of_file(MapProblem::NoUnit { which: "xy_unit" }))
    }

    /// The unit of heights, from the file if it is not given.
    pub(crate) fn z_unit(&self, of_file: Option<f64>) -> Result<f64, MapError> {
        let unit = self.z_unit.or(of_file);
        unit.ok_or_else(|| MapError::of_file(MapProblem::NoUnit { which: "z_unit" }))
    }

    /// Refuses units where the format has its own beyond doubt.
    pub(crate) fn no_z_unit(&self) -> Result<(), MapError> {
        match self.z_unit {
            None => Ok(()),
            Some(_) => Err(MapError::of_file(MapProblem::OwnUnit { which: "z_unit" })),
        }
    }

    /// The pitches, from the file where they are not given, mm.
    pub(crate) fn pitch(&self, of_file: [Option<f64>; 2]) -> Result<[f64; 2], MapError> {
        let pick = |given: Option<f64>, of_file: Option<f64>| {
            let pitch = given.or(of_file);
            let pitch = pitch.ok_or(MapProblem::NoPitch).and_then(check_pitch);
            pitch.map_err(MapError::of_file)
        };
        Ok([
            pick(self.pitch_x, of_file[0])?,
            pick(self.pitch_y, of_file[1])?,
        ])
    }
}

/// A unit of length by its name, mm: `m`, `cm`, `mm`, `um` or `µm`, `nm`, `in`.
pub fn length_unit(name: &str) -> Option<f64> {
    Some(match name {
        "m" => 1e3,
        "cm" => 10.0,
        "mm" => 1.0,
        // The micro sign and the Greek letter look alike.
        "um" | "\u{b5}m" | "\u{3bc}m" => 1e-3,
        "nm" => 1e-6,
        "in" => 25.4,
        _ => return None,
    })
}
