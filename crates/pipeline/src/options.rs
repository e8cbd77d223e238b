//! How a path is made, besides its chain and its task.

use turnpath_core::Servo;
use turnpath_verify::machined::FormScope;

use crate::lead::LeadSettings;

/// How a path is made, besides its chain and its task.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PathOptions {
    /// Whether segments whose error exceeds the tolerance are halved.
    pub refine: bool,
    /// Steps of time a second to which the controller rounds. Every control point is then put
    /// where the path is at such a step, so that program and path have the same points.
    pub time_steps: Option<f64>,
    /// How the path comes from rest and goes to rest. Without it the path begins and ends in
    /// motion.
    pub lead: Option<LeadSettings>,
    /// Whether the path covers the axis on purpose. The cusps at the axis then count as residual.
    pub covers_centre: bool,
    /// Which part of the machined surface counts for its form. With it the run measures the form.
    pub form: Option<FormScope>,
    /// How the axes follow the path. With it the run predicts their following error.
    pub servo: Option<Servo>,
    /// Whether the run keeps what pictures of the path need.
    pub sketch: bool,
}
