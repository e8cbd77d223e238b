//! Why a path cannot be carried by a program.

/// A path that a PVT program cannot carry, and where.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PmacError {
    /// A segment takes longer than the controller can count.
    #[error(
        "the segment that ends at {t:.6} s, C = {c_deg:.3} deg takes {ms:.4} ms; the controller \
         counts to 4095.9998 ms"
    )]
    Long {
        /// Its time, ms.
        ms: f64,
        /// When it ends, s.
        t: f64,
        /// C where it ends, deg.
        c_deg: f64,
    },
    /// A segment is shorter than a step of the controller's time.
    #[error(
        "the segment that ends at {t:.6} s, C = {c_deg:.3} deg takes less than 1/4096 ms, the \
         controller's step of time"
    )]
    Short {
        /// When it ends, s.
        t: f64,
        /// C where it ends, deg.
        c_deg: f64,
    },
    /// A value has more digits than doubles hold.
    #[error("{axis} = {value} at {t:.6} s has too many digits with {decimals} decimals")]
    Digits {
        /// C, X or Z.
        axis: char,
        /// Position or velocity.
        value: f64,
        /// Decimals that are asked for.
        decimals: u32,
        /// When, s.
        t: f64,
    },
    /// C turns so far that a wrapped position does not say which way.
    #[error(
        "C turns by half a revolution or more in the segment that ends at {t:.6} s, C = \
         {c_deg:.3} deg: wrapped positions do not say which way"
    )]
    HalfTurn {
        /// When it ends, s.
        t: f64,
        /// C where it ends, deg.
        c_deg: f64,
    },
    /// The path goes straight from point to point.
    #[error(
        "the path goes straight from point to point, and PVT plays cubics: such a path cannot be \
         carried by this program"
    )]
    Straight,
}

impl PmacError {
    /// What to do about it.
    pub fn help(&self) -> &'static str {
        match self {
            Self::Long { .. } => "place points closer together, or turn the spindle faster",
            Self::Short { .. } => "place points farther apart, or turn the spindle slower",
            Self::Digits { .. } => "write fewer decimals, or c_wrap = \"0-360\"",
            Self::HalfTurn { .. } => {
                "place points closer together, or write c_wrap = \"unwrapped\""
            }
            Self::Straight => "choose a velocity solver that gives cubics, or write posts = []",
        }
    }
}
