//! The moves before and after a path in words of G code, which most controllers share.

mod read;
mod write;

pub(crate) use read::read_travel;
pub(crate) use write::push_travel;
