//! What the segments of one axis add to its motion, many of them side by side.

use turnpath_core::registers::Loop;
use turnpath_core::toolpath::Cubic;

/// Segments that go through the registers together.
pub(crate) const GROUP: usize = 64;

/// The largest amounts of a cubic, and what it adds to the sums of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct AxisTerm {
    /// Largest speed.
    pub velocity: f64,
    /// Largest acceleration.
    pub acceleration: f64,
    /// Largest jerk.
    pub jerk: f64,
    /// Time integrals of the squares of velocity, acceleration and jerk.
    pub squares: [f64; 3],
    /// Signed travel.
    pub travel: f64,
}

impl AxisTerm {
    /// The term of a cubic that takes so long, s.
    #[inline(always)]
    pub fn of(cubic: &Cubic, duration: f64) -> Self {
        let once = duration.recip();
        let (twice, thrice) = (once * once, once * once * once);
        let (first, last) = (cubic.bend(0.0), cubic.bend(1.0));
        let speed_at = |s: f64| (cubic.slope(s) * once).abs();
        let at_ends = larger(speed_at(0.0), speed_at(1.0));
        let turning = turning_place(first, last);
        let has_turning = (0.0..=1.0).contains(&turning);
        let at_turning = if has_turning { speed_at(turning) } else { 0.0 };
        let jerk = cubic.jerk();
        let bends = (first * first + first * last + last * last) / 3.0;
        Self {
            velocity: larger(at_ends, at_turning),
            acceleration: larger((first * twice).abs(), (last * twice).abs()),
            jerk: (jerk * thrice).abs(),
            squares: [
                mean_square_slope(cubic) * twice * duration,
                bends * twice * twice * duration,
                jerk * jerk * thrice * thrice * duration,
            ],
            travel: cubic.value(1.0) - cubic.value(0.0),
        }
    }
}

/// Where the velocity of a segment turns, 0 to 1; NaN where it does not. That is where the acceleration changes its
/// sign. A zero at an end is that end, which counts anyway.
#[inline(always)]
pub(crate) fn turning_place(first_bend: f64, last_bend: f64) -> f64 {
    let place = first_bend / (first_bend - last_bend);
    match (first_bend < 0.0) != (last_bend < 0.0) {
        true => place,
        false => f64::NAN,
    }
}

/// The larger of two amounts; one that is no number does not count.
#[inline(always)]
fn larger(one: f64, other: f64) -> f64 {
    if (other > one) | one.is_nan() {
        other
    } else {
        one
    }
}

/// ∫ (dp/ds)² over s = 0 … 1.
#[inline(always)]
fn mean_square_slope(cubic: &Cubic) -> f64 {
    let [_, b, c, d] = cubic.0;
    b * b + 2.0 * b * c + (4.0 * c * c + 6.0 * b * d) / 3.0 + 3.0 * c * d + 1.8 * d * d
}

/// Terms of one axis, with a column for each quantity.
pub(crate) struct AxisTerms {
    velocity: [f64; GROUP],
    acceleration: [f64; GROUP],
    jerk: [f64; GROUP],
    squares: [[f64; GROUP]; 3],
    travel: [f64; GROUP],
}

impl Default for AxisTerms {
    fn default() -> Self {
        let empty = [0.0; GROUP];
        Self {
            velocity: empty,
            acceleration: empty,
            jerk: empty,
            squares: [empty; 3],
            travel: empty,
        }
    }
}

impl AxisTerms {
    /// Whether the first `count` terms have amounts above these of speed, acceleration and jerk.
    pub fn exceed(&self, count: usize, [velocity, acceleration, jerk]: [f64; 3]) -> bool {
        let above = |column: &[f64; GROUP], peak: f64| {
            let amounts = column.iter().take(count);
            amounts.fold(false, |any, amount| any | (*amount > peak))
        };
        above(&self.velocity, velocity)
            | above(&self.acceleration, acceleration)
            | above(&self.jerk, jerk)
    }

    /// The sums that each of the first `count` segments adds to: squares, and travel.
    pub fn sums(&self, count: usize) -> impl Iterator<Item = ([f64; 3], f64)> + '_ {
        let all = self.travel.iter().take(count).enumerate();
        all.map(|(i, travel)| (self.squares.each_ref().map(|column| column[i]), *travel))
    }
}

/// The loop over the segments of an axis, at most [`GROUP`]. The slices have both ends of all segments.
pub(crate) struct SegmentTerms<'a> {
    pub times: &'a [f64],
    pub positions: &'a [f64],
    pub velocities: &'a [f64],
    pub terms: &'a mut AxisTerms,
}

impl Loop for SegmentTerms<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let count = self.times.len().saturating_sub(1).min(GROUP);
        let all = [self.times, self.positions, self.velocities];
        let firsts = all.map(|column| &column[..count]);
        let lasts = all.map(|column| &column[1..=count]);
        for i in 0..count {
            let ([t0, p0, v0], [t1, p1, v1]) = (firsts.map(|f| f[i]), lasts.map(|l| l[i]));
            let duration = t1 - t0;
            let term = AxisTerm::of(&Cubic::hermite(p0, v0, p1, v1, duration), duration);
            self.terms.velocity[i] = term.velocity;
            self.terms.acceleration[i] = term.acceleration;
            self.terms.jerk[i] = term.jerk;
            for (column, square) in self.terms.squares.iter_mut().zip(term.squares) {
                column[i] = square;
            }
            self.terms.travel[i] = term.travel;
        }
    }
}
