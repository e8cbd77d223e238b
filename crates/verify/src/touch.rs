//! First touch: how high the nose centre stands when the tool, lowered at (C, X), meets the part.
//!
//! The height of the centre over a contact s of the radial profile is H(s) = g(θ, s) +
//! sqrt(R² − (s − X)²), and the tool is stopped by the largest one. Where Rκ < 1 all over the
//! tool's reach, H has a single maximum, which a bracketed secant finds; elsewhere a scan of the
//! whole reach ([`crate::scan`]) brackets every maximum that can be the largest.

use turnpath_core::{Misfit, Result, SurfaceModel, Tool};

use crate::Subject;
use crate::profiles::Profiles;
use crate::scan;
use crate::steep;

/// The secant stops when it moves less than this part of the nose radius. The height is wrong by
/// the square of it: 1e-16 of the radius.
const FOOT_TOLERANCE: f64 = 1e-8;
/// Most steps of the search, and from where on every second one halves the bracket: that alone
/// reaches [`FOOT_TOLERANCE`] in 28 halvings.
const MOST_STEPS: usize = 80;
const PATIENCE: usize = 16;
/// Angles and radii at which the profile's curvature is looked at before a single maximum is
/// taken for granted.
const LOOK: (usize, usize) = (90, 400);
/// Rκ up to which a single maximum is taken for granted, a little below 1 for what lies between
/// the places looked at.
const LARGEST_FIT: f64 = 0.95;

/// Finds first touches of one tool on one surface.
#[derive(Clone)]
pub struct FirstTouch {
    subject: Subject,
    /// |X| up to which the profile is known to leave a single maximum; below 0: nowhere.
    single_to: f64,
    /// Contacts are no further from X than this, mm,
    contact: f64,
    /// for |X| up to this, mm.
    contact_to: f64,
}

/// Where the tool is stopped.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Touch {
    /// Z of the nose centre, mm; with a point for a tool, of the point.
    pub z: f64,
    /// Radius of the contact, mm; negative beyond the axis.
    pub foot: f64,
    /// Slope of the profile at the contact.
    pub slope: f64,
}

impl Touch {
    pub(crate) const NOWHERE: Self = Self {
        z: f64::NAN,
        foot: f64::NAN,
        slope: f64::NAN,
    };
}

/// Bounds of a contact of which nothing is known.
pub(crate) const ANYWHERE: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

impl FirstTouch {
    /// Quickest for tool positions whose X lies within the aperture, or beyond it by what a normal
    /// to the rim takes: the nose radius.
    pub fn new(subject: Subject) -> Result<Self> {
        let (radius, rim) = (subject.tool.nose_radius, subject.part.aperture_radius);
        let fits = || -> Result<bool> {
            let found = largest_curvature(subject.surface.as_ref(), rim + 2.0 * radius)?;
            Ok(found.is_some_and(|curvature| radius * curvature < LARGEST_FIT))
        };
        let single = match (subject.compensates_nose, subject.tool.misfit) {
            (false, _) => true,
            (true, Misfit::Refuse) => fits()?,
            // Seams may be sharper than any look at curvatures sees.
            (true, Misfit::CutWhatFits) => false,
        };
        let contact = match single {
            true => subject.tool.reach(),
            false => steep::farthest_contact(&subject, rim + 2.0 * radius)?,
        };
        Ok(Self {
            subject,
            single_to: if single { rim + radius } else { -1.0 },
            contact,
            contact_to: rim + radius,
        })
    }

    /// What is measured.
    pub fn subject(&self) -> &Subject {
        &self.subject
    }

    /// Whether the profile leaves a single maximum everywhere, so that no scan is needed.
    pub fn is_single(&self) -> bool {
        self.single_to >= 0.0
    }

    /// Whether the nose may leave something standing that no pass of it reaches.
    pub fn leaves_seams(&self) -> bool {
        self.subject.tool.misfit == Misfit::CutWhatFits && self.subject.compensates_nose
    }

    /// The first touch at each (θ, X); NaN where the surface has no height below the nose.
    pub fn find(&self, theta: &[f64], x: &[f64], out: &mut Vec<Touch>) -> Result<()> {
        self.find_within(theta, x, |_| ANYWHERE, out)
    }

    /// The same where the contact of each is known to lie `within` two radii, those of the contacts
    /// with the nose further in and further out: the contact moves outward with X.
    pub(crate) fn find_within(
        &self,
        theta: &[f64],
        x: &[f64],
        within: impl Fn(usize) -> (f64, f64),
        out: &mut Vec<Touch>,
    ) -> Result<()> {
        let mut profiles = Profiles::new(self.subject.surface.as_ref(), theta);
        out.clear();
        out.resize(x.len(), Touch::NOWHERE);
        let tool = &self.subject.tool;
        if !self.subject.compensates_nose {
            bare(&mut profiles, x, out)
        } else if x.iter().all(|x| x.abs() <= self.single_to) {
            let mut brackets = Bracket::of_reach(tool, x);
            close_in(&mut profiles, tool.nose_radius, x, &mut brackets, out)
        } else {
            let within = |point: usize| self.narrowed(x[point], within(point));
            let mut hills = scan::hills(&mut profiles, tool, x, within)?;
            let mut tops = vec![Touch::NOWHERE; hills.len()];
            close_in(&mut profiles, tool.nose_radius, x, &mut hills, &mut tops)?;
            for (hill, top) in hills.iter().zip(tops) {
                let touch = &mut out[hill.point];
                if touch.z.is_nan() || top.z > touch.z {
                    *touch = top;
                }
            }
            Ok(())
        }
    }

