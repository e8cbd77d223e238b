//! Reads a formula: operator precedence by binding powers, straight into the graph.
//!
//! The grammar is so small that a parser of its own is shorter than one by combinators, and it
//! bounds its depth and knows the place of every operand.

use std::ops::Range;

use turnpath_plugin::prelude::NamedConstant;

use crate::complaint::{Complaint, Mistake};
use crate::dimension::Dimension;
use crate::gap::Source;
use crate::graph::{Graph, Id, MOST_NODES, Refusal};
use crate::lexer::{Kind, Token, tokens};
use crate::names::{Call, FUNCTIONS, Function, PairFunction, RADIUS, VALUES, VARIABLES};

/// Most bytes of a formula: far more than a person writes.
const MOST_BYTES: usize = 16_384;
/// How deep parentheses, powers and signs may stand in each other. It bounds the stack.
const MOST_LEVELS: usize = 64;

/// How tightly an operator binds.
const SUM: u8 = 1;
const PRODUCT: u8 = 2;
const SIGN: u8 = 3;
const POWER: u8 = 4;

/// A value in the formula.
#[derive(Debug, Clone)]
struct Operand {
    id: Id,
    dimension: Dimension,
    place: Range<usize>,
}

/// The graph of a formula, and its last node: the height in mm. Each subexpression has its place in
/// the text.
///
/// # Errors
/// If the text is no formula, or not that of a length.
pub fn parse(text: &str, constants: &[NamedConstant]) -> Result<Source, Complaint> {
    if text.len() > MOST_BYTES {
        return Err(Mistake::TooLong(MOST_BYTES).at(0..text.len()));
    }
    if text.trim().is_empty() {
        return Err(Mistake::Empty.at(0..text.len()));
    }
    let mut parser = Parser {
        text,
        constants,
        tokens: tokens(text)?,
        next: 0,
        graph: Graph::default(),
        places: Vec::new(),
    };
    let height = parser.expression(0, 0)?;
    parser.at_end()?;
    match height.dimension.common(Dimension::LENGTH) {
        Some(_) => Ok(Source {
            graph: parser.graph,
            places: parser.places,
            root: height.id,
        }),
        None => Err(Mistake::NotALength(height.dimension).at(height.place)),
    }
}

struct Parser<'a> {
    text: &'a str,
    constants: &'a [NamedConstant],
    tokens: Vec<Token>,
    next: usize,
    graph: Graph,
    /// The place of each node in the text.
    places: Vec<Option<Range<usize>>>,
}

