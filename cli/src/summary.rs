//! `summary.json`: what a run gave, for programs and for people later on.

use serde::Serialize;
use turnpath_core::{DEG, Direction, Tolerance};
use turnpath_host::Plugin;
use turnpath_pipeline::{Chain, Outcome};
use turnpath_recipe::Recipe;
use turnpath_verify::machined::MachinedFigures;
use turnpath_verify::{AxesMotion, AxisMotion, LeadFigures, PathFigures, Peak, ServoFigures};

use crate::coverage::{AxisCrossing, Coverage, Promise, largest_uncut};
use crate::lead::Lead;
use crate::machine::{HighestSpindle, MachineFigures};
use crate::servo::ServoSummary;
use crate::surface_error::SurfaceError;
use crate::unreached::Unreached;

/// Nanometres in a millimetre; multiplying keeps round figures round.
pub const NM_PER_MM: f64 = 1e6;
/// Micrometres in a millimetre.
pub const UM_PER_MM: f64 = 1e3;
/// A tolerance holds when measured ≤ this × tolerance: rounding in the last digit of a figure
/// that was aimed exactly at it does not count.
const ALLOWED: f64 = 1.001;

/// The whole summary. `null` stands for what this version does not measure.
#[derive(Debug, Serialize)]
pub struct Summary {
    turnpath: &'static str,
    name: String,
    chain: ChainNames,
    direction: &'static str,
    refine: bool,
    pub control_points: u64,
    pub rows: u64,
    pub points_added_by_refine: u64,
    pub revolutions: f64,
    pub cutting_time_s: f64,
    tolerance_nm: ToleranceNm,
    #[serde(flatten)]
    pub measured: Measured,
    /// The axes while the law is the feed strategy's own; null where another took its place.
    axes_of_law: Option<Axes>,
    pub unreached: Option<Unreached>,
    pub programs: Vec<ProgramSummary>,
    plugins: Vec<PluginFile>,
}

/// What was measured on a path; `turnpath verify` gives it alone.
#[derive(Debug, Serialize)]
pub struct Measured {
    pub interpolation_error_nm: InterpolationError,
    pub control_point_error_nm: PointError,
    pub residual_nm: Residual,
    pub coverage_nm: Coverage,
    pub axis_crossing_um: AxisCrossing,
    #[serde(flatten)]
    pub surface_error: SurfaceError,
    pub axes: Axes,
    /// The machine's limits; null without any.
    pub machine: Option<MachineFigures>,
    #[serde(flatten)]
    pub highest_spindle: HighestSpindle,
    /// Null without leads.
    pub lead: Option<Lead>,
    /// Null where the recipe asks for none.
    pub servo: Option<ServoSummary>,
    pub within: Within,
}

/// Names of the five strategies.
#[derive(Debug, Serialize)]
pub struct ChainNames {
    pub surface: String,
    pub feed: String,
    pub sampler: String,
    pub compensator: String,
    pub velocity: String,
}

#[derive(Debug, Serialize)]
struct ToleranceNm {
    interpolation: f64,
    residual: f64,
}

/// Played − true tool centre along z.
#[derive(Debug, Serialize)]
pub struct InterpolationError {
    /// Largest amount.
    pub max: f64,
    /// Root mean square over time.
    pub rms: f64,
    /// Where the largest is.
    pub at: Place,
}

/// Control points − true tool centre along z.
#[derive(Debug, Serialize)]
pub struct PointError {
    /// Largest amount.
    pub max: f64,
    /// Where it is.
    pub at: Place,
}

/// A place of the tool.
#[derive(Debug, Serialize)]
pub struct Place {
    pub c_deg: f64,
    pub x_mm: f64,
}

/// Cusps along the profile's normal; `null` where no two passes are neighbours.
#[derive(Debug, Serialize)]
pub struct Residual {
    /// Highest; none where no pass has a neighbour, which holds no tolerance.
    pub max: Option<f64>,
    at: Place,
    /// What the figure does not speak of.
    pub left_out: &'static str,
}

/// C in deg and s, X and Z in mm and s.
#[derive(Debug, Serialize)]
pub struct Axes {
    pub x: Axis,
    pub z: Axis,
    pub c: Axis,
}

#[derive(Debug, Serialize)]
pub struct Axis {
    max_velocity: f64,
    rms_velocity: f64,
    max_acceleration: f64,
    rms_acceleration: f64,
    max_jerk: f64,
    rms_jerk: f64,
    at: AxisPlaces,
}

