//! Why a surface cannot be taken out of a lens file.

use std::fmt;

/// Why a surface cannot be taken out of a lens file: all that was found, in the order of the lines.
#[derive(Debug, Clone, PartialEq)]
pub struct LensError {
    problems: Vec<LensProblem>,
}

/// Something in a lens file that stands in the way, and its line.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}{kind}", Place(*line))]
pub struct LensProblem {
    /// The line, from 1; `None` for the file as a whole.
    pub line: Option<usize>,
    /// What is wrong.
    pub kind: ProblemKind,
}

/// What is wrong with a lens file, or with what is asked of it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProblemKind {
    /// The bytes are no text.
    #[error("this is not a text")]
    NoText,
    /// The file has no surface.
    #[error("the file has no surface: no line begins with `SURF`")]
    NoSurfaces,
    /// A surface has another number than its place says.
    #[error("surface {expected} follows here, and the line says `{found}`")]
    SurfaceNumber {
        /// What the line has, shortened.
        found: String,
        /// The number in the order of the file.
        expected: usize,
    },
    /// The file does not say its unit.
    #[error("the file does not say its unit: it has no line `UNIT`")]
    NoUnit,
    /// The last line does not end.
    #[error("the file ends within this line, so more of it may be missing: save it again")]
    CutOff,
    /// No surface follows the one that is asked for.
    #[error(
        "surface {number} is the file's last, where a design has its image: the file may be cut off"
    )]
    LastSurface {
        /// The surface.
        number: usize,
    },
    /// The surface does not say its curvature.
    #[error("surface {number} has no line `CURV`; that of a plane says 0")]
    NoCurvature {
        /// The surface.
        number: usize,
    },
    /// The unit is unknown.
    #[error("the unit `{name}` is unknown: MM, CM, IN and METER are known")]
    Unit {
        /// Its name, shortened.
        name: String,
    },
    /// The design is not a sequence of surfaces.
    #[error("the mode is `{found}`: only sequential designs, `SEQ`, can be read")]
    Mode {
        /// The mode, shortened.
        found: String,
    },
    /// The design has several configurations, and a surface may differ between them.
    #[error(
        "the design has {count} configurations: save the one to be made as a file with one \
         configuration"
    )]
    Configurations {
        /// How many, as the file has it.
        count: String,
    },
    /// A line begins with a word that is not known, so it might change the surface.
    #[error("`{key}` is not known, so it might change the surface")]
    UnknownKey {
        /// The word, shortened.
        key: String,
    },
    /// A line of a surface stands before the first surface, or between surfaces behind a line that is of none.
    #[error(
        "`{key}` is a line of a surface and does not stand with one: such lines follow their `SURF`, \
         with no other line between"
    )]
    OfNoSurface {
        /// The line's key.
        key: String,
    },
    /// The type of the surface is not known.
    #[error("surfaces of type `{name}` cannot be read; {KNOWN_TYPES} can")]
    UnknownType {
        /// Its name, shortened.
        name: String,
    },
    /// A value that is not set, but follows from something else.
    #[error(
        "`{key}` follows from a solve or a pickup: make the value a fixed one, and save the file \
         again"
    )]
    Solve {
        /// The line's key.
        key: &'static str,
    },
    /// What stands there is no number, or not one that may stand there.
    #[error("`{found}` is no {wanted}")]
    NoNumber {
        /// The text, shortened.
        found: String,
        /// What should be there.
        wanted: &'static str,
    },
    /// A value stands there a second time.
    #[error("`{key}` stands there a second time")]
    Twice {
        /// The line's key and number.
        key: String,
    },
    /// A parameter that the type has not, or that turnpath does not know.
    #[error("{key} {index} of a surface of type `{kind}` is {value}; only 0 is known to turnpath")]
    Slot {
        /// `PARM` or `XDAT`.
        key: &'static str,
        /// Its number.
        index: u32,
        /// The type.
        kind: &'static str,
        /// Its value.
        value: f64,
    },
    /// A term of too high a power.
    #[error("the term of the power {power} is not 0; turnpath has powers up to {most}")]
    Power {
        /// The power.
        power: u32,
        /// The highest that a surface of turnpath has.
        most: u32,
    },
    /// The normalisation radius is no radius.
    #[error("the normalization radius is {value}; it must be above 0")]
    Normalization {
        /// The radius, in the file's unit.
        value: f64,
    },
    /// Zernike terms that end within the part.
    #[error(
        "the Zernike terms end at their normalization radius of {radius} mm, and the part reaches \
         {reach} mm from the vertex: set `Extrapolate` to 1, or make the part smaller"
    )]
    ZernikeEnd {
        /// The normalisation radius, mm.
        radius: f64,
        /// How far the part reaches, mm.
        reach: f64,
    },
    /// No surface has a shape.
    #[error("no surface of the file has a shape: all are planes; name one with `--surface`")]
    NoShape,
    /// Several surfaces have a shape.
    #[error("several surfaces have a shape: name one with `--surface`\n{}", list.join("\n"))]
    SeveralShapes {
        /// A line for each of them.
        list: Vec<String>,
    },
    /// There is no surface of this number.
    #[error("the file has no surface {number}: its surfaces are 0 to {last}")]
    NoSuchSurface {
        /// The number that was asked for.
        number: usize,
        /// The last of the file.
        last: usize,
    },
    /// The surface is switched off in the design.
    #[error("the design ignores this surface")]
    Ignored,
    /// The aperture is not a circle.
    #[error("`{key}` is an aperture that is not a circle: give the part's with `--aperture`")]
    ApertureForm {
        /// The line's key.
        key: String,
    },
    /// The surface has no aperture.
    #[error("surface {number} has no aperture: give the part's with `--aperture`")]
    NoAperture {
        /// The surface.
        number: usize,
    },
    /// A hole that is as large as the aperture.
    #[error("the aperture's inner radius {inner} is not below its outer radius {outer}")]
    Hole {
        /// In the file's unit.
        inner: f64,
        /// In the file's unit.
        outer: f64,
    },
    /// It is not known from which side the surface is cut.
    #[error("{0}: give the side of the tool with `--tool-side`")]
    Side(&'static str),
}

