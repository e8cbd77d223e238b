//! The surface models of turnpath. Each file has one formula, written once for every number type.
//!
//! z(x, y) is in mm, with x and y from the spindle axis and z towards the tool. ρ² = x² + y².

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