/// Where an axis' largest amounts are.
#[derive(Debug, Serialize)]
struct AxisPlaces {
    max_velocity: Place,
    max_acceleration: Place,
    max_jerk: Place,
}

/// Which tolerances hold; `machine` is null without limits of which there are figures, `lead` without
/// leads.
#[derive(Debug, Serialize)]
pub struct Within {
    pub interpolation: bool,
    pub residual: bool,
    /// Whether no more than the residual stays uncut at the part's edges and around the axis;
    /// null where the path is not meant to cover the part.
    pub coverage: Option<bool>,
    machine: Option<bool>,
    /// Whether the leads stay above the first touch, to the interpolation tolerance.
    pub lead: Option<bool>,
    /// Whether the path covers the part; only of a file, since a run's law is held to that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reach: Option<bool>,
}

/// A motion program, measured on its own text as read back.
#[derive(Debug, Serialize)]
pub struct ProgramSummary {
    pub file: String,
    pub post: &'static str,
    pub interpolation_error_nm: f64,
    pub within_interpolation: bool,
    /// Null without leads.
    pub within_lead: Option<bool>,
}

#[derive(Debug, Serialize)]
struct PluginFile {
    name: String,
    version: String,
    file: Option<String>,
    sha256: Option<String>,
}

impl Summary {
    /// The summary of a run.
    pub fn new(
        recipe: &Recipe,
        chain: &Chain,
        plugins: &[&Plugin],
        rows: u64,
        outcome: &Outcome,
        unreached: Option<Unreached>,
        programs: Vec<ProgramSummary>,
    ) -> Self {
        Self {
            turnpath: env!("CARGO_PKG_VERSION"),
            name: recipe.name.clone(),
            chain: ChainNames::of(chain),
            direction: match recipe.direction {
                Direction::Inward => "inward",
                Direction::Outward => "outward",
            },
            refine: recipe.refine,
            control_points: outcome.control_points,
            rows,
            points_added_by_refine: outcome.added_by_refine,
            revolutions: outcome.revolutions,
            cutting_time_s: outcome.cutting_time,
            tolerance_nm: ToleranceNm {
                interpolation: recipe.tolerance.interpolation * NM_PER_MM,
                residual: recipe.tolerance.residual * NM_PER_MM,
            },
            axes_of_law: outcome.own_axes.as_ref().map(Axes::of),
            measured: Measured::new(&outcome.figures, outcome.machined.as_ref(), recipe)
                .with_lead(
                    outcome.lead.as_ref().map(|leads| Lead::made(leads, recipe)),
                    &recipe.tolerance,
                )
                .with_servo(outcome.servo.as_ref()),
            unreached,
            programs,
            plugins: plugins
                .iter()
                .map(|plugin| PluginFile::of(plugin))
                .collect(),
        }
    }

    /// Whether all tolerances hold, on the path and on each program.
    pub fn all_hold(&self) -> bool {
        let programs = || {
            self.programs
                .iter()
                .all(|program| program.within_interpolation && program.within_lead.unwrap_or(true))
        };
        self.measured.all_hold() && programs()
    }

    /// The JSON text, with a line end.
    pub fn json(&self) -> String {
        to_json(self)
    }
}

/// A value as JSON text, with a line end.
pub fn to_json(value: &impl Serialize) -> String {
    let mut text = serde_json::to_string_pretty(value).unwrap_or_else(|error| error.to_string());
    text.push('\n');
    text
}

impl ChainNames {
    fn of(chain: &Chain) -> Self {
        Self {
            surface: chain.surface.name.clone(),
            feed: chain.feed.name.clone(),
            sampler: chain.sampler.name.clone(),
            compensator: chain.compensator.name.clone(),
            velocity: chain.velocity.name.clone(),
        }
    }
}

