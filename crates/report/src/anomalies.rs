//! Rows of a file that are not as the recipe gives them, or that stand out among their neighbours.
//! They change no verdict.

use serde::{Deserialize, Serialize};

use crate::place::PathPlace;
use crate::unit;

/// The anomalies of a path.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Anomalies {
    /// What the rows were compared with.
    #[serde(default)]
    pub compared_with: Standard,
    /// Why the rows were not compared with those of the recipe; `None` if they were.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub not_compared_because: Option<String>,
    /// How many there are.
    pub count: u64,
    /// The worst of them, the worst one first.
    pub places: Vec<Anomaly>,
}

/// What the rows of a file are compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Standard {
    /// The rows of the path that the recipe gives.
    Recipe,
    /// The rows around each one. This is a guess: honest paths have steps too.
    #[default]
    Neighbours,
}

/// One row that is wrong, or a few neighbours that differ from those around.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Anomaly {
    /// Which control point of the file, counted from 1.
    pub point: u64,
    /// Where it is.
    pub at: PathPlace,
    /// What is wrong.
    pub kind: AnomalyKind,
    /// In which columns a row differs; empty for other kinds.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub columns: Vec<Column>,
    /// How far the played path is moved along z, mm; of a gap the step along the rim. Not finite if
    /// there is nothing to compare with.
    #[serde(rename = "by_nm", with = "unit::nm")]
    pub by: f64,
    /// What the points around have, mm; `None` if they were not asked.
    #[serde(default, rename = "neighbours_nm", with = "unit::nm")]
    pub neighbours: Option<f64>,
}

/// What is wrong at an anomaly.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AnomalyKind {
    /// A row of the recipe's path is not in the file.
    RowLost,
    /// A row of the file is not in the recipe's path.
    RowAdded,
    /// A row differs from that of the recipe's path.
    RowDiffers,
    /// Z is off the first touch.
    ZPosition,
    /// The acceleration of C steps.
    CMotion,
    /// The acceleration of X steps.
    XMotion,
    /// The acceleration of Z steps.
    ZMotion,
    /// A row is missing among even steps.
    Gap,
}

/// A column of a file of a tool path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Column {
    /// The time since the row before.
    Time,
    /// C.
    C,
    /// X.
    X,
    /// Z.
    Z,
    /// dC/dt.
    Vc,
    /// dX/dt.
    Vx,
    /// dZ/dt.
    Vz,
    /// The section.
    Section,
}
