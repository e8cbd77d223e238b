//! How a machine's axes follow their commands: a model of the second order.

/// How one axis follows its command r: y″ + 2ζω₀y′ + ω₀²y = ω₀²r + 2ζω₀k_v r′ + k_a r″. The axis'
/// position is y(t − τ).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisServo {
    /// ω₀, rad/s; above zero.
    pub frequency: f64,
    /// ζ; above zero.
    pub damping: f64,
    /// τ, s; not below zero.
    pub delay: f64,
    /// k_v: the part of the velocity that is fed forward, 0 to 1.
    pub velocity_forward: f64,
    /// k_a: the part of the acceleration that is fed forward, 0 to 1.
    pub acceleration_forward: f64,
}

/// How each axis of the machine follows its command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Servo {
    /// The spindle.
    pub c: AxisServo,
    /// The radial slide.
    pub x: AxisServo,
    /// The slide that sets the depth.
    pub z: AxisServo,
}
