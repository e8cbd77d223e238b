//! Parameters: their declarations as data, the typed keys to their values, and the values.
//!
//! A [`Param`] declares a parameter once. It is also the key to the parameter's value, so that a
//! name is written once and a wrong kind does not compile. The host reads the declarations to check
//! a recipe, to fill in defaults and to explain a strategy. A strategy's constructor gets
//! [`Params`], in which every declared parameter is in range, and present unless it is optional.

mod declared;
mod info;
pub mod kind;
mod params;
mod value;

pub use declared::Param;
pub use info::{ParamDefault, ParamInfo, ParamKind};
pub use params::Params;
pub use value::{DataFile, NamedConstant, ParamValue};
