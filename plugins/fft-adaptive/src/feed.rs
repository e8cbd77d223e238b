//! The feed strategy `fft-adaptive`: eq. 1 to 3 and 5, with one feed for each revolution.

use turnpath_plugin::law_limits::MOST_REVOLUTIONS;
use turnpath_plugin::locus::{Profile, profile_at};
use turnpath_plugin::prelude::*;
use turnpath_plugin::ring::FeedTable;

use crate::chord::Chord;

/// Fewest radial profiles of a revolution. With 36 the feed that they allow has not settled yet
/// (121 revolutions instead of 122 on the paper's part).
const FEWEST_ANGLES: u64 = 72;
/// Most radial profiles of a revolution: one every 36 arc seconds.
const MOST_ANGLES: u64 = 36_000;
/// The largest feed of a chord alone, as a part of the range. The chord has no limit where nothing
/// is curved.
const LARGEST_PART: f64 = 0.1;
/// The part by which a capped feed stays below the one that keeps the residual. It covers what lies
/// between the floors of the table, and the passes where two feeds meet.
const MARGIN: f64 = 2e-4;
/// The least sagitta, mm: a thousandth of a nanometre, like the recipe's own tolerances.
const LEAST_SAGITTA: f64 = 1e-9;
/// The last revolution takes a rest of the range that is shorter than this part of its feed. Rounding
/// leaves such a rest where the feed divides the range.
const LEAST_REST: f64 = 1e-9;
/// Number of revolutions in each answer.
const BATCH: usize = 64;

/// The largest feed whose chord stays within a tolerance on every radial profile of the revolution.
#[derive(Debug, Clone, PartialEq)]
pub struct FftAdaptiveFeed {
    chord: Chord,
    tolerance: Option<f64>,
    limit_residual: bool,
    angles: u64,
}

const CHORD: Param<Choice> = Param::choice(
    "chord",
    &["full", "half"],
    "half: a chord of half the length, which gives the paper's 122 revolutions; full: eq. 1 \
             as printed, which gives 61",
)
.default("half");
const TOLERANCE: Param<Option<Length>> = Param::length(
    "tolerance",
    "sagitta of the chord along the radius; left out: tolerance.interpolation",
)
.min(LEAST_SAGITTA)
.optional();
const LIMIT_RESIDUAL: Param<Flag> = Param::flag(
    "limit_residual",
    "keep the feed at or below the one that holds tolerance.residual at every angle; the \
             chord takes no account of the nose",
)
.default(true);
const ANGLES: Param<Count> = Param::count("angles", "radial profiles of a revolution")
    .default(FEWEST_ANGLES)
    .min(FEWEST_ANGLES)
    .max(MOST_ANGLES);

impl Strategy for FftAdaptiveFeed {
    const NAME: &'static str = "fft-adaptive";
    const SUMMARY: &'static str = "one feed a revolution, whose chord stays within a tolerance on \
        every radial profile";
    const SOURCE: &'static str = "Zhong, Tong, Chen and Jiang, Development of an adaptive toolpath \
        planning strategy for diamond face turning of freeform surfaces (no DOI is known), \
        eq. 1–3 and 5; limit_residual is not the paper's";
    const PARAMS: &'static [ParamInfo] = &[
        CHORD.info(),
        TOLERANCE.info(),
        LIMIT_RESIDUAL.info(),
        ANGLES.info(),
    ];

    fn new(params: &Params) -> Result<Self> {
        Ok(Self {
            chord: Chord::from_word(params.get(CHORD)),
            tolerance: params.get(TOLERANCE),
            limit_residual: params.get(LIMIT_RESIDUAL),
            angles: params.get(ANGLES),
        })
    }
}

impl FeedStrategy for FftAdaptiveFeed {
    fn plan(&self, setup: Setup<'_>) -> Result<Box<dyn FeedPlan>> {
        let RadialRange { inner, outer } = setup.task.range;
        if !(inner.is_finite() && outer.is_finite() && inner < outer) {
            return Err(StrategyError::failed(format!(
                "there is nothing to cut: ρ runs from {inner} mm to {outer} mm"
            )));
        }
        let (rho, outward) = match setup.task.direction {
            Direction::Outward => (inner, 1.0),
            Direction::Inward => (outer, -1.0),
        };
        let residual_feed = match self.limit_residual {
            true => Some(FeedTable::for_residual(setup)?),
            false => None,
        };
        Ok(Box::new(FftAdaptivePlan {
            rays: Rays::new(self.angles as usize),
            chord: self.chord,
            tolerance: self.tolerance.unwrap_or(setup.task.tolerance.interpolation),
            residual_feed,
            largest: LARGEST_PART * (outer - inner),
            rho,
            outward,
            revolutions: 0,
        }))
    }
}

