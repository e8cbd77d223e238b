//! Control points of a file that stand out among their neighbours: told, and held against nothing.

use serde::Serialize;
use turnpath_core::DEG;
use turnpath_verify::{Anomaly, AnomalyKind};

use crate::figures::{grouped, line, millimetres, nanometres};
use crate::summary::{NM_PER_MM, Place};

/// Places that a person is shown.
const SHOWN: usize = 3;

/// Suspicious places of a path.
#[derive(Debug, Serialize)]
pub struct Suspicious {
    /// How many there are.
    pub count: u64,
    /// The first of them.
    pub places: Vec<SuspectPlace>,
}

/// One of them.
#[derive(Debug, Serialize)]
pub struct SuspectPlace {
    /// Which control point of the file, counted from 1.
    pub point: u64,
    at: Place,
    /// `z_position`; `c_motion`, `x_motion`, `z_motion`: the acceleration steps; `gap`: a row is
    /// missing, the figures are steps along the rim.
    what: &'static str,
    by_nm: f64,
    neighbours_nm: f64,
}

impl Suspicious {
    /// In the units of the file.
    pub fn of((count, suspects): (u64, Vec<Anomaly>)) -> Self {
        let places = suspects.iter().map(SuspectPlace::of).collect();
        Self { count, places }
    }

    /// The lines for a person; empty where nothing is suspicious.
    pub fn lines(&self) -> String {
        let mut text = String::new();
        let shown = self.places.iter().take(SHOWN);
        for (i, place) in shown.clone().enumerate() {
            let label = if i == 0 { "suspicious" } else { "" };
            let [whereabouts, what] = place.told();
            text += &line(label, whereabouts);
            text += &line("", what);
        }
        let more = self.count - shown.len() as u64;
        if more > 0 {
            text += &line("", format!("and {} places more", grouped(more)));
        }
        text
    }
}

impl SuspectPlace {
    fn of(suspect: &Anomaly) -> Self {
        Self {
            point: suspect.point,
            at: Place {
                c_deg: suspect.c / DEG,
                x_mm: suspect.x,
            },
            what: match suspect.kind {
                AnomalyKind::Height => "z_position",
                AnomalyKind::MotionOfC => "c_motion",
                AnomalyKind::MotionOfX => "x_motion",
                AnomalyKind::MotionOfZ => "z_motion",
                AnomalyKind::Gap => "gap",
            },
            by_nm: suspect.amount * NM_PER_MM,
            neighbours_nm: suspect.usual * NM_PER_MM,
        }
    }

    /// Where it is, and what.
    fn told(&self) -> [String; 2] {
        let what = match self.what {
            "z_position" => "Z is off the first touch by",
            "c_motion" => "C does not run on: as if off by",
            "x_motion" => "X does not run on: as if off by",
            "gap" => "a row is missing: the step along the rim is",
            _ => "Z does not run on: as if off by",
        };
        let whereabouts = format!(
            "point {}, C = {:.2} deg, X = {}",
            grouped(self.point),
            self.at.c_deg,
            millimetres(self.at.x_mm, 4)
        );
        let (by, usual) = (nanometres(self.by_nm), nanometres(self.neighbours_nm));
        [whereabouts, format!("{what} {by}, {usual} around")]
    }
}
