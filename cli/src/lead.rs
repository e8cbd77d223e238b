//! What leads do, as the summary, `verify` and a person get it.

use serde::Serialize;
use turnpath_core::{DEG, Tolerance};
use turnpath_pipeline::Leads;
use turnpath_recipe::Recipe;
use turnpath_verify::LeadFigures;

use crate::coverage::CROSSES;
use crate::figures::{self, millimetres, nanometres};
use crate::machine::MachineFigures;
use crate::summary::{Axes, NM_PER_MM, Place, UM_PER_MM, holds};

/// The leads of a path.
#[derive(Debug, Serialize)]
pub struct Lead {
    /// Only of a run: a file does not say where its part is highest.
    #[serde(flatten)]
    made: Option<Made>,
    /// Played − first touch of Z where it is smallest. At the joins it is 0, and between control
    /// points near them a little less.
    pub smallest_clearance_nm: f64,
    /// Where that is.
    pub at: Place,
    /// How far X as played goes beyond the axis; 0 where it does not.
    axis_crossing_um: f64,
    /// Largest steps of the acceleration at the control points, those of the joins among them.
    acceleration_jump: Jump,
    axes: Axes,
    #[serde(skip)]
    machine: Option<MachineFigures>,
}

/// How leads were made.
#[derive(Debug, Serialize)]
struct Made {
    in_s: f64,
    out_s: f64,
    turns_in: f64,
    turns_out: f64,
    control_points: u64,
    rest_clearance_mm: f64,
}

#[derive(Debug, Serialize)]
struct Jump {
    x_mm_per_s2: f64,
    z_mm_per_s2: f64,
    c_deg_per_s2: f64,
}

impl Lead {
    /// What was measured, in the units of the file.
    pub fn measured(figures: &LeadFigures, recipe: &Recipe) -> Self {
        Self {
            made: None,
            smallest_clearance_nm: figures.clearance * NM_PER_MM,
            at: Place {
                c_deg: figures.at_c / DEG,
                x_mm: figures.at_x,
            },
            axis_crossing_um: figures.x_beyond_axis * UM_PER_MM,
            acceleration_jump: Jump {
                x_mm_per_s2: figures.jumps.x,
                z_mm_per_s2: figures.jumps.z,
                c_deg_per_s2: figures.jumps.c / DEG,
            },
            axes: Axes::of(&figures.axes),
            machine: MachineFigures::new(&figures.axes, recipe),
        }
    }

    /// The same with how the run made them.
    pub fn made(leads: &Leads, recipe: &Recipe) -> Self {
        let made = Made {
            in_s: leads.in_time,
            out_s: leads.out_time,
            turns_in: leads.turns_in,
            turns_out: leads.turns_out,
            control_points: leads.points,
            rest_clearance_mm: leads.rest_clearance(),
        };
        Self {
            made: Some(made),
            ..Self::measured(&leads.figures, recipe)
        }
    }

    /// Whether they stay above the first touch, to the interpolation tolerance.
    pub fn clears(&self, tolerance: &Tolerance) -> bool {
        holds(
            -self.smallest_clearance_nm,
            tolerance.interpolation * NM_PER_MM,
        )
    }

    /// Whether they hold the machine's limits; none without limits of which there are figures.
    pub fn within_machine(&self) -> Option<bool> {
        self.machine.as_ref().and_then(MachineFigures::hold)
    }

    /// The lines for a person.
    pub fn lines(&self, clears: Option<bool>) -> String {
        let mut text = String::new();
        if let Some(made) = &self.made {
            let (come, go) = (figures::duration(made.in_s), figures::duration(made.out_s));
            let rest = millimetres(made.rest_clearance_mm, 3);
            text += &figures::line(
                "lead",
                format!("{come} in, {go} out; clears the part by {rest} at rest"),
            );
        }
        let label = if self.made.is_some() { "" } else { "lead" };
        let lowest = self.smallest_clearance_nm;
        let side = match lowest < 0.0 {
            true => "below",
            false => "above",
        };
        let verdict = match clears {
            Some(false) => format!(
                "EXCEEDED: it plunges at C = {:.2} deg, X = {}",
                self.at.c_deg,
                millimetres(self.at.x_mm, 4)
            ),
            _ => "holds".to_owned(),
        };
        let lowest = nanometres(lowest.abs());
        text += &figures::line(
            label,
            format!("lowest {lowest} {side} first touch; {verdict}"),
        );
        if self.axis_crossing_um > CROSSES {
            let crossing = nanometres(self.axis_crossing_um * NM_PER_MM / UM_PER_MM);
            let told = format!("X crosses the axis by {crossing} on the way from or to the part");
            text += &figures::line("lead warning", told);
        }
        text + &self
            .machine
            .as_ref()
            .map_or_else(String::new, |machine| machine.exceeded("lead "))
    }
}
