//! One run of an ablation: the path of a variant made and measured, and nothing written.

use std::io;

use serde::{Deserialize, Serialize};
use serde_json::Value;
use turnpath_core::toolpath::{SectionBlock, SegmentShape};
use turnpath_host::Catalogue;
use turnpath_pipeline::{Quiet, Sink, run as run_pipeline};
use turnpath_post::{PmacFormat, PmacWriter};
use turnpath_recipe::Recipe;

use crate::failure::Failure;
use crate::job::{Job, of_pipeline};
use crate::programs::pmac_format;
use crate::run::{making, refuse_straight_lines, summary};

use super::clock;

/// What a run gave.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Made {
    /// As `turnpath run` would write it into `summary.json`, without programs.
    pub summary: Value,
    /// Bytes of the lines that the post `pmac-pvt` makes of the points, header and footer aside;
    /// none where such a program cannot carry the path.
    pub program_bytes: Option<u64>,
    /// Processor time that it took to make and measure the path, on one thread.
    pub planning_time_s: f64,
}

/// Makes and measures the path of a recipe; on a pool of one thread, so that its time counts.
pub fn make(recipe: &Recipe, catalogue: &Catalogue) -> Result<Made, Failure> {
    let begun = clock::now();
    let job = Job::of(recipe.clone(), catalogue.clone())?;
    refuse_straight_lines(&job)?;
    let mut sizes = Sizes::of(&job);
    let outcome = run_pipeline(&job.chain, &job.prepared, making(&job), &mut sizes, &Quiet);
    let outcome = outcome.map_err(|error| of_pipeline(&job.recipe, error))?;
    let summary = summary(&job, sizes.rows, &outcome, Vec::new())?;
    let summary = serde_json::to_value(summary).map_err(|error| {
        Failure::File(format!(
            "error: the summary cannot be put into JSON: {error}"
        ))
    })?;
    Ok(Made {
        summary,
        program_bytes: sizes.program_bytes,
        planning_time_s: clock::now() - begun,
    })
}

/// Counts what files of the path would hold.
struct Sizes {
    format: PmacFormat,
    /// Whether the recipe asks for a program, so that a path which it cannot carry is a failure.
    is_asked: bool,
    rows: u64,
    program_bytes: Option<u64>,
}

impl Sizes {
    fn of(job: &Job) -> Self {
        let straight = job.chain.velocity.strategy.segments() == SegmentShape::Linear;
        Self {
            format: pmac_format(&job.recipe, job.compensates_nose()),
            is_asked: !job.recipe.output.posts.is_empty(),
            rows: 0,
            program_bytes: (!straight).then_some(0),
        }
    }
}

impl Sink for Sizes {
    /// The count of bytes alone; nothing where there is no program.
    fn encode(&self, stretch: &SectionBlock<'_>) -> io::Result<Vec<Vec<u8>>> {
        if self.program_bytes.is_none() {
            return Ok(Vec::new());
        }
        match PmacWriter::lines(&self.format, stretch) {
            Ok(lines) => Ok(vec![(lines.len() as u64).to_le_bytes().to_vec()]),
            Err(error) if self.is_asked => Err(error),
            Err(_) => Ok(Vec::new()),
        }
    }

    fn take(&mut self, points: usize, encoded: &[Vec<u8>]) -> io::Result<()> {
        self.rows += points as u64;
        let bytes = encoded
            .first()
            .and_then(|count| count.as_slice().try_into().ok());
        let bytes = bytes.map(u64::from_le_bytes);
        self.program_bytes = self.program_bytes.zip(bytes).map(|(sum, more)| sum + more);
        Ok(())
    }
}
