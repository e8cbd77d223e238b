//! Figures for papers: which are asked for, where their files go, and how they are written.

mod files;
mod request;

pub use files::Drawings;
pub use request::{DrawingFileError, DrawingRequest};
