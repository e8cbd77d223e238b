//! The plan of an ablation: its runs by their keys, for whatever queue makes them.

use std::path::Path;

use serde::{Deserialize, Serialize};
use turnpath_host::Catalogue;
use turnpath_pipeline::SilentObserver;
use turnpath_recipe::{Recipe, Variant};
use turnpath_report::variations;

use crate::data_files::DataFiles;
use crate::error::Error;

use super::key::Key;
use super::record::{Records, RunRecord};
use super::{refuse_unknown, variants, varied};

/// The form of a plan's JSON.
const FORMAT: u32 = 1;

/// The runs of an ablation, none of which is made for it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct AblationPlan {
    /// The form of the JSON.
    pub format: u32,
    /// The runs, in the order of the table.
    pub runs: Vec<RunPlan>,
}

/// A run of a plan.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct RunPlan {
    /// Its place in the table, from 0.
    pub index: usize,
    /// What [`run_of_ablation`](crate::run_of_ablation) knows it by.
    pub key: String,
    /// Each key of the recipe that varies, with this run's value in words.
    #[serde(with = "variations")]
    pub varied: Vec<(String, String)>,
    /// Whether it has a record.
    pub state: RunState,
}

/// Whether a run has a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RunState {
    /// It was made.
    Done,
    /// It was tried and failed.
    Failed,
    /// It is being made, or was lost with its process.
    Begun,
    /// It was not tried yet.
    Missing,
}

/// The runs of a recipe's `[ablation]`, and which of them have a record in `folder`. Nothing is made and
/// nothing is written.
///
/// # Errors
/// When the recipe has no `[ablation]`, when a variant chooses wrongly, or when a data file cannot be
/// read.
pub fn plan_ablation(
    recipe: &Recipe,
    catalogue: &Catalogue,
    folder: &Path,
) -> Result<AblationPlan, Error> {
    let data = DataFiles::default();
    let (variants, keys) = variants(recipe, catalogue, &data)?;
    refuse_unknown(&keys)?;
    Ok(plan_of(&variants, &keys, folder))
}

/// The plan of these variants.
pub(super) fn plan_of(variants: &[Variant], keys: &[Key], folder: &Path) -> AblationPlan {
    let records = Records::of(folder);
    let runs = variants.iter().zip(keys).enumerate();
    let runs = runs.map(|(index, (variant, key))| RunPlan {
        index,
        key: key.hash.clone(),
        varied: varied(variant),
        state: match records.read(key, &SilentObserver) {
            RunRecord::Measured(_) => RunState::Done,
            RunRecord::Failed(_) => RunState::Failed,
            RunRecord::Begun(_) => RunState::Begun,
            RunRecord::None => RunState::Missing,
        },
    });
    AblationPlan {
        format: FORMAT,
        runs: runs.collect(),
    }
}
