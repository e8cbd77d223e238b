//! The largest nose that fits, with the nose's own overrun taken into account.
//!
//! A nose fits where Rκ < 1. On the part alone the largest radius is therefore 1/κ. But if the
//! tool's X ends at the rim of a slope, the contact lies beyond the rim, and it lies further out
//! the larger the nose is. The region that must have room for the nose depends on R itself. The
//! search solves R·κ(region(R)) = 1.

use crate::extreme::Extreme;

/// The radius that the search finds may be too small by this part of itself.
const PRECISION: f64 = 1e-6;
/// A nose fits up to this Rκ. It is above 1 by as much as two searches for κ may differ.
const LARGEST_FIT: f64 = 1.0 + 1e-9;
/// The search ends after this many radii, whatever happens. It needs less than a third of them.
const MOST_TRIALS: usize = 100;
/// A bracket is wide while its lower end is below this part of the upper end.
const NARROW: f64 = 0.5;
/// In a wide bracket the next trial is at least this part of the upper end.
const LEAST_TRIAL: f64 = 1.0 / 16.0;

/// The largest nose, and the point that limits it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LargestNose {
    /// Radius of the nose, mm; infinite if nothing limits it.
    pub radius: f64,
    /// The most curved point that the nose touches. If the surface ends there, the extreme has no
    /// value.
    pub at: Extreme,
}

/// One trial radius, and the most curved point that a nose of this radius touches.
#[derive(Clone, Copy)]
struct Trial {
    radius: f64,
    at: Extreme,
}

impl Trial {
    /// Rκ − 1: below 0 the nose fits.
    fn excess(&self) -> f64 {
        self.radius * self.at.value - 1.0
    }

    fn fits(&self) -> bool {
        fits(self.radius, &self.at)
    }

    fn largest(&self) -> LargestNose {
        LargestNose {
            radius: self.radius,
            at: self.at,
        }
    }
}

/// Whether a nose of this radius fits where the curvature is largest.
pub fn fits(radius: f64, at: &Extreme) -> bool {
    radius * at.value <= LARGEST_FIT
}

