//! The stretches of a sampled path, and what each of them takes of a file.

use rayon::prelude::*;
use turnpath_core::toolpath::{PathBlock, Section, SectionBlock};
use turnpath_pipeline::PathSample;

/// A stretch of a sampled path, and what was measured on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampledStretch<A> {
    /// Where it lies.
    pub section: Section,
    /// What its points have, all but the first one.
    pub measured: A,
    measured_points: usize,
    /// Its points that belong to no other stretch.
    own_points: usize,
    /// How many times the path has such a stretch.
    times: f64,
}

impl<A> SampledStretch<A> {
    /// What the path has of something where the stretch stands for it. Its measured points have `amount`.
    pub fn of_path(&self, amount: u64) -> f64 {
        self.times * (amount as f64 * self.own_points as f64 / self.measured_points as f64)
    }
}

/// All stretches of a sample with two points at least: its blocks, and then its leads. `measure` is given the
/// points of a stretch. The first of them stands for the lines before.
///
/// # Errors
/// The first error of `measure`.
pub fn sampled_stretches<A: Send, E: Send>(
    sample: &PathSample,
    measure: impl Fn(&SectionBlock<'_>) -> Result<A, E> + Sync,
) -> Result<Vec<SampledStretch<A>>, E> {
    let blocks = sample.blocks.par_iter().map(|block| {
        // A block ends with the point at which the next one begins.
        let own = block.points.len().saturating_sub(1);
        let times = block.segments_for_each();
        stretch(Section::Cutting, &block.points, (own, times), &measure)
    });
    let leads = sample.leads.par_iter().map(|(section, points)| {
        let own = points.len();
        stretch(*section, points, (own, 1.0), &measure)
    });
    let all: Vec<_> = blocks.chain(leads).collect();
    all.into_iter().flatten().collect()
}

fn stretch<A, E>(
    section: Section,
    points: &PathBlock,
    (own_points, times): (usize, f64),
    measure: impl Fn(&SectionBlock<'_>) -> Result<A, E>,
) -> Option<Result<SampledStretch<A>, E>> {
    let first = points.get(0).filter(|_| points.len() > 1)?;
    let rest = PathBlock::of(points.shape, points.points().skip(1));
    let measured = measure(&SectionBlock {
        section,
        opens_section: false,
        before: &[first],
        points: &rest,
    });
    Some(measured.map(|measured| SampledStretch {
        section,
        measured,
        measured_points: rest.len(),
        own_points,
        times,
    }))
}

#[cfg(test)]
mod tests {
    use turnpath_core::toolpath::ControlPoint;
    use turnpath_pipeline::SampledBlock;

    use super::*;

    fn points(count: usize) -> PathBlock {
        let mut points = PathBlock::default();
        (0..count).for_each(|_| points.push(ControlPoint::default()));
        points
    }

    /// Five bytes a point: a block has its points but the last one, a lead has all of its own, and a point
    /// alone is no stretch.
    #[test]
    fn the_points_of_the_path_are_those_of_its_stretches_as_often_as_they_stand_for_it() {
        let block = |count: usize, stands_for: f64| SampledBlock {
            points: points(count),
            stands_for,
            without_border: 0.5,
        };
        let sample = PathSample {
            blocks: vec![block(11, 6.0), block(1, 7.0), block(5, 1.0)],
            leads: vec![(Section::LeadIn, points(4)), (Section::LeadOut, points(1))],
        };
        let measure = |block: &SectionBlock<'_>| Ok::<_, ()>(5 * block.points.len() as u64);
        let stretches = sampled_stretches(&sample, measure).unwrap();
        let sections: Vec<Section> = stretches.iter().map(|one| one.section).collect();
        let cutting = Section::Cutting;
        assert_eq!(sections, [cutting, cutting, Section::LeadIn]);
        let of_path = stretches.iter().map(|one| one.of_path(one.measured));
        let of_path: Vec<f64> = of_path.collect();
        assert_eq!(of_path, [5.0 * 30.0, 5.0 * 2.0, 5.0 * 4.0]);
        let error = sampled_stretches(&sample, |block| Err::<(), _>(block.points.len()));
        assert_eq!(error, Err(10));
    }
}
