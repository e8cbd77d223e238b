//! A place on the path: where a node may lie, and what the controller gets there.

/// The path at one place. Rates are per unit of the table's time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// In revolutions.
    pub n: f64,
    /// In the table's time.
    pub t: f64,
    /// Z of the locus, mm.
    pub z: f64,
    /// dZ/dt of the locus.
    pub z_rate: f64,
    /// X of the locus, mm.
    pub x: f64,
    /// dX/dt of the locus, as the host gives it: at a kink of the law the mean of both sides.
    pub x_rate: f64,
    /// C, rad.
    pub c: f64,
    /// dC/dt.
    pub c_rate: f64,
    /// Whether X has a kink there, so that its rate belongs to neither side.
    pub is_kink: bool,
    /// The number of the first place of the table beyond it.
    pub next: usize,
}
