//! What a compensator works on, and the meaning of its radial parameter.

use serde::{Deserialize, Serialize};

use crate::{SurfaceModel, Tool};

/// What the radial parameter ρ of a compensator means. The feed that keeps the residual depends on
/// it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Radial {
    /// ρ is the radius of the contact: neighbouring contacts lie one feed apart.
    Contact,
    /// ρ is the tool centre's X: contacts lie further apart than centres on concave parts.
    Centre,
}

/// What a compensator works on: a surface and a tool.
#[derive(Clone, Copy)]
pub struct Cut<'a> {
    /// The surface to be cut.
    pub surface: &'a dyn SurfaceModel,
    /// The tool.
    pub tool: &'a Tool,
}
