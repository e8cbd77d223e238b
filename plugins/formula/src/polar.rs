//! ρ and θ as functions of x and y, such that the axis is a point like any other where it can be.
//!
//! An even power of ρ is a power of x² + y². A product of ρᵐ with cos nθ or sin nθ, m ≥ n, has the
//! real or the imaginary part of (x + iy)ⁿ. cos cρ and cosh cρ are functions of ρ². What is left of ρ and θ has derivatives only beside the
//! axis: [`crate::run`] says what holds there.

use turnpath_plugin::prelude::Scalar;

use crate::graph::{Graph, Id, Node, Refusal};
use crate::names::{Function, Variable};

/// Largest n of cos nθ that becomes a polynomial.
const LARGEST_ORDER: f64 = 64.0;
/// How deep the search for nθ goes into an angle.
const ANGLE_LEVELS: usize = 8;
/// Most factors of a product, and most terms of a sum in it, that are looked at together.
const MOST_PARTS: usize = 64;

/// The same formula in which products of ρ and waves in θ are polynomials. Gives the graph and its
/// last node.
///
/// # Errors
/// If the formula becomes too large.
pub fn resolved(graph: &Graph, root: Id) -> Result<(Graph, Id), Refusal> {
    let mut resolution = Resolution {
        old: graph,
        new: Graph::default(),
        ids: Vec::new(),
    };
    for node in graph.nodes() {
        let id = resolution.node(*node)?;
        resolution.ids.push(id);
    }
    let root = resolution.id(root);
    Ok((resolution.new, root))
}

/// cos(nθ + b) or sin(nθ + b).
#[derive(Debug, Clone, Copy)]
struct Wave {
    is_sine: bool,
    /// n, which may be negative.
    order: f64,
    /// b, rad.
    shift: f64,
}

struct Resolution<'a> {
    old: &'a Graph,
    new: Graph,
    /// The new node of each old one.
    ids: Vec<Id>,
}

