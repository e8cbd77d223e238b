//! The formula as a list of steps on a few registers.

use crate::graph::{Graph, Id, Node};
use crate::names::{Function, PairFunction, Variable};

/// Most registers. So many values are kept at once only by formulas that nobody writes by hand.
pub const MOST_REGISTERS: usize = 128;

/// The registers of x and y, which keep them.
pub const X: u8 = 0;
/// See [`X`].
pub const Y: u8 = 1;

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
    /// a·first + second.
    Line(f64, f64),
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
    for id in (0..=root).rev() {
        if last.get(usize::from(id)).copied().flatten().is_none() {
            continue;
        }
        for operand in action(graph, id).1.into_iter().flatten() {
            if let Some(last) = last.get_mut(usize::from(operand)) {
                last.get_or_insert(id);
            }
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
        Node::Sum(a, b) => match (graph.number(a), graph.number(b)) {
            (Some(number), _) => line(graph, b, 1.0, number),
            (_, Some(number)) => line(graph, a, 1.0, number),
            _ if graph.is_square_of_rho(id) => none(Operation::SquareOfRho),
            _ => two(Operation::Sum, a, b),
        },
        Node::Product(a, b) => match (graph.number(a), graph.number(b)) {
            (Some(number), _) => one(Operation::TimesNumber(number), b),
            (_, Some(number)) => one(Operation::TimesNumber(number), a),
            _ => two(Operation::Product, a, b),
        },
        Node::Difference(a, b) => match graph.number(a) {
            Some(number) => line(graph, b, -1.0, number),
            None => two(Operation::Difference, a, b),
        },
        Node::Quotient(a, b) => match graph.number(a) {
            Some(number) => one(Operation::NumberOver(number), b),
            None => two(Operation::Quotient, a, b),
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
        Node::One(function, a) => one(Operation::One(function), a),
        Node::Two(function, a, b) => two(Operation::Two(function), a, b),
    }
}

/// a·sign + number, where a may be a product with a number itself.
fn line(graph: &Graph, a: Id, sign: f64, number: f64) -> (Operation, [Option<Id>; 2]) {
    if let Node::Product(one, two) = graph.node(a) {
        for (factor, other) in [(one, two), (two, one)] {
            if let Some(factor) = graph.number(factor) {
                return (Operation::Line(sign * factor, number), [Some(other), None]);
            }
        }
    }
    let operation = match sign {
        1.0 => Operation::PlusNumber(number),
        _ => Operation::Line(sign, number),
    };
    (operation, [Some(a), None])
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
        self.free
            .extend(freed.into_iter().filter(|register| *register > Y));
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
