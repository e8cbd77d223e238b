//! Control points of a file that stand out among their neighbours. They change no verdict.

use serde::{Deserialize, Serialize};

use crate::place::PathPlace;
use crate::unit;

/// The anomalies of a path.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Anomalies {
    /// How many there are.
    pub count: u64,
    /// The first of them.
    pub places: Vec<Anomaly>,
}

/// One control point, or a few neighbours, that differ from those around.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Anomaly {
    /// Which control point of the file, counted from 1.
    pub point: u64,
    /// Where it is.
    pub at: PathPlace,
    /// What differs.
    pub kind: AnomalyKind,
    /// By how much, mm: of a gap the step along the rim.
    #[serde(rename = "by_nm", with = "unit::nm")]
    pub by: f64,
    /// What the points around have, mm.
    #[serde(rename = "neighbours_nm", with = "unit::nm")]
    pub neighbours: f64,
}

/// What differs at an anomaly.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AnomalyKind {
    /// Z is off the first touch.
    ZPosition,
    /// The acceleration of C steps.
    CMotion,
    /// The acceleration of X steps.
    XMotion,
    /// The acceleration of Z steps.
    ZMotion,
    /// A row is missing.
    Gap,
}