/// A law that is planned up to the radius ρ.
struct FftAdaptivePlan {
    rays: Rays,
    chord: Chord,
    tolerance: f64,
    residual_feed: Option<FeedTable>,
    largest: f64,
    rho: f64,
    outward: f64,
    revolutions: usize,
}

impl FeedPlan for FftAdaptivePlan {
    fn extend(&mut self, setup: Setup<'_>, pieces: &mut Vec<FeedPiece>) -> Result<Continuation> {
        let RadialRange { inner, outer } = setup.task.range;
        let end = if self.outward > 0.0 { outer } else { inner };
        for _ in 0..BATCH {
            let mut feed = self.feed(setup.locus.surface())?;
            let left = self.outward * (end - self.rho);
            let last = left <= feed * (1.0 + LEAST_REST);
            if last {
                feed = feed.max(left);
            }
            let length = (left / feed).min(1.0);
            pieces.push(FeedPiece {
                length,
                coefficients: [self.rho, self.outward * feed, 0.0, 0.0, 0.0, 0.0],
            });
            self.rho += self.outward * feed;
            self.revolutions += 1;
            if last {
                return Ok(Continuation::End);
            }
        }
        if self.revolutions as f64 > MOST_REVOLUTIONS {
            return Err(too_many(self.rho));
        }
        Ok(Continuation::More)
    }
}

impl FftAdaptivePlan {
    /// Δr_max of the revolution that begins at ρ (eq. 3). It is not above the residual feed at any
    /// radius that the tool reaches between the revolution before and the one after.
    fn feed(&mut self, surface: &dyn SurfaceModel) -> Result<f64> {
        let chord = self.rays.largest_feed(surface, self.rho, |profile| {
            self.chord.length(profile.curvature(), self.tolerance) / profile.slant()
        })?;
        Ok(match &self.residual_feed {
            None => chord.min(self.largest),
            Some(residual_feed) => chord.min(self.least_residual_feed(residual_feed)),
        })
    }

    fn least_residual_feed(&self, residual_feed: &FeedTable) -> f64 {
        let reach = residual_feed.largest();
        let (behind, ahead) = (
            self.rho - self.outward * reach,
            self.rho + self.outward * 2.0 * reach,
        );
        residual_feed.least(behind.min(ahead), behind.max(ahead)) * (1.0 - MARGIN)
    }
}

/// The radial profiles of a revolution: θ_i = 2πi/n, i = 1 to n.
struct Rays {
    theta: Vec<f64>,
    rho: Vec<f64>,
    profiles: Vec<Profile>,
}

impl Rays {
    fn new(count: usize) -> Self {
        let theta = (1..=count).map(|i| TAU * i as f64 / count as f64);
        Self {
            theta: theta.collect(),
            rho: vec![0.0; count],
            profiles: vec![Profile::default(); count],
        }
    }

    /// min over i of (2π/θ_i)·Δr_i, all at the radius `rho`. Up to θ_i the tool has fed only by
    /// this part of the feed.
    fn largest_feed(
        &mut self,
        surface: &dyn SurfaceModel,
        rho: f64,
        allowed: impl Fn(&Profile) -> f64,
    ) -> Result<f64> {
        self.rho.fill(rho);
        profile_at(surface, &self.theta, &self.rho, &mut self.profiles)?;
        let mut least = f64::INFINITY;
        for (profile, theta) in self.profiles.iter().zip(&self.theta) {
            let feed = TAU / theta * allowed(profile);
            if feed.is_nan() {
                return Err(no_profile(*theta, rho));
            }
            least = least.min(feed);
        }
        Ok(least)
    }
}

fn no_profile(theta: f64, rho: f64) -> StrategyError {
    let (sin, cos) = Scalar::sin_cos(theta);
    StrategyError::failed(format!(
        "the surface has no curvature at x = {:.4} mm, y = {:.4} mm; choose a smaller aperture",
        rho * cos,
        rho * sin
    ))
}

fn too_many(rho: f64) -> StrategyError {
    TOLERANCE.refused(format!(
        "the path takes more than {MOST_REVOLUTIONS:.0e} revolutions and has only reached \
             ρ = {rho:.4} mm; give a larger tolerance"
    ))
}
