//! Passes with what they leave: the cusps between them, and what stays uncut.

use turnpath_core::Result;
use turnpath_core::toolpath::PathBlock;

use crate::coverage::{Coverage, CoverageFigures};
use crate::residual::{Passes, ResidualFigures};
use crate::touch::FirstTouch;

/// What the passes of a path leave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassFigures {
    /// Residual. It includes the cusps around the axis where the path is meant to cover it.
    pub residual: ResidualFigures,
    /// The material that stays uncut at the part's edges and around the axis.
    pub coverage: CoverageFigures,
}

/// Passes, those of a block or the last ones so far, with what they leave.
#[derive(Debug, Clone, Default)]
pub(crate) struct MeasuredPasses {
    passes: Passes,
    residual: ResidualFigures,
    /// What stays uncut.
    pub(crate) coverage: Coverage,
}

impl MeasuredPasses {
    /// Those of one block. `seen` gets each cusp.
    pub(crate) fn of(
        touch: &FirstTouch,
        points: &PathBlock,
        mut seen: impl FnMut(&ResidualFigures),
    ) -> Result<Self> {
        let passes = Passes::of(touch, points)?;
        let mut residual = ResidualFigures::default();
        passes.for_each_cusp(touch, |cusp| {
            residual.append(&cusp);
            seen(&cusp);
        })?;
        let coverage = Coverage::of(touch, points, &passes)?;
        Ok(Self {
            passes,
            residual,
            coverage,
        })
    }

    /// Appends those of the next block. `seen` gets each cusp where the blocks join.
    pub(crate) fn append(
        &mut self,
        touch: &FirstTouch,
        next: &Self,
        mut seen: impl FnMut(&ResidualFigures),
    ) -> Result<()> {
        let mut joint = ResidualFigures::default();
        self.passes.follow(touch, &next.passes, |cusp| {
            joint.append(&cusp);
            seen(&cusp);
        })?;
        self.residual.append(&next.residual);
        self.residual.append(&joint);
        self.coverage.append(&next.coverage, &next.passes);
        Ok(())
    }

    /// What they leave so far. `counts_centre` says whether the cusps around the axis count as residual.
    pub(crate) fn figures(&self, touch: &FirstTouch, counts_centre: bool) -> Result<PassFigures> {
        let (coverage, around_axis) = self.coverage.figures(touch)?;
        let mut residual = self.residual;
        if counts_centre {
            residual.append(&around_axis);
        }
        Ok(PassFigures { residual, coverage })
    }
}
