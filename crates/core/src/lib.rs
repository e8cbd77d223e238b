//! The vocabulary of turnpath and the traits of its stages: ordinary Rust, no ABI, no files.
//!
//! Lengths are in mm, angles in rad, times in s. θ is the angle of the C axis and ρ is the distance
//! from the spindle axis. z points to the tool, and the material lies below. N = θ/2π counts
//! revolutions.

mod compensator;
mod conicoid;
mod crease;
mod cusp;
mod cut;
mod dual;
mod error;
pub mod extreme;
mod feed;
pub mod fit;
mod form_budget;
pub mod hermite;
pub mod interference;
mod job_spec;
mod lanes;
pub mod largest_nose;
pub mod law_limits;
mod laws;
pub mod locus;
mod machine;
mod neighbours;
mod node_list;
mod orders;
mod pace;
mod param;
mod part;
pub mod part_shape;
mod path;
mod piecewise;
mod placement;
mod pose;
mod printable;
mod profile;
pub mod registers;
pub mod ring;
mod sampler;
mod scalar;
mod servo;
mod sine;
mod slot;
mod spindle;
mod strategy;
pub mod strip;
mod surface;
pub mod tally;
mod taylor;
#[cfg(test)]
mod test_surface;
pub mod toolpath;
mod turns;
mod velocity;

pub use compensator::{CentreSeries, Centres, Compensator, Rates};
pub use conicoid::Conicoid;
pub use cut::{Cut, Radial};
pub use dual::Dual;
pub use error::{Result, StrategyError};
pub use feed::{Continuation, FeedPiece, FeedPlan, FeedStrategy, Setup};
pub use form_budget::FormBudget;
pub use job_spec::JobSpec;
pub use lanes::Lanes;
pub use laws::{SpindleLaw, SpiralLaw, per_radian};
pub use locus::{CentreBuffers, Locus, ToolLocus};
pub use machine::{Axis, AxisLimits, Derivative, Limit, Machine};
pub use node_list::{LARGEST_OFFSET, NodeList, NodeOffset};
pub use orders::SeriesOrders;
pub use pace::Pace;
pub use param::{
    DataFile, NamedConstant, Param, ParamDefault, ParamInfo, ParamKind, ParamValue, Params, kind,
};
pub use part::{Direction, Misfit, Overrun, Part, RadialRange, Task, Tolerance, Tool};
pub use path::Path;
pub use piecewise::{Piece, PiecewisePolynomial, quintic};
pub use placement::Placement;
pub use pose::{Attitude, Pose};
pub use printable::{printable, printable_line};
pub use sampler::{Dependence, Sampler, SamplerPlan};
pub use scalar::{Mask, Scalar};
pub use servo::{AxisServo, Servo};
pub use sine::sines_and_cosines;
pub use slot::Slot;
pub use spindle::{SpindleAsk, SpindleStrategy};
pub use strategy::{HOST_KEYS, Strategy, StrategyInfo, is_strategy_name};
pub use surface::{GradientSeries, Gradients, Surface, SurfaceData, SurfaceGap, SurfaceModel};
pub use taylor::{ORDER, Series, Taylor};
pub use turnpath_units::{DEG, LengthPower, NM, Quantity, QuantityError, UM};
pub use turns::{
    MOST_STEPS_OF_TURN, Revolutions, Turn, angle, angles, even_angles, within_turn, within_turns,
};
pub use velocity::{Nodes, Velocities, VelocitySolver};
