//! The smallest residual feed on the part.

use turnpath_plugin::locus::CuspFeed;
use turnpath_plugin::prelude::*;

/// The smallest feed over the task's range, mm, that leaves no cusp above the residual tolerance.
///
/// A large feed belongs to the radius in the middle of two passes. The middles do not come nearer
/// to the ends of the range than half of the feed.
///
/// # Errors
/// If the locus has no value somewhere in the range.
pub fn smallest_residual_feed(setup: Setup<'_>) -> Result<f64> {
    let Setup { task, locus } = setup;
    let feed = smallest_within(setup, task.range)?;
    let law = CuspFeed::new(task.tolerance.residual, locus.radial(), &task.tool);
    let inset = 0.5 * feed * law.share(feed);
    let RadialRange { inner, outer } = task.range;
    let middles = RadialRange {
        inner: inner + inset,
        outer: outer - inset,
    };
    match inset > 0.0 && middles.inner < middles.outer {
        true => smallest_within(setup, middles),
        false => Ok(feed),
    }
}

fn smallest_within(setup: Setup<'_>, range: RadialRange) -> Result<f64> {
    let (residual, radial) = (setup.task.tolerance.residual, setup.locus.radial());
    let mut feed = Vec::new();
    let [smallest] = extreme::largest(range, &mut |theta, rho, out| {
        feed.resize(theta.len(), f64::NAN);
        setup
            .locus
            .residual_feed(residual, radial, theta, rho, &mut feed)?;
        for (i, feed) in feed.iter().enumerate() {
            if feed.is_nan() {
                return Err(no_feed(theta[i], rho[i]));
            }
            out[i] = [-feed];
        }
        Ok(())
    })?;
    Ok(-smallest.value)
}

fn no_feed(theta: f64, rho: f64) -> StrategyError {
    let (sin, cos) = Scalar::sin_cos(theta);
    StrategyError::failed(format!(
        "no feed can be found at x = {:.4} mm, y = {:.4} mm: the tool centre has no value there; \
         choose a smaller aperture, or give `feed`",
        rho * cos,
        rho * sin
    ))
}
