//! The feed that leaves cusps of a given height, from the curvature and the slope at the contact.
//!
//! Two neighbouring noses touch a profile of curvature κ. The middle of its circle, a nose centre
//! and the tip of the cusp form a triangle with the sides 1/κ − R, R and 1/κ − ε. By the law of
//! cosines the centres are
//!
//! c = 4 (1 − Rκ) sqrt(q (1 − κ²q)) apart, with q = ε(2R − ε)/(4 (1 − Rκ)(1 − εκ)),
//!
//! and the contacts c/(1 − Rκ). On a flat part this is 2 sqrt(2Rε − ε²), and nothing cancels on the
//! way there. The papers' parabola is its limit for small ε, and c² is the parabola's square times
//! [`CuspFeed::correction`].
//!
//! On a flat of the spacing s the parabola's cusps are s²/16R² of their height too high. Elsewhere
//! they err as on a flat of another spacing, [`CuspFeed::flat_spacing`]. Up to a certain flat
//! spacing the feed is the parabola's, and from a larger one on it is that of circles. Between them
//! it passes from one to the other with two continuous derivatives. So the cusps err alike in
//! hollows, where the contacts are far apart although the centres are not, and on domes.

use crate::profile::Profile;
use crate::{Mask, Misfit, Radial, Scalar, Tool};

/// Up to this flat spacing, as a part of the nose radius, a feed is the parabola's. On circles of
/// any curvature its cusps are up to 1e-4 of their height too high there. The margins of the feed
/// strategies cover twice as much.
pub const PARABOLA_TO: f64 = 1.0 / 25.0;

/// From this flat spacing on, as a part of the nose radius, a feed is that of circles. On the way
/// to it the cusps are less than 1.23e-4 of their height too high.
pub const CIRCLES_FROM: f64 = 1.0 / 15.0;

/// The part of the nose's reach that a feed may use. Neighbouring passes of a spiral are no exact
/// feed apart, and beyond the reach they do not meet at all.
const REACH_USED: f64 = 0.98;

/// The least value of 1 − Rκ in the residual feed with [`Misfit::CutWhatFits`]. The feed there is a
/// seventh of the feed on a flat. The formula goes to zero where the nose touches a hollow of its
/// own radius in one point. A seam beside such a point leaves cusps that grow with the feed itself,
/// not with its square, and no formula of the curvature describes these cusps.
pub const LEAST_GAP: f64 = 0.02;

/// The least value of 1 − Rκ in the cap on a contact's feed. In a hollow of nearly the nose's own
/// radius the contact runs over much of the profile while the nose hardly moves.
const LEAST_GAP_OF_CAP: f64 = 0.1;

/// The least value of 1 − Rκ in the flat spacing. The spacing there is so large that circles count.
const LEAST_GAP_OF_SPACING: f64 = 1e-9;

/// The feed dρ/dN that leaves cusps of one height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CuspFeed {
    residual: f64,
    radial: Radial,
    nose_radius: f64,
    /// Sine and cosine of half the included angle.
    edge: [f64; 2],
    misfit: Misfit,
}

/// The feeds at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalFeeds {
    /// 1 − Rκ.
    pub gap: f64,
    /// The feed of the parabola, mm.
    pub parabola: f64,
    /// The feed of circles, mm, where circles count.
    pub circles: Option<f64>,
}

impl CuspFeed {
    /// The feed for cusps of height `residual`, mm, where ρ means `radial`.
    pub fn new(residual: f64, radial: Radial, tool: &Tool) -> Self {
        let sine = tool.reach() / tool.nose_radius;
        Self {
            residual,
            radial,
            nose_radius: tool.nose_radius,
            edge: [sine, (1.0 - sine * sine).max(0.0).sqrt()],
            misfit: tool.misfit,
        }
    }

    /// 1 − Rκ at a curvature κ, 1/mm. A nose that cuts what fits has [`LEAST_GAP`] at least.
    pub fn gap<S: Scalar>(&self, curvature: S) -> S {
        let gap = -(curvature * self.nose_radius) + 1.0;
        match self.misfit {
            Misfit::Refuse => gap,
            Misfit::CutWhatFits => {
                let least = S::constant(LEAST_GAP);
                S::select(gap.less(least), least, gap)
            }
        }
    }

