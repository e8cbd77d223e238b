//! The surface, the part and the tool that a path is measured against.

use std::sync::Arc;

use turnpath_core::{Part, SurfaceModel, Tool};

/// The wanted surface, the part of it that counts, and the tool that cuts it.
#[derive(Clone)]
pub struct Subject {
    /// The surface.
    pub surface: Arc<dyn SurfaceModel>,
    /// The part. Cusps beyond it do not count.
    pub part: Part,
    /// The tool.
    pub tool: Tool,
    /// Whether the path is that of the nose centre. If not, the path is that of the contact, and
    /// the true position lies on the surface itself.
    pub compensates_nose: bool,
}
