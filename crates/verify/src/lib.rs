//! Measures what a tool path cuts, apart from whatever made the path.
//!
//! This crate finds the true tool position by the first touch of the nose on the surface. It never
//! asks a compensator. A path comes in blocks of neighbouring control points. The blocks are
//! measured in parallel ([`Meter::measure`]) and their figures are combined in order
//! ([`Meter::append`]), so the figures do not depend on the number of threads.

mod anomalies;
mod axes;
mod axis_terms;
mod best_sphere;
mod between_instants;
mod block_playback;
mod bracket;
mod certain_meter;
mod certain_motion;
mod closing;
mod comparison;
mod contact_bounds;
mod corners;
mod coverage;
mod crossings;
mod cusp;
mod cutting_speed;
mod edge_crossings;
mod exactness;
mod instants;
mod largest_errors;
mod lead;
mod limits;
mod lower_arc;
pub mod machined;
mod measured_passes;
mod meter;
mod next_contacts;
mod order;
mod part_edge;
mod periodogram;
mod playback;
mod points;
mod profiles;
mod program_meter;
mod residual;
mod scan;
mod search_limits;
mod searches;
mod servo;
mod sharp_peaks;
mod sketch;
mod small_turns;
mod spectrum;
mod spokes;
mod subject;
mod touch;
mod touches;
mod unreached;
mod worst;
mod worst_first;

pub use anomalies::{Anomaly, AnomalyDetector, AnomalyKind};
pub use axes::{AxesMotion, AxisMotion, Peak};
pub use best_sphere::BestSphere;
pub use block_playback::BlockPlayback;
pub use certain_meter::{CertainBlock, CertainMeter};
pub use certain_motion::{CertainMotion, Rounding};
pub use comparison::{
    Column, ComparisonFigures, HalfDigits, PathRow, RowAnomaly, RowComparison, RowFault,
};
pub use coverage::{CoverageFigures, EdgeHeights};
pub use cutting_speed::CuttingSpeed;
pub use instants::INSTANTS;
pub use lead::{Jumps, LeadBlockFigures, LeadFigures, LeadMeter};
pub use limits::{HighestSpeed, LimitFigure};
pub use measured_passes::PassFigures;
pub use meter::{BlockFigures, Meter, PathFigures};
pub use order::in_order;
pub use part_edge::UncutHeight;
pub use playback::PlaybackFigures;
pub use points::PointFigures;
pub use program_meter::{ProgramBlockFigures, ProgramMeter};
pub use residual::{ResidualFigures, SECTIONS, cusp_heights};
pub use servo::{FollowingError, ServoBlockFigures, ServoFigures, ServoMeter, ServoStart};
pub use sketch::{PathSketch, SpiralSample, TurnMotion};
pub use spectrum::{AxesLine, AxesSpectrum};
pub use spokes::{SpiralArms, Spoke};
pub use subject::Subject;
pub use touch::{FirstTouch, Touch};
pub use unreached::{Ride, UnreachedFigures, rides, unreached};
pub use worst_first::MOST_KEPT;
