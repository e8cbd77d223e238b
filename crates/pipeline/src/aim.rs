//! What refinement aims at.

/// Part of the tolerance that refinement aims at. The rest covers what the instants of a playback
/// can miss, and a finer measurement by someone else.
pub const AIM: f64 = 0.99;
/// A segment whose error exceeds this part of the aim is near it. At a border between steps of
/// 2 : 1 a spline's error on the long side is 1.3 times what it was.
pub const NEAR: f64 = 0.75;
