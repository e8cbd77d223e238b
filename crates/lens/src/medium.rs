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

/// Whether the light comes to a surface along +z of the design: after every mirror it turns round.
/// `None` where the distance before the surface says something else, as it does after a break of
/// coordinates by half a turn.
pub fn comes_along_z(blocks: &[SurfaceBlock<'_>], number: usize) -> Option<bool> {
    let earlier = blocks.get(..number).unwrap_or_default();
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
