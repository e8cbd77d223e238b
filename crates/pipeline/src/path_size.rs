//! How long a path is, and how long one may be.

pub use turnpath_core::law_limits::{MOST_PIECES, MOST_REVOLUTIONS};

/// Most control points: 250 GB of `toolpath.csv`, and more than a day of work.
pub const MOST_POINTS: f64 = 2e9;

/// A path that is too long.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathSize {
    /// How far the path feeds, mm.
    pub distance: f64,
    /// Revolutions, at least.
    pub revolutions: f64,
    /// Of what there is too much.
    pub excess: Excess,
}

/// Of what there is too much in a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Excess {
    /// Revolutions.
    Revolutions,
    /// Pieces of the law: so many at least.
    Pieces(f64),
    /// Control points: about so many.
    Points(f64),
}

impl std::fmt::Display for PathSize {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let revolutions = self.revolutions;
        write!(f, "it takes about {revolutions:.1e} revolutions")?;
        match self.excess {
            Excess::Revolutions => write!(f, ", and {MOST_REVOLUTIONS:.0e} are the most"),
            Excess::Pieces(pieces) => {
                let most = MOST_PIECES as f64;
                write!(
                    f,
                    " in {pieces:.1e} pieces of the law, and {most:.0e} pieces are the most"
                )
            }
            Excess::Points(points) => write!(
                f,
                " with {points:.1e} control points, and {MOST_POINTS:.0e} points are the most"
            ),
        }
    }
}
