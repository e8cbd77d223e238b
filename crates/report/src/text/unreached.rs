//! The lines on what the nose leaves standing.

use crate::unit;
use crate::unreached::Unreached;

use super::numbers::{line, path_place, small_length};

/// The lines on what the nose leaves standing; empty where the recipe refuses that.
pub fn unreached(unreached: Option<&Unreached>) -> String {
    let Some(unreached) = unreached else {
        return String::new();
    };
    if unreached.height <= 0.0 {
        return line("unreached", "nothing: the edge comes to every place");
    }
    let (height, at) = (small_length(unreached.height), path_place(&unreached.at));
    let percent = unreached.area_fraction * unit::percent::PER;
    let rest = format!(
        "{:.3e} mm3; higher than the tolerance on {percent:.2} % of the part",
        unreached.volume
    );
    line("unreached", format!("up to {height} along z, at {at}")) + &line("", rest)
}
