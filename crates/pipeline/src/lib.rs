//! Chains the five stages: law, nodes, locus, velocities; refines, measures, hands blocks on.
//!
//! A path is made in blocks of [`BLOCK`] revolutions or fewer, whatever the threads: a block's bytes
//! depend on the job alone. [`prepare`] checks tool against part and settles the range of ρ,
//! [`run`] makes the path and gives it to a [`Sink`] in order.

mod attributed;
mod beyond;
mod chain;
mod drift;
mod error;
mod largest_nose;
mod law;
mod lead;
mod make;
mod order;
mod plan;
mod prepare;
mod progress;
mod range;
mod refine;
mod run;
mod seams;
mod taper;

pub use chain::{Chain, Link};
pub use error::{PipelineError, Result};
pub use largest_nose::largest_nose;
pub use lead::{AxisLimits, LeadLimits, LeadSettings, Leads};
pub use plan::BLOCK;
pub use prepare::{Prepared, Wanted, prepare};
pub use progress::{Progress, Quiet, Stage};
pub use refine::{AIM, MOST_ROUNDS, SMALLEST_SEGMENT};
pub use run::{Expected, Making, Outcome, Sink, expect, run};
