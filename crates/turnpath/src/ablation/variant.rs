//! One run of an ablation: the path of a variant made and measured, and nothing written.

use turnpath_core::toolpath::SectionBlock;
use turnpath_host::Catalogue;
use turnpath_pipeline::{DraftSink, Observer, Sink, Stage};
use turnpath_post::{Layout, POSTS};
use turnpath_recipe::Recipe;
use turnpath_report::MeasuredRun;

use crate::data_files::DataFiles;
use crate::error::Error;
use crate::form::search_split;
use crate::job::Job;
use crate::page::error_sketch;
use crate::posts::{NotCarried, layout, posts};

use super::clock::{self, MeasuringClock};
use super::observer::AblationObserver;

/// Where the strategies and the data of all runs come from.
#[derive(Clone, Copy)]
pub struct Sources<'a> {
    /// The strategies.
    pub catalogue: &'a Catalogue,
    /// The data files, each read once for all runs.
    pub data: &'a DataFiles,
}

/// Makes and measures the path of a variant; on a pool of one thread, so that its processor time
/// counts.
pub fn run(
    recipe: &Recipe,
    sources: Sources<'_>,
    observer: &dyn AblationObserver,
) -> Result<MeasuredRun, Error> {
    let begun = clock::now();
    let job = Job::with_files(recipe.clone(), sources.catalogue, sources.data)?;
    let job = Job {
        keeps_sketch: true,
        ..job
    };
    let observer = RunObserver {
        ablation: observer,
        measuring: MeasuringClock::default(),
    };
    let path = search_split(&job, &observer, |job| {
        let mut sizes = SizeSink::new(job);
        let outcome = job.run_into(&mut sizes, &observer)?;
        Ok((sizes, outcome))
    })?;
    let report = job.report(path.sink.rows, &path.outcome, path.split, Vec::new())?;
    let measuring = observer.measuring.total();
    Ok(MeasuredRun {
        report,
        program_bytes: path.sink.program_bytes,
        planning_time: Some(clock::now() - begun - measuring),
        measuring_time: Some(measuring),
        sketch: path.outcome.sketch.as_ref().map(error_sketch),
    })
}

/// An observer of one run that shows nothing, and is cancelled with the ablation.
struct RunObserver<'a> {
    ablation: &'a dyn AblationObserver,
    measuring: MeasuringClock,
}

impl Observer for RunObserver<'_> {
    fn begin(&self, _: Stage, _: u64) {}

    fn advance(&self, _: u64) {}

    fn measures(&self, begins: bool) {
        self.measuring.measures(begins);
    }

    fn is_cancelled(&self) -> bool {
        self.ablation.is_cancelled()
    }
}

/// Counts what files of the path would hold.
struct SizeSink {
    /// The layout of the recipe's first post; without a post, that of the first of all posts.
    layout: Layout,
    /// Whether the recipe asks for a program, so that a path that the program cannot carry is a
    /// failure.
    is_asked: bool,
    /// Whether the path plays cubics. One of straight lines has no size here.
    plays_cubics: bool,
    rows: u64,
    /// Bytes of program lines; `None` where a program cannot carry the path.
    program_bytes: Option<u64>,
}

impl SizeSink {
    fn new(job: &Job) -> Self {
        let post = posts(&job.recipe).next().unwrap_or(&POSTS[0]);
        let plays_cubics = !job.plays_straight_lines();
        Self {
            layout: layout(&job.recipe, post, job.compensates_nose()),
            is_asked: !job.programs.is_empty(),
            plays_cubics,
            rows: 0,
            program_bytes: plays_cubics.then_some(0),
        }
    }
}

impl Sink for SizeSink {
    /// Bytes of the block's program lines; `None` where a program cannot carry the block.
    type Block = Option<u64>;
    type Error = NotCarried;

    fn encode(&self, block: &SectionBlock<'_>) -> Result<Option<u64>, NotCarried> {
        if self.program_bytes.is_none() {
            return Ok(None);
        }
        match self.layout.lines(block) {
            Ok(lines) => Ok(Some(lines.text.len() as u64)),
            Err(error) if self.is_asked => Err(NotCarried {
                post: self.layout.post.name,
                error,
            }),
            Err(_) => Ok(None),
        }
    }

    fn take(&mut self, points: usize, bytes: Option<u64>) -> Result<(), NotCarried> {
        self.rows += points as u64;
        self.program_bytes = self.program_bytes.zip(bytes).map(|(sum, more)| sum + more);
        Ok(())
    }
}

impl DraftSink for SizeSink {
    fn drop_draft(&mut self) {
        self.rows = 0;
        self.program_bytes = self.plays_cubics.then_some(0);
    }
}
