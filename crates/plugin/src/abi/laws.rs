//! Laws, and the setup and the path that the host lends to strategies.

use abi_stable::StableAbi;
use abi_stable::std_types::RVec;
use turnpath_core::{
    Locus, Path, Piece, PiecewisePolynomial, Result, Setup, SpindleLaw, SpiralLaw, Task,
};

use super::loan::{composite, crossing};
use super::reply::Returned;

/// A number and the coefficients of a piece in one row.
pub fn row(first: f64, [a, b, c, d, e, f]: [f64; 6]) -> [f64; 7] {
    [first, a, b, c, d, e, f]
}

/// The number and the coefficients of a row.
pub fn unrow([first, a, b, c, d, e, f]: &[f64; 7]) -> (f64, [f64; 6]) {
    (*first, [*a, *b, *c, *d, *e, *f])
}

/// A spiral law: the start and the coefficients of each piece, and the end of the last.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiLaw {
    pieces: RVec<[f64; 7]>,
    end: f64,
}

/// A spindle law, as t(N).
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiTime(AbiLaw);

impl From<&PiecewisePolynomial> for AbiLaw {
    fn from(law: &PiecewisePolynomial) -> Self {
        let pieces = law.pieces().iter();
        Self {
            pieces: pieces.map(|p| row(p.start, p.coefficients)).collect(),
            end: law.end(),
        }
    }
}

impl From<&AbiLaw> for PiecewisePolynomial {
    fn from(law: &AbiLaw) -> Self {
        let pieces = law.pieces.iter().map(unrow);
        let pieces = pieces.map(|(start, coefficients)| Piece {
            start,
            coefficients,
        });
        Self::from_pieces(pieces.collect(), law.end)
    }
}

impl Returned for SpindleLaw {
    type Wire = AbiTime;

    fn send(self) -> AbiTime {
        AbiTime(self.as_time().into())
    }

    fn receive(time: AbiTime) -> Result<Self> {
        Ok(Self::from_time((&time.0).into()))
    }
}

crossing! {
    ['a] &'a SpiralLaw => &'w AbiLaw, AbiLaw: |law| law.into(), |law| law;
    ['a] &'a AbiLaw => &'w SpiralLaw, SpiralLaw: |law| law.into(), |law| law;
    ['a] &'a SpindleLaw => &'w AbiTime, AbiTime: |law| AbiTime(law.as_time().into()), |law| law;
    ['a] &'a AbiTime => &'w SpindleLaw, SpindleLaw:
        |time| SpindleLaw::from_time((&time.0).into()), |law| law;
}

composite! {
    Setup => AbiSetup { task: &'a Task, locus: &'a dyn Locus }
    Path => AbiPath {
        task: &'a Task, locus: &'a dyn Locus, law: &'a SpiralLaw, spindle: &'a SpindleLaw,
    }
}
