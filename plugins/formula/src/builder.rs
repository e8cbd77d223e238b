//! Formulas that a program builds step by step, without a text.

use crate::build_error::BuildError;
use crate::formula::Formula;
use crate::graph::{Graph, Id};
use crate::names::{Call, FUNCTIONS, Variable};

/// A value of a formula that is being built. It belongs to the builder that gave it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Value(Id);

/// Builds a formula step by step: pure numbers in mm and rad, without units.
///
/// ```
/// use turnpath_formula::FormulaBuilder;
/// use turnpath_plugin::prelude::Surface;
///
/// let mut steps = FormulaBuilder::new();
/// let (x, y) = (steps.x()?, steps.y()?);
/// let (product, two) = (steps.product(x, y)?, steps.number(2.0)?);
/// let height = steps.quotient(product, two)?;
/// assert_eq!(steps.finish(height)?.sag(3.0, 4.0), 6.0);
/// # Ok::<(), turnpath_formula::BuildError>(())
/// ```
///
/// # Errors
/// All its methods fail when the formula becomes too large, or when a part that has only numbers has
/// no finite value.
#[derive(Debug, Clone, Default)]
pub struct FormulaBuilder {
    graph: Graph,
}

impl FormulaBuilder {
    /// No step yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// x, mm.
    pub fn x(&mut self) -> Result<Value, BuildError> {
        Ok(Value(self.graph.variable(Variable::X)?))
    }

    /// y, mm.
    pub fn y(&mut self) -> Result<Value, BuildError> {
        Ok(Value(self.graph.variable(Variable::Y)?))
    }

    /// A number.
    pub fn number(&mut self, number: f64) -> Result<Value, BuildError> {
        Ok(Value(self.graph.constant(number)?))
    }

    /// a + b.
    pub fn sum(&mut self, a: Value, b: Value) -> Result<Value, BuildError> {
        Ok(Value(self.graph.sum(a.0, b.0)?))
    }

    /// a − b.
    pub fn difference(&mut self, a: Value, b: Value) -> Result<Value, BuildError> {
        Ok(Value(self.graph.difference(a.0, b.0)?))
    }

    /// a·b.
    pub fn product(&mut self, a: Value, b: Value) -> Result<Value, BuildError> {
        Ok(Value(self.graph.product(a.0, b.0)?))
    }

    /// a / b.
    pub fn quotient(&mut self, a: Value, b: Value) -> Result<Value, BuildError> {
        Ok(Value(self.graph.quotient(a.0, b.0)?))
    }

    /// −a.
    pub fn negative(&mut self, a: Value) -> Result<Value, BuildError> {
        Ok(Value(self.graph.negative(a.0)?))
    }

    /// A power of a. A whole exponent suits every a, another one a that is not negative.
    pub fn power(&mut self, a: Value, exponent: f64) -> Result<Value, BuildError> {
        Ok(Value(self.graph.power(a.0, exponent)?))
    }

    /// A function by its name in formulas, such as `sin` or `atan2`, of one value or of two.
    ///
    /// # Errors
    /// Also when there is no such function.
    pub fn function(&mut self, name: &str, values: &[Value]) -> Result<Value, BuildError> {
        let known = FUNCTIONS.iter().find(|(known, _)| *known == name);
        match (known.map(|(_, call)| *call), values) {
            (Some(Call::One(function)), [a]) => Ok(Value(self.graph.one(function, a.0)?)),
            (Some(Call::Two(function)), [a, b]) => Ok(Value(self.graph.two(function, a.0, b.0)?)),
            _ => Err(BuildError::NoFunction {
                name: name.to_owned(),
                values: values.len(),
            }),
        }
    }

    /// The surface with this height, mm.
    ///
    /// # Errors
    /// Also when it keeps too many values at once, or when its height jumps where an angle ends.
    pub fn finish(self, height: Value) -> Result<Formula, BuildError> {
        Formula::of_graph(self.graph, height.0)
    }
}

#[cfg(test)]
mod tests {
    use turnpath_plugin::prelude::*;

    use super::*;

    /// 0.02·(x² − y²) + 5e-3·cos(4θ)·ρ⁴ in both ways.
    #[test]
    fn a_formula_that_is_built_is_the_one_that_is_read() {
        let mut params = Params::new();
        let text = "0.02/mm*(x^2 - y^2) + 5*um*cos(4*theta)*(rho/mm)^4";
        params.set("z", turnpath_core::ParamValue::Text(text.to_owned()));
        let read = Formula::new(&params).unwrap();
        let mut steps = FormulaBuilder::new();
        let built = (|| {
            let (x, y) = (steps.x()?, steps.y()?);
            let (rho, theta) = (
                steps.function("hypot", &[x, y])?,
                steps.function("atan2", &[y, x])?,
            );
            let (xx, yy) = (steps.power(x, 2.0)?, steps.product(y, y)?);
            let saddle = steps.difference(xx, yy)?;
            let (k, four, um) = (steps.number(0.02)?, steps.number(4.0)?, steps.number(5e-3)?);
            let saddle = steps.product(k, saddle)?;
            let angle = steps.product(four, theta)?;
            let wave = steps.function("cos", &[angle])?;
            let wave = steps.product(um, wave)?;
            let power = steps.power(rho, 4.0)?;
            let wave = steps.product(wave, power)?;
            let height = steps.sum(saddle, wave)?;
            steps.finish(height)
        })()
        .unwrap();
        for (x, y) in [(0.0, 0.0), (1.5, -0.25), (-3.0, 2.0), (0.0, -1e-9)] {
            let along = |x: f64, y: f64| {
                (
                    Taylor([x, 0.5, 0.0, 0.1, 0.0]),
                    Taylor([y, -1.0, 0.2, 0.0, 0.0]),
                )
            };
            let (x, y) = along(x, y);
            assert_eq!(built.sag(x, y).0, read.sag(x, y).0);
        }
        assert_eq!(Surface::gap(&built, f64::NAN, 0.0), None);
    }

    #[test]
    fn what_no_formula_is_has_its_reason() {
        let error = |steps: &mut FormulaBuilder, name: &str| {
            let x = steps.x().unwrap();
            steps.function(name, &[x]).unwrap_err().to_string()
        };
        let mut steps = FormulaBuilder::new();
        assert!(error(&mut steps, "gamma").contains("no function `gamma` of 1 values"));
        assert!(error(&mut steps, "hypot").contains("of 1 values"));
        assert_eq!(steps.number(f64::NAN), Err(BuildError::NoFiniteValue));
        let (x, y) = (steps.x().unwrap(), steps.y().unwrap());
        let theta = steps.function("atan2", &[y, x]).unwrap();
        let error = steps.finish(theta).unwrap_err().to_string();
        assert!(error.contains("jumps by"), "{error}");
    }

    #[test]
    fn a_formula_without_end_is_refused() {
        let mut steps = FormulaBuilder::new();
        let mut height = steps.x().unwrap();
        let error = loop {
            match steps.function("sin", &[height]) {
                Ok(next) => height = next,
                Err(error) => break error,
            }
        };
        assert!(matches!(error, BuildError::TooLarge(_)));
    }
}
