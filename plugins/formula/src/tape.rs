//! The formula as a list of steps on a few registers.

use turnpath_plugin::prelude::Scalar;

use crate::graph::{Graph, Id, Node};
use crate::names::{Function, PairFunction, Variable};

/// Most registers. So many values are kept at once only by formulas that nobody writes by hand.
pub const MOST_REGISTERS: usize = 128;

/// The registers in which x and y begin. A step may write them once nothing reads x or y any more.
pub const X: u8 = 0;
/// See [`X`].
pub const Y: u8 = 1;

/// factor·a + number, worked out where a is read: a step of its own would write it and read it
/// again, which takes longer than the line itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// The factor.
    pub factor: f64,
    /// The number. Adding −0 changes no number, not even the sign of 0.
    pub number: f64,
}

impl Line {
    const ITSELF: Self = Self {
        factor: 1.0,
        number: -0.0,
    };

    /// The line at a.
    #[inline(always)]
    pub fn at<S: Scalar>(self, a: S) -> S {
        // The same for every point of a batch, and a product with 1 takes a series five multiplications.
        match self.factor == 1.0 {
            true => a + self.number,
            false => a * self.factor + self.number,
        }
    }
}

/// What a step does with the registers a and b.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Operation {
    /// a + b.
    Sum,
    /// a − b.
    Difference,
    /// a·b.
    Product,
    /// a / b.
    Quotient,
    /// −a.
    Negative,
    /// a².
    Square,
    /// A whole power of a.
    Power(i32),
    /// A real power of a.
    RealPower(f64),
    /// A number.
    Number(f64),
    /// a + number.
    PlusNumber(f64),
    /// a·number.
    TimesNumber(f64),
    /// A line in a.
    Line(Line),
    /// a·first + b·second.
    SumOfMultiples(f64, f64),
    /// A line in a times a line in b.
    ProductOfLines(Line, Line),
    /// A line in a over a line in b.
    QuotientOfLines(Line, Line),
    /// A function of a line in a.
    OneOfLine(Function, Line),
    /// number / a.
    NumberOver(f64),
    /// x² + y².
    SquareOfRho,
    /// ρ of x and y.
    Rho,
    /// A real power of ρ, above 0, of x and y.
    RealPowerOfRho(f64),
    /// θ of x and y.
    Theta,
    /// A function of a.
    One(Function),
    /// A function of a and b.
    Two(PairFunction),
}

impl Operation {
    /// Whether it reads x and y from the registers in which they begin.
    fn reads_place(self) -> bool {
        matches!(
            self,
            Self::SquareOfRho | Self::Rho | Self::RealPowerOfRho(_) | Self::Theta
        )
    }
}

/// One step: what it does, what it reads, and the register that it writes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// What it does.
    pub operation: Operation,
    /// The first register that it reads.
    pub a: u8,
    /// The second one.
    pub b: u8,
    /// The register that it writes.
    pub out: u8,
}

/// A formula that can be run.
#[derive(Debug, Clone, PartialEq)]
pub struct Tape {
    /// The steps in their order.
    pub steps: Vec<Step>,
    /// How many registers they use.
    pub registers: usize,
    /// The register of the height.
    pub height: u8,
}

impl Tape {
    /// The steps of a graph without ρ in powers. `None` if they need too many registers.
    pub fn new(graph: &Graph, root: Id) -> Option<Self> {
        let last_uses = last_uses(graph, root);
        let mut writer = Writer {
            graph,
            registers: vec![X; graph.nodes().len()],
            free: Vec::new(),
            used: usize::from(Y) + 1,
            steps: Vec::new(),
        };
        let mut ends: Vec<Vec<Id>> = vec![Vec::new(); graph.nodes().len()];
        for (id, last) in (0..).zip(&last_uses) {
            if let Some(ends) = last.and_then(|last| ends.get_mut(usize::from(last))) {
                ends.push(id);
            }
        }
        for (id, ends) in (0..).zip(&ends) {
            if last_uses.get(usize::from(id)).copied().flatten().is_some() {
                writer.step(id, ends)?;
            }
        }
        Some(Self {
            height: writer.register(root),
            steps: writer.steps,
            registers: writer.used,
        })
    }
}

