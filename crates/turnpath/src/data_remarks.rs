//! Remarks on what the strategies are made of: on the data of a surface, what was filled and where the
//! path leaves them; and on strategies that are not the same on every machine.

use std::sync::Arc;

use turnpath_core::Slot;
use turnpath_host::{Catalogue, Plugin};
use turnpath_pipeline::{DataReach, Farthest, data_reach};
use turnpath_recipe::Recipe;
use turnpath_report::Remark;

use crate::diagnosis::of_pipeline;
use crate::error::Error;
use crate::job::Job;
use crate::plugins::used;
use crate::remarks::{PathSubject, remarks, short_edge};

impl Job {
    /// All remarks on the recipe and its path, those on its data among them.
    pub(crate) fn remarks(&self, path: &PathSubject, on_data: Vec<Remark>) -> Vec<Remark> {
        let found = &self.preparation.interference;
        let mut all = remarks(&self.recipe, path, found.cut_angle().value);
        let steepest = found.contact_angle().value;
        all.extend(short_edge(&self.preparation.task, path, steepest));
        all.extend(on_data);
        all.extend(inexact(
            &self.recipe,
            &self.catalogue,
            &self.inexact_surfaces,
        ));
        all
    }

    /// The remarks on the data of the surface. The tolerance of interpolation, mm, is that
    /// which the path is made for.
    pub(crate) fn data_remarks(&self, tolerance: f64) -> Result<Vec<Remark>, Error> {
        let reach = data_reach(&self.chain.locus_links(), &self.preparation);
        let reach = reach.map_err(|error| of_pipeline(&self.recipe, error))?;
        let on_data = |reach| on_data(reach, tolerance);
        Ok(reach.map(on_data).unwrap_or_default())
    }
}

/// The recipe's strategies whose last bits depend on the machine, a remark for each plugin. Of
/// `surfaces` that is known since they were made.
fn inexact(recipe: &Recipe, catalogue: &Catalogue, surfaces: &[String]) -> Vec<Remark> {
    let of_plugin = |plugin: &Arc<Plugin>| {
        let mut strategies: Vec<String> = Vec::new();
        for choice in Slot::ALL.into_iter().flat_map(|slot| recipe.choices(slot)) {
            let strategy = catalogue.find(choice.slot, choice.name());
            if strategy.is_none_or(|strategy| !Arc::ptr_eq(strategy.plugin(), plugin)) {
                continue;
            }
            let text = format!("{} {}", choice.slot, choice.name());
            let is_inexact = plugin.inexact.contains(&text) || surfaces.contains(&text);
            if is_inexact && !strategies.contains(&text) {
                strategies.push(text);
            }
        }
        let plugin = plugin.name.clone();
        (!strategies.is_empty()).then_some(Remark::NotByteExact { strategies, plugin })
    };
    let used = used(recipe, catalogue).into_iter();
    used.filter_map(of_plugin).collect()
}

/// `tolerance` is that of interpolation, mm.
fn on_data(reach: DataReach, tolerance: f64) -> Vec<Remark> {
    let DataReach {
        data,
        part,
        overrun,
    } = reach;
    let filled = (data.filled > 0).then_some(Remark::FilledPoints {
        filled: data.filled,
        points: data.points,
    });
    let fitted = data.fit_error.map(|error| Remark::FittedSurface {
        points: data.points,
        error,
        tolerance,
    });
    let beyond = |place: Option<Farthest>, on_part: bool| {
        place.map(|place| Remark::BeyondData {
            on_part,
            distance: place.distance,
            radius: place.radius,
            c: place.angle,
            continuation: data.continuation.clone(),
        })
    };
    let all = [filled, fitted, beyond(part, true), beyond(overrun, false)];
    all.into_iter().flatten().collect()
}
