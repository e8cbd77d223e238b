//! What stays uncut at the part's edges and around the axis, and X beyond the axis, as told.

use serde::Serialize;
use turnpath_core::{DEG, Overrun};
use turnpath_recipe::Recipe;
use turnpath_verify::{CoverageFigures, UncutHeight};

use crate::figures::{against, line, nanometres};
use crate::summary::{NM_PER_MM, UM_PER_MM, holds};

/// X below 0 that is told as a crossing, µm: less is rounding of a path that ends on the axis.
pub const CROSSES: f64 = 1e-3;

/// What an overrun promises.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Promise {
    /// The path covers the axis on purpose: the cusps there are residual like any other.
    pub covers_centre: bool,
    /// The path covers the whole part: what stays uncut is held to the residual tolerance.
    pub covers_part: bool,
}

impl Promise {
    /// Of the recipe's overrun.
    pub fn of(overrun: Overrun) -> Self {
        match overrun {
            Overrun::Contact => Self {
                covers_centre: true,
                covers_part: true,
            },
            Overrun::Length(_) => Self {
                covers_centre: true,
                covers_part: false,
            },
            Overrun::None => Self {
                covers_centre: false,
                covers_part: false,
            },
        }
    }
}

/// The overrun as the recipe has it.
fn name(overrun: Overrun) -> String {
    match overrun {
        Overrun::Contact => "overrun = \"contact\"".to_owned(),
        Overrun::None => "overrun = \"none\"".to_owned(),
        Overrun::Length(length) => format!("overrun = \"{length} mm\""),
    }
}

/// The largest of what stays uncut anywhere, mm.
pub fn largest_uncut(figures: &CoverageFigures) -> f64 {
    let all = [figures.rim, figures.hole, figures.centre];
    let heights = all.into_iter().flatten().map(|uncut| uncut.height);
    heights.fold(0.0, f64::max)
}

/// Heights that stay uncut, nm, with their angles. A figure is null where the part has no such
/// place, or where no pass reaches it: then `never_cut` names it.
#[derive(Debug, Serialize)]
pub struct Coverage {
    rim: Option<f64>,
    hole: Option<f64>,
    centre: Option<f64>,
    at_deg: At,
    never_cut: Vec<&'static str>,
}

/// Angles of the sections with those heights, deg.
#[derive(Debug, Serialize)]
struct At {
    rim: Option<f64>,
    hole: Option<f64>,
    centre: Option<f64>,
}

impl Coverage {
    /// What was measured, in nm.
    pub fn new(figures: &CoverageFigures) -> Self {
        let height = |uncut: Option<UncutHeight>| {
            uncut
                .map(|uncut| uncut.height * NM_PER_MM)
                .filter(|height| height.is_finite())
        };
        let angle = |uncut: Option<UncutHeight>| uncut.map(|uncut| uncut.at_theta / DEG);
        let CoverageFigures {
            rim, hole, centre, ..
        } = *figures;
        let never = |(name, uncut): (&'static str, Option<UncutHeight>)| {
            let uncut = uncut.filter(|uncut| !uncut.height.is_finite());
            uncut.map(|_| name)
        };
        let places = [("rim", rim), ("hole", hole), ("centre", centre)];
        Self {
            rim: height(rim),
            hole: height(hole),
            centre: height(centre),
            at_deg: At {
                rim: angle(rim),
                hole: angle(hole),
                centre: angle(centre),
            },
            never_cut: places.into_iter().filter_map(never).collect(),
        }
    }

