//! First touch: the height of the nose centre when the tool, lowered at (C, X), meets the part.
//!
//! The height of the centre over a contact s of the radial profile is H(s) = g(θ, s) +
//! sqrt(R² − (s − X)²). The contact with the largest height stops the tool. Where Rκ < 1 all over
//! the tool's reach, H has a single maximum, which a bracketed secant finds. Elsewhere a scan of the
//! whole reach ([`crate::scan`]) brackets every maximum that can be the highest.

use turnpath_core::tally::FIRST_TOUCHES;
use turnpath_core::{Misfit, Result, SurfaceModel};

use crate::bracket::Bracket;
use crate::contact_bounds;
use crate::profiles::Profiles;
use crate::scan;
use crate::subject::Subject;

/// The secant stops when it moves less than this part of the nose radius. The error of the height
/// is the square of this: 1e-16 of the radius.
const FOOT_TOLERANCE: f64 = 1e-8;
/// Largest number of steps of the search.
const MOST_STEPS: usize = 80;
/// After this many steps every second one halves the bracket. Halving alone reaches
/// [`FOOT_TOLERANCE`] in 28 steps.
const PATIENCE: usize = 16;
/// Angles and radii at which the profile's curvature is computed, to find out whether the height
/// has a single maximum.
const CURVATURE_GRID: (usize, usize) = (90, 400);
/// Rκ up to which the height is taken to have a single maximum. It is a little below 1, since the
/// curvature may be larger between the points of the grid.
const LARGEST_FIT: f64 = 0.95;

/// Finds first touches of one tool on one surface.
#[derive(Clone)]
pub struct FirstTouch {
    subject: Subject,
    /// |X| up to which the height is known to have a single maximum, mm; negative: nowhere.
    single_to: f64,
    /// Largest distance of a contact from X, mm, for |X| up to `contact_to`.
    contact: f64,
    /// |X| up to which `contact` holds, mm.
    contact_to: f64,
}

/// The position at which the part stops the tool.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Touch {
    /// Z of the nose centre, mm; Z of the contact if the path is that of the contact.
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

/// The bounds of a contact when nothing is known about it.
pub(crate) const ANYWHERE: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

impl FirstTouch {
    /// A search that is fastest for tool positions whose |X| exceeds the aperture's radius by no
    /// more than the nose radius: a normal to the rim leads no further.
    ///
    /// # Errors
    /// Where the surface fails.
    pub fn new(subject: Subject) -> Result<Self> {
        let (radius, rim) = (subject.tool.nose_radius, subject.part.aperture_radius);
        let fits = || -> Result<bool> {
            let found = largest_curvature(subject.surface.as_ref(), rim + 2.0 * radius)?;
            Ok(found.is_some_and(|curvature| radius * curvature < LARGEST_FIT))
        };
        let single = match (subject.compensates_nose, subject.tool.misfit) {
            (false, _) => true,
            (true, Misfit::Refuse) => fits()?,
            // A seam can be so sharp that no grid of curvatures shows it.
            (true, Misfit::CutWhatFits) => false,
        };
        let contact = match single {
            true => subject.tool.reach(),
            false => contact_bounds::farthest_contact(&subject, rim + 2.0 * radius)?,
        };
        Ok(Self {
            subject,
            single_to: if single { rim + radius } else { -1.0 },
            contact,
            contact_to: rim + radius,
        })
    }

    /// The surface, the part and the tool.
    pub fn subject(&self) -> &Subject {
        &self.subject
    }

    /// Whether the height has a single maximum everywhere on the part, so that no scan is needed.
    pub fn has_single_maximum(&self) -> bool {
        self.single_to >= 0.0
    }

    /// Whether the nose may leave material that no pass of it can reach.
    pub fn leaves_seams(&self) -> bool {
        self.subject.tool.misfit == Misfit::CutWhatFits && self.subject.compensates_nose
    }

    /// Finds the first touch at each (θ, X); NaN where the surface has no height below the nose.
    ///
    /// # Errors
    /// Where the surface fails.
    pub fn find(&self, theta: &[f64], x: &[f64], out: &mut Vec<Touch>) -> Result<()> {
        self.find_within(theta, x, |_| ANYWHERE, out)
    }

