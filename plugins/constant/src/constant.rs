//! The feed strategy `constant`.

use turnpath_plugin::law_limits::MOST_REVOLUTIONS;
use turnpath_plugin::prelude::*;

use crate::smallest::smallest_residual_feed;

/// The part by which a derived feed stays below the smallest feed that the search finds on the
/// part. It is more than the search misses, and costs a ten-thousandth more revolutions.
const MARGIN: f64 = 1e-4;

/// The law ρ = start ± f·N over the whole range.
#[derive(Debug, Clone, PartialEq)]
pub struct Constant {
    feed: Option<f64>,
}

const FEED: Param<Option<Feed>> = Param::feed(
    "feed",
    "feed per revolution; left out: the largest that holds tolerance.residual everywhere, as far as \
     neighbouring noses meet within their edges",
)
.positive()
.optional();

impl Strategy for Constant {
    const NAME: &'static str = "constant";
    const SUMMARY: &'static str =
        "one feed for the whole part, given or the largest that holds the residual everywhere";
    const SOURCE: &'static str = "the conventional spiral; derived feed after Wang et al. 2019, \
        eq. 1–3, at the worst place; large feeds from the exact cusp";
    const PARAMS: &'static [ParamInfo] = &[FEED.info()];

    fn new(params: &Params) -> Result<Self> {
        Ok(Self {
            feed: params.get(FEED),
        })
    }
}

impl FeedStrategy for Constant {
    fn plan(&self, setup: Setup<'_>) -> Result<Box<dyn FeedPlan>> {
        let RadialRange { inner, outer } = setup.task.range;
        let least = (outer - inner) / MOST_REVOLUTIONS;
        let feed = match self.feed {
            Some(feed) if feed < least => return Err(given_too_small(least)),
            Some(feed) => feed,
            None => smallest_residual_feed(setup)? * (1.0 - MARGIN),
        };
        Ok(Box::new(OnePiece { feed }))
    }
}

struct OnePiece {
    feed: f64,
}

impl FeedPlan for OnePiece {
    fn extend(&mut self, setup: Setup<'_>, pieces: &mut Vec<FeedPiece>) -> Result<Continuation> {
        let RadialRange { inner, outer } = setup.task.range;
        let (start, end) = match setup.task.direction {
            Direction::Inward => (outer, inner),
            Direction::Outward => (inner, outer),
        };
        let length = (outer - inner) / self.feed;
        let rate = (end - start) / length;
        pieces.push(FeedPiece {
            length,
            coefficients: [start, rate, 0.0, 0.0, 0.0, 0.0],
        });
        Ok(Continuation::End)
    }
}

fn given_too_small(least: f64) -> StrategyError {
    FEED.refused(format!(
        "it takes more than {MOST_REVOLUTIONS:.0e} revolutions; \
             give at least {:.1e} um/rev",
        least / UM
    ))
}
