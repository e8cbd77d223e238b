//! From a recipe to a measured tool path and its report.
//!
//! A [`Recipe`] says what is cut, with what and how exactly, and names one strategy for each
//! stage. A [`Catalogue`] has the strategies. Both make a [`Job`], where everything that can be
//! refused is refused; [`Job::run`] makes the path, measures it and gives a report with its
//! verdict. [`verify`] measures any tool path in a file, [`ablate`] sets variants of a recipe side
//! by side.
//!
//! ```
//! use turnpath::{Catalogue, Job, Outputs, Recipe, SilentObserver};
//!
//! let recipe = Recipe::load("../../docs/recipes/astigmatic-5mm.toml", &[])?;
//! let recipe = recipe.set("tolerance.residual", "200 nm")?;
//! let job = Job::new(recipe, &Catalogue::linked()?)?;
//! let result = job.run(Outputs::nowhere(), &SilentObserver)?;
//! assert!(result.report.verdict().holds());
//! # Ok::<(), turnpath::Error>(())
//! ```

mod ablation;
mod axis_notes;
mod chain;
mod check;
mod commands;
mod data_files;
mod data_remarks;
mod depths;
mod diagnosis;
mod drawings;
mod dry_run;
mod error;
mod figures;
mod folder;
mod form;
mod gap;
mod import;
mod input_files;
mod job;
mod memory;
mod meters;
mod named_files;
mod new_plugin;
mod outputs;
mod page;
mod part_shape;
mod path_file;
mod plots;
mod plugins;
mod plugins_lock;
mod posts;
mod program;
mod program_room;
mod program_size;
mod read_blocks;
mod recipe_file;
mod recipe_schema;
mod region;
mod remarks;
mod result_check;
mod rough_paths;
mod run;
mod sag;
mod sampled_stretches;
mod segment_rate;
mod sinks;
mod sizes;
mod speed_steps;
mod strategies;
mod subject;
mod summary;
mod surface;
mod surface_need;
mod toolpath;
mod unmeasured;
mod verify;

pub use ablation::{
    AblationObserver, AblationOptions, AblationPlan, AblationResult, FIGURES, PackError,
    PackedAblation, RunPlan, RunState, ablate, merge_ablation, pack_ablation, plan_ablation,
    run_of_ablation,
};
pub use commands::{commands_to_trust, controller_commands};
pub use data_files::DataFileError;
pub use drawings::{DrawingFileError, DrawingRequest};
pub use error::{Error, Fault};
pub use import::{ImportRequest, ImportedRecipe, import};
pub use job::Job;
pub use new_plugin::{
    CrateSource, NameError, NewPlugin, NewPluginError, PluginRequest, SourceError, new_plugin,
};
pub use outputs::Outputs;
pub use page::{PageError, PageRequest, result_recipe, write_page};
pub use part_shape::refused_check;
pub use plots::{GRID_POINTS, MapGrid, MapRequest, PlotError, PlotRequest};
pub use plugins::with_listed_plugins;
pub use plugins_lock::{PluginsLock, PluginsLockError};
pub use recipe_file::write_recipe;
pub use recipe_schema::recipe_schema;
pub use result_check::{ResultError, read_result};
pub use run::RunResult;
pub use sag::{MapSource, SagGaps, compare_with_map, write_sag, write_sag_to};
pub use strategies::with_wrong_strategies;
pub use toolpath::ToolPath;
pub use turnpath_core::toolpath::Section;
pub use turnpath_core::{Axis, Derivative, Limit, Quantity, Slot, Tolerance};
pub use turnpath_drawing::{Dots, DrawingError, Figure, Size};
pub use turnpath_files::{FileError, FolderError};
pub use turnpath_host::{
    Admission, Catalogue, HashError, Identity, LibraryFile, LoadError, Loadable, OwnPlugin,
    OwnStrategy, OwnSurface, Plugin, Refusal, SourceHash, Strategy, SurfaceNeed, calls,
};
pub use turnpath_lens::Side;
pub use turnpath_maps::{
    Format as MapFormat, LARGEST_LENGTH as LARGEST_MAP_LENGTH, LEAST_PITCH as LEAST_MAP_PITCH,
    length_unit,
};
pub use turnpath_pipeline::{Observer, SilentObserver, Stage};
pub use turnpath_post::{ProgramError, ReadError};
pub use turnpath_recipe::{
    Diagnostic, Diagnostics, Recipe, RecipeError, Span, TableInfo, declared, slot_keys, tables,
};
pub use turnpath_report as report;
pub use verify::verify;

// A plugin that nothing names is dropped by the linker.
#[cfg(feature = "built-ins")]
use {
    turnpath_atpg as _, turnpath_ats as _, turnpath_constant as _, turnpath_fft_adaptive as _,
    turnpath_formula as _, turnpath_grid as _, turnpath_integrated as _, turnpath_minimax as _,
    turnpath_nose_radius as _, turnpath_polynomials as _, turnpath_spindle as _,
    turnpath_surfaces as _, turnpath_triangle_rotary as _,
};
