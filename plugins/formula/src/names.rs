//! The names that every formula knows.

use std::f64::consts::PI;

use turnpath_plugin::prelude::{DEG, NM, UM};

use crate::dimension::Dimension;

/// A name that stands for a number: units, and π.
pub const VALUES: [(&str, f64, Dimension); 10] = [
    ("pi", PI, Dimension::PURE),
    ("rad", 1.0, Dimension::PURE),
    ("mrad", 1e-3, Dimension::PURE),
    ("deg", DEG, Dimension::PURE),
    ("mm", 1.0, Dimension::LENGTH),
    ("um", UM, Dimension::LENGTH),
    // The micro sign and the Greek letter look alike.
    ("\u{b5}m", UM, Dimension::LENGTH),
    ("\u{3bc}m", UM, Dimension::LENGTH),
    ("nm", NM, Dimension::LENGTH),
    ("inch", 25.4, Dimension::LENGTH),
];

/// A name that depends on the point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Variable {
    /// x.
    X,
    /// y.
    Y,
    /// The distance from the axis.
    Rho,
    /// The angle from x to y.
    Theta,
}

/// The variables. [`RADIUS`] is a second name of `rho`.
pub const VARIABLES: [(&str, Variable, Dimension); 4] = [
    ("x", Variable::X, Dimension::LENGTH),
    ("y", Variable::Y, Dimension::LENGTH),
    ("rho", Variable::Rho, Dimension::LENGTH),
    ("theta", Variable::Theta, Dimension::PURE),
];

/// The second name of `rho`.
pub const RADIUS: &str = "r";

/// A function of one value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Function {
    /// Square root.
    Sqrt,
    /// Absolute value.
    Abs,
    /// eˣ.
    Exp,
    /// Natural logarithm.
    Ln,
    /// Sine.
    Sin,
    /// Cosine.
    Cos,
    /// Tangent.
    Tan,
    /// Arc sine.
    Asin,
    /// Arc cosine.
    Acos,
    /// Arc tangent.
    Atan,
    /// Hyperbolic sine.
    Sinh,
    /// Hyperbolic cosine.
    Cosh,
    /// Hyperbolic tangent.
    Tanh,
    /// cos √a: no name of formulas, but what cos cρ is in terms of ρ².
    CosOfRoot,
    /// cosh √a.
    CoshOfRoot,
}

/// A function of two values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum PairFunction {
    /// The angle of the point (second, first).
    Atan2,
    /// The root of the sum of the squares.
    Hypot,
    /// The smaller one.
    Min,
    /// The larger one.
    Max,
}

/// What a call means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Call {
    /// A function of one value.
    One(Function),
    /// A function of two values.
    Two(PairFunction),
}

/// The functions.
pub const FUNCTIONS: [(&str, Call); 17] = [
    ("sqrt", Call::One(Function::Sqrt)),
    ("abs", Call::One(Function::Abs)),
    ("exp", Call::One(Function::Exp)),
    ("ln", Call::One(Function::Ln)),
    ("sin", Call::One(Function::Sin)),
    ("cos", Call::One(Function::Cos)),
    ("tan", Call::One(Function::Tan)),
    ("asin", Call::One(Function::Asin)),
    ("acos", Call::One(Function::Acos)),
    ("atan", Call::One(Function::Atan)),
    ("sinh", Call::One(Function::Sinh)),
    ("cosh", Call::One(Function::Cosh)),
    ("tanh", Call::One(Function::Tanh)),
    ("atan2", Call::Two(PairFunction::Atan2)),
    ("hypot", Call::Two(PairFunction::Hypot)),
    ("min", Call::Two(PairFunction::Min)),
    ("max", Call::Two(PairFunction::Max)),
];

/// Whether every formula knows this name already, so that no constant may have it.
pub fn is_taken(name: &str) -> bool {
    name == RADIUS
        || VALUES.iter().any(|(known, ..)| *known == name)
        || VARIABLES.iter().any(|(known, ..)| *known == name)
        || FUNCTIONS.iter().any(|(known, _)| *known == name)
}
