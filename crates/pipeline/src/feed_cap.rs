//! Where the feed comes near to the largest one of the nose.
//!
//! Neighbouring passes must meet within the edges of the nose. However large the residual is, the
//! feed does not exceed that. What the feed follows near there is not asked: it may be the residual,
//! and the recipe may give it.

use turnpath_core::locus::{CIRCLES_FROM, CuspFeed, Profile, profile_at};
use turnpath_core::{CentreBuffers, Locus, SpiralLaw, StrategyError, angle};

use crate::{PipelineError, Preparation, Result};

/// Places along the law that are looked at.
const PLACES: u32 = 20_000;
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

/// Where the law's feed comes within a tenth of the largest one of the nose; `None` where it does
/// so nowhere.
pub(crate) fn feed_cap(preparation: &Preparation, law: &SpiralLaw) -> Result<Option<FeedCap>> {
    let large = large_feeds(preparation, law);
    if large.is_empty() {
        return Ok(None);
    }
    let caps = caps(preparation, &large).map_err(PipelineError::Measure)?;
    let mut found: Option<FeedCap> = None;
    for (turn, cap) in large.iter().zip(caps) {
        if turn.feed < NEAR * cap {
            continue;
        }
        let known = found.unwrap_or(FeedCap {
            from: f64::INFINITY,
            to: f64::NEG_INFINITY,
            feed: f64::INFINITY,
        });
        let rho = turn.rho.abs();
        found = Some(FeedCap {
            from: known.from.min(rho),
            to: known.to.max(rho),
            feed: known.feed.min(cap),
        });
    }
    Ok(found)
}

/// The feed of a turn.
struct TurnFeed {
    theta: f64,
    /// The radius between the turn's two passes, mm.
    rho: f64,
    feed: f64,
}

/// The turns whose feed is so large that a cap may be near.
fn large_feeds(preparation: &Preparation, law: &SpiralLaw) -> Vec<TurnFeed> {
    let least = CIRCLES_FROM * NEAR * preparation.task.tool.nose_radius;
    let turns = law.end() - 1.0;
    let places = if turns > 0.0 { PLACES } else { 0 };
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
    (0..places).map(turn).filter(large).collect()
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
