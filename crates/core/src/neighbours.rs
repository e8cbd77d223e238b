//! Two neighbouring passes at one angle, half a feed to either side of a radius, and the feed with
//! which their cusp has a given height.
//!
//! A large feed spans so much of the profile that the curvature at one place does not describe it.
//! So the noses are placed as the compensator places them, and the tip between them is compared
//! with the nearest place of the profile.

use crate::profile::{Profile, profile_at};
use crate::{Centres, Compensator, Cut, Result};

/// Most rounds of the search for a feed, for cusps that jump. On the lens array of the documentation one
/// round finds most feeds, and at most six find the others.
const ROUNDS: usize = 16;
/// A feed that changes by less than this part of itself is found.
const SETTLED: f64 = 1e-8;
/// By how much rounding may err in a cusp, as a part of the height at which it lies. This is about four times
/// what it errs by. A smaller part would let searches far from height 0 follow noise, down to half the feed.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// The largest part of a feed that the rounding of cusps may leave open.
const MOST_NOISE: f64 = 1e-2;
/// The largest factor by which one round changes a feed. Where the nose fills a hollow, cusps say
/// little about it.
const LARGEST_STEP: f64 = 2.0;
/// A cusp of more than this many residuals says nothing of the feeds whose cusps are near the residual.
const FAR: f64 = 16.0;
/// Evaluations of the profile on the way to the place nearest to a tip. The tip is so near that the
/// first step leaves a thousandth of the way.
const FOOT_ROUNDS: usize = 3;

/// A surface, a tool and the compensator that places it.
#[derive(Clone, Copy)]
pub struct Neighbours<'a> {
    /// Surface and tool.
    pub cut: Cut<'a>,
    /// Places the tool.
    pub compensator: &'a dyn Compensator,
}

/// A feed that is searched for at one (θ, ρ).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeedSearch {
    /// C angle, rad.
    pub theta: f64,
    /// The radius in the middle of both passes, mm.
    pub rho: f64,
    /// The largest feed, mm.
    pub cap: f64,
    /// The feed, mm: a first value, which is at most the cap, and then the one that
    /// [`Neighbours::search`] found.
    pub feed: f64,
}

impl Neighbours<'_> {
    /// Finds the feeds whose cusps are `residual` high, mm.
    ///
    /// Where a pass has no place, or where the passes do not meet, or where the feed does not settle,
    /// the largest feed stays whose cusp was at most `residual`. If there was none, the first value
    /// stays.
    pub fn search(&self, residual: f64, searches: &mut [FeedSearch]) {
        let mut open: Vec<OpenSearch<'_>> = searches.iter_mut().map(OpenSearch::new).collect();
        for _ in 0..ROUNDS {
            if open.is_empty() {
                break;
            }
            let passes: Vec<FeedSearch> = open.iter().map(OpenSearch::pass).collect();
            let mut cusps = self.cusps_of_any(&passes).into_iter();
            open.retain_mut(|search| {
                let cusp = cusps.next().unwrap_or(Cusp::NONE);
                search.try_another(cusp, residual)
            });
        }
    }

    /// The cusps; NaN where there is none. A place that the surface refuses does not spoil the others.
    fn cusps_of_any(&self, passes: &[FeedSearch]) -> Vec<Cusp> {
        if let Ok(cusps) = self.cusps(passes) {
            return cusps;
        }
        let alone = |pass: &FeedSearch| {
            let cusp = self.cusps(std::slice::from_ref(pass));
            let cusp = cusp.ok().and_then(|cusp| cusp.first().copied());
            cusp.unwrap_or(Cusp::NONE)
        };
        passes.iter().map(alone).collect()
    }

    fn cusps(&self, passes: &[FeedSearch]) -> Result<Vec<Cusp>> {
        let theta: Vec<f64> = passes.iter().map(|pass| pass.theta).collect();
        let aside = |side: f64| passes.iter().map(move |pass| pass.rho + side * pass.feed);
        // Both noses of all passes together: a batch of twice the size takes less time than two.
        let rho: Vec<f64> = aside(-0.5).chain(aside(0.5)).collect();
        let noses = self.noses(&theta.repeat(2), &rho)?;
        let (first, second) = noses.split_at(passes.len());
        let radius = self.cut.tool.nose_radius;
        let tips: Vec<[f64; 2]> = first
            .iter()
            .zip(second)
            .map(|(one, two)| tip(one.centre, two.centre, radius))
            .collect();
        let between = first.iter().zip(second);
        let feet = between.map(|(one, two)| 0.5 * (one.foot + two.foot));
        let heights = self.heights(&theta, &tips, feet.collect())?;
        let cusp = |(height, tip): (f64, &[f64; 2])| Cusp {
            height,
            rounding: ROUNDING * tip[1].abs(),
        };
        Ok(heights.into_iter().zip(&tips).map(cusp).collect())
    }

    /// The noses at each (θ, ρ).
    fn noses(&self, theta: &[f64], rho: &[f64]) -> Result<Vec<Nose>> {
        let blank = || vec![f64::NAN; theta.len()];
        let (mut x, mut z, mut foot) = (blank(), blank(), blank());
        let places = Centres {
            x: &mut x,
            z: &mut z,
            foot: &mut foot,
        };
        self.compensator.centre(self.cut, theta, rho, places)?;
        let nose = |((x, z), foot): ((f64, f64), f64)| Nose {
            centre: [x, z],
            foot,
        };
        let places = x.into_iter().zip(z).zip(foot);
        let mut noses: Vec<Nose> = places.map(nose).collect();
        if !self.compensator.compensates_nose() {
            let mut profiles = vec![Profile::default(); theta.len()];
            profile_at(self.cut.surface, theta, rho, &mut profiles)?;
            for (nose, profile) in noses.iter_mut().zip(&profiles) {
                let along = self.cut.tool.nose_radius / profile.slant();
                nose.centre[0] -= along * profile.slope;
                nose.centre[1] += along;
            }
        }
        Ok(noses)
    }

    /// The distances of the tips from the profile, mm; positive above it. `feet` are first values
    /// of the nearest places.
    fn heights(&self, theta: &[f64], tips: &[[f64; 2]], mut feet: Vec<f64>) -> Result<Vec<f64>> {
        let mut profiles = vec![Profile::default(); tips.len()];
        let mut heights = vec![f64::NAN; tips.len()];
        for _ in 0..FOOT_ROUNDS {
            profile_at(self.cut.surface, theta, &feet, &mut profiles)?;
            let places = profiles.iter().zip(tips);
            for ((profile, tip), (foot, height)) in places.zip(feet.iter_mut().zip(&mut heights)) {
                let (aside, above) = (tip[0] - *foot, tip[1] - profile.height);
                let distance = (aside * aside + above * above).sqrt();
                *height = if above < 0.0 { -distance } else { distance };
                let slope = profile.slope;
                *foot += (aside + above * slope) / (1.0 + slope * slope - above * profile.second);
            }
        }
        Ok(heights)
    }
}

