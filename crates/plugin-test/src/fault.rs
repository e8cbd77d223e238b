//! What a check found, in words of the trade.

use turnpath_core::interference::Conflict;
use turnpath_core::{DEG, Limit, NM, Slot, StrategyError, UM};
use turnpath_host::LoadError;
use turnpath_pipeline::PipelineError;
use turnpath_recipe::{Diagnostics, RecipeError};

use crate::place::{AlongPath, OnPart};

/// A strategy that is not what the host takes it for.
#[derive(Debug, thiserror::Error)]
#[error("{}{strategy}{}: {kind}", before(.slot), on(.part))]
pub struct Fault {
    /// The slot, where it is known.
    pub slot: Option<Slot>,
    /// The strategy's name; that of the plugin where none of its strategies can be tried.
    pub strategy: String,
    /// The trial part, where the fault showed on one.
    pub part: Option<&'static str>,
    /// What is wrong.
    #[source]
    pub kind: FaultKind,
}

fn before(slot: &Option<Slot>) -> String {
    slot.map_or_else(String::new, |slot| format!("{slot}/"))
}

fn on(part: &Option<&'static str>) -> String {
    part.map_or_else(String::new, |part| format!(" on the {part}"))
}

/// What is wrong with a strategy, and where. Lengths in mm, angles in rad, times in s.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FaultKind {
    /// The declaration: a name that no recipe could choose, or a parameter of the host's.
    #[error("{0}")]
    Declaration(#[source] LoadError),
    /// A trial names a strategy that the crate does not export.
    #[error("the crate exports no strategy of this name; it exports {known}")]
    Unknown {
        /// The names that it exports.
        known: String,
    },
    /// The values of the trial do not fit the declared parameters.
    #[error("its parameters are refused; `Trial::with` gives others\n{}", .0.render(false))]
    Parameters(#[source] Diagnostics),
    /// The lines of the trial are no recipe.
    #[error("the trial's lines are refused\n{}", .0.render(false))]
    Lines(#[source] RecipeError),
    /// The lines of the trial are no TOML.
    #[error("the trial's lines are no TOML: {0}")]
    Toml(#[source] toml::de::Error),
    /// A file that the lines of the trial name cannot be read.
    #[error("the file {path} cannot be read: {source}")]
    File {
        /// The path as the lines give it.
        path: String,
        /// Why.
        source: std::io::Error,
    },
    /// The constructor failed or panicked.
    #[error("it cannot be made: {0}")]
    Construction(#[source] StrategyError),
    /// A direct call failed or panicked.
    #[error("{call} failed: {error}")]
    Call {
        /// The method.
        call: &'static str,
        /// Its error.
        #[source]
        error: StrategyError,
    },
    /// The host refused the part or the path that was made with it.
    #[error("{}", of_path(.0))]
    Path(#[source] PipelineError),
    /// Two calls that ask for the same gave different answers.
    #[error(
        "{what} gives {first} at first and {second} {when}: an answer must depend on the call alone"
    )]
    Repeat {
        /// What was asked for, and where.
        what: String,
        /// In which way it was asked again.
        when: &'static str,
        /// The first answer.
        first: f64,
        /// The second answer.
        second: f64,
    },
    /// An answer that is no finite number.
    #[error("{of} is {value} at {place}")]
    NoNumber {
        /// Which answer.
        of: &'static str,
        /// Where.
        place: OnPart,
        /// The answer.
        value: f64,
    },
    /// A surface without a height on the part.
    #[error("no height at {0}")]
    NoHeight(OnPart),
    /// A slope that differences of the height do not confirm.
    #[error("∂z/∂{axis} is {found} at {place}, and differences of the height give {measured}")]
    Slope {
        /// `x` or `y`.
        axis: char,
        /// Where.
        place: OnPart,
        /// The strategy's slope.
        found: f64,
        /// That of differences.
        measured: f64,
    },
    /// A series that does not continue the values that it belongs to.
    #[error(
        "the series of {of} is wrong in its term t^{order} at {place}: {found} mm, and the values along \
         the curve give {measured} mm"
    )]
    Series {
        /// Which series.
        of: &'static str,
        /// The power of t.
        order: usize,
        /// The middle of the curve.
        place: OnPart,
        /// The coefficient.
        found: f64,
        /// The one that the values give.
        measured: f64,
    },
    /// The nose cuts into the wanted surface.
    #[error("the nose gouges: its centre is {:.3} nm too low at {place}", depth / NM)]
    Gouge {
        /// Where: θ and X of the centre.
        place: OnPart,
        /// How deep, mm.
        depth: f64,
    },
    /// The nose does not reach the wanted surface.
    #[error("the nose hangs {:.3} nm above the surface at {place}", height / NM)]
    Hangs {
        /// Where: θ and X of the centre.
        place: OnPart,
        /// How high, mm.
        height: f64,
    },
    /// ρ is not what `radial` says.
    #[error("`radial` says that ρ is {declared}, and at {place} that is {found} mm")]
    Radial {
        /// The declared meaning.
        declared: &'static str,
        /// Where: θ and ρ.
        place: OnPart,
        /// The length that ρ should be, mm.
        found: f64,
    },
    /// A contact that is not where the nose touches.
    #[error("`foot` is {found} mm at {place}, and the nose touches at a radius of {touch} mm")]
    Foot {
        /// Where: θ and X of the centre.
        place: OnPart,
        /// The strategy's.
        found: f64,
        /// The true one.
        touch: f64,
    },
    /// Exact rates that differences of the centre do not confirm.
    #[error("{which} is {found} at {place}, and differences of the centre give {measured}")]
    Rate {
        /// Which of the rates.
        which: &'static str,
        /// Where: θ and ρ.
        place: OnPart,
        /// The strategy's.
        found: f64,
        /// That of differences.
        measured: f64,
    },
    /// A law that follows the angle and leaves an end open.
    #[error(
        "the law follows the angle and does not close at its {end}: the outermost pass at C = {:.1} deg \
         lies {:.3} um inside of the range's end, and {:.3} um would close", theta.to_degrees(), inside / UM, most / UM
    )]
    Open {
        /// `beginning` or `end`.
        end: &'static str,
        /// At which angle, rad.
        theta: f64,
        /// How far inside, mm.
        inside: f64,
        /// How far inside is enough, mm.
        most: f64,
    },
    /// A cusp above the residual that the strategy promises to keep.
    #[error("a cusp of {:.3} nm at {place}, and {:.3} nm are promised", height / NM, tolerance / NM)]
    Residual {
        /// Where.
        place: OnPart,
        /// The cusp, mm.
        height: f64,
        /// The tolerance, mm.
        tolerance: f64,
    },
    /// An error as played above the tolerance.
    #[error(
        "as played the path is {:.3} nm off at {place} {when} refinement, and {:.3} nm are allowed", error / NM, tolerance / NM
    )]
    Played {
        /// `before` or `after`.
        when: &'static str,
        /// Where.
        place: AlongPath,
        /// The error, mm.
        error: f64,
        /// The tolerance, mm.
        tolerance: f64,
    },
    /// Velocities that are not those of an axis whose motion is a polynomial.
    #[error(
        "v{axis} is {found} at node {node} of a motion of degree {degree}, whose rate there is {exact}"
    )]
    Velocity {
        /// `C`, `X` or `Z`.
        axis: char,
        /// The degree of the polynomial.
        degree: usize,
        /// The node.
        node: usize,
        /// The solver's velocity.
        found: f64,
        /// The exact one.
        exact: f64,
    },
    /// A block whose answer depends on more than the strategy declares.
    #[error(
        "`dependence` says {declared}, and v{axis} at node {node} is {alone} with these neighbours and {whole} \
         with all"
    )]
    Dependence {
        /// What it declares.
        declared: String,
        /// `C`, `X` or `Z`.
        axis: char,
        /// The node.
        node: usize,
        /// With the neighbours of a block.
        alone: f64,
        /// With the whole path.
        whole: f64,
    },
    /// A speed above the part of it that the host asked for.
    #[error(
        "the host asks for {asked:.4} of the speed, and the law has {found:.4} of it after {n:.3} revolutions"
    )]
    Factor {
        /// Revolutions.
        n: f64,
        /// The part that was asked for.
        asked: f64,
        /// The part that the law has.
        found: f64,
    },
    /// A limit of the machine that the strategy follows and does not hold.
    #[error("it follows the machine's limits, and {} is {ratio:.4} of its limit", limit.key())]
    Limit {
        /// The limit.
        limit: Limit,
        /// The largest amount over the limit.
        ratio: f64,
    },
}