    /// The lines for a person: the verdict, where there is one, and each place where more than the
    /// residual stays.
    pub fn lines(&self, recipe: &Recipe, verdict: Option<bool>) -> String {
        let mut texts = Vec::new();
        let tolerance = recipe.tolerance.residual;
        if let Some(holds) = verdict {
            let largest = self.places().map(|place| place.height);
            let largest = largest.fold(0.0, f64::max);
            texts.push(against(largest, tolerance, holds));
        }
        let exceeding = self
            .places()
            .filter(|place| !holds(place.height, tolerance * NM_PER_MM));
        texts.extend(exceeding.map(|place| place.told(recipe.overrun)));
        if texts.is_empty() {
            texts.push("nowhere more than the residual stays uncut".to_owned());
        }
        let labels = std::iter::once("coverage").chain(std::iter::repeat(""));
        let lines = labels.zip(&texts).map(|(label, text)| line(label, text));
        lines.collect()
    }

    /// The places that the part has.
    fn places(&self) -> impl Iterator<Item = Place> + '_ {
        let all = [
            ("rim", self.rim, self.at_deg.rim),
            ("hole", self.hole, self.at_deg.hole),
            ("centre", self.centre, self.at_deg.centre),
        ];
        all.into_iter().filter_map(|(name, height, at)| {
            at.map(|at_deg| Place {
                name,
                height: height.unwrap_or(f64::INFINITY),
                at_deg,
            })
        })
    }
}

struct Place {
    name: &'static str,
    height: f64,
    at_deg: f64,
}

impl Place {
    fn told(&self, overrun: Overrun) -> String {
        let (name, at, overrun) = (self.name, self.at_deg, name(overrun));
        if self.height.is_infinite() {
            return format!("{name} not reached at {at:.0} deg ({overrun})");
        }
        let height = nanometres(self.height);
        format!("{name} {height} uncut at {at:.0} deg ({overrun})")
    }
}

/// How far the tool goes beyond the axis, µm; 0 where it does not.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct AxisCrossing {
    /// X of the tool centre as played.
    x: f64,
    /// The contact.
    contact: f64,
}

impl AxisCrossing {
    /// What was measured, in µm.
    pub fn new(figures: &CoverageFigures) -> Self {
        Self {
            x: figures.x_beyond_axis * UM_PER_MM,
            contact: figures.contact_beyond_axis * UM_PER_MM,
        }
    }

    /// The warning for a person, where X crosses the axis.
    pub fn line(&self) -> String {
        if self.x <= CROSSES {
            return String::new();
        }
        let x = nanometres(self.x * NM_PER_MM / UM_PER_MM);
        let why = match self.contact <= CROSSES {
            true => "as the normal of a tilted centre asks",
            false => "since the feed goes on there",
        };
        line(
            "warning",
            format!("X crosses the axis by {x}, {why}; beyond it the part moves against the edge"),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crossing(x_beyond_axis: f64) -> String {
        AxisCrossing::new(&CoverageFigures {
            x_beyond_axis,
            ..CoverageFigures::default()
        })
        .line()
    }

    #[test]
    fn a_crossing_is_told_and_rounding_is_not() {
        assert_eq!(crossing(1e-13), "");
        let told = crossing(0.0123);
        assert!(told.starts_with("  warning         X crosses the axis by 12.30 um, "));
    }

    #[test]
    fn what_no_pass_reaches_is_null_and_named() {
        let never = UncutHeight {
            height: f64::INFINITY,
            at_theta: 0.0,
        };
        let some = UncutHeight {
            height: 1e-4,
            at_theta: 135.0 * DEG,
        };
        let coverage = Coverage::new(&CoverageFigures {
            rim: Some(some),
            centre: Some(never),
            ..CoverageFigures::default()
        });
        let json = serde_json::to_value(&coverage).unwrap_or_default();
        assert_eq!(json["never_cut"], serde_json::json!(["centre"]));
        assert_eq!(json["centre"], serde_json::Value::Null);
        assert_eq!(json["hole"], serde_json::Value::Null);
        assert_eq!(json["at_deg"]["hole"], serde_json::Value::Null);
        assert!(
            json["rim"]
                .as_f64()
                .is_some_and(|rim| (rim - 100.0).abs() < 1e-9)
        );
    }
}