/// A cusp.
#[derive(Clone, Copy)]
struct Cusp {
    /// Its height above the profile, mm.
    height: f64,
    /// By how much rounding may err in the height, mm.
    rounding: f64,
}

impl Cusp {
    /// Where passes have no place or do not meet.
    const NONE: Self = Self {
        height: f64::NAN,
        rounding: 0.0,
    };
}

/// A nose at its place.
struct Nose {
    centre: [f64; 2],
    foot: f64,
}

/// The lower crossing of two circles; NaN where they do not meet.
///
/// The measurement finds this crossing with code of its own. The two share nothing on purpose: a
/// fault here would otherwise hide from the measurement.
fn tip(one: [f64; 2], two: [f64; 2], radius: f64) -> [f64; 2] {
    let (dx, dz) = (two[0] - one[0], two[1] - one[1]);
    let squared = 0.25 * (dx * dx + dz * dz);
    let part = ((radius * radius - squared) / squared).sqrt() * 0.5;
    let side = if dx < 0.0 { -part } else { part };
    [
        0.5 * (one[0] + two[0]) + side * dz,
        0.5 * (one[1] + two[1]) - side * dx,
    ]
}

/// A search that has not ended.
struct OpenSearch<'a> {
    /// The place, with the feed that stays if the search ends.
    found: &'a mut FeedSearch,
    /// The feed that is tried, mm.
    feed: f64,
    /// The feed that was tried before it.
    before: Option<TriedFeed>,
    /// The largest feed whose cusp was at most the residual, mm; 0 while there is none.
    low: f64,
    /// The smallest feed whose cusp was higher, mm; infinite while there is none.
    high: f64,
}

/// A feed, mm, and the square root of its cusp.
#[derive(Clone, Copy)]
struct TriedFeed {
    feed: f64,
    sqrt_cusp: f64,
}

impl<'a> OpenSearch<'a> {
    fn new(search: &'a mut FeedSearch) -> Self {
        Self {
            feed: search.feed,
            found: search,
            before: None,
            low: 0.0,
            high: f64::INFINITY,
        }
    }

    /// The passes with the feed that is tried.
    fn pass(&self) -> FeedSearch {
        FeedSearch {
            feed: self.feed,
            ..*self.found
        }
    }

