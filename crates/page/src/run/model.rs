//! The data of a run's page, in mm, rad and s.

use serde::{Deserialize, Serialize};
use turnpath_report::{AxisNotes, PathSketch, RunReport, Samples, unit};

/// The data of a run's page.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunPage {
    /// What the run gave.
    pub report: RunReport,
    /// What pictures of its path need; `None` where no file of the path can be read.
    pub sketch: Option<PathSketch>,
    /// The surface that was wanted.
    pub surface: SurfaceSketch,
    /// The strategies, in the order of the slots; several of a sum of surfaces.
    pub chain: Vec<StageChoice>,
    /// What the axes of each file of the path mean.
    pub axes: Vec<FileAxes>,
    /// The text of the recipe, where it is known.
    pub recipe: Option<String>,
}

/// A surface on the square around its part.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SurfaceSketch {
    /// Cells along each side.
    pub cells: usize,
    /// Half of the side, mm.
    #[serde(rename = "half_mm", with = "unit::mm")]
    pub half: f64,
    /// The wanted height, mm: row after row, from the largest y down, and in a row from the smallest
    /// x up; not a number off the part.
    #[serde(rename = "height_um", with = "unit::um")]
    pub heights: Samples,
    /// The height above the best sphere or plane, mm.
    #[serde(rename = "deviation_um", with = "unit::um")]
    pub deviations: Samples,
    /// From what the deviation is; `None` where nothing fits.
    pub best: Option<BestFit>,
}

/// What a surface lies nearest to, by the mean square along z.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum BestFit {
    /// A sphere.
    Sphere {
        /// Its radius, mm: positive where it is hollow towards the tool.
        #[serde(rename = "radius_mm", with = "unit::mm")]
        radius: f64,
    },
    /// A plane.
    Plane,
}

/// What the axes of a file mean.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileAxes {
    /// The file's name.
    pub file: String,
    /// What X, Z and C of it mean.
    pub notes: AxisNotes,
}

/// A strategy that a recipe chooses.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct StageChoice {
    /// The slot's table in the recipe.
    pub slot: String,
    /// The strategy's name.
    pub name: String,
    /// What it does, in a sentence.
    pub summary: String,
    /// Where its method comes from; empty where it says nothing.
    pub source: String,
    /// Its parameters as the recipe gives them.
    pub parameters: Vec<(String, String)>,
    /// Those that the recipe leaves out, with the values that count for them.
    pub defaults: Vec<(String, String)>,
}