/// The types that can be read.
const KNOWN_TYPES: &str = "STANDARD, EVENASPH, ODDASPHE, XASPHERE, XOSPHERE, BICONICX, TOROIDAL, XPOLYNOM, SZERNSAG and FZERNSAG";

struct Place(Option<usize>);

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            None => Ok(()),
            Some(line) => write!(f, "line {line}: "),
        }
    }
}

impl ProblemKind {
    /// The problem at a line.
    pub(crate) fn at(self, line: usize) -> LensProblem {
        LensProblem {
            line: Some(line),
            kind: self,
        }
    }

    /// The problem of the file as a whole.
    pub(crate) fn of_file(self) -> LensProblem {
        LensProblem {
            line: None,
            kind: self,
        }
    }
}

impl LensError {
    /// The error of these problems.
    pub(crate) fn new(mut problems: Vec<LensProblem>) -> Self {
        problems.sort_by_key(|problem| problem.line.unwrap_or(usize::MAX));
        Self { problems }
    }

    /// All that stands in the way, in the order of the lines.
    pub fn problems(&self) -> &[LensProblem] {
        &self.problems
    }
}

impl From<LensProblem> for LensError {
    fn from(problem: LensProblem) -> Self {
        Self::new(vec![problem])
    }
}

impl fmt::Display for LensError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, problem) in self.problems.iter().enumerate() {
            let end = if index == 0 { "" } else { "\n" };
            write!(f, "{end}{problem}")?;
        }
        Ok(())
    }
}

impl std::error::Error for LensError {}