    /// Chooses another feed, as the present one has this cusp. False if the search ends.
    fn try_another(&mut self, cusp: Cusp, residual: f64) -> bool {
        // Steps below the noise of a cusp lead nowhere.
        let settled = SETTLED.max((cusp.rounding / residual).min(MOST_NOISE));
        let cusp = cusp.height;
        if cusp.is_nan() {
            return false;
        }
        let feed = self.feed;
        let is_low = cusp <= residual;
        if is_low {
            self.low = self.low.max(feed);
        } else {
            self.high = self.high.min(feed);
        }
        let better = self.better(cusp, residual).min(self.found.cap);
        let has_settled = (better - feed).abs() <= settled * feed;
        if has_settled {
            self.found.feed = better;
        } else if is_low {
            self.found.feed = feed;
        }
        self.feed = better;
        !has_settled
    }

    /// A better feed than the present one, which has this cusp.
    fn better(&mut self, cusp: f64, residual: f64) -> f64 {
        let present = TriedFeed {
            feed: self.feed,
            sqrt_cusp: cusp.max(0.0).sqrt(),
        };
        let by_square = present.feed * step_by_square(cusp, residual);
        let Some(before) = self.before.replace(present) else {
            return by_square;
        };
        match self.secant(before, present, residual) {
            Some(feed) => feed,
            // Halfway between the feeds that are known to be too low and too high.
            None if self.high.is_finite() => 0.5 * (self.low + self.high),
            None => by_square,
        }
    }

    /// The feed that leaves `residual` if the square roots of cusps grow evenly with the feed. None if this
    /// feed is out of bounds, or if the cusp before is far from the residual.
    fn secant(&self, before: TriedFeed, present: TriedFeed, residual: f64) -> Option<f64> {
        let wanted = residual.sqrt();
        if before.sqrt_cusp > FAR.sqrt() * wanted {
            return None;
        }
        let rate = (present.sqrt_cusp - before.sqrt_cusp) / (present.feed - before.feed);
        let feed = present.feed + (wanted - present.sqrt_cusp) / rate;
        let least = self.low.max(present.feed / LARGEST_STEP);
        let largest = self.high.min(present.feed * LARGEST_STEP);
        let is_within = feed == present.feed || (feed > least && feed < largest);
        is_within.then_some(feed)
    }
}

