//! Polynomial surfaces in the terms of the design programs: Zernike, Forbes' Q and Chebyshev.
//!
//! z(x, y) is in mm, with x and y from the spindle axis and z towards the tool. Each polynomial is
//! evaluated by its recurrence (`recurrence`), never by its powers, and its angular part as a
//! polynomial in x and y (`harmonics`), so that it has all derivatives at the axis too. Beyond the
//! normalisation radius all of them go on as the polynomials that they are.

mod chebyshev;
mod forbes;
mod harmonics;
mod jacobi;
mod recurrence;
mod terms;
mod zernike;

pub use chebyshev::Chebyshev;
pub use forbes::{ForbesQ2d, ForbesQbfs, ForbesQcon};
pub use zernike::Zernike;

// Tests of this crate's own parts need no strategies, which take most of its compile time.
#[cfg(not(test))]
turnpath_plugin::export!(surfaces: [Chebyshev, ForbesQ2d, ForbesQbfs, ForbesQcon, Zernike]);
