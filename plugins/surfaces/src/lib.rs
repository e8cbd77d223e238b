//! The surface models of turnpath. Each file has one formula, written once for every number type.
//!
//! z(x, y) is in mm, with x and y from the spindle axis and z towards the tool. ρ² = x² + y².

mod astigmatic;
mod biconic;
mod conic;
mod even_asphere;
mod lenslet_array;
mod odd_asphere;
mod off_axis_conic;
mod off_axis_paraboloid;
mod powers;
mod revolved;
mod sinusoidal_array;
mod toric;
mod toroid_yz;
mod xy_polynomial;

pub use astigmatic::Astigmatic;
pub use biconic::Biconic;
pub use conic::Conic;
pub use even_asphere::EvenAsphere;
pub use lenslet_array::LensletArray;
pub use odd_asphere::OddAsphere;
pub use off_axis_conic::OffAxisConic;
pub use off_axis_paraboloid::OffAxisParaboloid;
pub use sinusoidal_array::SinusoidalArray;
pub use toric::Toric;
pub use toroid_yz::ToroidYz;
pub use xy_polynomial::XyPolynomial;

turnpath_plugin::export!(surfaces: [
    Astigmatic,
    Biconic,
    Conic,
    EvenAsphere,
    LensletArray,
    OddAsphere,
    OffAxisConic,
    OffAxisParaboloid,
    SinusoidalArray,
    Toric,
    ToroidYz,
    XyPolynomial,
]);
