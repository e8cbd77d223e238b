//! Motion programs, measured on their own text.

use serde::{Deserialize, Serialize};

use crate::errors::Tolerances;
use crate::unit;
use crate::verdict::within;

/// What a recipe's own header or footer tells the controller besides the path.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ControllerCommand {
    /// The post whose template it is; empty in a report of a version that had one post alone.
    #[serde(default)]
    pub post: String,
    /// `header` or `footer`.
    pub template: String,
    /// The line in it, from 1.
    pub line: u64,
    /// The line without its comment; placeholders stand as the recipe has them.
    pub command: String,
    /// Whether all of its words are known to move nothing, set nothing and start nothing.
    pub harmless: bool,
}

/// The straight lines of a program that plays no cubics.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StraightLines {
    /// How many there are.
    pub lines: u64,
    /// How many stand for one segment of the path, on average.
    pub per_segment: f64,
}

/// A motion program, measured on its own text as it was read back.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ProgramReport {
    /// The file's name.
    pub file: String,
    /// The post that wrote it.
    pub post: String,
    /// Largest interpolation error, mm.
    #[serde(rename = "interpolation_error_nm", with = "unit::nm")]
    pub interpolation_error: f64,
    /// By how much the program's straight lines, digits and times raise the largest interpolation error
    /// above that of the path, mm. It is below zero where rounding happens to be of use; `None` in a report of a version
    /// that did not say it.
    #[serde(default, rename = "raised_by_nm", with = "unit::nm")]
    pub raised_by: Option<f64>,
    /// Whether that holds the interpolation tolerance; `None` without one.
    pub within_interpolation: Option<bool>,
    /// The straight lines; `None` where the program plays cubics.
    #[serde(default)]
    pub straight_lines: Option<StraightLines>,
    /// Peak to valley of the machined surface, mm; `None` without a tolerance of form, or where
    /// nothing is cut.
    #[serde(default, rename = "form_error_nm", with = "unit::nm")]
    pub form_error: Option<f64>,
    /// Whether that holds the tolerance of form; `None` without one.
    #[serde(default)]
    pub within_form: Option<bool>,
    /// The largest step of C's speed at a control point, rad/s, where the controller keeps it within a
    /// segment; `None` where it plays the path's cubics in time.
    #[serde(default, rename = "c_speed_step_deg_per_s", with = "unit::deg")]
    pub c_speed_step: Option<f64>,
    /// Smallest height of Z above the first touch on the leads, mm; `None` without leads.
    #[serde(rename = "lead_clearance_nm", with = "unit::nm")]
    pub lead_clearance: Option<f64>,
    /// Whether the leads stay above the first touch, to the interpolation tolerance or to the form
    /// in its place; `None` without leads.
    pub within_lead: Option<bool>,
}

/// What was measured on a program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProgramFigures {
    /// Largest interpolation error, mm.
    pub interpolation_error: f64,
    /// Largest interpolation error of the path that it carries, mm.
    pub path_error: f64,
    /// The largest step of C's speed at a control point, rad/s, where the controller keeps it within a
    /// segment.
    pub c_speed_step: Option<f64>,
    /// Peak to valley of the machined surface, mm, where it was measured.
    pub form_error: Option<f64>,
    /// Smallest height of Z above the first touch on the leads, mm; `None` without leads.
    pub lead_clearance: Option<f64>,
    /// Straight lines; `None` where the program plays cubics.
    pub lines: Option<u64>,
}

impl ProgramReport {
    /// Judges a program by its figures.
    pub fn new(file: String, post: &str, figures: &ProgramFigures, tolerance: &Tolerances) -> Self {
        let ProgramFigures {
            interpolation_error,
            path_error,
            c_speed_step,
            form_error,
            lead_clearance,
            lines,
        } = *figures;
        let holds = |figure: f64, limit: Option<f64>| limit.map(|limit| within(figure, limit));
        Self {
            file,
            post: post.to_owned(),
            interpolation_error,
            raised_by: Some(interpolation_error - path_error),
            c_speed_step,
            within_interpolation: holds(interpolation_error, tolerance.interpolation),
            straight_lines: lines.map(|lines| StraightLines {
                lines,
                per_segment: f64::NAN,
            }),
            form_error,
            within_form: holds(form_error.unwrap_or(f64::INFINITY), tolerance.form),
            lead_clearance,
            within_lead: lead_clearance
                .and_then(|clearance| holds(-clearance, tolerance.deepest())),
        }
    }

    /// The same beside its path of so many segments.
    #[must_use]
    pub fn beside_path(self, segments: u64) -> Self {
        let straight_lines = self.straight_lines.map(|straight| StraightLines {
            per_segment: straight.lines as f64 / segments.max(1) as f64,
            ..straight
        });
        Self {
            straight_lines,
            ..self
        }
    }

    /// Whether the program holds its tolerances.
    pub fn holds(&self) -> bool {
        let verdicts = [
            self.within_interpolation,
            self.within_form,
            self.within_lead,
        ];
        !verdicts.contains(&Some(false))
    }
}
