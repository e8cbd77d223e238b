//! The formula as a graph: each subexpression stands once, and constants are worked out.

use std::collections::BTreeMap;

use turnpath_plugin::prelude::Scalar;

use crate::names::{Function, PairFunction, Variable};

/// Most nodes of a formula.
pub const MOST_NODES: usize = 4096;

/// Largest whole exponent, which is worked out by multiplications. Rounding grows with it: a thousand
/// takes three digits.
const LARGEST_EXPONENT: f64 = 1000.0;

/// How deep a power of ρ is looked for.
const LEVELS: usize = 8;

/// The number of a node. Nodes stand after those that they use.
pub type Id = u16;

/// A subexpression. Numbers are their bits, so that nodes can be compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Node {
    /// A variable.
    Variable(Variable),
    /// A number.
    Constant(u64),
    /// a + b.
    Sum(Id, Id),
    /// a − b.
    Difference(Id, Id),
    /// a·b.
    Product(Id, Id),
    /// a / b.
    Quotient(Id, Id),
    /// −a.
    Negative(Id),
    /// A whole power.
    Power(Id, i32),
    /// A power of a positive number.
    RealPower(Id, u64),
    /// A function of one value.
    One(Function, Id),
    /// A function of two values.
    Two(PairFunction, Id, Id),
}

impl Node {
    /// The nodes that it is made of.
    pub fn operands(self) -> [Option<Id>; 2] {
        match self {
            Self::Variable(_) | Self::Constant(_) => [None, None],
            Self::Sum(a, b)
            | Self::Difference(a, b)
            | Self::Product(a, b)
            | Self::Quotient(a, b)
            | Self::Two(_, a, b) => [Some(a), Some(b)],
            Self::Negative(a) | Self::Power(a, _) | Self::RealPower(a, _) | Self::One(_, a) => {
                [Some(a), None]
            }
        }
    }
}

/// Why a node cannot be made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Refusal {
    /// The graph is full.
    TooLarge,
    /// It has only constants, and no finite value.
    NoFiniteValue,
}

/// The nodes of a formula.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Graph {
    nodes: Vec<Node>,
    numbers: BTreeMap<Node, Id>,
}

impl Graph {
    /// The nodes in their order.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// A node by its number.
    pub fn node(&self, id: Id) -> Node {
        let node = self.nodes.get(usize::from(id)).copied();
        node.unwrap_or(Node::Constant(0))
    }

