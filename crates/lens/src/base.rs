//! The conic section that a surface begins with.

/// A conic section: cρ² / (1 + sqrt(1 − (1 + K)c²ρ²)), c = 1/radius.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Base {
    /// Radius of curvature, mm; positive: concave; `None`: straight.
    pub radius: Option<f64>,
    /// The conic constant K.
    pub conic: f64,
}

impl Base {
    /// The same seen from behind.
    pub(crate) fn seen_from_behind(self) -> Self {
        Self {
            radius: self.radius.map(|radius| -radius),
            conic: self.conic,
        }
    }
}
