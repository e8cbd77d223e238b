//! Reads and checks recipes: TOML with units. Every value keeps its span for later messages.
//!
//! [`Recipe::load`] reads a file and the `--set` arguments. [`Recipe::bind`] checks the parameters
//! of a strategy against its declarations. This crate loads no plugin and knows no strategy.
//!
//! ```
//! use turnpath_core::Slot;
//! use turnpath_recipe::Recipe;
//!
//! let text = r#"
//! format = 1
//! [part]
//! aperture = "5 mm"
//! [surface]
//! use = "astigmatic"
//! k = "0.08 /mm"
//! [tool]
//! nose_radius = "1 mm"
//! [tolerance]
//! interpolation = "100 nm"
//! residual = "100 nm"
//! [spindle]
//! speed = "500 rpm"
//! [path]
//! overrun = "none"
//! lead = false
//! [feed]
//! use = "constant"
//! feed = "10 um/rev"
//! [sampler]
//! use = "equal-angle"
//! step = "6 deg"
//! [compensator]
//! use = "z-direction"
//! [velocity]
//! use = "triangle-rotary"
//! "#;
//! let recipe = Recipe::parse(text, "mirror.toml", &["tool.nose_radius=0.5 mm".into()])?;
//! assert_eq!(recipe.tool.nose_radius, 0.5);
//! assert_eq!(recipe.choice(Slot::Feed).name(), "constant");
//!
//! let error = Recipe::parse(&text.replace("5 mm", "5 ms"), "mirror.toml", &[]).unwrap_err();
//! assert!(error.render(false).contains("is a time"));
//! # Ok::<(), turnpath_recipe::RecipeError>(())
//! ```

mod ablation;
mod bind;
mod choice;
mod coefficients;
mod constants;
pub mod declared;
mod diagnostic;
mod document;
mod folder_name;
mod key_value;
mod presets;
mod read;
mod recipe;
mod recipe_text;
mod rough_paths;
mod rough_place;
mod set;
mod span;
mod suggest;
mod surface_entry;
mod surface_list;
mod table_info;
mod tables;
mod value;
mod wrong_recipe;

pub use ablation::{Variant, Variation};
pub use bind::{Binding, NamedFile};
pub use choice::Choice;
pub use diagnostic::{Diagnostic, Diagnostics};
pub use document::{Entry, Node, Table, Value};
pub use presets::Preset;
pub use recipe::{Recipe, RecipeError};
pub use recipe_text::FileProblem;
pub use rough_paths::{RoughPath, rough_path_tables};
pub use span::{Source, Span, Spanned};
pub use surface_entry::SurfaceEntry;
pub use table_info::TableInfo;
pub use tables::{
    AskedTolerances, DataFormat, Output, PostSettings, ZReference, slot_keys, tables,
};
pub use wrong_recipe::WrongRecipe;
