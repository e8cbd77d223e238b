//! How many chords stand for a cubic segment.
//!
//! A chord is the straight line that all axes go, linear in time, from one point of the cubic to
//! another. What counts is by how much it leaves the surface along z. Where C does not keep its speed
//! within a segment, the chord is at another C than the cubic, and Z belongs to C: Z then counts by
//! its distance from the curve Z(C) of the cubic. So does X, times the steepest slope.

use turnpath_core::toolpath::Segment;

/// Slope of the surface along X for which a chord's distance along X counts. X seldom bends within a
/// segment, so a larger slope would cost no line on most paths; on a part that is steeper where X
/// bends, the chords may be off by more than their share. The program's own measurement shows that.
const SLOPE: f64 = 1.0;
/// The part of its mean speed within a segment that C keeps where Z counts as a curve over C. Where C
/// is slower or faster, as from rest, Z counts as it is.
const STEADY: std::ops::RangeInclusive<f64> = 0.5..=2.0;
/// Places at which the bend is looked at. The bend of a cubic is linear, so it is largest at an end;
/// the middle is for the slope over C, which is no polynomial.
const PLACES: [f64; 3] = [0.0, 0.5, 1.0];
/// A chord over a part w of a segment is at most w²/8 of the largest bend from its cubic.
const BEND: f64 = 8.0;

/// The smallest number of equally long chords that stay within `deviation` of a segment, mm. It may
/// be any number from 1, or not finite.
pub(crate) fn chords_within(deviation: f64, segment: &Segment) -> f64 {
    let rise = segment.c.value(1.0) - segment.c.value(0.0);
    let is_steady = |s: &f64| rise > 0.0 && STEADY.contains(&(segment.c.slope(*s) / rise));
    let over_c = PLACES.iter().all(is_steady);
    let bend = |s: f64| {
        let (z, x) = (segment.z.bend(s), segment.x.bend(s));
        match over_c {
            false => z.abs() + SLOPE * x.abs(),
            true => {
                let turned = segment.c.bend(s) / segment.c.slope(s);
                let z = z - turned * segment.z.slope(s);
                let x = x - turned * segment.x.slope(s);
                z.abs() + SLOPE * x.abs()
            }
        }
    };
    let largest = PLACES.into_iter().map(bend).fold(0.0, f64::max);
    (largest / (BEND * deviation)).sqrt().ceil().max(1.0)
}

#[cfg(test)]
mod tests {
    use turnpath_core::toolpath::ControlPoint;

    use super::*;

    fn segment(from: [f64; 6], to: [f64; 6]) -> Segment {
        let point = |t: f64, [c, x, z, vc, vx, vz]: [f64; 6]| ControlPoint {
            t,
            c,
            x,
            z,
            vc,
            vx,
            vz,
        };
        Segment::between(&point(0.0, from), &point(0.01, to))
    }

    /// Largest distance of the chords from the cubic along z, on a surface on which the cubic lies
    /// and that has the slope 0 along X, by looking at many places.
    fn largest_distance(segment: &Segment, chords: f64) -> f64 {
        let mut largest = 0.0f64;
        for k in 0..chords as u32 {
            let [a, b] = [f64::from(k), f64::from(k + 1)].map(|k| k / chords);
            for i in 0..=50 {
                let part = f64::from(i) / 50.0;
                let between = |cubic: &turnpath_core::toolpath::Cubic| {
                    (1.0 - part) * cubic.value(a) + part * cubic.value(b)
                };
                let (c, z) = (between(&segment.c), between(&segment.z));
                // The place of the cubic at this C, by halving.
                let (mut low, mut high) = (0.0, 1.0);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    match segment.c.value(middle) < c {
                        true => low = middle,
                        false => high = middle,
                    }
                }
                largest = largest.max((z - segment.z.value(low)).abs());
            }
        }
        largest
    }

    #[test]
    fn chords_keep_their_distance_and_no_fewer_would() {
        for (from, to) in [
            (
                [0.0, 2.5, 0.0, 50.0, -0.2, 5.0],
                [0.5, 2.498, 0.03, 50.0, -0.2, 1.0],
            ),
            // C gains a fifth of its speed.
            (
                [0.0, 2.5, 0.0, 50.0, -0.2, 5.0],
                [0.55, 2.498, 0.05, 60.0, -0.2, 5.5],
            ),
            (
                [0.0, 2.5, 0.0, 60.0, -0.2, -9.0],
                [0.55, 2.498, 0.01, 50.0, -0.2, 8.0],
            ),
        ] {
            let segment = segment(from, to);
            for deviation in [1e-3, 1e-4, 1e-6] {
                let chords = chords_within(deviation, &segment);
                let distance = largest_distance(&segment, chords);
                assert!(distance <= 1.001 * deviation, "{chords} {distance:e}");
                if chords > 4.0 {
                    let fewer = largest_distance(&segment, (0.8 * chords).floor());
                    assert!(fewer > deviation, "{chords} {fewer:e}");
                }
            }
        }
    }

    #[test]
    fn a_line_is_one_chord_even_where_c_changes_its_speed() {
        // Z and X go with C, which gains speed.
        let segment = segment(
            [0.0, 2.5, 0.0, 50.0, -0.5, 5.0],
            [0.55, 2.4945, 0.055, 60.0, -0.6, 6.0],
        );
        assert_eq!(chords_within(1e-9, &segment), 1.0);
    }
}
