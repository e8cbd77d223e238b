//! The range of an axis, its ticks, and the power of ten that its title has.

use std::f64::consts::LN_10;

use turnpath_core::Scalar;

/// Sizes from which, and below which, a power of ten goes into the title.
const PLAIN: std::ops::Range<f64> = 1e-2..1e4;
/// Steps between ticks, in a decade.
const STEPS: [f64; 3] = [1.0, 2.0, 5.0];
/// So many steps have two ticks in any range: their distance is half of it at the most.
const ENOUGH: usize = 5;
/// How far beyond its end a tick may lie by rounding, in steps.
const ROUNDING: f64 = 1e-9;
/// The narrowest axis, as a share of its values: numbers that told more apart would be too long.
const NARROWEST: f64 = 1e-6;

/// What an axis shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    pub from: f64,
    pub to: f64,
    pub spacing: Spacing,
}

/// How values lie along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spacing {
    Even,
    Logarithmic,
}

/// A tick of an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Tick {
    pub value: f64,
    /// Its number; empty for a tick between numbers.
    pub text: String,
}

impl Range {
    /// An even axis that has some room: never empty.
    pub fn even(from: f64, to: f64) -> Self {
        let narrowest = NARROWEST * from.abs().max(to.abs());
        let room = narrowest.max(0.5);
        let (from, to) = match from.is_finite() && to.is_finite() && to - from > narrowest {
            true => (from, to),
            false if from.is_finite() => (from - room, from + room),
            false => (0.0, 1.0),
        };
        Self {
            from,
            to,
            spacing: Spacing::Even,
        }
    }

    /// From 0 to a little above the largest value, and from a little below the smallest one where it is
    /// negative. What is no number does not count.
    pub fn with_zero(values: impl IntoIterator<Item = f64>) -> Self {
        /// The room beyond the values.
        const ROOM: f64 = 1.08;
        /// Below a millionth of any unit there is rounding alone.
        const LEAST: f64 = 1e-6;
        let known = values.into_iter().filter(|value| value.is_finite());
        let (least, most) = known.fold((0.0, 0.0), |(least, most): (f64, f64), value| {
            (least.min(value), most.max(value))
        });
        match most.max(-least) > LEAST {
            true => Self::even(ROOM * least, ROOM * most),
            false => Self::even(0.0, 1.0),
        }
    }

    /// A logarithmic axis between two positive values.
    pub fn logarithmic(from: f64, to: f64) -> Self {
        Self {
            spacing: Spacing::Logarithmic,
            ..Self::even(from, to)
        }
    }

    /// Where a value lies, from 0 to 1.
    pub fn share(self, value: f64) -> f64 {
        let of = |value: f64| match self.spacing {
            Spacing::Even => value,
            Spacing::Logarithmic => Scalar::ln(value),
        };
        (of(value) - of(self.from)) / (of(self.to) - of(self.from))
    }

    /// The power of ten by which the numbers of the ticks are divided.
    pub fn power(self) -> i32 {
        let size = self.from.abs().max(self.to.abs());
        match self.spacing == Spacing::Logarithmic || PLAIN.contains(&size) {
            true => 0,
            false => decade(size),
        }
    }

    /// Ticks, about so many numbers at the most, and two at least.
    pub fn ticks(self, most: usize) -> Vec<Tick> {
        match self.spacing {
            Spacing::Even => (most.max(2)..=ENOUGH.max(most))
                .map(|most| self.even_ticks(most))
                .find(|ticks| ticks.len() > 1)
                .unwrap_or_default(),
            Spacing::Logarithmic => self.decades(),
        }
    }

    fn even_ticks(self, most: usize) -> Vec<Tick> {
        let (step, decimals) = self.step(most);
        let unit = ten_to(self.power());
        let [first, last] = [
            (self.from / step - ROUNDING).ceil(),
            (self.to / step + ROUNDING).floor(),
        ];
        let tick = |count: usize| {
            let value = (first + count as f64) * step;
            // The sum gives 0 its plus.
            let text = format!("{:.decimals$}", value / unit + 0.0);
            Tick {
                value,
                text: text.replace('-', "−"),
            }
        };
        (0..=(last - first).max(0.0) as usize).map(tick).collect()
    }

    /// The distance of ticks, and the digits after the point that their numbers have.
    fn step(self, most: usize) -> (f64, usize) {
        let least = (self.to - self.from) / most as f64;
        let power = decade(least);
        let decades = [power, power + 1].into_iter();
        let mut steps = decades.flat_map(|power| STEPS.map(|step| (step * ten_to(power), power)));
        let (step, power) = steps
            .find(|(step, _)| *step >= least)
            .unwrap_or((least, power));
        let decimals = usize::try_from(self.power() - power).unwrap_or(0);
        (step, decimals)
    }

    /// A tick at each whole number of each decade, with numbers at the decades.
    fn decades(self) -> Vec<Tick> {
        let powers = decade(self.from)..=decade(self.to);
        let all = powers.flat_map(|power| (1..10_u32).map(move |count| (power, count)));
        let tick = |(power, count): (i32, u32)| Tick {
            value: f64::from(count) * ten_to(power),
            text: match count {
                1 => format!("{}", ten_to(power)),
                _ => String::new(),
            },
        };
        let ticks = all.map(tick);
        ticks
            .filter(|tick| (self.from..=self.to).contains(&tick.value))
            .collect()
    }
}