    /// The number that a node is, if it is one.
    pub fn number(&self, id: Id) -> Option<f64> {
        match self.node(id) {
            Node::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    fn put(&mut self, node: Node) -> Result<Id, Refusal> {
        if let Some(id) = self.numbers.get(&node) {
            return Ok(*id);
        }
        let id = match Id::try_from(self.nodes.len()) {
            Ok(id) if usize::from(id) < MOST_NODES => id,
            _ => return Err(Refusal::TooLarge),
        };
        self.nodes.push(node);
        self.numbers.insert(node, id);
        Ok(id)
    }

    /// A variable.
    pub fn variable(&mut self, variable: Variable) -> Result<Id, Refusal> {
        self.put(Node::Variable(variable))
    }

    /// A number.
    pub fn constant(&mut self, value: f64) -> Result<Id, Refusal> {
        if !value.is_finite() {
            return Err(Refusal::NoFiniteValue);
        }
        // −0 and 0 are one number.
        self.put(Node::Constant((value + 0.0).to_bits()))
    }

    /// a + b.
    pub fn sum(&mut self, a: Id, b: Id) -> Result<Id, Refusal> {
        match (self.number(a), self.number(b)) {
            (Some(one), Some(two)) => self.constant(one + two),
            (Some(0.0), None) => Ok(b),
            (None, Some(0.0)) => Ok(a),
            _ => self.put(Node::Sum(a.min(b), a.max(b))),
        }
    }

    /// a − b.
    pub fn difference(&mut self, a: Id, b: Id) -> Result<Id, Refusal> {
        match (self.number(a), self.number(b)) {
            (Some(one), Some(two)) => self.constant(one - two),
            (Some(0.0), None) => self.negative(b),
            (None, Some(two)) => {
                let opposite = self.constant(-two)?;
                self.sum(a, opposite)
            }
            _ => self.put(Node::Difference(a, b)),
        }
    }

    /// a·b.
    pub fn product(&mut self, a: Id, b: Id) -> Result<Id, Refusal> {
        match (self.number(a), self.number(b)) {
            (Some(one), Some(two)) => self.constant(one * two),
            (Some(0.0), None) | (None, Some(0.0)) => self.constant(0.0),
            (Some(1.0), None) => Ok(b),
            (None, Some(1.0)) => Ok(a),
            (Some(one), None) => self.scaled(b, one),
            (None, Some(two)) => self.scaled(a, two),
            _ if a == b => self.power(a, 2.0),
            _ => self.put(Node::Product(a.min(b), a.max(b))),
        }
    }

    /// A product with a number. Two numbers in a row become one.
    fn scaled(&mut self, a: Id, factor: f64) -> Result<Id, Refusal> {
        if let Node::Product(one, two) = self.node(a) {
            for (number, other) in [(one, two), (two, one)] {
                if let Some(number) = self.number(number) {
                    let both = self.constant(number * factor)?;
                    return self.put(Node::Product(both.min(other), both.max(other)));
                }
            }
        }
        let factor = self.constant(factor)?;
        self.put(Node::Product(a.min(factor), a.max(factor)))
    }

    /// a / b. A division by a number is a product with its inverse.
    pub fn quotient(&mut self, a: Id, b: Id) -> Result<Id, Refusal> {
        match (self.number(a), self.number(b)) {
            (Some(one), Some(two)) => self.constant(one / two),
            (None, Some(two)) if (1.0 / two).is_normal() => {
                let inverse = self.constant(1.0 / two)?;
                self.product(a, inverse)
            }
            (None, Some(0.0)) => Err(Refusal::NoFiniteValue),
            _ => self.put(Node::Quotient(a, b)),
        }
    }

    /// −a.
    pub fn negative(&mut self, a: Id) -> Result<Id, Refusal> {
        match (self.number(a), self.node(a)) {
            (Some(number), _) => self.constant(-number),
            (None, Node::Negative(inner)) => Ok(inner),
            (None, Node::Product(one, two))
                if self.number(one).is_some() || self.number(two).is_some() =>
            {
                self.scaled(a, -1.0)
            }
            _ => self.put(Node::Negative(a)),
        }
    }

    /// aⁿ. Whole exponents are worked out by multiplications, which is right for every a.
    pub fn power(&mut self, a: Id, exponent: f64) -> Result<Id, Refusal> {
        let whole = exponent.fract() == 0.0 && exponent.abs() <= LARGEST_EXPONENT;
        if let Some(number) = self.number(a) {
            let value = match whole {
                true => Scalar::powi(number, exponent as i32),
                false => Scalar::powf(number, exponent),
            };
            return self.constant(value);
        }
        match (whole, self.node(a)) {
            (true, _) if exponent == 0.0 => self.constant(1.0),
            (true, _) if exponent == 1.0 => Ok(a),
            (true, Node::Power(base, inner))
                if (f64::from(inner) * exponent).abs() <= LARGEST_EXPONENT =>
            {
                self.power(base, f64::from(inner) * exponent)
            }
            (true, Node::RealPower(base, bits))
                if self.node(base) == Node::Variable(Variable::Rho) =>
            {
                self.power(base, f64::from_bits(bits) * exponent)
            }
            (true, Node::Product(one, two)) => match (self.number(one), self.number(two)) {
                (Some(number), _) => self.scaled_power(number, two, exponent),
                (_, Some(number)) => self.scaled_power(number, one, exponent),
                _ => self.put(Node::Power(a, exponent as i32)),
            },
            (true, _) => self.put(Node::Power(a, exponent as i32)),
            (false, Node::Variable(Variable::Rho)) if exponent != 0.5 => {
                self.put(Node::RealPower(a, exponent.to_bits()))
            }
            (false, _) => self.real_power(a, exponent),
        }
    }

    /// A power of what is not negative. One of c·ρⁿ is one of ρ, since ρ itself is not negative.
    fn real_power(&mut self, a: Id, exponent: f64) -> Result<Id, Refusal> {
        match self.power_of_rho(a) {
            Some((factor, power)) if factor > 0.0 && (power, exponent) != (1.0, 0.5) => {
                let rho = self.variable(Variable::Rho)?;
                let power = self.power(rho, power * exponent)?;
                let factor = self.constant(Scalar::powf(factor, exponent))?;
                self.product(factor, power)
            }
            _ if exponent == 0.5 => self.put(Node::One(Function::Sqrt, a)),
            _ => self.put(Node::RealPower(a, exponent.to_bits())),
        }
    }

    /// c and n of a subexpression that is c·ρⁿ.
    pub fn power_of_rho(&self, id: Id) -> Option<(f64, f64)> {
        self.power_of_rho_in(id, LEVELS)
    }

    fn power_of_rho_in(&self, id: Id, levels: usize) -> Option<(f64, f64)> {
        let next = levels.checked_sub(1)?;
        let of = |id: Id| self.power_of_rho_in(id, next);
        match self.node(id) {
            Node::Variable(Variable::Rho) => Some((1.0, 1.0)),
            Node::Negative(a) => of(a).map(|(c, n)| (-c, n)),
            Node::Product(a, b) => match (self.number(a), self.number(b)) {
                (Some(factor), _) => of(b).map(|(c, n)| (c * factor, n)),
                (None, Some(factor)) => of(a).map(|(c, n)| (c * factor, n)),
                (None, None) => {
                    let ((c, n), (d, m)) = (of(a)?, of(b)?);
                    Some((c * d, n + m))
                }
            },
            Node::Power(a, exponent) => {
                of(a).map(|(c, n)| (Scalar::powi(c, exponent), n * f64::from(exponent)))
            }
            Node::RealPower(a, bits) if self.node(a) == Node::Variable(Variable::Rho) => {
                Some((1.0, f64::from_bits(bits)))
            }
            Node::Sum(a, b) => match (self.square(a)?, self.square(b)?) {
                ((Variable::X, c), (Variable::Y, d)) | ((Variable::Y, c), (Variable::X, d))
                    if c == d =>
                {
                    Some((c, 2.0))
                }
                _ => None,
            },
            _ => None,
        }
    }

    /// The variable and the factor of its square, where a node is c·x² or (c·x)².
    fn square(&self, id: Id) -> Option<(Variable, f64)> {
        let scaled = |id: Id| match self.node(id) {
            Node::Product(a, b) => match (self.number(a), self.number(b)) {
                (Some(factor), _) => (factor, b),
                (None, Some(factor)) => (factor, a),
                (None, None) => (1.0, id),
            },
            _ => (1.0, id),
        };
        let (factor, power) = scaled(id);
        let Node::Power(base, 2) = self.node(power) else {
            return None;
        };
        match (scaled(base), self.node(scaled(base).1)) {
            ((of_base, _), Node::Variable(variable)) => {
                Some((variable, factor * of_base * of_base))
            }
            _ => None,
        }
    }

    /// (number·a)ⁿ. The number leaves the power, so that ρ/edge to some power is a power of ρ.
    fn scaled_power(&mut self, number: f64, a: Id, exponent: f64) -> Result<Id, Refusal> {
        let factor = Scalar::powi(number, exponent as i32);
        if factor.is_normal() {
            let power = self.power(a, exponent)?;
            let factor = self.constant(factor)?;
            return self.product(power, factor);
        }
        let factor = self.constant(number)?;
        let base = self.put(Node::Product(a.min(factor), a.max(factor)))?;
        self.put(Node::Power(base, exponent as i32))
    }

    /// A function of one value.
    pub fn one(&mut self, function: Function, a: Id) -> Result<Id, Refusal> {
        match self.number(a) {
            Some(number) => self.constant(function.of(number)),
            None if function == Function::Sqrt => self.real_power(a, 0.5),
            None => self.put(Node::One(function, a)),
        }
    }

    /// Whether a node is x² + y².
    pub fn is_square_of_rho(&self, id: Id) -> bool {
        let square_of = |id: Id| match self.node(id) {
            Node::Power(base, 2) => Some(self.node(base)),
            _ => None,
        };
        let Node::Sum(a, b) = self.node(id) else {
            return false;
        };
        let [x, y] = [Variable::X, Variable::Y].map(|variable| Some(Node::Variable(variable)));
        let squares = (square_of(a), square_of(b));
        squares == (x, y) || squares == (y, x)
    }

    /// A function of two values.
    pub fn two(&mut self, function: PairFunction, a: Id, b: Id) -> Result<Id, Refusal> {
        match (self.number(a), self.number(b)) {
            (Some(one), Some(two)) => self.constant(function.of(one, two)),
            _ => match (function, self.node(a), self.node(b)) {
                (PairFunction::Hypot, Node::Variable(Variable::X), Node::Variable(Variable::Y))
                | (PairFunction::Hypot, Node::Variable(Variable::Y), Node::Variable(Variable::X)) => {
                    self.variable(Variable::Rho)
                }
                (PairFunction::Atan2, Node::Variable(Variable::Y), Node::Variable(Variable::X)) => {
                    self.variable(Variable::Theta)
                }
                _ => self.put(Node::Two(function, a, b)),
            },
        }
    }
}

impl Function {
    /// The function's value.
    #[inline(always)]
    pub fn of<S: Scalar>(self, a: S) -> S {
        match self {
            Self::Sqrt => a.sqrt(),
            Self::Abs => Scalar::abs(a),
            Self::Exp => a.exp(),
            Self::Ln => a.ln(),
            Self::Sin => Scalar::sin(a),
            Self::Cos => Scalar::cos(a),
            Self::Tan => a.tan(),
            Self::Asin => a.asin(),
            Self::Acos => a.acos(),
            Self::Atan => a.atan(),
            Self::Sinh => Scalar::sinh(a),
            Self::Cosh => Scalar::cosh(a),
            Self::Tanh => a.tanh(),
            Self::CosOfRoot => of_root(a, -1.0),
            Self::CoshOfRoot => of_root(a, 1.0),
        }
    }
}

/// Terms of the series of cos √a below 1: what is left out is below 1/22!.
const TERMS: u32 = 10;

/// cos √a where `sign` is −1, and cosh √a where it is 1: both are power series in a, so that they have
/// all derivatives at 0.
#[inline(always)]
fn of_root<S: Scalar>(a: S, sign: f64) -> S {
    let is_small = a.less(S::constant(1.0));
    let small = S::select(is_small, a, S::constant(0.0));
    let one = S::constant(1.0);
    let mut series = one;
    for k in (1..=TERMS).rev() {
        let divisor = f64::from(2 * k * (2 * k - 1));
        series = series * small * (sign / divisor) + 1.0;
    }
    let root = S::select(is_small, one, a).sqrt();
    let far = match sign < 0.0 {
        true => Scalar::cos(root),
        false => Scalar::cosh(root),
    };
    S::select(is_small, series, far)
}

impl PairFunction {
    /// The function's value.
    #[inline(always)]
    pub fn of<S: Scalar>(self, a: S, b: S) -> S {
        match self {
            Self::Atan2 => a.atan2(b),
            Self::Hypot => Scalar::hypot(a, b),
            Self::Min => Scalar::min(a, b),
            Self::Max => Scalar::max(a, b),
        }
    }
}
