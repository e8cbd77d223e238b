//! Where the nose makes contact at the ends of the range of ρ.

use turnpath_core::{
    CentreBuffers, Locus, RadialRange, Scalar, StrategyError, Tool, ToolLocus, even_angles,
};

use crate::{LocusLinks, PipelineError, Result};

/// Angles at which the contact is looked for beyond the rim and the hole.
const RIM_ANGLES: usize = 720;
/// Positions within the nose's reach at which the surface is looked for.
const REACH_POSITIONS: usize = 64;

/// The radii of contact while ρ runs over `range`. Where ρ is the centre's X, the contact goes
/// beyond that range on slopes.
pub fn contact_range(
    links: &LocusLinks,
    locus: &ToolLocus,
    tool: &Tool,
    range: RadialRange,
) -> Result<RadialRange> {
    let theta: Vec<f64> = even_angles(RIM_ANGLES).collect();
    let mut contact = RadialRange {
        inner: range.inner.abs(),
        ..range
    };
    for rho in [range.inner, range.outer] {
        let mut centres = CentreBuffers::default();
        centres.resize(theta.len());
        let answer = locus.centre(&theta, &vec![rho; theta.len()], centres.as_centres());
        answer.map_err(|error| links.compensator.failed(format!("at ρ = {rho} mm"), error))?;
        for (foot, theta) in centres.foot.iter().zip(&theta) {
            if !foot.is_finite() {
                return Err(no_contact(links, tool, *theta, rho));
            }
            contact.inner = contact.inner.min(foot.abs());
            contact.outer = contact.outer.max(foot.abs());
        }
    }
    if range.inner <= 0.0 {
        contact.inner = 0.0;
    }
    Ok(contact)
}

/// The error where a compensator finds no contact. It is the recipe's fault if the surface ends
/// within the nose's reach, and the compensator's if it does not.
pub fn no_contact(links: &LocusLinks, tool: &Tool, theta: f64, rho: f64) -> PipelineError {
    let context = format!(
        "at C = {:.1} deg, ρ = {rho:.4} mm",
        theta / turnpath_core::DEG
    );
    let (s, c) = Scalar::sin_cos(theta);
    let reach = tool.reach();
    let feet = (0..=REACH_POSITIONS)
        .map(|i| rho + reach * (2.0 * i as f64 / REACH_POSITIONS as f64 - 1.0));
    let (x, y): (Vec<f64>, Vec<f64>) = feet.map(|foot| (foot * c, foot * s)).unzip();
    let mut z = vec![f64::NAN; x.len()];
    match links.surface.strategy.heights(&x, &y, &mut z) {
        Err(error) => links.surface.failed(context, error),
        Ok(()) if z.iter().all(|z| z.is_finite()) => links
            .compensator
            .bad_answer(format!("no number for the contact {context}")),
        Ok(()) => PipelineError::NoSurface(StrategyError::failed(format!(
            "the nose finds no contact {context}, since the surface ends within its reach; choose \
             a smaller aperture or a smaller tool"
        ))),
    }
}
