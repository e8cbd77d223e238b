//! Everything that crosses the plugin boundary. This is the only module with abi_stable in it.
//!
//! - [`data`] has the plain values and their conversions in both directions.
//! - [`surface`], [`feed`], [`sampler`], [`compensator`], [`velocity`], [`spindle`] and [`locus`] each have
//!   three parts for a trait of the core: a mirror of the trait that can cross, an adapter that wraps
//!   the core's trait into the mirror, and an adapter that unwraps it again.
//! - [`root`] has what a library exports, and opens it.
//!
//! A batch crosses as slices. Only laws and nodes are copied. The macros of abi_stable write
//! all the `unsafe` code except for the one cast in [`root`].
#![allow(unsafe_code)] // #[sabi_trait] and #[derive(StableAbi)] expand to unsafe code
#![allow(non_local_definitions)] // the expansion of #[sabi_trait] raises it
#![allow(missing_docs)] // private, and #[sabi_trait] generates public items without docs
#![allow(clippy::too_many_arguments)] // a batch crosses as slices, one argument each

pub(crate) mod catalogue;
pub(crate) mod compensator;
pub(crate) mod data;
pub(crate) mod feed;
pub(crate) mod locus;
pub(crate) mod panic_safe_box;
pub(crate) mod path;
pub(crate) mod root;
pub(crate) mod sampler;
pub(crate) mod spindle;
pub(crate) mod surface;
pub(crate) mod velocity;
