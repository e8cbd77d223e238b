//! Quantities with units, as people write them: "5 mm", "45 deg", "500 rpm". Nothing of tool paths.
//!
//! Inside, a quantity is a number in mm, rad and s. [`Quantity::parse`] reads a text,
//! [`Quantity::format`] writes one, and a [`QuantityError`] says what is wrong with a text and which
//! unit may have been meant.
//!
//! ```
//! use turnpath_units::{DEG, Quantity, QuantityError};
//!
//! assert_eq!(Quantity::Length.parse("100 nm"), Ok(1e-4));
//! assert_eq!(Quantity::Angle.format(45.0 * DEG), "45 deg");
//! let error = Quantity::Length.parse("5 microns").unwrap_err();
//! assert!(matches!(error, QuantityError::UnknownUnit { meant: Some("um"), .. }));
//! ```

mod decimal;
mod length_power;
mod quantity;
mod table;
mod text;

pub use length_power::LengthPower;
pub use quantity::{Quantity, QuantityError};

/// A degree in rad.
pub const DEG: f64 = std::f64::consts::PI / 180.0;
/// A micrometre in mm.
pub const UM: f64 = 1e-3;
/// A nanometre in mm.
pub const NM: f64 = 1e-6;