fn of_path(error: &PipelineError) -> String {
    match error {
        PipelineError::Gouge { conflicts, .. } => {
            let words: Vec<String> = conflicts.iter().map(of_conflict).collect();
            format!(
                "the trial's tool does not fit the part: {}; give another [tool] or [part] with \
                 `Trial::with`, unless the slopes or the series of a surface are wrong",
                words.join(", ")
            )
        }
        error => error.to_string(),
    }
}

fn of_conflict(conflict: &Conflict) -> String {
    let (what, at) = match conflict {
        Conflict::NoseRadius { largest, at } => {
            (format!("a nose radius of at most {largest:.4} mm fits"), at)
        }
        Conflict::IncludedAngle { least, at } => {
            let degrees = least / DEG;
            (
                format!("an included angle of {degrees:.2} deg is needed"),
                at,
            )
        }
        Conflict::Clearance { least, at, .. } => {
            let degrees = least / DEG;
            (
                format!("a clearance angle of {degrees:.2} deg is needed"),
                at,
            )
        }
    };
    format!("{what} at x = {:.4} mm, y = {:.4} mm", at.x, at.y)
}

/// The checks: which one finds a fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Check {
    /// Name and parameters.
    Declaration,
    /// The constructor.
    Construction,
    /// The contract: lengths, order, numbers, range, as the host checks them on whole paths.
    Contract,
    /// Same answers, in batches, again, and on many threads.
    Repetition,
    /// Heights on the part.
    Heights,
    /// Slopes and series against differences.
    Derivatives,
    /// The nose against the first touch.
    Touch,
    /// Laws that follow the angle.
    Closing,
    /// Cusps.
    Residual,
    /// The played path.
    Played,
    /// Velocities of polynomials, and the nodes that they depend on.
    Velocities,
    /// Speeds and limits.
    Speed,
}

impl FaultKind {
    /// The check that finds such faults.
    pub const fn check(&self) -> Check {
        match self {
            Self::Declaration(_)
            | Self::Unknown { .. }
            | Self::Parameters(_)
            | Self::Lines(_)
            | Self::Toml(_)
            | Self::File { .. } => Check::Declaration,
            Self::Construction(_) => Check::Construction,
            Self::NoHeight(_) | Self::Path(PipelineError::NoSurface(_)) => Check::Heights,
            Self::Call { .. } | Self::Path(_) => Check::Contract,
            Self::Repeat { .. } => Check::Repetition,
            Self::Slope { .. } | Self::Series { .. } | Self::Rate { .. } => Check::Derivatives,
            Self::NoNumber { .. }
            | Self::Gouge { .. }
            | Self::Hangs { .. }
            | Self::Radial { .. }
            | Self::Foot { .. } => Check::Touch,
            Self::Open { .. } => Check::Closing,
            Self::Residual { .. } => Check::Residual,
            Self::Played { .. } => Check::Played,
            Self::Velocity { .. } | Self::Dependence { .. } => Check::Velocities,
            Self::Factor { .. } | Self::Limit { .. } => Check::Speed,
        }
    }
}
