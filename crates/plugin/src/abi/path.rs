//! What the host lends to strategies: laws, setup and path.

use abi_stable::StableAbi;
use abi_stable::sabi_types::RRef;
use abi_stable::std_types::{RSlice, RVec};
use turnpath_core::{
    Locus, Path, Piece, PiecewisePolynomial, Result, Setup, SpindleLaw, SpiralLaw, SurfaceModel,
    Task,
};

use super::declaration::Outgoing;
use super::loan::Crossing;
use super::locus::{IncomingLocus, LentLocus};
use super::numbers::{TASK, read_task, task_numbers};
use super::surface::{IncomingSurface, LentSurface};

/// A law: the start and the coefficients of each piece, and the end of the last.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiLaw {
    pieces: RVec<[f64; 7]>,
    end: f64,
}

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
        let piece = |row: &[f64; 7]| {
            let (start, coefficients) = unrow(row);
            Piece {
                start,
                coefficients,
            }
        };
        Self::from_pieces(law.pieces.iter().map(piece).collect(), law.end)
    }
}

/// A number and the coefficients of a piece in one row.
pub fn row(first: f64, [a, b, c, d, e, f]: [f64; 6]) -> [f64; 7] {
    [first, a, b, c, d, e, f]
}

/// The number and the coefficients of a row.
pub fn unrow([first, a, b, c, d, e, f]: &[f64; 7]) -> (f64, [f64; 6]) {
    (*first, [*a, *b, *c, *d, *e, *f])
}

/// Task and locus, lent for the duration of a call.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiSetup<'a> {
    task: RSlice<'a, f64>,
    locus: LentLocus<'a>,
    surface: LentSurface<'a>,
}

pub struct SetupLender<'a> {
    task: [f64; TASK],
    locus: Outgoing<&'a dyn Locus>,
    surface: Outgoing<&'a dyn SurfaceModel>,
}

impl<'a> Crossing for Setup<'a> {
    type Wire<'w> = AbiSetup<'w>;
    type Lender = SetupLender<'a>;

    fn lender(self) -> Result<SetupLender<'a>> {
        Ok(SetupLender {
            task: task_numbers(self.task),
            locus: Outgoing(self.locus),
            surface: Outgoing(self.locus.surface()),
        })
    }

    fn lend<'l>(lender: &'l mut SetupLender<'a>) -> AbiSetup<'l> {
        AbiSetup {
            task: lender.task.as_slice().into(),
            locus: lender.locus.lend(),
            surface: lender.surface.lend(),
        }
    }
}

pub struct SetupReader<'a> {
    task: Task,
    locus: IncomingLocus<'a, RRef<'a, ()>>,
}

impl<'a> Crossing for AbiSetup<'a> {
    type Wire<'w> = Setup<'w>;
    type Lender = SetupReader<'a>;

    fn lender(self) -> Result<SetupReader<'a>> {
        let surface = IncomingSurface::new(self.surface)?;
        Ok(SetupReader {
            task: read_task(&self.task),
            locus: IncomingLocus::new(self.locus, surface)?,
        })
    }

    fn lend<'l>(lender: &'l mut SetupReader<'a>) -> Setup<'l> {
        Setup {
            task: &lender.task,
            locus: &lender.locus,
        }
    }
}

/// Setup and laws, lent for the duration of a call.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiPath<'a> {
    setup: AbiSetup<'a>,
    law: &'a AbiLaw,
    time: &'a AbiLaw,
}

pub struct PathLender<'a> {
    setup: SetupLender<'a>,
    law: AbiLaw,
    time: AbiLaw,
}

impl<'a> Crossing for Path<'a> {
    type Wire<'w> = AbiPath<'w>;
    type Lender = PathLender<'a>;

    fn lender(self) -> Result<PathLender<'a>> {
        let Path {
            task,
            locus,
            law,
            spindle,
        } = self;
        Ok(PathLender {
            setup: Setup { task, locus }.lender()?,
            law: law.into(),
            time: spindle.as_time().into(),
        })
    }

    fn lend<'l>(lender: &'l mut PathLender<'a>) -> AbiPath<'l> {
        AbiPath {
            setup: Setup::lend(&mut lender.setup),
            law: &lender.law,
            time: &lender.time,
        }
    }
}

pub struct PathReader<'a> {
    setup: SetupReader<'a>,
    law: SpiralLaw,
    spindle: SpindleLaw,
}

impl<'a> Crossing for AbiPath<'a> {
    type Wire<'w> = Path<'w>;
    type Lender = PathReader<'a>;

    fn lender(self) -> Result<PathReader<'a>> {
        Ok(PathReader {
            setup: self.setup.lender()?,
            law: self.law.into(),
            spindle: SpindleLaw::from_time(self.time.into()),
        })
    }

    fn lend<'l>(lender: &'l mut PathReader<'a>) -> Path<'l> {
        let Setup { task, locus } = AbiSetup::lend(&mut lender.setup);
        Path {
            task,
            locus,
            law: &lender.law,
            spindle: &lender.spindle,
        }
    }
}
