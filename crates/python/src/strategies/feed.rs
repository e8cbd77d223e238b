//! Feed strategies of Python.

use pyo3::prelude::*;
use turnpath_core::{Continuation, FeedPiece, FeedPlan, FeedStrategy, Result, Setup};

use super::Callable;
use crate::arrays::rows;
use crate::failure::asked;
use crate::loan::lend_locus;
use crate::views::path::SetupView;

/// A piece of a law: its length, then its six coefficients.
const PIECE: usize = 7;
/// Pieces that the host gets at once.
const PIECES: usize = 4096;

/// A feed that Python gives as a whole.
pub struct PyFeed(pub Callable);

impl FeedStrategy for PyFeed {
    fn plan(&self, setup: Setup<'_>) -> Result<Box<dyn FeedPlan>> {
        let pieces: Vec<[f64; PIECE]> = lend_locus(setup.locus, |locus| {
            asked(|py| {
                let task = setup.task.clone();
                let law = self.0.bind(py).call1((SetupView { task, locus },))?;
                rows(&law, "the law")
            })
        })?;
        Ok(Box::new(WholeLaw { pieces, given: 0 }))
    }
}

struct WholeLaw {
    pieces: Vec<[f64; PIECE]>,
    given: usize,
}

impl FeedPlan for WholeLaw {
    fn extend(&mut self, _: Setup<'_>, pieces: &mut Vec<FeedPiece>) -> Result<Continuation> {
        let rest = self.pieces.get(self.given..).unwrap_or_default();
        let next = rest.iter().take(PIECES);
        self.given += next.len();
        pieces.extend(next.map(|[length, coefficients @ ..]| FeedPiece {
            length: *length,
            coefficients: *coefficients,
        }));
        match self.given < self.pieces.len() {
            true => Ok(Continuation::More),
            false => Ok(Continuation::End),
        }
    }
}
