//! Everything that crosses the plugin boundary. This is the only module with abi_stable in it.
//!
//! - [`declaration`] has the macro that makes both sides of a trait from one declaration.
//! - [`marked_object`] marks the calls of objects; [`loan`] and [`reply`] carry arguments and answers
//!   across; [`text`] writes and reads what is small, and [`task`], [`laws`] and [`request`] have the
//!   arguments of several slots.
//! - [`surface`], [`locus`], [`feed`], [`sampler`], [`compensator`], [`velocity`] and [`spindle`]
//!   have the declarations.
//! - [`catalogue`], [`root`] and [`entry`] have what a library exports, and open it; [`layout`]
//!   decides whether it fits.
//!
//! A batch crosses as slices. Laws, nodes, texts and the bytes of files are copied. The macros of
//! abi_stable write all the `unsafe` code except for that in [`entry`] and [`marked_object`].
//!
//! What crosses can grow without a new number of the boundary: traits by methods with a default,
//! texts by fields and words, lists of numbers at their ends, and the root by constructors.
#![allow(unsafe_code)] // #[sabi_trait] and #[derive(StableAbi)] expand to unsafe code
#![allow(non_local_definitions)] // the expansion of #[sabi_trait] raises it
#![allow(missing_docs)] // private, and #[sabi_trait] generates public items without docs

pub(crate) mod catalogue;
pub(crate) mod compensator;
pub(crate) mod declaration;
pub(crate) mod entry;
pub(crate) mod feed;
pub(crate) mod laws;
pub(crate) mod layout;
pub(crate) mod loan;
pub(crate) mod locus;
pub(crate) mod marked_object;
#[cfg(test)]
mod newer_host;
pub(crate) mod reply;
pub(crate) mod request;
pub(crate) mod root;
pub(crate) mod sampler;
pub(crate) mod spindle;
pub(crate) mod surface;
pub(crate) mod task;
pub(crate) mod text;
pub(crate) mod velocity;
