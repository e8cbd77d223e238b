//! What the nose leaves standing where it does not fit, for the summary.

use serde::Serialize;
use turnpath_core::{DEG, Misfit, StrategyError, Tolerance, UM};
use turnpath_pipeline::PipelineError;
use turnpath_verify::{FirstTouch, UnreachedFigures, unreached};

use crate::failure::Failure;
use crate::figures;
use crate::job::{Job, of_pipeline};
use crate::summary::Place;

/// Of a part that is cut as far as the nose fits.
#[derive(Debug, Serialize)]
pub struct Unreached {
    /// Largest height above the surface, along z.
    height_um: f64,
    volume_mm3: f64,
    at: Place,
    /// Part of the area that stays higher than the residual tolerance, along z.
    area_fraction: f64,
}

impl Unreached {
    /// What stays on a job's part; none unless the recipe asks for what fits of a nose.
    pub fn of_job(job: &Job) -> Result<Option<Self>, Failure> {
        let asked = job.recipe.tool.misfit == Misfit::CutWhatFits && job.compensates_nose();
        if asked && !job.prepared.touch.leaves_seams() {
            return Ok(Some(Self::new(&UnreachedFigures::default())));
        }
        Self::of(&job.prepared.touch, &job.recipe.tolerance)
            .map_err(|error| of_pipeline(&job.recipe, PipelineError::Measure(error)))
    }

    /// The same for what is measured.
    pub fn of(touch: &FirstTouch, tolerance: &Tolerance) -> Result<Option<Self>, StrategyError> {
        if !touch.leaves_seams() {
            return Ok(None);
        }
        let found = unreached(touch, tolerance.residual)?;
        Ok(Some(Self::new(&found)))
    }

    fn new(found: &UnreachedFigures) -> Self {
        Self {
            height_um: found.height / UM,
            volume_mm3: found.volume,
            at: Place {
                c_deg: found.at_theta / DEG,
                x_mm: found.at_rho,
            },
            area_fraction: found.area_fraction,
        }
    }

    /// The lines for a person.
    pub fn lines(&self) -> String {
        if self.height_um <= 0.0 {
            return figures::line("unreached", "nothing: the edge comes to every place");
        }
        let height = figures::nanometres(self.height_um / UM);
        let Place { c_deg, x_mm } = self.at;
        let x = figures::millimetres(x_mm, 4);
        let text = figures::line(
            "unreached",
            format!("up to {height} along z, at C = {c_deg:.2} deg, X = {x}"),
        );
        let percent = 100.0 * self.area_fraction;
        let rest = format!(
            "{:.3e} mm3; higher than the residual tolerance on {percent:.2} % of the part",
            self.volume_mm3
        );
        text + &figures::line("", rest)
    }
}