    /// The parabola's feed, mm: sqrt(8Rε/(1 − Rκ))/w for the contact's radius, and
    /// sqrt(8Rε(1 − Rκ))/w for the centre's X. Infinite where the nose does not fit.
    pub fn parabola(&self, profile: &Profile) -> f64 {
        let (nose_radius, residual) = (self.nose_radius, self.residual);
        let gap = self.gap(profile.curvature());
        if gap <= 0.0 {
            return f64::INFINITY;
        }
        let squared = match self.radial {
            Radial::Contact => 8.0 * nose_radius * residual / gap,
            Radial::Centre => 8.0 * nose_radius * residual * gap,
        };
        squared.sqrt() / profile.slant()
    }

    /// The feed of circles, at most the cap, mm. The profile counts as its circle of curvature.
    pub fn circles(&self, profile: &Profile) -> f64 {
        let gap = self.gap(profile.curvature());
        let cap = self.cap(profile.slope, gap);
        if gap <= 0.0 {
            return cap;
        }
        let feed = self.parabola(profile) * self.correction(gap).sqrt();
        if feed > cap { cap } else { feed }
    }

    /// The feeds from the curvature and the slope at the contact alone.
    pub fn feeds(&self, profile: &Profile) -> LocalFeeds {
        let gap = self.gap(profile.curvature());
        LocalFeeds {
            gap,
            parabola: self.parabola(profile),
            circles: self.needs_circles(gap).then(|| self.circles(profile)),
        }
    }

    /// The feed from the curvature and the slope at the contact alone, mm.
    pub fn feed(&self, profile: &Profile) -> f64 {
        self.join(&self.feeds(profile))
    }

    /// Joins the feeds of a place, mm.
    pub fn join(&self, feeds: &LocalFeeds) -> f64 {
        let LocalFeeds {
            gap,
            parabola,
            circles,
        } = *feeds;
        let Some(circles) = circles else {
            return parabola;
        };
        match self.share(self.flat_spacing(gap)) {
            0.0 => parabola,
            1.0 => circles,
            share => parabola + share * (circles - parabola),
        }
    }

    /// The spacing of passes on a flat on which the parabola errs as it does at this 1 − Rκ, mm.
    ///
    /// By the first order of [`CuspFeed::correction`] the cusps of the parabola are
    /// ε(1/g − 3 + 3g)/2R of their height too high, g = 1 − Rκ, and on a flat of the spacing s they
    /// are s²/16R². So s² = 8Rε(1/g − 3 + 3g). In a hollow that the nose nearly fills, s is the
    /// spacing of the contacts.
    pub fn flat_spacing<S: Scalar>(&self, gap: S) -> S {
        let least = S::constant(LEAST_GAP_OF_SPACING);
        let gap = S::select(gap.less(least), least, gap);
        let squared = gap.recip() + (gap * 3.0 - 3.0);
        (squared * (8.0 * self.nose_radius * self.residual)).sqrt()
    }

    /// The part that the feed of circles has at a flat spacing, mm: 0 at small ones, 1 at large
    /// ones.
    pub fn share<S: Scalar>(&self, flat_spacing: S) -> S {
        let way = flat_spacing / self.nose_radius - PARABOLA_TO;
        let way = way / (CIRCLES_FROM - PARABOLA_TO);
        smooth_step(way)
    }

    /// The square of the feed of circles as a multiple of the parabola's:
    /// (1 − ε/2R)(1 − κ²q)/(1 − εκ), with κ from `gap` = 1 − Rκ, which is positive. Where the
    /// passes would be more than half a circle apart, it is that of half a circle.
    pub fn correction<S: Scalar>(&self, gap: S) -> S {
        let radius = self.nose_radius;
        let residual = self.residual.min(radius);
        let curvature = (-gap + 1.0) / radius;
        let tip = -(curvature * residual) + 1.0;
        let bend = curvature.squared() * (0.25 * residual * (2.0 * radius - residual));
        let bend = bend / (gap * tip);
        let half = bend.less(S::constant(0.5));
        let safe = S::select(half, S::constant(0.5), bend);
        let rest = S::select(half, -bend + 1.0, (safe * 4.0).recip());
        rest / tip * (1.0 - 0.5 * residual / radius)
    }

    /// The largest feed of which neighbouring noses meet within their edges, mm, at a place of this
    /// slope and this 1 − Rκ: 2R(sin A − |slope| cos A)/w², with half the included angle A. It does
    /// not fall below [`CIRCLES_FROM`] of the nose radius: where the contact comes so near to the
    /// end of the edge, the interference check decides.
    pub fn cap<S: Scalar>(&self, slope: S, gap: S) -> S {
        let [sine, cosine] = self.edge;
        let falls = slope.less(S::constant(0.0));
        let steep = S::select(falls, -slope, slope);
        let reach = (-(steep * cosine) + sine) / (slope.squared() + 1.0);
        let centres = reach * (2.0 * REACH_USED * self.nose_radius);
        let cap = match self.radial {
            Radial::Centre => centres,
            Radial::Contact => {
                let least = S::constant(LEAST_GAP_OF_CAP);
                centres / S::select(gap.less(least), least, gap)
            }
        };
        let least = S::constant(CIRCLES_FROM * self.nose_radius);
        S::select(cap.less(least), least, cap)
    }

