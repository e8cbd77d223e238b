//! `summary.json`: what a run gave, for programs and for people later on.

use serde::Serialize;
use turnpath_core::{DEG, Direction, Tolerance};
use turnpath_host::Plugin;
use turnpath_pipeline::{Chain, Outcome};
use turnpath_recipe::Recipe;
use turnpath_verify::machined::MachinedFigures;
use turnpath_verify::{AxisMotion, PathFigures};

use crate::surface_error::SurfaceError;

/// Nanometres in a millimetre; multiplying keeps round figures round.
pub const NM_PER_MM: f64 = 1e6;
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
    pub programs: Vec<ProgramSummary>,
    plugins: Vec<PluginFile>,
}

/// What was measured on a path; `turnpath verify` gives it alone.
#[derive(Debug, Serialize)]
pub struct Measured {
    pub interpolation_error_nm: InterpolationError,
    pub residual_nm: Residual,
    #[serde(flatten)]
    pub surface_error: SurfaceError,
    pub axes: Axes,
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
    max_acceleration: f64,
    rms_acceleration: f64,
    max_jerk: f64,
}

/// Which tolerances hold; `machine` is null without limits to hold.
#[derive(Debug, Serialize)]
pub struct Within {
    pub interpolation: bool,
    pub residual: bool,
    machine: Option<bool>,
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
            measured: Measured::new(
                &outcome.figures,
                outcome.machined.as_ref(),
                &recipe.tolerance,
            ),
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
                .all(|program| program.within_interpolation)
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
    /// Figures against tolerances, in the units of the file.
    pub fn new(
        figures: &PathFigures,
        machined: Option<&MachinedFigures>,
        tolerance: &Tolerance,
    ) -> Self {
        let (playback, residual, axes) = (&figures.playback, &figures.residual, &figures.axes);
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
            residual_nm: Residual {
                max: residual.highest().map(|height| height * NM_PER_MM),
                at: Place {
                    c_deg: residual.at_theta / DEG,
                    x_mm: residual.at_rho,
                },
                left_out: match residual.cusps {
                    0 => "no turn has a neighbour",
                    _ => "the innermost turn",
                },
            },
            surface_error: SurfaceError::of(machined),
            axes: Axes {
                x: Axis::of(&axes.x, 1.0),
                z: Axis::of(&axes.z, 1.0),
                c: Axis::of(&axes.c, DEG),
            },
            within: Within {
                interpolation: holds(playback.max(), tolerance.interpolation),
                residual: residual
                    .highest()
                    .is_some_and(|height| holds(height, tolerance.residual)),
                machine: None,
                reach: None,
            },
        }
    }

    /// Whether all that is measured holds.
    pub fn all_hold(&self) -> bool {
        let Within {
            interpolation,
            residual,
            machine,
            reach,
        } = self.within;
        interpolation && residual && machine.unwrap_or(true) && reach.unwrap_or(true)
    }
}

impl ProgramSummary {
    /// Figures of a program against the tolerance.
    pub fn new(
        file: String,
        post: &'static str,
        figures: &PathFigures,
        tolerance: &Tolerance,
    ) -> Self {
        let error = figures.playback.max();
        Self {
            file,
            post,
            interpolation_error_nm: error * NM_PER_MM,
            within_interpolation: holds(error, tolerance.interpolation),
        }
    }
}

/// Whether a measured figure holds a tolerance.
fn holds(measured: f64, tolerance: f64) -> bool {
    measured <= ALLOWED * tolerance
}

impl Axis {
    fn of(motion: &AxisMotion, unit: f64) -> Self {
        Self {
            max_velocity: motion.max_velocity / unit,
            max_acceleration: motion.max_acceleration / unit,
            rms_acceleration: motion.rms_acceleration() / unit,
            max_jerk: motion.max_jerk / unit,
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
