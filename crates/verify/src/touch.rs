//! First touch: the height of the nose centre when the tool, lowered at (C, X), meets the part.
//!
//! The height of the centre over a contact s of the radial profile is H(s) = g(θ, s) +
//! sqrt(R² − (s − X)²). The contact with the largest height stops the tool. Where Rκ < 1 all over
//! the tool's reach, H has a single maximum, which a bracketed secant finds. Elsewhere a scan of the
//! whole reach ([`crate::scan`]) brackets every maximum that can be the highest.

use rayon::prelude::*;
use turnpath_core::locus::{Profile, profile_at};
use turnpath_core::registers::in_widest;
use turnpath_core::tally::FIRST_TOUCHES;
use turnpath_core::{Misfit, Result, SurfaceModel};

use crate::contact_bounds;
use crate::next_contacts::NextContacts;
use crate::profiles::Profiles;
use crate::scan;
use crate::search_limits::{SURE_FIT, WIDTH};
use crate::searches::Searches;
use crate::small_turns::TurnStarts;
use crate::subject::Subject;
pub use crate::touches::Touch;
use crate::touches::Touches;

/// Angles and radii at which the profile's curvature is computed, to find out whether the height
/// has a single maximum.
const CURVATURE_GRID: (usize, usize) = (90, 400);

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

/// What the search for first touches needs again and again, and what it found last.
#[derive(Default)]
pub(crate) struct TouchBuffers {
    searches: Box<Searches>,
    /// The touches of the last search.
    pub touches: Touches,
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
            Ok(found.is_some_and(|curvature| radius * curvature < SURE_FIT))
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
        let mut buffers = TouchBuffers::default();
        buffers.touches.resize(x.len());
        self.search(theta, x, within, &mut buffers, 0)?;
        out.clear();
        out.extend(buffers.touches.iter());
        Ok(())
    }

    /// Like [`Self::find`], without an allocation for each batch: the touches are in the buffers.
    pub(crate) fn find_in(
        &self,
        theta: &[f64],
        x: &[f64],
        buffers: &mut TouchBuffers,
    ) -> Result<()> {
        buffers.touches.resize(x.len());
        self.search(theta, x, |_| ANYWHERE, buffers, 0)
    }

    /// Finds the first touch along curves side by side, at most [`WIDTH`] of them. `theta` and `x` have
    /// the position of each at one time, then at the next one, and so on, evenly spaced. The touches at
    /// the first time are known: they are the first ones of `known`. Where the height has a single
    /// maximum, each search begins where the touches before lead.
    pub(crate) fn find_along(
        &self,
        theta: &[f64],
        x: &[f64],
        (known, curves): (&Touches, usize),
        buffers: &mut TouchBuffers,
    ) -> Result<()> {
        buffers.touches.resize(x.len());
        buffers.touches.begin_with(known, curves);
        if !self.subject.compensates_nose || !self.has_single_maxima(x) {
            let (theta, x) = (&theta[curves..], &x[curves..]);
            return self.search(theta, x, |_| ANYWHERE, buffers, curves);
        }
        FIRST_TOUCHES.add(x.len() - curves);
        let Subject { surface, tool, .. } = &self.subject;
        let TouchBuffers { searches, touches } = buffers;
        let starts = TurnStarts::at(&theta[..curves]);
        let mut expected = [0.0; WIDTH];
        for first in (curves..x.len()).step_by(curves.max(1)) {
            let here = first..first + curves;
            let expected = &mut expected[..curves];
            in_widest(NextContacts::after(
                &touches.foot[..first],
                &x[..here.end],
                expected,
            ));
            let places = (&theta[here.clone()], &x[here]);
            searches.begin_near(&starts, expected, places, tool.reach());
            searches.close_in(surface.as_ref(), tool.nose_radius, touches, first)?;
        }
        Ok(())
    }

    /// Searches for touches and writes them from number `first` on.
    fn search(
        &self,
        theta: &[f64],
        x: &[f64],
        within: impl Fn(usize) -> (f64, f64),
        buffers: &mut TouchBuffers,
        first: usize,
    ) -> Result<()> {
        FIRST_TOUCHES.add(x.len());
        if !self.subject.compensates_nose {
            self.on_surface(theta, x, &mut buffers.touches, first)
        } else if self.has_single_maxima(x) {
            self.only_maxima(theta, x, buffers, first)
        } else {
            self.highest_maxima(theta, x, within, buffers, first)
        }
    }

    /// Whether the height has a single maximum at each X.
    fn has_single_maxima(&self, x: &[f64]) -> bool {
        // Without a way out of the loop it goes through vector registers.
        x.iter()
            .fold(true, |all, x| all & (x.abs() <= self.single_to))
    }

    /// The touches on the path of the contact: points of the surface itself.
    fn on_surface(
        &self,
        theta: &[f64],
        x: &[f64],
        found: &mut Touches,
        first: usize,
    ) -> Result<()> {
        let mut profiles = Profiles::new(self.subject.surface.as_ref(), theta);
        profiles.at_all(x)?;
        found.z[first..].copy_from_slice(&profiles.height);
        found.foot[first..].copy_from_slice(x);
        found.slope[first..].copy_from_slice(&profiles.slope);
        Ok(())
    }

    /// The touches where the height has a single maximum.
    fn only_maxima(
        &self,
        theta: &[f64],
        x: &[f64],
        buffers: &mut TouchBuffers,
        first: usize,
    ) -> Result<()> {
        let Subject { surface, tool, .. } = &self.subject;
        let TouchBuffers { searches, touches } = buffers;
        let batches = theta.chunks(WIDTH).zip(x.chunks(WIDTH));
        for (batch, (theta, x)) in batches.enumerate() {
            let first = first + batch * WIDTH;
            searches.begin_in_reach(theta, x, tool.reach());
            searches.close_in(surface.as_ref(), tool.nose_radius, touches, first)?;
        }
        Ok(())
    }

    /// The touches where the height may have several maxima.
    fn highest_maxima(
        &self,
        theta: &[f64],
        x: &[f64],
        within: impl Fn(usize) -> (f64, f64),
        buffers: &mut TouchBuffers,
        first: usize,
    ) -> Result<()> {
        let Subject { surface, tool, .. } = &self.subject;
        let mut profiles = Profiles::new(surface.as_ref(), theta);
        let within = |point: usize| self.narrowed(x[point], within(point));
        let maxima = scan::maxima(&mut profiles, tool, x, within)?;
        let mut tops = Touches::default();
        tops.resize(maxima.len());
        for (batch, maxima) in maxima.chunks(WIDTH).enumerate() {
            let searches = &mut buffers.searches;
            searches.begin_in_brackets(maxima, &profiles, x);
            searches.close_in(surface.as_ref(), tool.nose_radius, &mut tops, batch * WIDTH)?;
        }
        buffers.touches.clear_from(first);
        for (maximum, top) in maxima.iter().zip(tops.iter()) {
            let owner = first + maximum.point;
            let highest = buffers.touches.z[owner];
            if highest.is_nan() || top.z > highest {
                buffers.touches.set(owner, top);
            }
        }
        Ok(())
    }

    /// Narrows the bounds of the contact with the nose at `x` to what the surface's slopes allow.
    fn narrowed(&self, x: f64, (low, high): (f64, f64)) -> (f64, f64) {
        match x.abs() <= self.contact_to {
            true => (low.max(x - self.contact), high.min(x + self.contact)),
            false => (low, high),
        }
    }
}

