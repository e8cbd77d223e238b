//! Finds, checks and loads turnpath plugins, and looks strategies up by name.
//!
//! A [`Catalogue`] starts with the strategies that are linked into the program, or with none, and
//! takes more from libraries. A loaded [`Strategy`] cannot be told from a linked one but by its
//! [`Plugin`].
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
//! A library is native code with the user's rights: whether to trust it is the caller's to decide,
//! before it is handed over. What is checked here keeps damaged, foreign and outdated files from
//! being run; it does not make a hostile one harmless.

mod catalogue;
mod elf;
mod error;
mod image;
mod library;
mod machine;
mod native;
mod plugin;

pub use catalogue::Catalogue;
pub use error::{LoadError, Refusal};
pub use plugin::{Plugin, Strategy};
pub use turnpath_plugin::loading::{BOUNDARY_VERSION, BoundaryVersion};
