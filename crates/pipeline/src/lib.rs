//! Chains the stages: spiral law, spindle law, nodes, locus, velocities. Refines and measures the
//! path, and delivers it block by block.
//!
//! A path is made in blocks of [`BLOCK`] revolutions or fewer. The bytes of a block depend on the
//! task alone, not on the number of threads. [`prepare()`] checks the tool against the part and
//! settles the range of ρ. [`run()`] makes the path and gives it to a [`DraftSink`] in order.

mod ahead;
mod aim;
mod attributed;
mod beyond;
mod blocks;
mod chain;
mod columns;
mod composite;
mod contact;
mod data_reach;
mod drift;
mod drift_bound;
mod error;
mod estimate;
mod feed_cap;
mod fit;
mod held_nodes;
mod largest_nose;
mod law;
mod lead;
mod make;
mod measurement;
mod node_check;
mod observer;
mod on_part;
mod options;
mod order;
mod path_size;
mod plan;
mod planning_locus;
mod prepare;
mod range;
mod recorder;
mod refine;
mod repeated_blocks;
mod run;
mod sample;
mod schedule;
mod seams;
mod segment_state;
mod sink;
mod size;
mod spindle;
mod stale;
mod tail;
mod taper;
mod walls;
mod window;

pub use aim::AIM;
pub use attributed::NamedSurface;
pub use chain::{Chain, Link, LocusLinks};
pub use composite::{PlacedSurface, PoseError, PosedSurface, SurfaceSum};
pub use data_reach::{DataReach, Farthest, ON_DATA, data_reach};
pub use error::{PipelineError, Result, RunError};
pub use estimate::Estimate;
pub use feed_cap::FeedCap;
pub use largest_nose::largest_nose;
pub use lead::{AxisLimits, LeadLimits, LeadSettings, Leads};
pub use measurement::Outcome;
pub use observer::{Observer, SilentObserver, Stage};
pub use options::PathOptions;
pub use path_size::{Excess, MOST_POINTS, MOST_REVOLUTIONS, PathSize};
pub use plan::BLOCK;
pub use prepare::{Preparation, prepare};
pub use refine::MOST_ROUNDS;
pub use run::{make_unmeasured, run};
pub use sample::{PathSample, SampledBlock, sample_path};
pub use segment_state::SMALLEST_SEGMENT;
pub use sink::{DraftSink, Sink};
pub use taper::LARGEST_END_GAP;
