//! The largest nose that fits, its own overrun taken into account.
//!
//! A nose fits where Rκ < 1, and on the part alone that makes 1/κ. But where the tool's X ends at
//! the rim of a slope the contact lies beyond it, the further the larger the nose: the region that
//! must have room for it depends on R itself, and R·κ(region(R)) = 1 is solved.

use crate::extreme::Extreme;

/// By how much, as a part of it, the radius that is found may be too small.
const PRECISION: f64 = 1e-6;
/// Rκ up to which a nose fits, beyond 1 by what the search for κ may differ from itself.
const FULL: f64 = 1.0 + 1e-9;
/// Most radii that are tried between two: every third one halves what is left.
const MOST_TRIALS: usize = 100;
/// A bracket is wide while its lower end is below this part of the upper one, and its next trial
/// is no smaller than this one.
const NARROW: f64 = 0.5;
const WIDEST: f64 = 1.0 / 16.0;

/// The largest nose, and what limits it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LargestNose {
    /// Its radius, mm; infinite where nothing limits it.
    pub radius: f64,
    /// The most curved place in its reach; where the surface ends there it has no value.
    pub at: Extreme,
}

/// One radius that was tried.
#[derive(Clone, Copy)]
struct Tried {
    radius: f64,
    at: Extreme,
}

impl Tried {
    /// Rκ − 1: below 0 the nose fits.
    fn excess(&self) -> f64 {
        self.radius * self.at.value - 1.0
    }

    fn fits(&self) -> bool {
        self.radius * self.at.value <= FULL
    }

    fn largest(&self) -> LargestNose {
        LargestNose {
            radius: self.radius,
            at: self.at,
        }
    }
}

/// The largest radius that fits, up to `most`, beyond which nothing limits it.
///
/// `on_part` is the largest curvature of the part itself. `check` gives that of all the places
/// which a nose of some radius touches, infinite where the surface ends within them.
///
/// # Errors
/// Those of `check`.
///
/// ```
/// use turnpath_core::extreme::Extreme;
/// use turnpath_core::largest_nose::largest_that_fits;
/// // A hollow of 0.2 /mm on the part; beyond the rim it grows with the reach of the nose.
/// let hollow = |value: f64| Extreme { value, theta: 0.0, rho: 5.0 };
/// let found = largest_that_fits(hollow(0.2), 1e3, |radius| {
///     Ok::<_, ()>(hollow(0.2 + 0.1 * radius))
/// })?;
/// // 0.2 R + 0.1 R² = 1
/// assert!((found.radius - (11f64.sqrt() - 1.0)).abs() < 1e-5);
/// # Ok::<(), ()>(())
/// ```
pub fn largest_that_fits<E>(
    on_part: Extreme,
    most: f64,
    mut check: impl FnMut(f64) -> Result<Extreme, E>,
) -> Result<LargestNose, E> {
    let mut attempt = |radius| check(radius).map(|at| Tried { radius, at });
    let on_part = if on_part.value * most > 1.0 {
        Tried {
            radius: on_part.value.recip(),
            at: on_part,
        }
    } else {
        Tried {
            radius: most,
            at: on_part,
        }
    };
    let largest = attempt(on_part.radius)?;
    if largest.fits() {
        let unlimited = largest.radius == most;
        return Ok(LargestNose {
            radius: if unlimited {
                f64::INFINITY
            } else {
                largest.radius
            },
            at: on_part.at,
        });
    }
    between(on_part, largest, attempt)
}

/// The largest radius that fits, below `above`, which does not.
fn between<E>(
    on_part: Tried,
    mut above: Tried,
    mut attempt: impl FnMut(f64) -> Result<Tried, E>,
) -> Result<LargestNose, E> {
    // The smaller the nose, the less lies beyond the part: with none at all, the part alone.
    let mut below = Tried {
        radius: 0.0,
        at: on_part.at,
    };
    for trial in 0..MOST_TRIALS {
        if above.radius - below.radius <= PRECISION * above.radius {
            break;
        }
        let here = attempt(next(&below, &above, trial))?;
        if here.fits() {
            below = here;
        } else {
            above = here;
        }
    }
    // What limits it is seen by the nose that does not fit; where that has no value, the surface
    // ends there.
    let largest = LargestNose {
        at: above.at,
        ..below.largest()
    };
    Ok(largest)
}

/// While the bracket is wide, its middle in powers. Then by turns where a straight line through
/// both ends has Rκ = 1, a little to either side of it so that the bracket closes, and the middle.
fn next(below: &Tried, above: &Tried, trial: usize) -> f64 {
    let (low, high) = (below.radius, above.radius);
    if low < NARROW * high {
        return (low * high).sqrt().max(WIDEST * high);
    }
    let middle = 0.5 * (low + high);
    let rise = above.excess() - below.excess();
    if trial % 3 == 2 || !rise.is_finite() || rise <= 0.0 {
        return middle;
    }
    let root = low - below.excess() * (high - low) / rise;
    let side = if trial.is_multiple_of(3) { -1.0 } else { 1.0 };
    let root = root + side * 0.4 * PRECISION * high;
    if root > low && root < high {
        root
    } else {
        middle
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hollow(value: f64) -> Extreme {
        Extreme {
            value,
            theta: 0.0,
            rho: 1.0,
        }
    }

    /// The largest radius for a curvature that depends on it, and how many were tried.
    fn search(on_part: f64, curvature: impl Fn(f64) -> f64) -> (f64, usize) {
        let mut tried = 0;
        let found = largest_that_fits(hollow(on_part), 1e3, |radius| {
            tried += 1;
            Ok::<_, ()>(hollow(curvature(radius)))
        });
        (found.unwrap().radius, tried)
    }

    #[test]
    fn where_the_part_itself_limits_it_one_look_is_enough() {
        assert_eq!(search(0.25, |_| 0.25), (4.0, 1));
    }

    #[test]
    fn a_part_without_hollows_takes_any() {
        assert_eq!(search(-0.3, |_| -0.3).0, f64::INFINITY);
        assert_eq!(search(0.0, |_| 0.0).0, f64::INFINITY);
    }

    #[test]
    fn a_hollow_that_comes_into_reach_at_once_limits_it_there() {
        for step in [0.01, 0.7, 2.0, 3.9] {
            let (found, tried) = search(0.25, |radius| if radius < step { 0.25 } else { 9.0 });
            let known = step.max(1.0 / 9.0);
            assert!((found / known - 1.0).abs() < 1e-5, "{found} {known}");
            assert!(tried <= 60, "{tried}");
        }
    }

    #[test]
    fn where_the_surface_ends_is_a_limit_too() {
        let (found, _) = search(-1.0, |radius| match radius < 12.3 {
            true => -1.0,
            false => f64::INFINITY,
        });
        assert!((found / 12.3 - 1.0).abs() < 1e-5);
    }

    #[test]
    fn a_smooth_growth_takes_few_looks() {
        for (a, b) in [(0.2, 0.1), (0.9, 3.0), (1e-3, 1e-2), (-0.5, 0.3)] {
            let (found, tried) = search(a, |radius| a + b * radius);
            let known = ((a * a + 4.0 * b).sqrt() - a) / (2.0 * b);
            assert!((found / known - 1.0).abs() < 1e-5, "{found} {known}");
            assert!(tried < 35, "{tried}");
        }
    }
}
