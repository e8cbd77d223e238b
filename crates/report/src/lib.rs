//! What turnpath gave, as data: the figures of a run, of a file, of a check and of an ablation.
//!
//! The model holds mm, rad and s. In JSON each number has its unit in its key, or is a pure number
//! ([`mod@unit`]). [`text`] is the same for a person, [`comparison`] sets the runs of an ablation side
//! by side. Nothing here makes or measures a path.
//!
//! ```
//! use turnpath_report::{RunReport, from_json, to_json};
//! # let text = include_str!("../tests/data/summary.json");
//! let report: RunReport = from_json(text)?;      // the content of summary.json
//! assert!(report.verdict().holds());
//! assert!(report.path.interpolation_error.max < 100e-6);
//! assert_eq!(to_json(&report), text);
//! # Ok::<(), turnpath_report::FormatError>(())
//! ```

mod ablation;
mod anomalies;
mod axes;
mod axis_notes;
mod check;
pub mod comparison;
mod coverage;
mod cutting_speed;
mod errors;
mod feed_cap;
mod file;
mod form;
mod format;
mod lead;
mod machine;
mod map_comparison;
mod part_shape;
mod path;
mod place;
mod program;
mod reach;
mod remark;
mod remark_subject;
mod result_check;
mod rough_path;
mod run;
#[cfg(test)]
mod sample;
mod samples;
mod servo;
mod sketch;
mod spokes;
mod surface_error;
pub mod text;
mod tool_fit;
pub mod unit;
mod unreached;
pub mod variations;
mod verdict;
mod wholeness;

pub use ablation::{AblationReport, AblationRun, FailedRun, MeasuredRun, RunOutcome};
pub use anomalies::{Anomalies, Anomaly, AnomalyKind, Column, Standard};
pub use axes::{Axes, AxisMotion, Motion};
pub use axis_notes::AxisNotes;
pub use check::{CheckReport, Estimate, ProgramEstimate, RoughPathEstimate};
pub use coverage::{AxisCrossing, Coverage, Overrun, Uncut};
pub use cutting_speed::CuttingSpeed;
pub use errors::{
    ControlPointError, InterpolationError, LeftOut, PlayedCusp, Residual, Tolerances,
};
pub use feed_cap::FeedCap;
pub use file::FileReport;
pub use form::{FormReport, FormSplit};
pub use format::{FORMAT, FormatError, from_json, to_json};
pub use lead::{AccelerationStep, LeadLayout, LeadReport};
pub use machine::{HighestSpindle, LimitFigure, MachineLimits, MachineReport, MachineSource};
pub use map_comparison::{MapComparison, MapPlace};
pub use part_shape::{PartCurvature, PartHeight, PartPlace, PartShape, PartSlope, RefusedCheck};
pub use path::PathReport;
pub use place::{PathPlace, SurfacePoint};
pub use program::{ControllerCommand, ProgramFigures, ProgramReport, StraightLines};
pub use reach::{Radial, Radii, Reach};
pub use remark::Remark;
pub use remark_subject::{ProgramDigits, RemarkSubject};
pub use result_check::ResultCheck;
pub use rough_path::{Left, RoughPathReport};
pub use run::{
    ChainNames, DataSource, Direction, PluginSource, RecipeSource, ResultFile, RunReport,
};
pub use samples::Samples;
pub use servo::{FollowingErrors, LinearLag, PredictedError, RotaryLag, ServoReport};
pub use sketch::{
    AxisSketch, EdgeSketch, ErrorMap, ErrorProfile, ErrorSketch, PathSketch, RadialMean,
    SpiralSketch, TurnSketch,
};
pub use spokes::{Arms, Spokes};
pub use surface_error::{RealNose, SurfaceError};
pub use tool_fit::{
    AngleMargin, ContactPlace, Hollow, Margins, NoseMargin, Region, Sections, Slope, ToolFit,
};
pub use unreached::Unreached;
pub use verdict::{Verdict, within};
pub use wholeness::{Wholeness, WholenessFault};