impl Resolution<'_> {
    fn id(&self, old: Id) -> Id {
        self.ids.get(usize::from(old)).copied().unwrap_or(0)
    }

    fn node(&mut self, node: Node) -> Result<Id, Refusal> {
        match node {
            Node::Variable(variable) => self.new.variable(variable),
            Node::Constant(bits) => self.new.constant(f64::from_bits(bits)),
            Node::Sum(a, b) => self.new.sum(self.id(a), self.id(b)),
            Node::Difference(a, b) => self.new.difference(self.id(a), self.id(b)),
            Node::Product(a, b) => self.product(a, b),
            Node::Quotient(a, b) => self.new.quotient(self.id(a), self.id(b)),
            Node::Negative(a) => self.new.negative(self.id(a)),
            Node::Power(a, exponent) => self.power_of(a, exponent),
            Node::RealPower(a, bits) => self.new.power(self.id(a), f64::from_bits(bits)),
            Node::One(function, a) => self.one(function, a),
            Node::Two(function, a, b) => self.new.two(function, self.id(a), self.id(b)),
        }
    }

    /// A function of one value. cos and cosh of c·ρⁿ with an odd n are functions of ρ²ⁿ.
    fn one(&mut self, function: Function, a: Id) -> Result<Id, Refusal> {
        let of_root = match function {
            Function::Cos => Function::CosOfRoot,
            Function::Cosh => Function::CoshOfRoot,
            _ => return self.new.one(function, self.id(a)),
        };
        match self.old.power_of_rho(a) {
            Some((factor, power)) if power > 0.0 && power % 2.0 == 1.0 => {
                let square = self.square_of_rho()?;
                let argument = self.new.power(square, power)?;
                let factor = self.new.constant(factor * factor)?;
                let argument = self.new.product(factor, argument)?;
                self.new.one(of_root, argument)
            }
            _ => self.new.one(function, self.id(a)),
        }
    }

    /// x² + y².
    fn square_of_rho(&mut self) -> Result<Id, Refusal> {
        let x = self.new.variable(Variable::X)?;
        let y = self.new.variable(Variable::Y)?;
        let (xx, yy) = (self.new.power(x, 2.0)?, self.new.power(y, 2.0)?);
        self.new.sum(xx, yy)
    }

    /// A power of a node of the old graph. That of a product with ρ in it is the product of its factors
    /// as often.
    fn power_of(&mut self, a: Id, exponent: i32) -> Result<Id, Refusal> {
        let mut factors = Vec::new();
        self.factors(a, &mut factors);
        let count = usize::try_from(exponent).unwrap_or(0);
        let few = count > 0 && factors.len() * count <= MOST_PARTS;
        if factors.len() > 1 && few && self.has_rho(&factors) {
            return self.product_of(&factors.repeat(count), MOST_PARTS);
        }
        let base = self.id(a);
        self.power(base, exponent)
    }

    /// A power; that of ρ is one of x² + y², times ρ if it is odd.
    fn power(&mut self, base: Id, exponent: i32) -> Result<Id, Refusal> {
        if self.new.node(base) != Node::Variable(Variable::Rho) {
            return self.new.power(base, f64::from(exponent));
        }
        let square = self.square_of_rho()?;
        let even = self.new.power(square, f64::from(exponent.div_euclid(2)))?;
        match exponent.rem_euclid(2) {
            0 => Ok(even),
            _ => self.new.product(even, base),
        }
    }

    fn product(&mut self, a: Id, b: Id) -> Result<Id, Refusal> {
        let mut factors = Vec::new();
        self.factors(a, &mut factors);
        self.factors(b, &mut factors);
        match factors.len() <= MOST_PARTS && self.has_rho(&factors) {
            true => self.product_of(&factors, MOST_PARTS),
            false => self.new.product(self.id(a), self.id(b)),
        }
    }

    /// The factors of a product of the old graph, as far as they are few.
    fn factors(&self, id: Id, factors: &mut Vec<Id>) {
        let mut open = vec![id];
        while let Some(id) = open.pop() {
            match self.old.node(id) {
                Node::Product(a, b) if factors.len() + open.len() < MOST_PARTS => {
                    open.extend([b, a]);
                }
                Node::Power(base, exponent @ 2..=8) if self.wave(base).is_some() => {
                    factors.extend((0..exponent).map(|_| base));
                }
                _ => factors.push(id),
            }
        }
    }

    fn has_rho(&self, factors: &[Id]) -> bool {
        factors.iter().any(|factor| self.power_of_rho(*factor) > 0)
    }

    fn power_of_rho(&self, id: Id) -> i32 {
        match self.old.node(id) {
            Node::Variable(Variable::Rho) => 1,
            Node::Power(base, exponent)
                if self.old.node(base) == Node::Variable(Variable::Rho) && exponent > 0 =>
            {
                exponent
            }
            _ => 0,
        }
    }

    /// A product with ρ in it. A sum with waves in θ is multiplied out, so that each of its terms
    /// gets the powers of ρ; `left` bounds how often.
    fn product_of(&mut self, factors: &[Id], left: usize) -> Result<Id, Refusal> {
        let sum = factors.iter().position(|factor| self.has_wave(*factor));
        let Some(at) = sum.filter(|_| left > 1) else {
            return self.single_product(factors);
        };
        let mut terms = Vec::new();
        if let Some(sum) = factors.get(at) {
            self.terms(*sum, &mut terms);
        }
        let left = left / terms.len().max(1);
        let mut total = self.new.constant(0.0)?;
        for (term, is_negative) in terms {
            let mut parts = Vec::new();
            self.factors(term, &mut parts);
            parts.extend(factors.iter().take(at));
            parts.extend(factors.iter().skip(at + 1));
            let product = self.product_of(&parts, left)?;
            total = match is_negative {
                true => self.new.difference(total, product)?,
                false => self.new.sum(total, product)?,
            };
        }
        Ok(total)
    }

    /// Whether a factor is a sum of few terms with a wave in θ among them.
    fn has_wave(&self, id: Id) -> bool {
        if !matches!(
            self.old.node(id),
            Node::Sum(..) | Node::Difference(..) | Node::Negative(_)
        ) {
            return false;
        }
        let mut terms = Vec::new();
        self.terms(id, &mut terms);
        let has_wave = |(term, _): &(Id, bool)| {
            let mut factors = Vec::new();
            self.factors(*term, &mut factors);
            factors.iter().any(|factor| self.wave(*factor).is_some())
        };
        terms.len() < MOST_PARTS && terms.iter().any(has_wave)
    }

    /// The terms of a sum of the old graph, and whether each is subtracted.
    fn terms(&self, id: Id, terms: &mut Vec<(Id, bool)>) {
        let mut open = vec![(id, false)];
        while let Some((id, is_negative)) = open.pop() {
            match self.old.node(id) {
                _ if terms.len() + open.len() >= MOST_PARTS => terms.push((id, is_negative)),
                Node::Sum(a, b) => open.extend([(b, is_negative), (a, is_negative)]),
                Node::Difference(a, b) => open.extend([(b, !is_negative), (a, is_negative)]),
                Node::Negative(a) => open.push((a, !is_negative)),
                _ => terms.push((id, is_negative)),
            }
        }
    }

    /// A product without sums: each wave takes as many powers of ρ as it has waves on the turn.
    fn single_product(&mut self, factors: &[Id]) -> Result<Id, Refusal> {
        let mut powers: i32 = 0;
        let mut product = self.new.constant(1.0)?;
        let mut waves = Vec::new();
        for factor in factors {
            match (self.power_of_rho(*factor), self.wave(*factor)) {
                (0, Some(wave)) => waves.push((wave, *factor)),
                (0, None) => product = self.new.product(product, self.id(*factor))?,
                (power, _) => powers = powers.saturating_add(power),
            }
        }
        for (wave, factor) in waves {
            let order = wave.order.abs() as i32;
            let value = if order <= powers {
                powers -= order;
                self.polynomial(wave)?
            } else {
                self.id(factor)
            };
            product = self.new.product(product, value)?;
        }
        if powers == 0 {
            return Ok(product);
        }
        let rho = self.new.variable(Variable::Rho)?;
        let rest = self.power(rho, powers)?;
        self.new.product(product, rest)
    }

    /// cos(nθ + b)·ρⁿ, or the same with a sine.
    fn polynomial(&mut self, wave: Wave) -> Result<Id, Refusal> {
        let x = self.new.variable(Variable::X)?;
        let y = self.new.variable(Variable::Y)?;
        let (mut real, mut imaginary) = (x, y);
        for _ in 1..wave.order.abs() as i32 {
            let (xr, yi) = (self.new.product(x, real)?, self.new.product(y, imaginary)?);
            let (xi, yr) = (self.new.product(x, imaginary)?, self.new.product(y, real)?);
            (real, imaginary) = (self.new.difference(xr, yi)?, self.new.sum(xi, yr)?);
        }
        if wave.order < 0.0 {
            imaginary = self.new.negative(imaginary)?;
        }
        let cos = self.new.constant(Scalar::cos(wave.shift))?;
        let sin = self.new.constant(Scalar::sin(wave.shift))?;
        let (along, across) = match wave.is_sine {
            true => (imaginary, self.new.product(real, sin)?),
            false => (real, self.new.product(imaginary, sin)?),
        };
        let along = self.new.product(along, cos)?;
        match wave.is_sine {
            true => self.new.sum(along, across),
            false => self.new.difference(along, across),
        }
    }

    /// The wave that a node of the old graph is, if it is one. Its order is not zero.
    fn wave(&self, id: Id) -> Option<Wave> {
        let (is_sine, angle) = match self.old.node(id) {
            Node::One(Function::Sin, angle) => (true, angle),
            Node::One(Function::Cos, angle) => (false, angle),
            _ => return None,
        };
        let (order, shift) = self.turns(angle, ANGLE_LEVELS)?;
        let is_whole = order.fract() == 0.0 && order != 0.0 && order.abs() <= LARGEST_ORDER;
        is_whole.then_some(Wave {
            is_sine,
            order,
            shift,
        })
    }

    /// n and b of an angle nθ + b, where b is a number.
    fn turns(&self, angle: Id, levels: usize) -> Option<(f64, f64)> {
        let next = levels.checked_sub(1)?;
        let turns = |id: Id| self.turns(id, next);
        match self.old.node(angle) {
            Node::Constant(bits) => Some((0.0, f64::from_bits(bits))),
            Node::Variable(Variable::Theta) => Some((1.0, 0.0)),
            Node::Negative(a) => turns(a).map(|(n, b)| (-n, -b)),
            Node::Sum(a, b) => {
                let (one, two) = (turns(a)?, turns(b)?);
                Some((one.0 + two.0, one.1 + two.1))
            }
            Node::Difference(a, b) => {
                let (one, two) = (turns(a)?, turns(b)?);
                Some((one.0 - two.0, one.1 - two.1))
            }
            Node::Product(a, b) => {
                let (factor, other) = match (self.old.number(a), self.old.number(b)) {
                    (Some(factor), _) => (factor, b),
                    (None, Some(factor)) => (factor, a),
                    (None, None) => return None,
                };
                turns(other).map(|(n, b)| (n * factor, b * factor))
            }
            _ => None,
        }
    }
}
