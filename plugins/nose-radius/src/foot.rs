//! The foot: where the nose at a given X touches the radial section from above.
//!
//! Let d be the foot's distance from the centre's X. The touching circle has d = R g_ρ/w at the
//! foot, so d is a root of G(d) = d − R g_ρ(ρ + d)/w. G′ = 1 − Rκ: where the nose fits (Rκ < 1 over
//! its reach) G grows, the root is the only one, and G(−R) < 0 < G(R) is its bracket. Where the nose
//! need not fit, a scan brackets all roots that may be the highest point.

use turnpath_plugin::prelude::*;

use crate::polar::{Evaluation, Rays};
use crate::scan::{Maximum, scan};
use crate::search::{Bracket, Searches, WIDTH};
use crate::touch::{Nose, Touch, rise};

/// A maximum counts as the highest if it lies below the highest point of a scan by less than this
/// part of R. This is more than rounding, and more than the difference of maxima that are too close
/// for a scan to separate.
const INSEPARABLE: f64 = 1e-11;

/// Finds feet in batches. One finder serves for any number of batches.
#[derive(Default)]
pub struct FootFinder {
    brackets: Vec<Bracket>,
    searches: Searches,
    points: Evaluation<f64>,
    rays: Rays,
    touches: Vec<Touch>,
}

impl FootFinder {
    /// The touch at each (θ, ρ).
    pub fn find(&mut self, cut: Cut<'_>, theta: &[f64], rho: &[f64]) -> Result<&[Touch]> {
        let nose = Nose {
            radius: cut.tool.nose_radius,
            reach: cut.tool.reach(),
        };
        self.touches.clear();
        let rays = self.rays.at(theta.iter().copied());
        let touches = rays.zip(rho).map(|(ray, rho)| Touch::unknown(ray, *rho));
        self.touches.extend(touches);
        self.brackets.clear();
        match cut.tool.misfit {
            Misfit::Refuse => {
                let brackets = (0..theta.len()).map(|point| Bracket::whole(point, nose));
                self.brackets.extend(brackets);
                self.search(cut.surface, nose)?;
            }
            Misfit::CutWhatFits => self.find_highest(cut.surface, nose)?,
        }
        Ok(&self.touches)
    }

    /// The touch at the highest of all maxima. There is none if the surface rises up to a border of
    /// its own within the reach: nobody knows what the nose would touch there.
    fn find_highest(&mut self, surface: &dyn SurfaceModel, nose: Nose) -> Result<()> {
        let scan = scan(surface, nose, &self.touches, &mut self.points)?;
        let unknown = std::mem::take(&mut self.touches);
        for (rival, candidate) in scan.candidates.iter().enumerate() {
            let mut touch = unknown[candidate.point];
            match candidate.maximum {
                Maximum::Between { lower, upper } => {
                    self.brackets.push(Bracket::between(rival, lower, upper));
                }
                Maximum::EdgeEnd(offset) => (touch.offset, touch.at_edge_end) = (offset, true),
            }
            self.touches.push(touch);
        }
        self.search(surface, nose)?;
        let rivals = std::mem::replace(&mut self.touches, unknown);
        let (touches, points) = (&mut self.touches, &mut self.points);
        points.set(rivals.iter().map(|rival| rival.ray.point(rival.foot())));
        points.gradient(surface)?;
        let mut tops: Vec<f64> = scan
            .highest
            .iter()
            .map(|highest| highest - INSEPARABLE * nose.radius)
            .collect();
        for ((rival, candidate), height) in rivals.iter().zip(&scan.candidates).zip(&points.z) {
            let top = height + rise(nose.radius, rival.offset);
            if top > tops[candidate.point] {
                tops[candidate.point] = top;
                touches[candidate.point] = *rival;
            }
        }
        Ok(())
    }

    /// Runs all searches to their ends.
    fn search(&mut self, surface: &dyn SurfaceModel, nose: Nose) -> Result<()> {
        for brackets in self.brackets.chunks(WIDTH) {
            self.searches.begin(brackets, &self.touches, nose);
            self.searches.run(surface, &mut self.touches)?;
        }
        Ok(())
    }
}
