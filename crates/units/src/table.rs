//! The table of units, the scale of each unit to inner units, and suggestions for misspelt units.

use std::f64::consts::TAU;

use crate::decimal::Decimal;
use crate::{DEG, Quantity};

/// The acceleration of free fall, by definition, mm/s².
const STANDARD_GRAVITY: f64 = 9806.65;

/// How a number in a unit becomes one in inner units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Scale {
    /// The decimal point moves this many places to the right.
    Shift(i64),
    /// Inches: times 25.4, exactly.
    Inches,
    /// Per inch: over 25.4.
    PerInch,
    /// Times `over`, divided by `under`: irrational factors.
    Factor(f64, f64),
}

impl Scale {
    pub(crate) fn apply(self, number: &Decimal) -> f64 {
        match self {
            Self::Shift(places) => number.shifted(places).to_f64(),
            Self::Inches => number.times(254).shifted(-1).to_f64(),
            Self::PerInch => number.shifted(1).to_f64() / 254.0,
            Self::Factor(over, under) => number.to_f64() * over / under,
        }
    }

    /// A value in inner units as a number in this unit; none if it is not finite.
    pub(crate) fn undo(self, value: f64) -> Option<Decimal> {
        match self {
            Self::Shift(places) => Some(Decimal::rounded(value)?.shifted(-places)),
            Self::Inches => Decimal::rounded(value / 25.4),
            Self::PerInch => Decimal::rounded(value * 25.4),
            Self::Factor(over, under) => Decimal::rounded(value * under / over),
        }
    }
}

/// One unit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Unit {
    pub(crate) symbol: &'static str,
    pub(crate) quantity: Quantity,
    pub(crate) scale: Scale,
}

const fn unit(quantity: Quantity, symbol: &'static str, scale: Scale) -> Unit {
    Unit {
        symbol,
        quantity,
        scale,
    }
}

/// All units, the usual one of each kind first.
pub(crate) const UNITS: &[Unit] = {
    use Quantity::{
        Acceleration, Angle, AngularAcceleration, AngularJerk, Feed, Frequency, Jerk, Length,
        PerLength, RotationSpeed, Time, Velocity,
    };
    use Scale::{Factor, Inches, PerInch, Shift};
    &[
        unit(Length, "mm", Shift(0)),
        unit(Length, "um", Shift(-3)),
        unit(Length, "nm", Shift(-6)),
        unit(Length, "cm", Shift(1)),
        unit(Length, "m", Shift(3)),
        unit(Length, "in", Inches),
        unit(Angle, "deg", Factor(DEG, 1.0)),
        unit(Angle, "rad", Shift(0)),
        unit(Angle, "mrad", Shift(-3)),
        unit(Angle, "arcmin", Factor(DEG, 60.0)),
        unit(Angle, "arcsec", Factor(DEG, 3600.0)),
        unit(PerLength, "/mm", Shift(0)),
        unit(PerLength, "/m", Shift(-3)),
        unit(PerLength, "/cm", Shift(-1)),
        unit(PerLength, "/um", Shift(3)),
        unit(PerLength, "/in", PerInch),
        unit(Feed, "um/rev", Shift(-3)),
        unit(Feed, "mm/rev", Shift(0)),
        unit(Feed, "nm/rev", Shift(-6)),
        unit(Feed, "cm/rev", Shift(1)),
        unit(Feed, "m/rev", Shift(3)),
        unit(Feed, "in/rev", Inches),
        unit(RotationSpeed, "rpm", Factor(TAU, 60.0)),
        unit(RotationSpeed, "rev/s", Factor(TAU, 1.0)),
        unit(RotationSpeed, "rad/s", Shift(0)),
        unit(RotationSpeed, "Hz", Factor(TAU, 1.0)),
        unit(Frequency, "Hz", Factor(TAU, 1.0)),
        unit(Frequency, "kHz", Factor(1e3 * TAU, 1.0)),
        unit(Time, "s", Shift(0)),
        unit(Time, "ms", Shift(-3)),
        unit(Time, "us", Shift(-6)),
        unit(Time, "min", Factor(60.0, 1.0)),
        unit(Time, "h", Factor(3600.0, 1.0)),
        unit(Velocity, "mm/s", Shift(0)),
        unit(Velocity, "um/s", Shift(-3)),
        unit(Velocity, "m/s", Shift(3)),
        unit(Velocity, "mm/min", Factor(1.0, 60.0)),
        unit(Velocity, "m/min", Factor(1000.0, 60.0)),
        unit(Acceleration, "mm/s^2", Shift(0)),
        unit(Acceleration, "m/s^2", Shift(3)),
        unit(Acceleration, "um/s^2", Shift(-3)),
        unit(Acceleration, "g", Factor(STANDARD_GRAVITY, 1.0)),
        unit(Jerk, "mm/s^3", Shift(0)),
        unit(Jerk, "m/s^3", Shift(3)),
        unit(AngularAcceleration, "rad/s^2", Shift(0)),
        unit(AngularAcceleration, "deg/s^2", Factor(DEG, 1.0)),
        unit(AngularAcceleration, "rpm/s", Factor(TAU, 60.0)),
        unit(AngularJerk, "rad/s^3", Shift(0)),
        unit(AngularJerk, "deg/s^3", Factor(DEG, 1.0)),
    ]
};

