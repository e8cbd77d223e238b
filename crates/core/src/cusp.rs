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
//! Small feeds follow the parabola, and large feeds the circles. Between them the feed passes from
//! one to the other with two continuous derivatives.

use crate::profile::Profile;
use crate::{Mask, Misfit, Radial, Scalar, Tool};

/// Up to this part of the nose radius a feed is the parabola's. Its cusps are up to 1e-4 of their
/// height too high there, which the margins of the feed strategies cover.
pub const PARABOLA_TO: f64 = 1.0 / 25.0;

/// From this part of the nose radius on, a feed is that of the circles. On the way to it the cusps
/// are less than 1.2e-4 of their height too high.
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

    /// The parabola's feed, mm: sqrt(8Rε/(1 − Rκ))/w for the contact's radius, and
    /// sqrt(8Rε(1 − Rκ))/w for the centre's X. Infinite where the nose does not fit.
    pub fn parabola(&self, profile: &Profile) -> f64 {
        let (nose_radius, residual) = (self.nose_radius, self.residual);
        let gap = match (1.0 - nose_radius * profile.curvature(), self.misfit) {
            (gap, Misfit::CutWhatFits) if gap < LEAST_GAP => LEAST_GAP,
            (gap, _) => gap,
        };
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
        let gap = 1.0 - self.nose_radius * profile.curvature();
        let gap = match self.misfit {
            Misfit::CutWhatFits => gap.max(LEAST_GAP),
            Misfit::Refuse => gap,
        };
        let cap = self.cap(profile.slope, gap);
        if gap <= 0.0 {
            return cap;
        }
        let feed = self.parabola(profile) * self.correction(gap).sqrt();
        if feed > cap { cap } else { feed }
    }

    /// The feed from the curvature and the slope at the contact alone, mm.
    pub fn feed(&self, profile: &Profile) -> f64 {
        let parabola = self.parabola(profile);
        match self.share(parabola) {
            0.0 => parabola,
            _ => self.joined(parabola, self.circles(profile)),
        }
    }

    /// Joins the parabola's feed and that of circles, mm.
    pub fn joined(&self, parabola: f64, circles: f64) -> f64 {
        match self.share(parabola) {
            0.0 => parabola,
            1.0 => circles,
            share => parabola + share * (circles - parabola),
        }
    }

    /// The part that the feed of circles has where the parabola's feed is `parabola`, mm: 0 for
    /// small feeds, 1 for large ones.
    pub fn share<S: Scalar>(&self, parabola: S) -> S {
        let way = parabola / self.nose_radius - PARABOLA_TO;
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
    /// not fall below the largest part of the nose radius at which the parabola counts: where the
    /// contact comes so near to the end of the edge, the interference check decides.
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

    /// Whether some of these feeds of the parabola, mm, are so large that circles count.
    pub fn needs_circles<S: Scalar>(&self, parabola: S) -> bool {
        (!parabola.less(S::constant(PARABOLA_TO * self.nose_radius))).any()
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
            let step = 1e-3;
            let feed = |way: f64| at(residual_of(way));
            let second = |way: f64| {
                (feed(way + step * 0.04) - 2.0 * feed(way) + feed(way - step * 0.04))
                    / (step * 0.04 * step * 0.04)
            };
            let mut last = feed(0.03);
            for i in 1..=5000 {
                let way = 0.03 + 0.05 * f64::from(i) / 5000.0;
                let next = feed(way);
                assert!(next > last, "{curvature}: {way}");
                // Within the parabola's own error of it.
                assert!((next / way - 1.0).abs() < 2e-3, "{curvature}: {way}");
                last = next;
            }
            for border in [PARABOLA_TO, CIRCLES_FROM] {
                let jump = second(border - step * 0.1) - second(border + step * 0.1);
                assert!(jump.abs() < 0.1, "{curvature}: {jump} at {border}");
            }
        }
    }

    #[test]
    fn below_the_passage_the_feed_is_the_parabolas_to_the_last_bit() {
        for curvature in [-2.0, 0.0, 0.7] {
            for part in [1e-4, 1e-2, 0.0399] {
                let gap = 1.0 - curvature;
                let residual = part * part / (8.0 * gap);
                let feed = CuspFeed::new(residual, Radial::Centre, &tool(1.0)).feed(&of(curvature));
                let parabola = (8.0 * residual * gap).sqrt();
                assert_eq!(feed.to_bits(), parabola.to_bits());
            }
        }
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
