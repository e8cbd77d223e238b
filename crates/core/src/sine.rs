//! Sine and cosine of many angles at once, with the bits of `libm::sincos` in every lane.
//!
//! Each lane does the operations of libm in their order, without branches. Where libm's own branch
//! is another one, libm itself gives that lane: near a multiple of π/2 its reduction takes a second
//! round, and a few angles in a million lie there; beyond [`LARGEST`] the reduction is another
//! algorithm.

use std::hint::black_box;

use crate::registers::{Loop, in_widest};

/// Angles that go through the kernel together.
const WIDTH: usize = 8;

/// Adding this rounds to a whole number, whose lowest bits are then those of the sum.
const TO_WHOLE: f64 = 1.5 / f64::EPSILON;
/// 2/π.
const QUARTERS_PER_RAD: f64 = f64::from_bits(0x3fe4_5f30_6dc9_c883);
/// The first 33 bits of π/2.
const QUARTER: f64 = f64::from_bits(0x3ff9_21fb_5440_0000);
/// π/2 − [`QUARTER`].
const QUARTER_TAIL: f64 = f64::from_bits(0x3dd0_b461_1a62_6331);
/// The first bits of the angles around 1, 2, 3 and 4 quarters whose reduction takes more rounds.
const CANCELLING: [u64; 4] = [0x3ff9_21fb, 0x4009_21fb, 0x4012_d97c, 0x4019_21fb];
/// From so many bits that cancel on, the reduction of a larger angle takes a second round.
const MOST_CANCELLED: i64 = 16;

/// The smallest angle whose first 32 bits are these.
const fn first_with(bits: u64) -> f64 {
    f64::from_bits(bits << 32)
}

/// Below this angle the sine is the angle, and the cosine is 1.
const TINY: f64 = first_with(0x3e46_a09e);
/// Below these angles (odd multiples of π/4) the nearest multiple of π/2 is 0, 1, 2, 3 and 4 times.
const BORDERS: [f64; 5] = [
    first_with(0x3fe9_21fc),
    first_with(0x4002_d97d),
    first_with(0x400f_6a7b),
    first_with(0x4015_fdbd),
    first_with(0x401c_463c),
];
/// Below this angle, 2²⁰ π/2, the reduction is that of [`Remainder`].
const LARGEST: f64 = first_with(0x4139_21fb);

/// Coefficients of x³, x⁵, … of the sine.
const SINE: [f64; 6] = [
    f64::from_bits(0xbfc5_5555_5555_5549),
    f64::from_bits(0x3f81_1111_1110_f8a6),
    f64::from_bits(0xbf2a_01a0_19c1_61d5),
    f64::from_bits(0x3ec7_1de3_57b1_fe7d),
    f64::from_bits(0xbe5a_e5e6_8a2b_9ceb),
    f64::from_bits(0x3de5_d93a_5acf_d57c),
];
/// Coefficients of x⁴, x⁶, … of the cosine.
const COSINE: [f64; 6] = [
    f64::from_bits(0x3fa5_5555_5555_554c),
    f64::from_bits(0xbf56_c16c_16c1_5177),
    f64::from_bits(0x3efa_01a0_19cb_1590),
    f64::from_bits(0xbe92_7e4f_809c_52ad),
    f64::from_bits(0x3e21_ee9e_bdb4_b1c4),
    f64::from_bits(0xbda8_fae9_be88_38d4),
];

/// Sine and cosine of each angle, rad. All slices have one length.
pub fn sines_and_cosines(angles: &[f64], sines: &mut [f64], cosines: &mut [f64]) {
    in_widest(Angles(angles, sines, cosines));
}

/// The loop of [`sines_and_cosines`].
struct Angles<'a>(&'a [f64], &'a mut [f64], &'a mut [f64]);

impl Loop for Angles<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self(angles, sines, cosines) = self;
        let (whole, rest) = angles.as_chunks::<WIDTH>();
        let (sines, rest_sines) = sines.as_chunks_mut::<WIDTH>();
        let (cosines, rest_cosines) = cosines.as_chunks_mut::<WIDTH>();
        for ((angles, sines), cosines) in whole.iter().zip(sines).zip(cosines) {
            (*sines, *cosines) = of_lanes(angles);
        }
        for ((angle, sine), cosine) in rest.iter().zip(rest_sines).zip(rest_cosines) {
            (*sine, *cosine) = libm::sincos(*angle);
        }
    }
}

/// Sine and cosine of each lane.
#[inline(always)]
pub(crate) fn of_lanes<const N: usize>(angles: &[f64; N]) -> ([f64; N], [f64; N]) {
    let (mut sines, mut cosines) = ([0.0; N], [0.0; N]);
    let mut is_exception = false;
    for lane in 0..N {
        let reduced = Remainder::of(angles[lane]);
        is_exception |= reduced.is_exception;
        (sines[lane], cosines[lane]) = reduced.sin_cos(angles[lane]);
    }
    // Both are made, also where the caller leaves one out: the compiler would unroll the shorter loop
    // instead of putting its lanes side by side, which takes five times as long.
    let (mut sines, mut cosines) = black_box((sines, cosines));
    if is_exception {
        for lane in 0..N {
            (sines[lane], cosines[lane]) = libm::sincos(angles[lane]);
        }
    }
    (sines, cosines)
}

/// An angle without its nearest multiple of π/2.
struct Remainder {
    /// The rest, −π/4 to π/4.
    rest: f64,
    /// What `rest` leaves out.
    tail: f64,
    /// The multiple, in its lowest bits.
    quarters: u64,
    /// Whether libm reduces this angle in another way.
    is_exception: bool,
}

