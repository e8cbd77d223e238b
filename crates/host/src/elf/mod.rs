//! ELF libraries, checked before the system's loader gets them. The loader trusts the headers: a file
//! cut short within a segment would end the program with a signal.
#![allow(clippy::useless_conversion)] // a word of the headers is u32 or u64

mod check;
mod headers;
mod tables;

pub use check::check;