    /// Like [`Self::find`] where each contact is known to lie `within` two radii: those of the
    /// contacts at a smaller and at a larger X, since the contact moves outward as X grows.
    pub(crate) fn find_within(
        &self,
        theta: &[f64],
        x: &[f64],
        within: impl Fn(usize) -> (f64, f64),
        out: &mut Vec<Touch>,
    ) -> Result<()> {
        FIRST_TOUCHES.add(x.len());
        let mut profiles = Profiles::new(self.subject.surface.as_ref(), theta);
        out.clear();
        out.resize(x.len(), Touch::NOWHERE);
        let tool = &self.subject.tool;
        if !self.subject.compensates_nose {
            on_surface(&mut profiles, x, out)
        } else if x.iter().all(|x| x.abs() <= self.single_to) {
            let mut brackets = Bracket::of_reach(tool, x);
            close_in(&mut profiles, tool.nose_radius, x, &mut brackets, out)
        } else {
            let within = |point: usize| self.narrowed(x[point], within(point));
            let mut maxima = scan::maxima(&mut profiles, tool, x, within)?;
            let mut tops = vec![Touch::NOWHERE; maxima.len()];
            close_in(&mut profiles, tool.nose_radius, x, &mut maxima, &mut tops)?;
            for (maximum, top) in maxima.iter().zip(tops) {
                let touch = &mut out[maximum.point];
                if touch.z.is_nan() || top.z > touch.z {
                    *touch = top;
                }
            }
            Ok(())
        }
    }

    /// Narrows the bounds of the contact with the nose at `x` to what the surface's slopes allow.
    fn narrowed(&self, x: f64, (low, high): (f64, f64)) -> (f64, f64) {
        match x.abs() <= self.contact_to {
            true => (low.max(x - self.contact), high.min(x + self.contact)),
            false => (low, high),
        }
    }
}

/// The touches on the path of the contact: points of the surface itself.
fn on_surface(profiles: &mut Profiles<'_>, x: &[f64], out: &mut [Touch]) -> Result<()> {
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

/// One search in one bracket: F(s) = g_ρ q − (s − X), with q = sqrt(R² − (s − X)²), falls through
/// zero at a maximum.
#[derive(Clone, Copy)]
struct Search {
    /// Index of the bracket.
    bracket: usize,
    /// The present s.
    at: f64,
    /// The previous s, and F there.
    before: Option<(f64, f64)>,
}

/// Closes in on the maximum in every bracket. `out` has one entry for each bracket.
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
            let here = Evaluation {
                fall: slope * lift - offset,
                by_normal: x[bracket.point] + radius * slope / (1.0 + slope * slope).sqrt(),
            };
            let halve = step > PATIENCE && step % 2 == 0;
            let next = search.next(&here, bracket, halve);
            if (next - search.at).abs() <= FOOT_TOLERANCE * radius {
                return false;
            }
            search.before = Some((search.at, here.fall));
            search.at = next;
            true
        });
    }
    Ok(())
}

/// The values of one step of a search.
struct Evaluation {
    /// F at the present s.
    fall: f64,
    /// The next s by the normal through this contact: the first guess.
    by_normal: f64,
}

impl Search {
    /// The next s. The first step follows the normal through the contact, later steps the secant.
    /// If the proposed s lies outside the bracket, or `halve` is set, the next s is the middle of
    /// the bracket. Where the surface has no value, the bracket shrinks towards its start, where
    /// the surface has one.
    fn next(&self, here: &Evaluation, bracket: &mut Bracket, halve: bool) -> f64 {
        let nowhere = here.fall.is_nan();
        if here.fall > 0.0 || (nowhere && self.at < bracket.start) {
            bracket.low = self.at;
        } else if here.fall < 0.0 || (nowhere && self.at > bracket.start) {
            bracket.high = self.at;
        }
        let proposed = match self.before {
            None => here.by_normal,
            Some((at, then)) if then != here.fall => {
                self.at - here.fall * (self.at - at) / (here.fall - then)
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

/// The largest curvature of the radial profiles out to ±`reach`; `None` if one of them is not
/// finite.
fn largest_curvature(surface: &dyn SurfaceModel, reach: f64) -> Result<Option<f64>> {
    let (angles, radii) = CURVATURE_GRID;
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