/// The last node that reads each node from a register; the root reads itself. `None` for nodes that
/// no step needs.
fn last_uses(graph: &Graph, root: Id) -> Vec<Option<Id>> {
    let mut last: Vec<Option<Id>> = vec![None; graph.nodes().len()];
    if let Some(own) = last.get_mut(usize::from(root)) {
        *own = Some(root);
    }
    let mut last_of_place = None;
    for id in (0..=root).rev() {
        if last.get(usize::from(id)).copied().flatten().is_none() {
            continue;
        }
        let (operation, operands) = action(graph, id);
        if operation.reads_place() {
            last_of_place.get_or_insert(id);
        }
        for operand in operands.into_iter().flatten() {
            if let Some(last) = last.get_mut(usize::from(operand)) {
                last.get_or_insert(id);
            }
        }
    }
    for (id, (node, last)) in (0..).zip(graph.nodes().iter().zip(&mut last)) {
        if matches!(node, Node::Variable(Variable::X | Variable::Y)) {
            *last = (*last).max(last_of_place.filter(|place| *place > id));
        }
    }
    last
}

/// The operation of a node, and the nodes that it reads from registers.
fn action(graph: &Graph, id: Id) -> (Operation, [Option<Id>; 2]) {
    let one = |operation, a| (operation, [Some(a), None]);
    let two = |operation, a, b| (operation, [Some(a), Some(b)]);
    let none = |operation| (operation, [None, None]);
    match graph.node(id) {
        Node::Constant(bits) => none(Operation::Number(f64::from_bits(bits))),
        Node::Variable(Variable::Rho) => none(Operation::Rho),
        Node::Variable(Variable::Theta) => none(Operation::Theta),
        // x and y are in their registers already: the writer makes no step for them.
        Node::Variable(Variable::X | Variable::Y) => none(Operation::Number(0.0)),
        Node::Sum(..) if graph.is_square_of_rho(id) => none(Operation::SquareOfRho),
        Node::Sum(a, b) => match has_number(graph, a, b) {
            true => line(graph, id),
            false => multiples(graph, [a, b], 1.0),
        },
        Node::Product(a, b) => match has_number(graph, a, b) {
            true => line(graph, id),
            false => of_lines(graph, [a, b], Operation::Product, Operation::ProductOfLines),
        },
        Node::Difference(a, b) => match has_number(graph, a, b) {
            true => line(graph, id),
            false => multiples(graph, [a, b], -1.0),
        },
        Node::Quotient(a, b) => match graph.number(a) {
            Some(number) => one(Operation::NumberOver(number), b),
            None => of_lines(
                graph,
                [a, b],
                Operation::Quotient,
                Operation::QuotientOfLines,
            ),
        },
        Node::Negative(a) => one(Operation::Negative, a),
        Node::Power(a, 2) => one(Operation::Square, a),
        Node::Power(a, exponent) => one(Operation::Power(exponent), a),
        Node::RealPower(a, bits)
            if graph.node(a) == Node::Variable(Variable::Rho) && f64::from_bits(bits) > 0.0 =>
        {
            none(Operation::RealPowerOfRho(f64::from_bits(bits)))
        }
        Node::RealPower(a, bits) => one(Operation::RealPower(f64::from_bits(bits)), a),
        Node::One(function, a) => match line_in(graph, a) {
            (Line::ITSELF, a) => one(Operation::One(function), a),
            (line, a) => one(Operation::OneOfLine(function, line), a),
        },
        Node::Two(function, a, b) => two(Operation::Two(function), a, b),
    }
}

fn has_number(graph: &Graph, a: Id, b: Id) -> bool {
    graph.number(a).is_some() || graph.number(b).is_some()
}

/// The step of a node that is a line itself.
fn line(graph: &Graph, id: Id) -> (Operation, [Option<Id>; 2]) {
    let (line, a) = line_in(graph, id);
    let operation = match line {
        Line {
            factor: 1.0,
            number,
        } => Operation::PlusNumber(number),
        Line {
            factor,
            number: 0.0,
        } => Operation::TimesNumber(factor),
        line => Operation::Line(line),
    };
    (operation, [Some(a), None])
}

