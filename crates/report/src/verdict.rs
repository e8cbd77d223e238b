//! Which tolerances and limits hold.

use serde::{Deserialize, Serialize};

/// A tolerance or a limit holds when the figure is at most this times it. A figure that was aimed
/// exactly at its tolerance may exceed it by rounding, which does not count.
const ALLOWANCE: f64 = 1.001;

/// Whether a figure is within a tolerance or a limit.
pub fn within(figure: f64, limit: f64) -> bool {
    figure <= ALLOWANCE * limit
}

/// Which tolerances and limits hold. `None` stands for one that a path is not held to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Verdict {
    /// The interpolation error; `None` where the recipe gives a form in place of its tolerance.
    pub interpolation: Option<bool>,
    /// The highest cusp; `None` where the recipe gives a form in place of its tolerance.
    pub residual: Option<bool>,
    /// The form of the machined surface; `None` without a tolerance of it.
    #[serde(default)]
    pub form: Option<bool>,
    /// What stays uncut at the part's edges and around the axis, held to the residual tolerance or
    /// to the form in its place.
    /// `None` where the path is not meant to cover the part.
    pub coverage: Option<bool>,
    /// The machine's limits, over cut and leads; `None` without limits that were measured.
    pub machine: Option<bool>,
    /// The error that the model of the servos predicts; `None` without a tolerance of it.
    #[serde(default)]
    pub servo: Option<bool>,
    /// Whether the leads stay above the first touch, to the interpolation tolerance or to the form
    /// in its place; `None` without leads.
    pub lead: Option<bool>,
    /// Whether the path covers the part; of a file alone, since the law of a run is held to that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reach: Option<bool>,
    /// Whether a file has the bytes that the summary beside it lists; of a file alone, `None` where
    /// no summary lists it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub result: Option<bool>,
    /// Whether the path is there from its beginning to its end; of a file alone, and only if the
    /// recipe asks for leads.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub whole: Option<bool>,
    /// Whether C turns no faster in the cut than the recipe's spindle; of a file alone, since the law of a run
    /// is held to that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spindle: Option<bool>,
    /// The tolerances of the programs, each on its own text; `None` without programs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub programs: Option<bool>,
    /// All that the paths before the finishing one are held to; `None` without such paths.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub passes: Option<bool>,
}

impl Verdict {
    /// Whether everything holds.
    pub fn holds(&self) -> bool {
        self.entries().all(|(_, holds)| holds != Some(false))
    }

    /// Each tolerance or limit by its name, in a fixed order.
    pub fn entries(&self) -> impl Iterator<Item = (&'static str, Option<bool>)> {
        let Self {
            interpolation,
            residual,
            form,
            coverage,
            machine,
            servo,
            lead,
            reach,
            result,
            whole,
            spindle,
            programs,
            passes,
        } = *self;
        [
            ("interpolation", interpolation),
            ("residual", residual),
            ("form", form),
            ("coverage", coverage),
            ("machine", machine),
            ("servo", servo),
            ("lead", lead),
            ("reach", reach),
            ("result", result),
            ("whole", whole),
            ("spindle", spindle),
            ("programs", programs),
            ("passes", passes),
        ]
        .into_iter()
    }

    /// The names of those that do not hold.
    pub fn failures(&self) -> impl Iterator<Item = &'static str> {
        let failed = self.entries().filter(|(_, holds)| *holds == Some(false));
        failed.map(|(name, _)| name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL_HOLD: Verdict = Verdict {
        interpolation: Some(true),
        residual: None,
        form: Some(true),
        coverage: Some(true),
        machine: None,
        servo: None,
        lead: None,
        reach: None,
        result: None,
        whole: None,
        spindle: None,
        programs: Some(true),
        passes: None,
    };

    #[test]
    fn what_a_path_is_not_held_to_holds_nothing_back() {
        assert!(ALL_HOLD.holds());
        assert_eq!(ALL_HOLD.failures().count(), 0);
    }

    #[test]
    fn one_that_fails_is_enough_and_is_named() {
        let verdict = Verdict {
            programs: Some(false),
            servo: Some(false),
            ..ALL_HOLD
        };
        assert!(!verdict.holds());
        assert_eq!(
            verdict.failures().collect::<Vec<_>>(),
            ["servo", "programs"]
        );
    }

    #[test]
    fn a_figure_that_is_no_number_is_within_nothing() {
        assert!(within(1.0005, 1.0) && !within(1.0011, 1.0));
        assert!(!within(f64::NAN, 1.0));
    }
}