/// The largest radius that fits. The search looks up to `most`; if a nose of that radius fits, the
/// radius has no limit.
///
/// `on_part` is the largest curvature of the part itself. `check` gives the largest curvature over
/// all the points that a nose of a radius touches. It gives infinity if the surface ends within
/// them.
///
/// # Errors
/// The errors of `check`.
///
/// ```
/// use turnpath_core::extreme::Extreme;
/// use turnpath_core::largest_nose::largest_that_fits;
/// // A hollow of 0.2 /mm on the part; beyond the rim it grows with the reach of the nose.
/// let hollow = |value: f64| Extreme { value, theta: 0.0, rho: 5.0 };
/// let largest = largest_that_fits(hollow(0.2), 1e3, |radius| {
///     Ok::<_, ()>(hollow(0.2 + 0.1 * radius))
/// })?;
/// // 0.2 R + 0.1 R² = 1
/// assert!((largest.radius - (11f64.sqrt() - 1.0)).abs() < 1e-5);
/// # Ok::<(), ()>(())
/// ```
pub fn largest_that_fits<E>(
    on_part: Extreme,
    most: f64,
    mut check: impl FnMut(f64) -> Result<Extreme, E>,
) -> Result<LargestNose, E> {
    let mut attempt = |radius| check(radius).map(|at| Trial { radius, at });
    let on_part = if on_part.value * most > 1.0 {
        Trial {
            radius: on_part.value.recip(),
            at: on_part,
        }
    } else {
        Trial {
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

/// The largest radius that fits, below `above`, which does not fit.
fn between<E>(
    on_part: Trial,
    mut above: Trial,
    mut attempt: impl FnMut(f64) -> Result<Trial, E>,
) -> Result<LargestNose, E> {
    // The smaller the nose, the less it touches beyond the part. A nose of zero radius touches the
    // part alone.
    let mut below = Trial {
        radius: 0.0,
        at: on_part.at,
    };
    let mut room = None;
    for _ in 0..MOST_TRIALS {
        let (low, high) = (below.radius, above.radius);
        if high - low <= PRECISION * high {
            break;
        }
        let next = if low < NARROW * high {
            (low * high).sqrt().max(LEAST_TRIAL * high)
        } else {
            let room = room.get_or_insert_with(|| Room::new(low, high));
            room.next_trial(&below, &above)
        };
        let here = attempt(next)?;
        if here.fits() {
            below = here;
        } else {
            above = here;
        }
    }
    // The nose that does not fit shows what limits the radius. If the curvature has no value there,
    // the surface ends there.
    let largest = LargestNose {
        at: above.at,
        ..below.largest()
    };
    Ok(largest)
}

/// How far a trial may be from the middle of a narrow bracket.
///
/// The trials are those of the ITP method (Oliveira and Takahashi, *ACM Transactions on Mathematical
/// Software* 47, 5 (2021), doi:10.1145/3423597): where a straight line through both ends has Rκ = 1, a
/// little towards the middle, and never so far from it that the search would take two trials more than
/// halving.
struct Room {
    /// Width of the bracket at the beginning, mm.
    width: f64,
    /// Largest half width of the bracket that still leaves enough trials, mm.
    half: f64,
}

impl Room {
    fn new(low: f64, high: f64) -> Self {
        let width = high - low;
        // As wide as the last bracket, doubled until halving with one trial to spare leads there.
        let mut half = PRECISION * low;
        while half < width {
            half *= 2.0;
        }
        Self { width, half }
    }

    /// The next trial within the bracket.
    fn next_trial(&mut self, below: &Trial, above: &Trial) -> f64 {
        let (low, high) = (below.radius, above.radius);
        let (middle, width) = (0.5 * (low + high), high - low);
        let farthest = (self.half - 0.5 * width).max(0.0);
        self.half *= 0.5;
        let rise = above.excess() - below.excess();
        if !rise.is_finite() || rise <= 0.0 {
            return middle;
        }
        // A nose that fits may have Rκ a little above 1.
        let root = (low - below.excess() * width / rise).clamp(low, high);
        let (side, distance) = ((middle - root).signum(), (middle - root).abs());
        // The usual parameters of the method: κ₁ = 0.2 over the first width, κ₂ = 2. A trial that is a
        // little farther from the root than a last bracket is wide on either side closes the bracket.
        let inward = (0.2 * width * width / self.width).max(0.4 * PRECISION * high);
        let inward = inward.min(distance);
        middle - side * (distance - inward).min(farthest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scalar;

    fn hollow(value: f64) -> Extreme {
        Extreme {
            value,
            theta: 0.0,
            rho: 1.0,
        }
    }

    /// The largest radius for a curvature that depends on the radius, and the number of trials.
    fn search(on_part: f64, curvature: impl Fn(f64) -> f64) -> (f64, usize) {
        let mut trials = 0;
        let largest = largest_that_fits(hollow(on_part), 1e3, |radius| {
            trials += 1;
            Ok::<_, ()>(hollow(curvature(radius)))
        });
        (largest.unwrap().radius, trials)
    }

    #[test]
    fn where_the_part_itself_limits_the_nose_one_trial_is_enough() {
        assert_eq!(search(0.25, |_| 0.25), (4.0, 1));
    }

    #[test]
    fn a_part_without_hollows_fits_any_nose() {
        assert_eq!(search(-0.3, |_| -0.3).0, f64::INFINITY);
        assert_eq!(search(0.0, |_| 0.0).0, f64::INFINITY);
    }

    #[test]
    fn a_hollow_that_suddenly_comes_into_reach_is_the_limit() {
        for step in [1e-7, 0.01, 0.7, 2.0, 3.9] {
            let (largest, trials) = search(0.25, |radius| if radius < step { 0.25 } else { 9.0 });
            let known = step.max(1.0 / 9.0);
            assert!((largest / known - 1.0).abs() < 1e-5, "{largest} {known}");
            assert!(trials <= 31, "{trials}");
        }
    }

    #[test]
    fn the_end_of_the_surface_is_a_limit_too() {
        let (largest, _) = search(-1.0, |radius| match radius < 12.3 {
            true => -1.0,
            false => f64::INFINITY,
        });
        assert!((largest / 12.3 - 1.0).abs() < 1e-5);
    }

    #[test]
    fn a_growth_along_a_line_takes_few_trials() {
        for (a, b) in [(0.2, 0.1), (0.9, 3.0), (1e-3, 1e-2), (-0.5, 0.3)] {
            let (largest, trials) = search(a, |radius| a + b * radius);
            let known = ((a * a + 4.0 * b).sqrt() - a) / (2.0 * b);
            assert!((largest / known - 1.0).abs() < 1e-5, "{largest} {known}");
            assert!(trials <= 14, "{trials}");
        }
    }

    #[test]
    fn a_growth_as_a_power_takes_more_trials_the_steeper_it_is() {
        for (power, most) in [
            (1, 14),
            (2, 14),
            (3, 14),
            (5, 16),
            (8, 16),
            (13, 31),
            (100, 31),
        ] {
            for scale in [1e-3, 0.03, 0.9, 3.0, 70.0] {
                let curvature = |radius: f64| 1e-3 + Scalar::powi(radius / scale, power);
                let (largest, trials) = search(1e-3, curvature);
                let is_below = |radius: f64| radius * curvature(radius) < 1.0;
                assert!(is_below(largest * (1.0 - 1e-5)) && !is_below(largest * (1.0 + 1e-5)));
                assert!(trials <= most, "R^{power} over {scale}: {trials}");
            }
        }
    }
}
