//! Everything that crosses the plugin boundary: the one module with abi_stable in it.
//!
//! - [`data`]: plain values and their way there and back;
//! - [`surface`], [`feed`], [`sampler`], [`compensator`], [`velocity`], [`locus`]: for each trait of the
//!   core a mirror that can cross, an adapter that wraps the core's trait into the mirror, and one
//!   that unwraps it again;
//! - [`root`]: what a library exports, and how it is opened.
//!
//! A batch crosses as slices; nothing is copied but the pieces of a law. `unsafe` is what the
//! macros of abi_stable write, and the one cast in [`root`].
#![allow(unsafe_code)] // #[sabi_trait] and #[derive(StableAbi)] expand to unsafe code
#![allow(non_local_definitions)] // raised by #[sabi_trait]'s expansion
#![allow(missing_docs)] // private, and #[sabi_trait] generates public items without docs
#![allow(clippy::too_many_arguments)] // a batch crosses as slices, one argument each

pub(crate) mod catalogue;
pub(crate) mod compensator;
pub(crate) mod contained;
pub(crate) mod data;
pub(crate) mod feed;
pub(crate) mod locus;
pub(crate) mod root;
pub(crate) mod sampler;
pub(crate) mod surface;
pub(crate) mod velocity;