impl Measured {
    /// Figures against the recipe's tolerances and limits, in the units of the file.
    pub fn new(figures: &PathFigures, machined: Option<&MachinedFigures>, recipe: &Recipe) -> Self {
        let promise = Promise::of(recipe.overrun);
        let (playback, residual, axes) = (&figures.playback, &figures.residual, &figures.axes);
        let tolerance = &recipe.tolerance;
        let machine = MachineFigures::new(axes, recipe);
        let at = Place {
            c_deg: playback.at_c / DEG,
            x_mm: playback.at_x,
        };
        Self {
            interpolation_error_nm: InterpolationError {
                max: playback.max() * NM_PER_MM,
                rms: playback.rms() * NM_PER_MM,
                at,
            },
            control_point_error_nm: PointError {
                max: figures.points.max() * NM_PER_MM,
                at: Place {
                    c_deg: figures.points.at_c / DEG,
                    x_mm: figures.points.at_x,
                },
            },
            residual_nm: Residual {
                max: residual.highest().map(|height| height * NM_PER_MM),
                at: Place {
                    c_deg: residual.at_theta / DEG,
                    x_mm: residual.at_rho,
                },
                left_out: match residual.cusps {
                    0 => "no turn has a neighbour",
                    _ if promise.covers_centre => "nothing",
                    _ => "the innermost turn",
                },
            },
            coverage_nm: Coverage::new(&figures.coverage),
            axis_crossing_um: AxisCrossing::new(&figures.coverage),
            surface_error: SurfaceError::of(machined),
            axes: Axes::of(axes),
            lead: None,
            servo: None,
            within: Within {
                interpolation: holds(playback.max(), tolerance.interpolation),
                residual: residual
                    .highest()
                    .is_some_and(|height| holds(height, tolerance.residual)),
                coverage: promise
                    .covers_part
                    .then(|| holds(largest_uncut(&figures.coverage), tolerance.residual)),
                machine: machine.as_ref().and_then(MachineFigures::hold),
                lead: None,
                reach: None,
            },
            machine,
            highest_spindle: HighestSpindle::new(axes, recipe),
        }
    }

    /// The same with what was measured on leads.
    pub fn with_lead(mut self, lead: Option<Lead>, tolerance: &Tolerance) -> Self {
        self.within.lead = lead.as_ref().map(|lead| lead.clears(tolerance));
        let within_machine = lead.as_ref().and_then(Lead::within_machine);
        self.within.machine = match (self.within.machine, within_machine) {
            (Some(cut), Some(lead)) => Some(cut && lead),
            (cut, lead) => cut.or(lead),
        };
        self.lead = lead;
        self
    }

    /// The same with what the servo makes of the path.
    pub fn with_servo(mut self, servo: Option<&ServoFigures>) -> Self {
        self.servo = servo.map(ServoSummary::of);
        self
    }

    /// Whether all that is measured holds.
    pub fn all_hold(&self) -> bool {
        let Within {
            interpolation,
            residual,
            coverage,
            machine,
            lead,
            reach,
        } = self.within;
        let asked = [coverage, machine, lead, reach];
        interpolation && residual && asked.into_iter().flatten().all(|holds| holds)
    }
}

impl Place {
    /// Where a largest amount is.
    pub fn of(peak: &Peak) -> Self {
        Self {
            c_deg: peak.at_c / DEG,
            x_mm: peak.at_x,
        }
    }
}

impl ProgramSummary {
    /// Figures of a program against the tolerance.
    pub fn new(
        file: String,
        post: &'static str,
        figures: &PathFigures,
        lead: Option<&LeadFigures>,
        tolerance: &Tolerance,
    ) -> Self {
        let error = figures.playback.max();
        Self {
            file,
            post,
            interpolation_error_nm: error * NM_PER_MM,
            within_interpolation: holds(error, tolerance.interpolation),
            within_lead: lead.map(|lead| holds(-lead.clearance, tolerance.interpolation)),
        }
    }
}

/// Whether a measured figure holds a tolerance or a limit.
pub fn holds(measured: f64, tolerance: f64) -> bool {
    measured <= ALLOWED * tolerance
}

impl Axes {
    /// Motion in the units of the file.
    pub fn of(axes: &AxesMotion) -> Self {
        Self {
            x: Axis::of(&axes.x, 1.0),
            z: Axis::of(&axes.z, 1.0),
            c: Axis::of(&axes.c, DEG),
        }
    }
}

impl Axis {
    fn of(motion: &AxisMotion, unit: f64) -> Self {
        Self {
            max_velocity: motion.velocity.amount / unit,
            rms_velocity: motion.rms_velocity() / unit,
            max_acceleration: motion.acceleration.amount / unit,
            rms_acceleration: motion.rms_acceleration() / unit,
            max_jerk: motion.jerk.amount / unit,
            rms_jerk: motion.rms_jerk() / unit,
            at: AxisPlaces {
                max_velocity: Place::of(&motion.velocity),
                max_acceleration: Place::of(&motion.acceleration),
                max_jerk: Place::of(&motion.jerk),
            },
        }
    }
}

impl PluginFile {
    fn of(plugin: &Plugin) -> Self {
        Self {
            name: plugin.name.clone(),
            version: plugin.version.clone(),
            file: plugin.file.as_ref().map(|file| file.display().to_string()),
            sha256: plugin.sha256.clone(),
        }
    }
}
