//! The stretches of a sampled path, each measured alone: what of a file they take.

use rayon::prelude::*;
use turnpath_core::toolpath::{PathBlock, Section, SectionBlock};
use turnpath_pipeline::PathSample;

/// What a stretch of a sampled path has of something.
#[derive(Debug, Clone, Copy)]
pub struct SampledStretch<A> {
    /// Where it lies.
    pub section: Section,
    /// What its points have, all but the first one.
    pub amount: A,
    /// Points that have this amount.
    measured: usize,
    /// Points of the stretch without the one at which the next stretch begins.
    points: usize,
    /// How many times the path has such a stretch.
    times: f64,
}

impl<A> SampledStretch<A> {
    /// What the path has of an amount where the stretch stands for it.
    pub fn of_path(&self, amount: u64) -> f64 {
        self.times * (amount as f64 * self.points as f64 / self.measured as f64)
    }
}

/// All stretches of a sample: its blocks, and then its leads. `measure` gives what points of a section have.
/// They begin with one that stands for the lines before.
pub fn sampled_stretches<A: Send, E: Send>(
    sample: &PathSample,
    measure: impl Fn(&SectionBlock<'_>) -> Result<A, E> + Sync,
) -> Result<Vec<SampledStretch<A>>, E> {
    let stretch = |section: Section, points: &PathBlock, times: Option<f64>| {
        let first = points.get(0).filter(|_| points.len() > 1)?;
        let mut rest = PathBlock {
            shape: points.shape,
            ..PathBlock::default()
        };
        points.points().skip(1).for_each(|point| rest.push(point));
        let amount = measure(&SectionBlock {
            section,
            opens_section: false,
            before: &[first],
            points: &rest,
        });
        Some(amount.map(|amount| SampledStretch {
            section,
            amount,
            measured: rest.len(),
            // A block ends with the point at which the next one begins.
            points: rest.len() + usize::from(times.is_none()),
            times: times.unwrap_or(1.0),
        }))
    };
    let blocks = sample.blocks.par_iter().map(|block| {
        stretch(
            Section::Cutting,
            &block.points,
            Some(block.segments_for_each()),
        )
    });
    let leads = sample.leads.par_iter();
    let leads = leads.map(|(section, points)| stretch(*section, points, None));
    let all: Vec<_> = blocks.chain(leads).collect();
    all.into_iter().flatten().collect()
}
