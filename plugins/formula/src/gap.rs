//! Why a formula has no height, no slope or no derivative at a place: which part of its text, and what happens
//! there.

use std::ops::Range;

use turnpath_plugin::prelude::*;

use crate::graph::{Graph, Id, Node};
use crate::names::Function;
use crate::tape::Tape;

/// A formula as it was read, with the place of each subexpression in its text.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// The subexpressions as they were written: nothing is multiplied out.
    pub graph: Graph,
    /// The bytes of each; `None` for those that stand nowhere in the text.
    pub places: Vec<Option<Range<usize>>>,
    /// The height.
    pub root: Id,
}

impl Source {
    /// The part of the text that has no value, no slope or no derivative at (x, y), and what happens
    /// there; `None` where the formula has all.
    pub fn gap(&self, x: f64, y: f64) -> Option<(Range<usize>, &'static str)> {
        let mut here = self.root;
        if self.is_smooth(here, x, y)? {
            return None;
        }
        let mut place = self.place(here);
        // The cause is the first part on the way down whose own parts are all right.
        while let Some(below) = self.rough_operand(here, x, y) {
            here = below;
            place = self.place(here).or(place);
        }
        Some((place?, self.reason(here, x, y)))
    }

    fn place(&self, id: Id) -> Option<Range<usize>> {
        self.places.get(usize::from(id)).cloned().flatten()
    }

    /// Whether a subexpression has a value and slopes, and the derivatives of these along x and along
    /// y. `None` if it needs too many registers.
    fn is_smooth(&self, id: Id, x: f64, y: f64) -> Option<bool> {
        let tape = Tape::new(&self.graph, id)?;
        let (of_x, of_y) = (Dual::variable_x(x), Dual::variable_y(y));
        let are_finite = |rates: [f64; 2]| {
            let line = |from: Dual<f64>, rate: f64| {
                let mut line = Taylor::<Dual<f64>>::constant(0.0);
                line.0[0] = from;
                line.0[1] = Dual::constant(rate);
                line
            };
            let series = tape.at(line(of_x, rates[0]), line(of_y, rates[1])).0;
            let all = series.iter().flat_map(|one| [one.value, one.dx, one.dy]);
            all.into_iter().all(f64::is_finite)
        };
        Some(are_finite([1.0, 0.0]) && are_finite([0.0, 1.0]))
    }

    /// Whether a subexpression has slopes.
    fn has_slope(&self, id: Id, x: f64, y: f64) -> bool {
        Tape::new(&self.graph, id).is_some_and(|tape| {
            let value = tape.at(Dual::variable_x(x), Dual::variable_y(y));
            value.dx.is_finite() && value.dy.is_finite()
        })
    }

    fn rough_operand(&self, id: Id, x: f64, y: f64) -> Option<Id> {
        let operands = self.graph.node(id).operands().into_iter().flatten();
        operands
            .into_iter()
            .find(|operand| self.is_smooth(*operand, x, y) == Some(false))
    }

    fn value(&self, id: Id, x: f64, y: f64) -> f64 {
        Tape::new(&self.graph, id).map_or(f64::NAN, |tape| tape.at(x, y))
    }

    /// What happens in a subexpression whose own parts are all right.
    fn reason(&self, id: Id, x: f64, y: f64) -> &'static str {
        let of = |a: Id| self.value(a, x, y);
        match self.graph.node(id) {
            Node::One(Function::Sqrt, a) if of(a) < 0.0 => "the root of a negative number",
            Node::One(Function::Ln, a) if of(a) < 0.0 => "the logarithm of a negative number",
            Node::One(Function::Ln, a) if of(a) == 0.0 => "the logarithm of 0",
            Node::One(Function::Asin | Function::Acos, a) if of(a).abs() > 1.0 => {
                "the arc of a number beyond -1 and 1"
            }
            Node::Quotient(_, b) if of(b) == 0.0 => "a division by 0",
            Node::Power(a, exponent) if exponent < 0 && of(a) == 0.0 => "a division by 0",
            Node::RealPower(a, _) if of(a) < 0.0 => "a broken power of a negative number",
            Node::RealPower(a, _) if of(a) == 0.0 => {
                "a broken power of 0, whose derivatives turnpath does not know"
            }
            _ if self.has_slope(id, x, y) => "no finite derivatives up to the fourth",
            _ if self.value(id, x, y).is_finite() => "no slope",
            _ => "no finite value",
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::parser::parse;

    #[track_caller]
    fn gap(text: &str, x: f64, y: f64) -> Option<(&str, &'static str)> {
        let source = parse(text, &[]).unwrap();
        let (place, reason) = source.gap(x, y)?;
        Some((&text[place], reason))
    }

    #[test]
    fn the_part_that_has_no_value_is_found_with_its_reason() {
        for (text, x, expected) in [
            (
                "2*mm*sqrt(1 - (x/mm)^2) + y",
                1.5,
                ("sqrt(1 - (x/mm)^2)", "the root of a negative number"),
            ),
            (
                "mm*ln(x/mm)",
                -1.0,
                ("ln(x/mm)", "the logarithm of a negative number"),
            ),
            ("mm*cos(ln(x/mm))", 0.0, ("ln(x/mm)", "the logarithm of 0")),
            (
                "x + mm*mm/(x - 2*mm)",
                2.0,
                ("mm*mm/(x - 2*mm)", "a division by 0"),
            ),
            ("mm*(x/mm)^-2", 0.0, ("(x/mm)^-2", "a division by 0")),
            (
                "mm*asin(x/mm)",
                1.5,
                ("asin(x/mm)", "the arc of a number beyond -1 and 1"),
            ),
            (
                "mm*(x/mm)^1.5",
                -0.5,
                ("(x/mm)^1.5", "a broken power of a negative number"),
            ),
            ("mm*sqrt(x/mm)", 0.0, ("sqrt(x/mm)", "no slope")),
            ("mm*exp(x/mm)", 1e3, ("exp(x/mm)", "no finite value")),
            // The value of the whole is 0 there.
            (
                "nm/(1 + exp(-300*x/mm))",
                -2.4,
                ("exp(-300*x/mm)", "no finite value"),
            ),
            (
                "nm/(1 + exp(-300*x/mm))",
                -2.34,
                ("exp(-300*x/mm)", "no finite derivatives up to the fourth"),
            ),
            (
                "mm*(x/mm)^1.5",
                0.0,
                (
                    "(x/mm)^1.5",
                    "a broken power of 0, whose derivatives turnpath does not know",
                ),
            ),
        ] {
            assert_eq!(gap(text, x, 0.25), Some(expected), "{text}");
        }
    }

    #[test]
    fn where_there_is_a_height_nothing_is_to_blame() {
        assert_eq!(gap("x^2/mm + rho*cos(theta)", 0.0, 0.0), None);
        assert_eq!(gap("rho^3/mm^2*cos(3*theta)", 0.0, 0.0), None);
    }
}