    /// Bounds of the contact with the nose at `x`, by what the slopes allow.
    fn narrowed(&self, x: f64, (low, high): (f64, f64)) -> (f64, f64) {
        match x.abs() <= self.contact_to {
            true => (low.max(x - self.contact), high.min(x + self.contact)),
            false => (low, high),
        }
    }
}

/// The touch of a point: the surface itself.
fn bare(profiles: &mut Profiles<'_>, x: &[f64], out: &mut [Touch]) -> Result<()> {
    profiles.at_all(x)?;
    for (i, touch) in out.iter_mut().enumerate() {
        *touch = Touch {
            z: profiles.height[i],
            foot: x[i],
            slope: profiles.slope[i],
        };
    }
    Ok(())
}

/// Where a maximum lies.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bracket {
    /// Of which (θ, X).
    pub point: usize,
    pub low: f64,
    pub high: f64,
    /// A place in it where the surface has a height.
    pub start: f64,
}

impl Bracket {
    fn of_reach(tool: &Tool, x: &[f64]) -> Vec<Self> {
        let reach = tool.reach();
        let around = |(point, x): (usize, &f64)| Self {
            point,
            low: x - reach,
            high: x + reach,
            start: *x,
        };
        x.iter().enumerate().map(around).collect()
    }
}

/// One search: F(s) = g_ρ q − (s − X), q = sqrt(R² − (s − X)²), falls through zero at a maximum.
#[derive(Clone, Copy)]
struct Search {
    bracket: usize,
    at: f64,
    before: Option<(f64, f64)>,
}

/// Closes in on the maximum in every bracket; `out` has a place for each.
fn close_in(
    profiles: &mut Profiles<'_>,
    radius: f64,
    x: &[f64],
    brackets: &mut [Bracket],
    out: &mut [Touch],
) -> Result<()> {
    let begin = |(bracket, within): (usize, &Bracket)| Search {
        bracket,
        at: within.start,
        before: None,
    };
    let mut open: Vec<Search> = brackets.iter().enumerate().map(begin).collect();
    for step in 0..MOST_STEPS {
        if open.is_empty() {
            break;
        }
        let point = |search: &Search| brackets[search.bracket].point;
        profiles.at(open.iter().map(|search| (point(search), search.at)))?;
        let mut i = 0;
        open.retain_mut(|search| {
            let (height, slope) = (profiles.height[i], profiles.slope[i]);
            i += 1;
            let bracket = &mut brackets[search.bracket];
            let offset = search.at - x[bracket.point];
            let lift = (radius * radius - offset * offset).max(0.0).sqrt();
            if height.is_finite() {
                out[search.bracket] = Touch {
                    z: height + lift,
                    foot: search.at,
                    slope,
                };
            }
            let seen = Seen {
                fall: slope * lift - offset,
                by_normal: x[bracket.point] + radius * slope / (1.0 + slope * slope).sqrt(),
            };
            let halve = step > PATIENCE && step % 2 == 0;
            let next = search.next(&seen, bracket, halve);
            if (next - search.at).abs() <= FOOT_TOLERANCE * radius {
                return false;
            }
            search.before = Some((search.at, seen.fall));
            search.at = next;
            true
        });
    }
    Ok(())
}

/// What a search finds at one place.
struct Seen {
    /// F there.
    fall: f64,
    /// Where the normal through this contact leads: the first guess of a better one.
    by_normal: f64,
}

impl Search {
    /// The next place: by the normal through the contact at first, then by the secant; the middle
    /// of the bracket where either leaves it, or when it is time to halve. Where the surface has
    /// no value the bracket shrinks towards its start, which had one.
    fn next(&self, seen: &Seen, bracket: &mut Bracket, halve: bool) -> f64 {
        let nowhere = seen.fall.is_nan();
        if seen.fall > 0.0 || (nowhere && self.at < bracket.start) {
            bracket.low = self.at;
        } else if seen.fall < 0.0 || (nowhere && self.at > bracket.start) {
            bracket.high = self.at;
        }
        let proposed = match self.before {
            None => seen.by_normal,
            Some((at, then)) if then != seen.fall => {
                self.at - seen.fall * (self.at - at) / (seen.fall - then)
            }
            Some(_) => self.at,
        };
        if !halve && (bracket.low..=bracket.high).contains(&proposed) {
            proposed
        } else {
            0.5 * (bracket.low + bracket.high)
        }
    }
}

/// The largest curvature of the radial profiles out to ±`reach`; `None` where there is no value.
fn largest_curvature(surface: &dyn SurfaceModel, reach: f64) -> Result<Option<f64>> {
    let (angles, radii) = LOOK;
    let mut largest = f64::NEG_INFINITY;
    let mut profiles = vec![turnpath_core::locus::Profile::default(); angles];
    let theta: Vec<f64> = (0..angles)
        .map(|i| std::f64::consts::PI * i as f64 / angles as f64)
        .collect();
    for i in 0..=radii {
        let rho = vec![reach * (2.0 * i as f64 / radii as f64 - 1.0); angles];
        turnpath_core::locus::profile_at(surface, &theta, &rho, &mut profiles)?;
        for profile in &profiles {
            let curvature = profile.curvature();
            if !curvature.is_finite() {
                return Ok(None);
            }
            largest = largest.max(curvature);
        }
    }
    Ok(Some(largest))
}
