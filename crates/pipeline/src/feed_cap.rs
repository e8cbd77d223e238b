//! Where the feed comes near to the largest one of the nose.
//!
//! Neighbouring passes must meet within the edges of the nose. However large the residual is, the
//! feed does not exceed that. What the feed follows near there is not asked: it may be the residual,
//! and the recipe may give it.

use std::ops::Range;

use rayon::prelude::*;
use turnpath_core::locus::{CIRCLES_FROM, CuspFeed, Profile, profile_at};
use turnpath_core::{CentreBuffers, Locus, SpiralLaw, StrategyError, angle};

use crate::order::one_at_a_time;
use crate::{PipelineError, Preparation, Result};

/// Places along the law that are looked at.
const PLACES: u32 = 20_000;
/// Places that a thread looks at together. Their numbers stay in its cache.
const TOGETHER: u32 = 500;
/// The part of the largest feed from which on a feed is near to it. Laws stay below the feed of all
/// radii around, so they do not come nearer than this where they are capped.
const NEAR: f64 = 0.9;

/// Where the law's feed comes within a tenth of the largest one of the nose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeedCap {
    /// The least radius, mm.
    pub from: f64,
    /// The largest radius, mm.
    pub to: f64,
    /// The least of the largest feeds there, mm.
    pub feed: f64,
}

impl FeedCap {
    /// Both places together.
    fn and(self, other: Self) -> Self {
        Self {
            from: self.from.min(other.from),
            to: self.to.max(other.to),
            feed: self.feed.min(other.feed),
        }
    }
}

/// Where the law's feed comes within a tenth of the largest one of the nose; `None` where it does
/// so nowhere.
pub(crate) fn feed_cap(preparation: &Preparation, law: &SpiralLaw) -> Result<Option<FeedCap>> {
    if law.end() <= 1.0 {
        return Ok(None);
    }
    let group = |number: u32| (TOGETHER * number)..PLACES.min(TOGETHER * (number + 1));
    let groups = (0..PLACES.div_ceil(TOGETHER)).into_par_iter();
    let caps = one_at_a_time(groups.map(|number| cap_among(preparation, law, group(number))));
    let caps = caps.map_err(PipelineError::Measure)?;
    Ok(caps.into_iter().flatten().reduce(FeedCap::and))
}

/// The same among some of the places. A largest feed that is no number counts for nothing.
fn cap_among(
    preparation: &Preparation,
    law: &SpiralLaw,
    places: Range<u32>,
) -> std::result::Result<Option<FeedCap>, StrategyError> {
    let large = large_feeds(preparation, law, places);
    if large.is_empty() {
        return Ok(None);
    }
    let caps = caps(preparation, &large)?;
    let capped = large.iter().zip(caps);
    let capped = capped.filter(|(turn, cap)| turn.feed >= NEAR * cap);
    let places = capped.map(|(turn, cap)| FeedCap {
        from: turn.rho.abs(),
        to: turn.rho.abs(),
        feed: cap,
    });
    Ok(places.reduce(FeedCap::and))
}

/// The feed of a turn.
struct TurnFeed {
    theta: f64,
    /// The radius between the turn's two passes, mm.
    rho: f64,
    feed: f64,
}

/// The turns that begin at some of the places and whose feed is so large that a cap may be near.
fn large_feeds(preparation: &Preparation, law: &SpiralLaw, places: Range<u32>) -> Vec<TurnFeed> {
    let least = CIRCLES_FROM * NEAR * preparation.task.tool.nose_radius;
    let turns = law.end() - 1.0;
    let turn = |i: u32| {
        let n = turns * f64::from(i) / f64::from(PLACES);
        let (rho, next) = (law.value(n), law.value(n + 1.0));
        TurnFeed {
            theta: angle(n),
            rho: 0.5 * (rho + next),
            feed: (next - rho).abs(),
        }
    };
    let large = |turn: &TurnFeed| turn.feed > least;
    places.map(turn).filter(large).collect()
}

/// The largest feeds of the nose, mm.
fn caps(
    preparation: &Preparation,
    turns: &[TurnFeed],
) -> std::result::Result<Vec<f64>, StrategyError> {
    let Preparation { task, locus, .. } = preparation;
    let theta: Vec<f64> = turns.iter().map(|turn| turn.theta).collect();
    let rho: Vec<f64> = turns.iter().map(|turn| turn.rho).collect();
    let mut centres = CentreBuffers::default();
    centres.resize(turns.len());
    locus.centre(&theta, &rho, centres.as_centres())?;
    let mut profiles = vec![Profile::default(); turns.len()];
    profile_at(locus.surface(), &theta, &centres.foot, &mut profiles)?;
    let law = CuspFeed::new(task.tolerance.residual, locus.radial(), &task.tool);
    let cap = |profile: &Profile| law.cap(profile.slope, law.gap(profile.curvature()));
    Ok(profiles.iter().map(cap).collect())
}
