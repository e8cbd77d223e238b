//! The feed strategy `constant`.

use turnpath_plugin::prelude::*;

use crate::smallest::smallest_held_feed;

/// By how much a derived feed stays below the smallest found on the part: more than the search
/// misses it by, and a ten-thousandth more revolutions.
const MARGIN: f64 = 1e-4;

/// ρ = start ± f·N over the whole range.
#[derive(Debug, Clone, PartialEq)]
pub struct Constant {
    feed: Option<f64>,
}

impl Strategy for Constant {
    const NAME: &'static str = "constant";
    const SUMMARY: &'static str = "one feed for the whole part, given or the smallest that is held";
    const SOURCE: &'static str = "the conventional spiral; derived feed after Wang et al. 2019, \
        eq. 1–3, at the worst place";
    const PARAMS: &'static [Param] = &[Param::feed(
        "feed",
        "feed per revolution; left out: the largest that holds tolerance.residual everywhere",
    )
    .positive()
    .optional()];

    fn new(params: &Params) -> Result<Self> {
        Ok(Self {
            feed: params.given("feed"),
        })
    }
}

impl FeedStrategy for Constant {
    fn plan(&self, setup: Setup<'_>) -> Result<Box<dyn FeedPlan>> {
        let feed = match self.feed {
            Some(feed) => feed,
            None => smallest_held_feed(setup)? * (1.0 - MARGIN),
        };
        Ok(Box::new(OnePiece { feed }))
    }
}

struct OnePiece {
    feed: f64,
}

impl FeedPlan for OnePiece {
    fn extend(&mut self, setup: Setup<'_>, pieces: &mut Vec<Stretch>) -> Result<Onward> {
        let RadialRange { inner, outer } = setup.job.range;
        let (start, end) = match setup.job.direction {
            Direction::Inward => (outer, inner),
            Direction::Outward => (inner, outer),
        };
        let length = (outer - inner) / self.feed;
        let rate = (end - start) / length;
        pieces.push(Stretch {
            length,
            coefficients: [start, rate, 0.0, 0.0, 0.0, 0.0],
        });
        Ok(Onward::Done)
    }
}
