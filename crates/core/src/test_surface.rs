//! A surface for tests of what asks surfaces for batches.

use crate::{Scalar, Surface};

/// z = 0.1 sin 3x + 0.2 x y.
pub struct Waves;

impl Surface for Waves {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        (x * 3.0).sin() * 0.1 + x * y * 0.2
    }
}
