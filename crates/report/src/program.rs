//! Motion programs, measured on their own text.

use serde::{Deserialize, Serialize};

use crate::coverage::Coverage;
use crate::errors::{Residual, Tolerances};
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
    /// Cusps between the program's own passes; `None` where X goes as on the path, but for its digits, so
    /// that its passes are those of the path.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub residual: Option<Residual>,
    /// Whether these hold the residual tolerance; `None` without one, or where they are those of the path.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub within_residual: Option<bool>,
    /// What the program's own passes leave uncut; `None` where they are those of the path.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coverage: Option<Coverage>,
    /// Whether that holds the residual tolerance, or the form in its place; `None` where the passes are those
    /// of the path, or the path is not meant to cover the part.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub within_coverage: Option<bool>,
    /// Largest error that the servos and the program together leave, mm; `None` without servos.
    #[serde(
        default,
        rename = "servo_error_nm",
        with = "unit::nm",
        skip_serializing_if = "Option::is_none"
    )]
    pub servo_error: Option<f64>,
    /// Whether that holds the tolerance of the servos; `None` without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub within_servo: Option<bool>,
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
    /// Cusps between the program's own passes; `None` where they are those of the path.
    pub residual: Option<Residual>,
    /// What these passes leave uncut.
    pub coverage: Option<Coverage>,
    /// Whether the path is meant to cover the part. What stays uncut is then judged.
    pub covers_part: bool,
    /// The largest step of C's speed at a control point, rad/s, where the controller keeps it within a
    /// segment.
    pub c_speed_step: Option<f64>,
    /// Largest error that the servos and the program together leave, mm; `None` without servos.
    pub servo_error: Option<f64>,
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
            residual,
            coverage,
            covers_part,
            c_speed_step,
            servo_error,
            form_error,
            lead_clearance,
            lines,
        } = *figures;
        let holds = |figure: f64, limit: Option<f64>| limit.map(|limit| within(figure, limit));
        let highest = residual.map(|residual| residual.max.unwrap_or(f64::INFINITY));
        let uncut = coverage.filter(|_| covers_part);
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
            residual,
            within_residual: highest.and_then(|highest| holds(highest, tolerance.residual)),
            coverage,
            within_coverage: uncut
                .and_then(|uncut| holds(uncut.largest(), tolerance.most_material())),
            servo_error,
            within_servo: servo_error.and_then(|error| holds(error, tolerance.servo)),
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
            self.within_residual,
            self.within_coverage,
            self.within_servo,
            self.within_form,
            self.within_lead,
        ];
        !verdicts.contains(&Some(false))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coverage::Uncut;
    use crate::errors::LeftOut;
    use crate::place::PathPlace;

    const TOLERANCE: Tolerances = Tolerances {
        interpolation: Some(1e-3),
        residual: Some(500e-6),
        form: None,
        servo: None,
    };

    fn report(height: Option<f64>, covers_part: bool) -> ProgramReport {
        let residual = height.map(|height| Residual {
            max: Some(height),
            at: PathPlace { c: 0.0, x: 0.0 },
            left_out: LeftOut::Nothing,
        });
        let coverage = height.map(|height| Coverage {
            rim: Some(Uncut {
                height: Some(height),
                c: 0.0,
            }),
            ..Coverage::default()
        });
        let figures = ProgramFigures {
            interpolation_error: 650e-6,
            path_error: 480e-6,
            residual,
            coverage,
            covers_part,
            c_speed_step: None,
            servo_error: None,
            form_error: None,
            lead_clearance: None,
            lines: height.map(|_| 1000),
        };
        ProgramReport::new("q.cnc".to_owned(), "beckhoff-g93", &figures, &TOLERANCE)
    }

    #[test]
    fn passes_of_a_programs_own_are_judged_and_those_of_its_path_are_not() {
        let exceeds = report(Some(502e-6), true);
        assert_eq!(exceeds.within_residual, Some(false));
        assert_eq!(exceeds.within_coverage, Some(false));
        assert!(!exceeds.holds());
        assert!(report(Some(499e-6), true).holds());
        // A path that is not meant to cover the part may leave its edges uncut.
        assert_eq!(report(Some(502e-6), false).within_coverage, None);
        let of_path = report(None, true);
        assert!(of_path.holds());
        let text = serde_json::to_string(&of_path).unwrap();
        for key in ["residual", "coverage"] {
            assert!(!text.contains(key), "{text}");
        }
    }
}
