//! A row of `toolpath.csv`, with the units of the file.

use serde::{Deserialize, Serialize};
use turnpath_core::DEG;
use turnpath_core::toolpath::{ControlPoint, Section};

/// The first line of `toolpath.csv`.
///
/// On a path of straight segments, the velocities of a point are the rates of the segment after it.
/// Those of the last point are the rates of the segment before it.
pub const HEADER: [&str; 8] = [
    "time_s",
    "c_deg",
    "x_mm",
    "z_mm",
    "vc_deg_per_s",
    "vx_mm_per_s",
    "vz_mm_per_s",
    "section",
];

/// Columns of numbers; the last column has the sections.
pub(crate) const NUMBERS: usize = HEADER.len() - 1;
/// The units of the columns.
#[cfg(feature = "parquet")]
pub(crate) const UNITS: [&str; HEADER.len()] =
    ["s", "deg", "mm", "mm", "deg/s", "mm/s", "mm/s", "1"];

/// One control point as the file has it. Numbers have the fewest digits from which the same double
/// is read back.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Row {
    time_s: f64,
    c_deg: f64,
    x_mm: f64,
    z_mm: f64,
    vc_deg_per_s: f64,
    vx_mm_per_s: f64,
    vz_mm_per_s: f64,
    section: u8,
}

impl Row {
    /// The row of a control point.
    pub fn new(point: &ControlPoint, section: Section) -> Self {
        Self {
            time_s: point.t,
            c_deg: point.c / DEG,
            x_mm: point.x,
            z_mm: point.z,
            vc_deg_per_s: point.vc / DEG,
            vx_mm_per_s: point.vx,
            vz_mm_per_s: point.vz,
            section: section as u8,
        }
    }

    /// Its numbers, in the order of [`HEADER`].
    pub fn numbers(&self) -> [f64; NUMBERS] {
        [
            self.time_s,
            self.c_deg,
            self.x_mm,
            self.z_mm,
            self.vc_deg_per_s,
            self.vx_mm_per_s,
            self.vz_mm_per_s,
        ]
    }

    /// The control point of a row.
    pub fn point(&self) -> ControlPoint {
        ControlPoint {
            t: self.time_s,
            c: self.c_deg * DEG,
            x: self.x_mm,
            z: self.z_mm,
            vc: self.vc_deg_per_s * DEG,
            vx: self.vx_mm_per_s,
            vz: self.vz_mm_per_s,
        }
    }

    /// The section, if there is one with this number.
    pub fn section(&self) -> Option<Section> {
        [Section::LeadIn, Section::Cutting, Section::LeadOut]
            .into_iter()
            .find(|section| *section as u8 == self.section)
    }
}