/// a + sign·b, where each may be a multiple of another node.
fn multiples(graph: &Graph, ids: [Id; 2], sign: f64) -> (Operation, [Option<Id>; 2]) {
    let [(first, a), (second, b)] = ids.map(|id| multiple_in(graph, id));
    let operation = match (first, sign * second) {
        (1.0, 1.0) => Operation::Sum,
        (1.0, -1.0) => Operation::Difference,
        (first, second) => Operation::SumOfMultiples(first, second),
    };
    (operation, [Some(a), Some(b)])
}

/// What is made of two nodes, `plain` unless one of them is a line in another node.
fn of_lines(
    graph: &Graph,
    ids: [Id; 2],
    plain: Operation,
    of: fn(Line, Line) -> Operation,
) -> (Operation, [Option<Id>; 2]) {
    let [(first, a), (second, b)] = ids.map(|id| line_in(graph, id));
    let operation = match first == Line::ITSELF && second == Line::ITSELF {
        true => plain,
        false => of(first, second),
    };
    (operation, [Some(a), Some(b)])
}

/// A node as a line in another one; [`Line::ITSELF`] of itself if it is none.
fn line_in(graph: &Graph, id: Id) -> (Line, Id) {
    let with_number = |a: Id, sign: f64, number: f64| {
        let (factor, a) = multiple_in(graph, a);
        let factor = sign * factor;
        (Line { factor, number }, a)
    };
    match graph.node(id) {
        Node::Sum(a, b) => match (graph.number(a), graph.number(b)) {
            (Some(number), _) => with_number(b, 1.0, number),
            (None, Some(number)) => with_number(a, 1.0, number),
            (None, None) => (Line::ITSELF, id),
        },
        Node::Difference(a, b) => match graph.number(a) {
            Some(number) => with_number(b, -1.0, number),
            None => (Line::ITSELF, id),
        },
        _ => with_number(id, 1.0, -0.0),
    }
}

/// A node as a multiple of another one.
fn multiple_in(graph: &Graph, id: Id) -> (f64, Id) {
    match graph.node(id) {
        Node::Product(a, b) => match (graph.number(a), graph.number(b)) {
            (Some(factor), _) => (factor, b),
            (None, Some(factor)) => (factor, a),
            (None, None) => (1.0, id),
        },
        Node::Negative(a) => (-1.0, a),
        _ => (1.0, id),
    }
}

struct Writer<'a> {
    graph: &'a Graph,
    /// The register of each node that has one.
    registers: Vec<u8>,
    free: Vec<u8>,
    used: usize,
    steps: Vec<Step>,
}

impl Writer<'_> {
    fn register(&self, id: Id) -> u8 {
        self.registers.get(usize::from(id)).copied().unwrap_or(X)
    }

    /// Writes the step of a node. The registers of the nodes in `ends` are free after it was read.
    fn step(&mut self, id: Id, ends: &[Id]) -> Option<()> {
        let fixed = match self.graph.node(id) {
            Node::Variable(Variable::X) => Some(X),
            Node::Variable(Variable::Y) => Some(Y),
            _ => None,
        };
        if let Some(register) = fixed {
            *self.registers.get_mut(usize::from(id))? = register;
            return Some(());
        }
        let (operation, operands) = action(self.graph, id);
        let [a, b] = operands.map(|operand| operand.map_or(X, |id| self.register(id)));
        let read = ends.iter().filter(|end| **end != id);
        let freed: Vec<u8> = read.map(|end| self.register(*end)).collect();
        self.free.extend(freed);
        let out = match self.free.pop() {
            Some(out) => out,
            None => {
                let next = u8::try_from(self.used).ok()?;
                self.used += 1;
                (self.used <= MOST_REGISTERS).then_some(next)?
            }
        };
        *self.registers.get_mut(usize::from(id))? = out;
        self.steps.push(Step {
            operation,
            a,
            b,
            out,
        });
        Some(())
    }
}