impl Parser<'_> {
    fn peek(&self) -> Token {
        let end = self.text.len();
        let token = self.tokens.get(self.next).cloned();
        token.unwrap_or(Token {
            kind: Kind::End,
            place: end..end,
        })
    }

    fn advance(&mut self) -> Token {
        let token = self.peek();
        self.next += 1;
        token
    }

    fn takes(&mut self, sign: char) -> bool {
        let taken = self.peek().kind == Kind::Sign(sign);
        self.next += usize::from(taken);
        taken
    }

    fn at_end(&self) -> Result<(), Complaint> {
        let token = self.peek();
        match token.kind {
            Kind::End => Ok(()),
            Kind::Sign(sign) => Err(Mistake::Stray(sign).at(token.place)),
            Kind::Number(_) | Kind::Name => Err(Mistake::NoOperator.at(token.place)),
        }
    }

    /// An expression whose operators bind at least as tightly as `least`.
    fn expression(&mut self, least: u8, level: usize) -> Result<Operand, Complaint> {
        if level > MOST_LEVELS {
            return Err(Mistake::TooDeep(MOST_LEVELS).at(self.peek().place));
        }
        let mut left = self.operand(level)?;
        loop {
            let Kind::Sign(sign) = self.peek().kind else {
                return Ok(left);
            };
            let binding = match sign {
                '+' | '-' => SUM,
                '*' | '/' => PRODUCT,
                '^' => POWER,
                _ => return Ok(left),
            };
            if binding < least {
                return Ok(left);
            }
            self.advance();
            // A power takes what is right of it first: 2^3^2 is 2^9, and 2^-1 is a half.
            let right = match sign {
                '^' => self.expression(SIGN, level + 1)?,
                _ => self.expression(binding + 1, level + 1)?,
            };
            left = self.combined(sign, left, right)?;
        }
    }

    fn operand(&mut self, level: usize) -> Result<Operand, Complaint> {
        let token = self.advance();
        match token.kind {
            Kind::Number(number) => {
                let dimension = match number {
                    0.0 => Dimension::Any,
                    _ => Dimension::PURE,
                };
                self.number(number, dimension, token.place)
            }
            Kind::Name => self.named(&token.place, level),
            Kind::Sign('(') => {
                let inner = self.expression(0, level + 1)?;
                let place = token.place.start..self.close(&token.place)?;
                Ok(Operand { place, ..inner })
            }
            Kind::Sign('+') => self.expression(SIGN, level + 1),
            Kind::Sign('-') => {
                let inner = self.expression(SIGN, level + 1)?;
                let place = token.place.start..inner.place.end;
                let made = self.graph.negative(inner.id);
                self.finished(made, inner.dimension, place)
            }
            Kind::Sign(_) | Kind::End => Err(Mistake::NoValue.at(token.place)),
        }
    }

    /// The end of the parenthesis that closes the one at `opened`.
    fn close(&mut self, opened: &Range<usize>) -> Result<usize, Complaint> {
        let token = self.peek();
        match token.kind {
            Kind::Sign(')') => {
                self.advance();
                Ok(token.place.end)
            }
            Kind::End => Err(Mistake::Open.at(opened.clone())),
            Kind::Sign(sign) => Err(Mistake::Stray(sign).at(token.place)),
            Kind::Number(_) | Kind::Name => Err(Mistake::NoOperator.at(token.place)),
        }
    }

    fn number(
        &mut self,
        number: f64,
        dimension: Dimension,
        place: Range<usize>,
    ) -> Result<Operand, Complaint> {
        let made = self.graph.constant(number);
        self.finished(made, dimension, place)
    }

    fn named(&mut self, place: &Range<usize>, level: usize) -> Result<Operand, Complaint> {
        let name = self.text.get(place.clone()).unwrap_or_default();
        let place = place.clone();
        let is_called = self.peek().kind == Kind::Sign('(');
        let call = FUNCTIONS.iter().find(|(known, _)| *known == name);
        match (call, is_called) {
            (Some((_, call)), true) => return self.called(name, *call, place, level),
            (Some(_), false) => return Err(Mistake::NoArguments(name.to_owned()).at(place)),
            (None, true) => return Err(Mistake::NotAFunction(name.to_owned()).at(place)),
            (None, false) => {}
        }
        if let Some(constant) = self.constants.iter().find(|known| known.name == name) {
            let dimension = Dimension::Power(f64::from(constant.length_power));
            return self.number(constant.value, dimension, place);
        }
        if let Some((_, value, dimension)) = VALUES.iter().find(|(known, ..)| *known == name) {
            return self.number(*value, *dimension, place);
        }
        let long = if name == RADIUS { "rho" } else { name };
        match VARIABLES.iter().find(|(known, ..)| *known == long) {
            Some((_, variable, dimension)) => {
                let made = self.graph.variable(*variable);
                self.finished(made, *dimension, place)
            }
            None => Err(self.unknown(name).at(place)),
        }
    }

    fn unknown(&self, name: &str) -> Mistake {
        let known = VALUES.iter().map(|(known, ..)| *known);
        let known = known.chain(VARIABLES.iter().map(|(known, ..)| *known));
        let known = known.chain(FUNCTIONS.iter().map(|(known, _)| *known));
        let mut known = known.chain(self.constants.iter().map(|known| known.name.as_str()));
        let help = match known.find(|known| known.eq_ignore_ascii_case(name)) {
            Some(meant) => format!("; did you mean `{meant}`?"),
            None => "; a constant of this name belongs in `constants`".to_owned(),
        };
        let name = name.to_owned();
        Mistake::Unknown { name, help }
    }

    fn called(
        &mut self,
        name: &str,
        call: Call,
        place: Range<usize>,
        level: usize,
    ) -> Result<Operand, Complaint> {
        let opened = self.advance().place;
        let mut arguments = Vec::new();
        if self.peek().kind != Kind::Sign(')') {
            arguments.push(self.expression(0, level + 1)?);
            while self.takes(',') {
                arguments.push(self.expression(0, level + 1)?);
            }
        }
        let place = place.start..self.close(&opened)?;
        match (call, arguments.as_slice()) {
            (Call::One(function), [only]) => self.one(function, only, place),
            (Call::Two(function), [first, second]) => self.two(function, first, second, place),
            _ => {
                let wanted = match call {
                    Call::One(_) => "one argument",
                    Call::Two(_) => "two arguments",
                };
                let (name, found) = (name.to_owned(), arguments.len());
                Err(Mistake::Arguments {
                    name,
                    wanted,
                    found,
                }
                .at(place))
            }
        }
    }

    fn one(
        &mut self,
        function: Function,
        argument: &Operand,
        place: Range<usize>,
    ) -> Result<Operand, Complaint> {
        let dimension = match function {
            Function::Sqrt => argument.dimension.to(0.5),
            Function::Abs => argument.dimension,
            _ if argument.dimension.is_pure() => Dimension::PURE,
            _ => return Err(Mistake::NotPure(argument.dimension).at(argument.place.clone())),
        };
        let made = self.graph.one(function, argument.id);
        self.finished(made, dimension, place)
    }

    fn two(
        &mut self,
        function: PairFunction,
        first: &Operand,
        second: &Operand,
        place: Range<usize>,
    ) -> Result<Operand, Complaint> {
        let common = common(first, second, &place)?;
        let dimension = match function {
            PairFunction::Atan2 => Dimension::PURE,
            PairFunction::Hypot | PairFunction::Min | PairFunction::Max => common,
        };
        let made = self.graph.two(function, first.id, second.id);
        self.finished(made, dimension, place)
    }

    fn combined(
        &mut self,
        sign: char,
        left: Operand,
        right: Operand,
    ) -> Result<Operand, Complaint> {
        let place = left.place.start..right.place.end;
        let (a, b) = (left.id, right.id);
        let (made, dimension) = match sign {
            '+' => (self.graph.sum(a, b), common(&left, &right, &place)?),
            '-' => (self.graph.difference(a, b), common(&left, &right, &place)?),
            '*' => (
                self.graph.product(a, b),
                left.dimension.times(right.dimension),
            ),
            '/' => (
                self.graph.quotient(a, b),
                left.dimension.times(right.dimension.to(-1.0)),
            ),
            _ => {
                let exponent = self.graph.number(b).filter(|_| right.dimension.is_pure());
                let exponent = exponent.ok_or_else(|| Mistake::Exponent.at(right.place))?;
                (self.graph.power(a, exponent), left.dimension.to(exponent))
            }
        };
        self.finished(made, dimension, place)
    }

    /// An operand that was put into the graph. The graph keeps its first place in the text.
    fn finished(
        &mut self,
        made: Result<Id, Refusal>,
        dimension: Dimension,
        place: Range<usize>,
    ) -> Result<Operand, Complaint> {
        let id = match made {
            Ok(id) => id,
            Err(Refusal::TooLarge) => return Err(Mistake::TooLarge(MOST_NODES).at(place)),
            Err(Refusal::NoFiniteValue) => return Err(Mistake::NoFiniteValue.at(place)),
        };
        let nodes = self.graph.nodes().len();
        self.places.resize(nodes.max(self.places.len()), None);
        if let Some(known) = self.places.get_mut(usize::from(id)) {
            known.get_or_insert_with(|| place.clone());
        }
        Ok(Operand {
            id,
            dimension,
            place,
        })
    }
}

fn common(left: &Operand, right: &Operand, place: &Range<usize>) -> Result<Dimension, Complaint> {
    let common = left.dimension.common(right.dimension);
    common.ok_or_else(|| Mistake::Unlike(left.dimension, right.dimension).at(place.clone()))
}