/// A unit in the spelling of the table: no spaces, `u` for µ, `^2` for ², `/mm` for `1/mm` and
/// `mm^-1`.
pub(crate) fn tidy_unit(written: &str) -> String {
    let mut plain = String::new();
    for c in written.chars().filter(|c| !c.is_whitespace()) {
        match c {
            'µ' | 'μ' => plain.push('u'),
            '²' => plain.push_str("^2"),
            '³' => plain.push_str("^3"),
            other => plain.push(other),
        }
    }
    if let Some(rest) = plain.strip_prefix("1/") {
        return format!("/{rest}");
    }
    match plain
        .strip_suffix("^-1")
        .or_else(|| plain.strip_suffix("⁻¹"))
    {
        Some(base) => format!("/{base}"),
        None => plain,
    }
}

/// Whether a unit of one quantity can stand for another one: a length can stand for a feed, and a
/// speed of rotation for a frequency.
pub(crate) fn stands_for(of: Quantity, wanted: Quantity) -> bool {
    let too = match wanted {
        Quantity::Feed => of == Quantity::Length,
        Quantity::Frequency => of == Quantity::RotationSpeed,
        _ => false,
    };
    of == wanted || too
}

/// The unit of this symbol, if it can stand for the quantity.
pub(crate) fn find_unit(symbol: &str, quantity: Quantity) -> Option<&'static Unit> {
    UNITS
        .iter()
        .find(|unit| unit.symbol == symbol && stands_for(unit.quantity, quantity))
}

/// Texts that resemble numbers and units.
pub(crate) mod unit_like {
    use super::{Quantity, UNITS};

    /// Long names and signs, in lower case and singular, with the unit that they mean.
    const NAMES: &[(&str, &str)] = &[
        ("millimetre", "mm"),
        ("millimeter", "mm"),
        ("micrometre", "um"),
        ("micrometer", "um"),
        ("micron", "um"),
        ("nanometre", "nm"),
        ("nanometer", "nm"),
        ("centimetre", "cm"),
        ("centimeter", "cm"),
        ("metre", "m"),
        ("meter", "m"),
        ("inch", "in"),
        ("inche", "in"),
        ("\"", "in"),
        ("degree", "deg"),
        ("°", "deg"),
        ("radian", "rad"),
        ("milliradian", "mrad"),
        ("'", "arcmin"),
        ("permm", "/mm"),
        ("mm-1", "/mm"),
        ("rev/min", "rpm"),
        ("r/min", "rpm"),
        ("1/min", "rpm"),
        ("/min", "rpm"),
        ("rp", "rpm"),
        ("rps", "rev/s"),
        ("um/r", "um/rev"),
        ("mm/r", "mm/rev"),
        ("mmpr", "mm/rev"),
    ];

    /// Whether the text begins with an infinity or a NaN.
    pub(crate) fn is_not_finite(text: &str) -> bool {
        let unsigned = text.trim_start_matches(['+', '-']);
        let end = unsigned
            .find(|c: char| !c.is_alphabetic())
            .unwrap_or(unsigned.len());
        let word = unsigned[..end].to_lowercase();
        matches!(word.as_str(), "inf" | "infinity" | "nan")
    }

    /// Whether what follows the number is more of a number: `1.2.3 mm`, `5,5 mm`, `1 000 mm`.
    pub(crate) fn continues_a_number(rest: &str) -> bool {
        let digits_first = rest.starts_with(|c: char| c.is_ascii_digit() || ".,_+-".contains(c));
        digits_first && !rest.starts_with("1/") && !rest.starts_with("1 /")
    }

    /// The unit of the quantity that may be meant by an unknown one.
    pub(crate) fn closest(written: &str, quantity: Quantity) -> Option<&'static str> {
        let lower = written.to_lowercase();
        let singular = lower.strip_suffix('s').unwrap_or(&lower);
        let named = NAMES
            .iter()
            .find(|(name, _)| *name == lower || *name == singular);
        let of_kind = |symbol: &&str| super::find_unit(symbol, quantity).is_some();
        if let Some(symbol) = named.map(|(_, symbol)| *symbol).filter(of_kind) {
            return Some(symbol);
        }
        let symbols = || UNITS.iter().map(|unit| unit.symbol).filter(of_kind);
        symbols()
            .find(|symbol| symbol.to_lowercase() == lower)
            .or_else(|| symbols().find(|symbol| strsim::osa_distance(symbol, &lower) == 1))
    }
}