/// The factor from a feed with this cusp to the one that leaves `residual`, if cusps grow with the square of
/// the feed.
fn step_by_square(cusp: f64, residual: f64) -> f64 {
    match cusp > residual / (LARGEST_STEP * LARGEST_STEP) {
        true => (residual / cusp).sqrt().max(1.0 / LARGEST_STEP),
        false => LARGEST_STEP,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Misfit, Radial, Scalar, Surface, Tool};

    /// A flat part that ends at a rim.
    struct Disc {
        rim: f64,
    }

    impl Surface for Disc {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, y: S) -> S {
            // NaN beyond the rim.
            (-(x.squared() + y.squared()) + self.rim * self.rim).sqrt() * 0.0
        }
    }

    /// The path of a point.
    struct Bare;

    impl Compensator for Bare {
        fn radial(&self) -> Radial {
            Radial::Centre
        }

        fn compensates_nose(&self) -> bool {
            false
        }

        fn centre(&self, cut: Cut<'_>, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()> {
            let mut profiles = vec![Profile::default(); rho.len()];
            profile_at(cut.surface, theta, rho, &mut profiles)?;
            out.x.copy_from_slice(rho);
            out.foot.copy_from_slice(rho);
            for (z, profile) in out.z.iter_mut().zip(&profiles) {
                *z = profile.height;
            }
            Ok(())
        }
    }

    /// Feeds that begin at a tenth of the one that is right, on a flat under a nose of 1 mm.
    fn found(rho: f64, residual: f64) -> f64 {
        let tool = Tool {
            nose_radius: 1.0,
            included_angle: None,
            clearance_angle: None,
            misfit: Misfit::Refuse,
        };
        let neighbours = Neighbours {
            cut: Cut {
                surface: &Disc { rim: 5.0 },
                tool: &tool,
            },
            compensator: &Bare,
        };
        let mut searches = [FeedSearch {
            theta: 0.3,
            rho,
            cap: 1.9,
            feed: 0.05,
        }];
        neighbours.search(residual, &mut searches);
        searches[0].feed
    }

    #[test]
    fn on_a_flat_the_search_finds_the_closed_form() {
        let residual = 31e-3f64;
        let exact = 2.0 * (2.0 * residual - residual * residual).sqrt();
        let feed = found(2.0, residual);
        assert!((feed / exact - 1.0).abs() < 1e-9, "{feed} for {exact}");
    }

    /// The rounds try 0.05, 0.1, 0.2 and 0.4 mm. With the last one a pass lies beyond the rim.
    #[test]
    fn beside_a_rim_the_last_feed_stays_whose_cusp_was_seen() {
        assert!((found(4.85, 31e-3) - 0.2).abs() < 1e-15);
        // Here even the first pass has no place.
        assert!((found(4.99, 31e-3) - 0.05).abs() < 1e-15);
    }

    const RESIDUAL: f64 = 2e-4;

    /// The feed that a search finds where cusps follow a law of the feed, and how many feeds it tries. It
    /// begins at 0.02 mm.
    fn search_by(law: impl Fn(f64) -> f64) -> (f64, usize) {
        search_with_rounding(0.0, law)
    }

    fn search_with_rounding(rounding: f64, law: impl Fn(f64) -> f64) -> (f64, usize) {
        let mut pass = FeedSearch {
            theta: 0.0,
            rho: 1.0,
            cap: 0.4,
            feed: 0.02,
        };
        let mut search = OpenSearch::new(&mut pass);
        let mut tried = 0;
        while tried < ROUNDS {
            tried += 1;
            let feed = search.feed;
            let height = law(feed);
            if !search.try_another(Cusp { height, rounding }, RESIDUAL) {
                break;
            }
            let step = search.feed / feed;
            assert!((0.5..=2.0).contains(&step), "{feed} to {}", search.feed);
        }
        (pass.feed, tried)
    }

    fn check(law: impl Fn(f64) -> f64, wanted: f64, most: usize) {
        let (feed, tried) = search_by(law);
        assert!((feed / wanted - 1.0).abs() < 1e-8, "{feed} for {wanted}");
        assert!(tried <= most, "{tried} feeds for {wanted}");
    }

    #[test]
    fn where_cusps_grow_with_the_square_one_step_finds_the_feed() {
        check(|feed| 0.5 * feed * feed, 0.02, 1);
        check(|feed| 0.2 * feed * feed, 1e-3f64.sqrt(), 2);
    }

    /// With steps by the square alone none of these settles in so many rounds as there are.
    #[test]
    fn where_cusps_grow_by_another_law_the_search_settles_too() {
        check(|feed| 5e-3 * feed, 0.04, 8);
        check(|feed| 0.02 * feed, 0.01, 8);
        check(
            |feed| 200.0 * feed.squared().squared(),
            1e-6f64.sqrt().sqrt(),
            8,
        );
        // As over a ridge: nearly no cusp up to some feed.
        check(|feed| (feed - 0.018).max(0.0) * 0.02, 0.028, 8);
        let offset = |feed: f64| 1e-6 + (feed - 0.015).squared();
        check(offset, 0.015 + 1.99e-4f64.sqrt(), 8);
    }

    /// As over a part a kilometre away from height 0.
    #[test]
    fn a_search_ends_where_cusps_differ_by_rounding_alone() {
        for offset in 0..1000 {
            let height = 1e6 + f64::from(offset) * 0.01;
            let law = |feed: f64| (height + 0.3 * feed.squared()) - height;
            let (feed, tried) = search_with_rounding(ROUNDING * height, law);
            let wanted = (RESIDUAL / 0.3).sqrt();
            assert!((feed / wanted - 1.0).abs() < 1e-5, "{feed} for {wanted}");
            assert!(tried <= 3, "{tried} feeds at {height}");
        }
    }

    #[test]
    fn a_cusp_that_is_far_too_high_does_not_end_the_search() {
        for wild in [f64::INFINITY, 1e15] {
            let law = |feed: f64| {
                if feed > 0.015 {
                    wild
                } else {
                    3.0 * feed.squared()
                }
            };
            check(law, (RESIDUAL / 3.0).sqrt(), 8);
        }
    }

    #[test]
    fn a_feed_does_not_exceed_the_cap() {
        assert_eq!(search_by(|_| 0.0).0, 0.4);
        assert_eq!(search_by(|_| -1e-6).0, 0.4);
        // A step by the square leads to the cap, and a secant.
        assert_eq!(search_by(|feed| 1e-4 * feed).0, 0.4);
        assert_eq!(search_by(|feed| 4e-4 * feed).0, 0.4);
    }

    /// Cusps that jump over the residual, and cusps that have no value beyond a feed.
    #[test]
    fn the_largest_feed_stays_whose_cusp_was_low_enough() {
        let (feed, _) = search_by(|feed| if feed < 0.03 { 1e-4 } else { 3e-4 });
        assert!(feed < 0.03 && feed > 0.0299, "{feed}");
        let (feed, _) = search_by(|feed| if feed < 0.025 { 1e-4 } else { f64::NAN });
        assert_eq!(feed, 0.02);
    }

    #[test]
    fn where_no_cusp_is_low_enough_the_first_feed_stays() {
        assert_eq!(search_by(|_| 3e-4), (0.02, ROUNDS));
    }
}
