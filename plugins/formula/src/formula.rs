//! The surface that a recipe writes as a formula.

use turnpath_plugin::prelude::*;

use crate::build_error::BuildError;
use crate::complaint::{Complaint, Mistake};
use crate::gap::Source;
use crate::graph::{Graph, Id, MOST_NODES, Refusal};
use crate::jump::jump;
use crate::lexer::names;
use crate::names::is_taken;
use crate::parser::parse;
use crate::polar::resolved;
use crate::tape::{MOST_REGISTERS, Tape};

/// z = a formula in x, y, ρ, θ and named constants.
///
/// Beyond the aperture the formula goes on. Where it has no value, such as the root of a negative
/// number, z is NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct Formula {
    tape: Tape,
    /// The formula as it was read, to say where it has no value.
    source: Box<Source>,
}

const Z: Param<Text> = Param::text(
    "z",
    "the height as a formula in x, y, rho, theta, units and constants",
)
.example("0.02/mm*(x^2 - y^2) + 5*um*cos(4*theta)*(rho/mm)^4");

const CONSTANTS: Param<Option<Constants>> = Param::constants(
    "constants",
    "the formula's constants by their names: numbers, lengths, angles, powers of lengths",
)
.example("{ k = \"0.08 /mm\" }")
.optional();

impl Strategy for Formula {
    const NAME: &'static str = "formula";
    const SUMMARY: &'static str = "a formula in x, y, rho and theta, with constants and units";
    const PARAMS: &'static [ParamInfo] = &[Z.info(), CONSTANTS.info()];

    fn new(params: &Params) -> Result<Self> {
        let constants = params.get(CONSTANTS).unwrap_or_default();
        if let Some(constant) = constants.iter().find(|constant| is_taken(&constant.name)) {
            return Err(CONSTANTS.refused(format!(
                "every formula has its own `{}`; choose another name",
                constant.name
            )));
        }
        let made = formula(params.get(Z), constants).map_err(|complaint| {
            let message = complaint.to_string();
            Z.refused_at(complaint.place, message)
        })?;
        match unused(params.get(Z), constants) {
            None => Ok(made),
            Some(constant) => Err(CONSTANTS.refused(format!(
                "the formula does not use `{}`; leave it out",
                constant.name
            ))),
        }
    }
}

/// The first constant that stands nowhere in a formula.
fn unused<'a>(text: &str, constants: &'a [NamedConstant]) -> Option<&'a NamedConstant> {
    let names = names(text)?;
    let is_used = |constant: &&NamedConstant| names.contains(&constant.name.as_str());
    constants.iter().find(|constant| !is_used(constant))
}

impl Formula {
    /// The formula of a graph that stands in no text.
    pub(crate) fn of_graph(graph: Graph, root: Id) -> std::result::Result<Self, BuildError> {
        let (of_points, height) = resolved(&graph, root)?;
        let tape = Tape::new(&of_points, height).ok_or(BuildError::TooWide(MOST_REGISTERS))?;
        if let Some(jump) = jump(&of_points, &tape) {
            return Err(BuildError::Jump(jump.sentence()));
        }
        let source = Box::new(Source {
            graph,
            places: Vec::new(),
            root,
        });
        Ok(Self { tape, source })
    }
}

fn formula(text: &str, constants: &[NamedConstant]) -> std::result::Result<Formula, Complaint> {
    let source = Box::new(parse(text, constants)?);
    let whole = || 0..text.len();
    let (graph, root) = resolved(&source.graph, source.root).map_err(|refusal| match refusal {
        Refusal::TooLarge => Mistake::TooLarge(MOST_NODES).at(whole()),
        Refusal::NoFiniteValue => Mistake::NoFiniteValue.at(whole()),
    })?;
    let tape = Tape::new(&graph, root);
    let tape = tape.ok_or_else(|| Mistake::TooWide(MOST_REGISTERS).at(whole()))?;
    match jump(&graph, &tape) {
        None => Ok(Formula { tape, source }),
        Some(jump) => Err(jump.complaint(text)),
    }
}

impl Surface for Formula {
    const SIDE_BY_SIDE: bool = false;
    // All functions that a formula may have, in lanes of series: more of them would compile for minutes.
    const HEIGHT_COEFFICIENTS_IN_LANES: usize = 3;
    const SLOPE_COEFFICIENTS_IN_LANES: usize = 0;

    #[inline(always)]
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        self.tape.run(x, y)
    }

    fn gap(&self, x: f64, y: f64) -> Option<SurfaceGap> {
        let (place, reason) = self.source.gap(x, y)?;
        Some(SurfaceGap {
            entry: 0,
            param: Z.info().name.to_owned(),
            place,
            reason: reason.to_owned(),
        })
    }
}
