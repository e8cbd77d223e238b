//! The surface models of turnpath: one formula a file, written once for every number type.
//!
//! z(x, y) in mm, x and y from the spindle axis, z towards the tool; ρ² = x² + y².

mod astigmatic;
mod conic;
mod off_axis_paraboloid;
mod sinusoidal_array;
mod toric;
mod xy_polynomial;

pub use astigmatic::Astigmatic;
pub use conic::Conic;
pub use off_axis_paraboloid::OffAxisParaboloid;
pub use sinusoidal_array::SinusoidalArray;
pub use toric::Toric;
pub use xy_polynomial::XyPolynomial;

turnpath_plugin::export!(surfaces: [
    Astigmatic,
    Conic,
    OffAxisParaboloid,
    SinusoidalArray,
    Toric,
    XyPolynomial,
]);
