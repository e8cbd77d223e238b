//! Compensation along Z: X is what the feed says, and Z is raised by R/cos α at the contact.
//!
//! The nose of radius R touches the radial profile z = g(s) at s where its normal passes through the
//! centre: X = s − R sin α, Z = g(s) + R cos α, tan α = g′(s). On a straight slope the contact lies R
//! sin α beside X, so that Z stands R/cos α above the profile at X; Newton's iteration takes the bend
//! of the profile into account.
#![forbid(unsafe_code)]
use turnpath_plugin::locus::{Profile, profile_at};
use turnpath_plugin::prelude::*;

/// Most steps of Newton's iteration. Where the nose fits, it takes four.
const MOST_STEPS: usize = 20;
/// A step below this part of the nose radius ends the iteration. The error of Z is its square.
const ENOUGH: f64 = 1e-10;

struct ZByCosine;

impl Strategy for ZByCosine {
    const NAME: &'static str = "z-by-cosine";
    const SUMMARY: &'static str = "X as the feed says, Z raised by the cosine of the slope";
    const SOURCE: &'static str = "X = s − R sin α, Z = g(s) + R cos α, tan α = g′(s)";

    fn new(_: &Params) -> Result<Self> {
        Ok(Self)
    }
}

impl Compensator for ZByCosine {
    /// ρ is X of the nose centre.
    fn radial(&self) -> Radial {
        Radial::Centre
    }

    fn centre(&self, cut: Cut<'_>, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()> {
        let radius = cut.tool.nose_radius;
        let mut profile = vec![Profile::default(); theta.len()];
        // A point ends by itself: its answer must not depend on the others of the batch.
        let mut moves = vec![true; theta.len()];
        out.foot.copy_from_slice(rho);
        for _ in 0..MOST_STEPS {
            profile_at(cut.surface, theta, out.foot, &mut profile)?;
            for (i, profile) in profile.iter().enumerate() {
                if !moves[i] {
                    continue;
                }
                let w = profile.slant();
                // s − R sin α − X, and its derivative by s.
                let miss = out.foot[i] - radius * profile.slope / w - rho[i];
                let step = miss / (1.0 - radius * profile.second / (w * w * w));
                out.foot[i] -= step;
                moves[i] = step.abs() > ENOUGH * radius;
            }
            if !moves.contains(&true) {
                break;
            }
        }
        profile_at(cut.surface, theta, out.foot, &mut profile)?;
        out.x.copy_from_slice(rho);
        for (i, profile) in profile.iter().enumerate() {
            // The nose over the contact: exact to the square of what the contact misses.
            let beside = out.foot[i] - rho[i];
            out.z[i] = profile.height + (radius * radius - beside * beside).sqrt();
        }
        Ok(())
    }
}

turnpath_plugin::export!(compensators: [ZByCosine]);

#[cfg(test)]
mod tests {
    #[test]
    fn conforms() {
        turnpath_plugin_test::check!();
    }
}
