//! The dry run of a program: it turns C to some angles with the tool high above the rim, and stops at
//! each, so that a person sees which side of the part lies under the tool.
//!
//! Nothing in it goes lower than the plane of the program's approach.

use crate::layout::Layout;
use crate::program_format::{DRY_RUN_MARK, END_OF_DRY_RUN_MARK, TURN_DEG};
use crate::template::plain_text;
use crate::travel::{C, Extent, Travel, X, Z};
use crate::travel_check::TravelCheck;

/// A stop of a dry run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DryStop {
    /// The path's C, whole degrees.
    pub c_deg: i64,
    /// What a person should see there.
    pub said: String,
}

/// Why a dry run is not written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("its line {line}, as read back, would not do: {what}")]
pub struct DryRunError {
    /// The line, from 1.
    pub line: u64,
    /// What is wrong with it.
    pub what: String,
}

impl Layout {
    /// The program of a dry run at the radius `x`, mm, over a path of this extent. `said` are lines at its
    /// beginning; header and footer are those of the path's program. The text is read back before it is
    /// given.
    ///
    /// # Errors
    /// When a move of its own text is not over the plane.
    pub fn dry_run(
        &self,
        extent: &Extent,
        x: f64,
        (said, stops): (&[String], &[DryStop]),
        (header, footer): (&str, &str),
    ) -> Result<Vec<u8>, DryRunError> {
        let Self { post, format } = self;
        let comment = post.comment;
        let mut text = String::new();
        for line in said {
            text.push_str(&format!("{comment} {}\n", plain_text(line)));
        }
        text.push_str(header);
        text.push_str(&format!("{comment} {DRY_RUN_MARK}\n"));
        let mut text = text.into_bytes();
        let one = 10i64.pow(format.position_decimals);
        let over_rim = [
            Travel::Begin,
            Travel::Rapid {
                axis: Z,
                to: extent.plane(format),
            },
            Travel::Rapid {
                axis: X,
                to: (x * one as f64).round() as i64,
            },
        ];
        text.extend(self.travel_lines(&over_rim));
        for stop in stops {
            let sign = if format.c_reversed { -1 } else { 1 };
            let to = match format.c_wrapped {
                true => (sign * stop.c_deg).rem_euclid(TURN_DEG),
                false => sign * stop.c_deg,
            };
            text.extend(self.travel_lines(&[Travel::Rapid {
                axis: C,
                to: to * one,
            }]));
            text.extend_from_slice(format!("{comment} {}\n", plain_text(&stop.said)).as_bytes());
            text.extend(self.travel_lines(&[Travel::Stop]));
        }
        text.extend_from_slice(format!("{comment} {END_OF_DRY_RUN_MARK}\n{footer}").as_bytes());
        self.check_dry_run(&text, extent)?;
        Ok(text)
    }

    /// Reads the moves of a dry run back.
    fn check_dry_run(&self, text: &[u8], extent: &Extent) -> Result<(), DryRunError> {
        let one = 10u64.pow(self.format.position_decimals) as f64;
        let mut check = TravelCheck::above(extent.plane(&self.format) as f64 / one);
        let grammar = self.post.dialect.grammar(&self.format);
        let mut inside = false;
        for (line, number) in text.split(|byte| *byte == b'\n').zip(1..) {
            let wrong = |what: String| DryRunError { line: number, what };
            let (code, comment) = grammar.split_comment(line);
            let comment = String::from_utf8_lossy(comment.unwrap_or_default());
            match comment.trim() {
                DRY_RUN_MARK => inside = true,
                END_OF_DRY_RUN_MARK => inside = false,
                _ => {}
            }
            if inside {
                let code = String::from_utf8_lossy(code);
                let places = self.post.dialect.read_travel(code.trim(), &mut check.modes);
                let went = places.and_then(|places| check.go_to(&places, number, &self.format));
                went.map_err(wrong)?;
            }
        }
        check
            .finish()
            .map_err(|(line, what)| DryRunError { line, what })
    }
}