    /// Whether circles count at some of these 1 − Rκ.
    pub fn needs_circles<S: Scalar>(&self, gap: S) -> bool {
        let spacing = self.flat_spacing(gap);
        (!spacing.less(S::constant(PARABOLA_TO * self.nose_radius))).any()
    }
}

/// A step from 0 at 0 to 1 at 1 with two continuous derivatives.
pub fn smooth_step<S: Scalar>(way: S) -> S {
    let (none, whole) = (S::constant(0.0), S::constant(1.0));
    let way = S::select(way.less(whole), way, whole);
    let way = S::select(way.less(none), none, way);
    way * way * way * ((way * 6.0 - 15.0) * way + 10.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tool(nose_radius: f64) -> Tool {
        Tool {
            nose_radius,
            included_angle: None,
            clearance_angle: None,
            misfit: Misfit::Refuse,
        }
    }

    fn of(curvature: f64) -> Profile {
        Profile {
            height: 0.0,
            slope: 0.0,
            second: curvature,
        }
    }

    /// The height above a circle of curvature κ of the tip between two noses whose centres are
    /// `chord` apart, by the two triangles and nothing else.
    fn height(curvature: f64, nose_radius: f64, chord: f64) -> f64 {
        let half = 0.5 * chord;
        let below = (nose_radius * nose_radius - half * half).sqrt();
        if curvature == 0.0 {
            return nose_radius - below;
        }
        let centre = (1.0 / curvature - nose_radius).abs();
        let along = (centre * centre - half * half).sqrt();
        match curvature > 0.0 {
            true => 1.0 / curvature - (along + below),
            false => along - below + 1.0 / curvature,
        }
    }

    #[test]
    fn on_a_flat_part_it_is_the_closed_form() {
        let feed = CuspFeed::new(1e-3, Radial::Centre, &tool(0.2)).feed(&of(0.0));
        assert!((feed / 39.95e-3 - 1.0).abs() < 1e-3, "{feed}");
        for residual in [1e-3, 2e-3, 1e-2, 5e-2, 0.1f64] {
            let exact = 2.0 * (2.0 * 0.2 * residual - residual * residual).sqrt();
            for radial in [Radial::Centre, Radial::Contact] {
                let feed = CuspFeed::new(residual, radial, &tool(0.2)).feed(&of(0.0));
                assert!((feed / exact - 1.0).abs() < 1e-14, "{feed} for {exact}");
            }
        }
    }

    /// Curvatures from a dome as sharp as a quarter of the nose to a hollow that the nose fills to
    /// nine tenths, and through 0.
    #[test]
    fn on_circles_the_cusp_of_the_triangles_is_the_residual() {
        for curvature in [-4.0, -1.0, -0.1, -1e-9, 0.0, 1e-9, 0.1, 0.5, 0.9] {
            for residual in [2e-3, 1e-2, 3e-2] {
                let profile = of(curvature);
                let centres = CuspFeed::new(residual, Radial::Centre, &tool(1.0)).circles(&profile);
                let found = height(curvature, 1.0, centres);
                let off = (found / residual - 1.0).abs();
                // The triangles cancel: 1e9 mm against 1e-3 mm.
                let allowed = if curvature.abs() == 1e-9 { 1e-4 } else { 1e-10 };
                assert!(off < allowed, "{curvature}, {residual}: {off}");
                let contacts =
                    CuspFeed::new(residual, Radial::Contact, &tool(1.0)).circles(&profile);
                let gap = 1.0 - curvature;
                assert!((contacts * gap / centres - 1.0).abs() < 1e-12);
            }
        }
    }

    /// Over the passage the feed has two continuous derivatives in ε, and it grows.
    #[test]
    fn over_the_passage_the_feed_grows_with_two_continuous_derivatives() {
        for curvature in [-1.0, 0.0, 0.5] {
            let at = |residual: f64| {
                CuspFeed::new(residual, Radial::Centre, &tool(1.0)).feed(&of(curvature))
            };
            let gap = 1.0 - curvature;
            let residual_of = |part: f64| part * part / (8.0 * gap);
            // The flat spacing as a multiple of the centres' spacing.
            let flat = (1.0 / gap - 3.0 + 3.0 * gap).sqrt() / gap.sqrt();
            let step = 1e-3;
            let feed = |way: f64| at(residual_of(way));
            let second = |way: f64| {
                (feed(way + step * 0.04) - 2.0 * feed(way) + feed(way - step * 0.04))
                    / (step * 0.04 * step * 0.04)
            };
            let mut last = feed(0.03 / flat);
            for i in 1..=5000 {
                let way = (0.03 + 0.05 * f64::from(i) / 5000.0) / flat;
                let next = feed(way);
                assert!(next > last, "{curvature}: {way}");
                // Within the parabola's own error of it.
                assert!((next / way - 1.0).abs() < 2e-3, "{curvature}: {way}");
                last = next;
            }
            for border in [PARABOLA_TO, CIRCLES_FROM] {
                let border = border / flat;
                let jump = second(border - step * 0.1) - second(border + step * 0.1);
                assert!(jump.abs() < 0.1, "{curvature}: {jump} at {border}");
            }
        }
    }

    #[test]
    fn below_the_passage_the_feed_is_the_parabolas_to_the_last_bit() {
        for curvature in [-2.0, 0.0, 0.7, 0.95] {
            for part in [1e-4, 1e-2, 0.0399] {
                let gap: f64 = 1.0 - curvature;
                let residual = part * part / (8.0 * (1.0 / gap - 3.0 + 3.0 * gap));
                let feed = CuspFeed::new(residual, Radial::Centre, &tool(1.0)).feed(&of(curvature));
                let parabola = (8.0 * residual * gap).sqrt();
                assert_eq!(feed.to_bits(), parabola.to_bits());
            }
        }
    }

    /// The feed itself, over all curvatures from a sharp dome to a hollow that the nose all but
    /// fills, on a flat and on a slope, and over residuals on both sides of the passage. At the cap
    /// and at half a circle cusps are smaller, and there the feed may only be too small.
    #[test]
    fn on_all_circles_the_cusp_of_the_feed_is_the_residual_within_the_stated_error() {
        let curvatures = [
            -30.0, -4.0, -1.0, -0.3, 0.0, 0.2, 0.33, 0.5, 0.7, 0.8, 0.9, 0.95, 0.97, 0.99,
        ];
        let mut largest: f64 = 0.0;
        for curvature in curvatures {
            for step in 0..400 {
                let residual = 1e-7 * Scalar::exp(f64::from(step) * 0.03);
                for slope in [0.0, 0.8f64] {
                    let w = (1.0 + slope * slope).sqrt();
                    let profile = Profile {
                        height: 0.0,
                        slope,
                        second: curvature * w * w * w,
                    };
                    for radial in [Radial::Centre, Radial::Contact] {
                        let law = CuspFeed::new(residual, radial, &tool(1.0));
                        let gap = 1.0 - curvature;
                        let feed = law.feed(&profile);
                        let centres = match radial {
                            Radial::Centre => feed * w,
                            Radial::Contact => feed * w * gap,
                        };
                        let over = height(curvature, 1.0, centres) / residual - 1.0;
                        let what = format!("{curvature}, {residual}, {slope}: {over}");
                        assert!(over < 1.23e-4, "{what}");
                        let bend = curvature * curvature * residual / (2.0 * gap);
                        let capped = feed >= 0.99 * law.cap(slope, gap);
                        // The triangles cancel where the residual is small.
                        assert!(capped || bend > 0.4 || over > -1e-6, "{what}");
                        largest = largest.max(over);
                    }
                }
            }
        }
        assert!(largest > 1e-4, "{largest}");
    }

    /// The tip between two noses on a slope of 30 degrees, under an edge of 100 degrees: at the cap
    /// the lower side of one edge ends just beyond it.
    #[test]
    fn at_the_cap_the_tip_lies_just_within_the_edges() {
        let included = 100.0f64.to_radians();
        let tool = Tool {
            included_angle: Some(included),
            ..tool(1.0)
        };
        let tilt = 30.0f64.to_radians();
        let profile = Profile {
            slope: Scalar::sin(tilt) / Scalar::cos(tilt),
            ..of(0.0)
        };
        let cap = CuspFeed::new(0.5, Radial::Centre, &tool).feed(&profile);
        let half = 0.5 * cap / Scalar::cos(tilt);
        let depth = (1.0 - half * half).sqrt();
        let aside = half * Scalar::cos(tilt) + depth * Scalar::sin(tilt);
        let used = aside / tool.reach();
        assert!((0.98..1.0).contains(&used), "{used}");
    }
}