/// The largest curvature of the radial profiles out to ±`reach`; `None` if one of them is not
/// finite.
fn largest_curvature(surface: &dyn SurfaceModel, reach: f64) -> Result<Option<f64>> {
    let (angles, radii) = CURVATURE_GRID;
    let theta: Vec<f64> = (0..angles)
        .map(|i| std::f64::consts::PI * i as f64 / angles as f64)
        .collect();
    let on_ring = |i: usize| -> Result<Option<f64>> {
        let rho = vec![reach * (2.0 * i as f64 / radii as f64 - 1.0); angles];
        let mut profiles = vec![Profile::default(); angles];
        profile_at(surface, &theta, &rho, &mut profiles)?;
        let mut curvatures = profiles.iter().map(Profile::curvature);
        let finite = |largest: f64, one: f64| one.is_finite().then(|| largest.max(one));
        Ok(curvatures.try_fold(f64::NEG_INFINITY, finite))
    };
    // Most surfaces that end within reach have no value on the outermost ring: then no other ring is asked.
    let Some(mut largest) = on_ring(0)? else {
        return Ok(None);
    };
    let rings: Vec<Result<Option<f64>>> = (1..=radii).into_par_iter().map(on_ring).collect();
    // The first ring that fails or has no value decides, as if they had been asked one after the other.
    for ring in rings {
        match ring? {
            Some(on_ring) => largest = largest.max(on_ring),
            None => return Ok(None),
        }
    }
    Ok(Some(largest))
}