impl Remainder {
    /// libm's `rem_pio2` in its first round.
    #[inline(always)]
    fn of(angle: f64) -> Self {
        let amount = angle.abs();
        let [none, one, two, three, four] = BORDERS.map(|border| amount < border);
        let few = match () {
            () if none => 0.0,
            () if one => 1.0,
            () if two => 2.0,
            () if three => 3.0,
            () => 4.0,
        };
        let sum = match four {
            true => f64::copysign(few, angle) + TO_WHOLE,
            false => angle * QUARTERS_PER_RAD + TO_WHOLE,
        };
        let count = sum - TO_WHOLE;
        let high = angle - count * QUARTER;
        let low = count * QUARTER_TAIL;
        let rest = high - low;
        let first_bits = amount.to_bits() >> 32;
        let near_few = CANCELLING.map(|bits| first_bits == bits);
        let cancelled = exponent(amount) - exponent(rest) > MOST_CANCELLED;
        let is_exception = match four {
            true => near_few[0] | near_few[1] | near_few[2] | near_few[3],
            false => cancelled | (amount >= LARGEST) | angle.is_nan(),
        };
        Self {
            rest,
            tail: (high - rest) - low,
            quarters: sum.to_bits(),
            is_exception,
        }
    }

    /// libm's `k_sin`, `k_cos` and the choice between them.
    #[inline(always)]
    fn sin_cos(&self, angle: f64) -> (f64, f64) {
        let (x, tail) = (self.rest, self.tail);
        let square = x * x;
        let fourth = square * square;
        let [s1, s2, s3, s4, s5, s6] = SINE;
        let terms = s2 + square * (s3 + square * s4) + square * fourth * (s5 + square * s6);
        let cube = square * x;
        let amount = angle.abs();
        let sine = match () {
            () if amount < TINY => angle,
            () if amount < BORDERS[0] => x + cube * (s1 + square * terms),
            () => x - ((square * (0.5 * tail - cube * terms) - tail) - cube * s1),
        };
        let [c1, c2, c3, c4, c5, c6] = COSINE;
        let terms = square * (c1 + square * (c2 + square * c3))
            + fourth * fourth * (c4 + square * (c5 + square * c6));
        let half = 0.5 * square;
        let most = 1.0 - half;
        let cosine = match amount < TINY {
            true => 1.0,
            false => most + (((1.0 - most) - half) + (square * terms - x * tail)),
        };
        let (sine, cosine) = match self.quarters & 1 == 1 {
            true => (cosine, sine),
            false => (sine, cosine),
        };
        let turned =
            |value: f64, quarters: u64| f64::from_bits(value.to_bits() ^ ((quarters & 2) << 62));
        (
            turned(sine, self.quarters),
            turned(cosine, self.quarters + 1),
        )
    }
}

/// The exponent's bits of a number that is not negative, or of its amount.
#[inline(always)]
fn exponent(value: f64) -> i64 {
    (value.to_bits() >> 52) as i64 & 0x7ff
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::*;
    use crate::registers::each_width;

    /// Random angles of a turn, of many turns and of any bits, and the angles at and beside all
    /// borders.
    fn angles() -> Vec<f64> {
        let mut state = 1_u64;
        let mut next = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            state
        };
        let mut angles: Vec<f64> = Vec::new();
        for k in 0..2_000_000 {
            let part = (next() >> 11) as f64 / (1_u64 << 53) as f64;
            angles.push(match k % 4 {
                0 | 1 => part * std::f64::consts::TAU,
                2 => (part - 0.5) * 1e4,
                _ => f64::from_bits(next()),
            });
        }
        let others = [0, 0x0010_0000, 0x3e46_a09e, 0x4139_21fb, 0x7ff0_0000];
        let borders = BORDERS.map(|border| border.to_bits() >> 32);
        for first in borders.into_iter().chain(CANCELLING).chain(others) {
            for near in first.saturating_sub(1)..=first + 1 {
                for low in [0, 1, next() >> 32, next() >> 32, 0xffff_ffff] {
                    let angle = f64::from_bits(near << 32 | low);
                    angles.extend([angle, -angle]);
                }
            }
        }
        for quarters in -5000..5000 {
            let angle = f64::from(quarters) * std::f64::consts::FRAC_PI_2;
            angles.extend([angle.next_down(), angle, angle.next_up()]);
        }
        angles
    }

    #[test]
    fn every_lane_has_the_bits_of_libm_in_all_registers() {
        let angles = angles();
        let same = |one: f64, other: f64| {
            one.to_bits() == other.to_bits() || (one.is_nan() && other.is_nan())
        };
        let (mut sines, mut cosines) = (vec![0.0; angles.len()], vec![0.0; angles.len()]);
        each_width(|registers| {
            sines.fill(0.0);
            cosines.fill(0.0);
            registers.run(Angles(&angles, &mut sines, &mut cosines));
            for (i, angle) in angles.iter().enumerate() {
                let (sine, cosine) = libm::sincos(*angle);
                let is_same = same(sines[i], sine) && same(cosines[i], cosine);
                assert!(is_same, "{registers:?}: {angle:e}");
            }
        });
    }

    /// Exceptions cost as much as libm: few angles of a turn may be some.
    #[test]
    fn few_angles_of_a_turn_are_exceptions() {
        let turn = (0..1_000_000).map(|k| f64::from(k) * 6.283e-6);
        let exceptions = turn
            .filter(|angle| Remainder::of(*angle).is_exception)
            .count();
        assert!(exceptions < 20, "{exceptions}");
    }
}
