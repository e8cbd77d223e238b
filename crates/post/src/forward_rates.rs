//! The velocities of control points between straight lines: the rates of the line behind each.

use turnpath_core::toolpath::{ControlPoint, Section};

/// Gives points their velocities: those of the line to the next point, and the last point those of the
/// line before it.
#[derive(Debug, Default)]
pub(crate) struct ForwardRates {
    /// The point whose next one is not known yet.
    waiting: Option<(ControlPoint, Section)>,
    /// The rates of the last line.
    rates: [f64; 3],
}

impl ForwardRates {
    /// Takes the next point, and gives the one before it.
    pub(crate) fn push(
        &mut self,
        next: (ControlPoint, Section),
    ) -> Option<(ControlPoint, Section)> {
        let before = self.waiting.replace(next)?;
        let (from, to) = (&before.0, &next.0);
        let time = to.t - from.t;
        self.rates = [to.c - from.c, to.x - from.x, to.z - from.z].map(|way| way / time);
        Some(self.with_rates(before))
    }

    /// The last point.
    pub(crate) fn finish(&mut self) -> Option<(ControlPoint, Section)> {
        let last = self.waiting.take()?;
        Some(self.with_rates(last))
    }

    fn with_rates(&self, (point, section): (ControlPoint, Section)) -> (ControlPoint, Section) {
        let [vc, vx, vz] = self.rates;
        let point = ControlPoint {
            vc,
            vx,
            vz,
            ..point
        };
        (point, section)
    }
}
