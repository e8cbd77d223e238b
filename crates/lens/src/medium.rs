//! What lies before and behind a surface, and which way the light goes there.

use crate::surface_block::SurfaceBlock;

/// What fills the space between two surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Medium {
    /// Nothing.
    Air,
    /// A glass: a part.
    Glass,
}

/// What fills the space before the surface of this number. A mirror and a break of coordinates leave
/// the light in what it is in.
pub fn before(blocks: &[SurfaceBlock<'_>], number: usize) -> Medium {
    let earlier = blocks.get(..number).unwrap_or_default().iter().rev();
    for block in earlier.filter(|block| !block.is_break()) {
        match block.glass() {
            Some(true) => {}
            Some(false) => return Medium::Glass,
            None => return Medium::Air,
        }
    }
    Medium::Air
}

/// Tilts of breaks, taken together, from which on the axes may look the other way, deg.
const TURNED_ROUND: f64 = 90.0;

/// Whether the light comes to a surface along +z of the design: after every mirror it turns round.
/// `None` where the distance before the surface says something else, as it does after a break of
/// coordinates by half a turn, or where such a break stands behind that distance.
pub fn comes_along_z(blocks: &[SurfaceBlock<'_>], number: usize) -> Option<bool> {
    let earlier = blocks.get(..number).unwrap_or_default();
    if tilt_behind_last_distance(earlier) >= TURNED_ROUND {
        return None;
    }
    let is_mirror = |block: &&SurfaceBlock<'_>| !block.is_break() && block.glass() == Some(true);
    let mirrors = earlier.iter().filter(is_mirror).count();
    let along = mirrors.is_multiple_of(2);
    let distances = earlier.iter().rev().filter_map(SurfaceBlock::thickness);
    let last = distances.into_iter().find(|distance| *distance != 0.0);
    match last.is_none_or(|last| (last > 0.0) == along) {
        true => Some(along),
        false => None,
    }
}

/// The tilts about x and y of the breaks of coordinates behind the last distance that is not 0, added up,
/// deg. The distance of a break lies behind its tilts.
fn tilt_behind_last_distance(earlier: &[SurfaceBlock<'_>]) -> f64 {
    let is_distance = |block: &&SurfaceBlock<'_>| block.thickness().is_some_and(|way| way != 0.0);
    let behind = earlier.iter().rev().take_while(|block| !is_distance(block));
    let breaks = behind.filter(|block| block.is_break());
    let numbers = breaks.flat_map(SurfaceBlock::break_numbers);
    let tilts = numbers.filter(|(name, _)| matches!(*name, "tilt x" | "tilt y"));
    tilts.map(|(_, tilt)| tilt.abs()).sum()
}
