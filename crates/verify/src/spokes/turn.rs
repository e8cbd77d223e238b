//! The errors of one turn of a path, and how many of them a window has.

/// Angles of a mean turn: four for each period of the highest harmonic.
pub(super) const ANGLES: usize = 4 * HIGHEST;
/// The lowest harmonic. Below it are tilt and astigmatism, which are no spokes.
pub(super) const LOWEST: usize = 3;
/// The highest harmonic.
pub(super) const HIGHEST: usize = 512;
/// Turns of a window. Fewer would not show whether a pattern that turns slowly stays.
pub(super) const WINDOW: usize = 64;

/// The errors of one turn.
#[derive(Debug, Clone)]
pub(super) struct Turn {
    /// C in turns, rounded down.
    pub(super) number: i64,
    /// The error at each angle, mm; NaN where no contact lies on the part.
    pub(super) errors: Vec<f64>,
    /// The smallest radius of a contact, mm; infinite without one.
    pub(super) from: f64,
    /// The largest, mm.
    pub(super) to: f64,
}

impl Turn {
    pub(super) fn new(number: i64) -> Self {
        Self {
            number,
            errors: vec![f64::NAN; ANGLES],
            from: f64::INFINITY,
            to: 0.0,
        }
    }

    /// Adds errors at the angles from number `first` on, NaN where there is none. Their contacts lie
    /// between two radii, mm.
    pub(super) fn include(&mut self, first: usize, errors: &[f64], [from, to]: [f64; 2]) {
        for (own, error) in self.errors[first..].iter_mut().zip(errors) {
            *own = if error.is_nan() { *own } else { *error };
        }
        self.from = self.from.min(from);
        self.to = self.to.max(to);
    }

    /// Adds the part of this turn that lies in the next block.
    pub(super) fn join(&mut self, rest: &Self) {
        self.include(0, &rest.errors, [rest.from, rest.to]);
    }
}