/// A number with four digits.
pub fn four_digits(value: f64) -> String {
    let decimals = usize::try_from(3 - decade(value.abs().max(1e-3))).unwrap_or(0);
    format!("{value:.decimals$}")
}

/// The power of ten below a size.
fn decade(size: f64) -> i32 {
    let power = (Scalar::ln(size) / LN_10).floor() as i32;
    // The logarithm of a power of ten may lie a rounding off.
    match ten_to(power + 1) <= size {
        true => power + 1,
        false => power,
    }
}

fn ten_to(power: i32) -> f64 {
    Scalar::powi(10.0, power)
}

/// A title with the power of ten that its numbers are divided by: `jerk / 10⁴ mm/s³`.
pub fn title(quantity: &str, unit: &str, power: i32) -> String {
    let unit = match (power, unit) {
        (0, unit) => unit.to_owned(),
        (power, "") => format!("10{}", raised(power)),
        (power, unit) => format!("10{} {unit}", raised(power)),
    };
    match unit.as_str() {
        "" => quantity.to_owned(),
        unit => format!("{quantity} / {unit}"),
    }
}

fn raised(power: i32) -> String {
    let digit = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        c => c
            .to_digit(10)
            .and_then(|digit| char::from_u32(0x2070 + digit))
            .unwrap_or(c),
    };
    power.to_string().chars().map(digit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(range: Range, most: usize) -> Vec<String> {
        range
            .ticks(most)
            .into_iter()
            .map(|tick| tick.text)
            .collect()
    }

    #[test]
    fn ticks_are_round_and_lie_within_the_range() {
        assert_eq!(
            texts(Range::even(-25.0, 25.0), 5),
            ["−20", "−10", "0", "10", "20"]
        );
        assert_eq!(
            texts(Range::even(0.0, 0.3), 4),
            ["0.0", "0.1", "0.2", "0.3"]
        );
        assert_eq!(texts(Range::even(0.95, 1.0), 3), ["0.96", "0.98", "1.00"]);
        let wide = Range::even(-3.7e7, 9.9e8);
        for most in 2..20 {
            let ticks = wide.ticks(most);
            assert!((2..=most.max(3) + 1).contains(&ticks.len()), "{most}");
            assert!(
                ticks
                    .iter()
                    .all(|tick| (0.0..=1.0).contains(&wide.share(tick.value)))
            );
        }
    }

    #[test]
    fn long_numbers_leave_their_power_of_ten_to_the_title() {
        let range = Range::with_zero([250_000.0]);
        assert_eq!(range.power(), 5);
        assert_eq!(texts(range, 3), ["0", "1", "2"]);
        assert_eq!(title("jerk", "mm/s³", 5), "jerk / 10⁵ mm/s³");
        let small = Range::with_zero([4e-6]);
        assert_eq!(title("points", "", small.power()), "points / 10⁻⁶");
        assert_eq!(texts(small, 3), ["0", "2", "4"]);
        // What is rounding alone is drawn as nothing.
        assert_eq!(Range::with_zero([3e-8]), Range::even(0.0, 1.0));
    }

    #[test]
    fn a_logarithmic_axis_has_numbers_at_its_decades() {
        let range = Range::logarithmic(1.0, 512.0);
        let ticks = range.ticks(9);
        assert_eq!(ticks.len(), 9 + 9 + 5);
        let numbers: Vec<&str> = ticks.iter().map(|tick| tick.text.as_str()).collect();
        let numbers: Vec<&str> = numbers
            .into_iter()
            .filter(|text| !text.is_empty())
            .collect();
        assert_eq!(numbers, ["1", "10", "100"]);
        assert!((range.share(32.0) - 5.0 / 9.0).abs() < 1e-12);
    }

    #[test]
    fn a_number_has_four_digits() {
        let texts = [67.18943, 1234.56, 0.0471234].map(four_digits);
        assert_eq!(texts, ["67.19", "1235", "0.04712"]);
    }

    #[test]
    fn an_axis_from_zero_covers_negative_values_too() {
        let range = Range::with_zero([3.0, f64::NAN, -1.0, f64::INFINITY]);
        assert_eq!((range.from, range.to), (-1.08, 3.24));
        let range = Range::with_zero([-1.0, -2.0]);
        assert_eq!((range.from, range.to), (-2.16, 0.0));
    }

    #[test]
    fn a_range_is_no_narrower_than_its_numbers_can_tell() {
        for (from, to) in [(2e16, 2e16), (7.0, 7.0 + 1e-12), (-3e9, -3e9 + 1.0)] {
            let range = Range::even(from, to);
            assert!(range.from <= from && range.to >= to, "{range:?}");
            let numbers = texts(range, 3);
            assert!(numbers.len() > 1 && numbers.iter().all(|text| text.chars().count() < 10));
        }
    }

    #[test]
    fn no_data_make_no_empty_range() {
        for range in [
            Range::even(f64::NAN, f64::NAN),
            Range::even(2.0, 2.0),
            Range::with_zero([0.0]),
            Range::even(f64::INFINITY, f64::NEG_INFINITY),
        ] {
            assert!(range.from < range.to, "{range:?}");
            assert!(range.ticks(5).len() >= 2);
        }
    }
}
