//! Finds, checks and loads turnpath plugins, and looks strategies up by name.
//!
//! A [`Catalogue`] begins empty or with the strategies that are linked into the program, and more
//! can be added from libraries and [by the program itself](Catalogue::with_own). Only its [`Plugin`] shows whether a [`Strategy`] is linked or loaded.
//!
//! ```
//! use turnpath_core::Slot;
//! use turnpath_host::Catalogue;
//!
//! let catalogue = Catalogue::linked()?;
//! assert!(catalogue.find(Slot::Sampler, "no-such-sampler").is_none());
//! # Ok::<(), turnpath_host::LoadError>(())
//! ```
//!
//! A library is native code with the user's rights. The caller decides whether to trust it before
//! adding it. The checks here keep damaged, foreign and outdated files from running; they do not
//! make a hostile library harmless.

mod admission;
mod catalogue;
mod elf;
mod error;
mod hash;
mod image;
mod library;
mod loader;
mod machine;
mod native;
mod own_plugin;
mod own_strategy;
mod plugin;
mod private_copy;
mod source_hash;

pub use admission::Admission;
pub use catalogue::Catalogue;
pub use error::{LoadError, Refusal};
pub use hash::{sha256_hex, sha256_hex_of_file};
pub use image::entry_symbol;
pub use library::{LibraryFile, Loadable};
pub use own_plugin::OwnPlugin;
pub use own_strategy::{Identity, OwnStrategy, OwnSurface, SurfaceNeed};
pub use plugin::{Plugin, Strategy};
pub use source_hash::{HashError, SourceHash};
pub use turnpath_plugin::calls;
pub use turnpath_plugin::loading::{BOUNDARY_VERSION, BoundaryVersion};
