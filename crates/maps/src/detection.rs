//! How a file is known as one of a format.

use crate::format::Format;
use crate::{gsf, metropro};

/// The format of a file. Formats with a mark in their first bytes are known by it; of the two that
/// are called `.dat`, the one without a mark is that of Zemax.
pub fn format_of(name: &str, bytes: &[u8]) -> Option<Format> {
    if metropro::is(bytes) {
        return Some(Format::MetroPro);
    }
    if gsf::is(bytes) {
        return Some(Format::Gsf);
    }
    let (_, extension) = name.rsplit_once('.')?;
    Some(match extension.to_ascii_lowercase().as_str() {
        "dat" => Format::Zemax,
        "int" => Format::CodeV,
        "xyz" => Format::Xyz,
        "gsf" => Format::Gsf,
        _ => return None,
    })
}
