//! Surfaces that are made of other surfaces: an entry that is scaled and moved, a sum, a pose.
//!
//! Each is an adapter over [`SurfaceModel`](turnpath_core::SurfaceModel) and asks nothing of the
//! surfaces below but what that trait has. A surface of any plugin can therefore be part of a sum.

mod frame;
mod placed;
mod posed;
mod rooms;
mod root;
mod sum;

pub use placed::PlacedSurface;
pub use posed::{PoseError, PosedSurface};
pub use sum::SurfaceSum;
