//! How large a program or a part of it may be: `"100 MB"`, `"200000 blocks"`.

use std::fmt;
use std::str::FromStr;

/// The units of bytes: those of controllers and disks, powers of ten.
const UNITS: [(&str, f64); 4] = [("B", 1.0), ("kB", 1e3), ("MB", 1e6), ("GB", 1e9)];
/// The unit of blocks.
const BLOCKS: &str = "blocks";
/// Counts from here on are not exact as doubles.
const MOST: f64 = 9e15;

/// The size of a text.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct TextSize {
    /// Its bytes.
    pub bytes: u64,
    /// Its blocks: lines, comments among them.
    pub blocks: u64,
}

/// The most that a text may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Amount {
    /// So many bytes.
    Bytes(u64),
    /// So many blocks.
    Blocks(u64),
}

/// Why a text is no amount.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0:?} is no amount")]
pub struct AmountError(String);

impl TextSize {
    /// That of a text.
    pub fn of(text: &[u8]) -> Self {
        Self {
            bytes: text.len() as u64,
            blocks: memchr::memchr_iter(b'\n', text).count() as u64,
        }
    }

    /// That of two texts, one behind the other.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            bytes: self.bytes + other.bytes,
            blocks: self.blocks + other.blocks,
        }
    }
}

impl Amount {
    /// Whether a text is no larger.
    pub fn holds(&self, size: TextSize) -> bool {
        match self {
            Self::Bytes(most) => size.bytes <= *most,
            Self::Blocks(most) => size.blocks <= *most,
        }
    }

    /// How many texts of this amount a text makes at least.
    pub fn parts_of(&self, size: TextSize) -> u64 {
        match self {
            Self::Bytes(most) => size.bytes.div_ceil(*most),
            Self::Blocks(most) => size.blocks.div_ceil(*most),
        }
    }

    /// A size in the words of the amount.
    pub fn said(&self, size: TextSize) -> String {
        match self {
            Self::Bytes(_) => bytes(size.bytes),
            Self::Blocks(_) => format!("{} {BLOCKS}", size.blocks),
        }
    }
}

impl FromStr for Amount {
    type Err = AmountError;

    fn from_str(text: &str) -> Result<Self, AmountError> {
        let wrong = || AmountError(text.to_owned());
        let trimmed = text.trim();
        let end = trimmed.find(|c: char| !(c.is_ascii_digit() || c == '.'));
        let (number, unit) = trimmed.split_at(end.ok_or_else(wrong)?);
        let number: f64 = number.parse().map_err(|_| wrong())?;
        let unit = unit.trim();
        let factor = UNITS.iter().find(|(name, _)| *name == unit);
        let factor = factor.map(|(_, factor)| *factor);
        let count = (number * factor.unwrap_or(1.0)).floor();
        if !(1.0..=MOST).contains(&count) {
            return Err(wrong());
        }
        match factor {
            Some(_) => Ok(Self::Bytes(count as u64)),
            None if unit == BLOCKS => Ok(Self::Blocks(count as u64)),
            None => Err(wrong()),
        }
    }
}

impl fmt::Display for Amount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bytes(most) => f.write_str(&bytes(*most)),
            Self::Blocks(most) => write!(f, "{most} {BLOCKS}"),
        }
    }
}

/// Bytes in the largest unit that leaves one or more.
fn bytes(count: u64) -> String {
    let number = count as f64;
    let fits = |unit: &&(&str, f64)| number >= unit.1;
    let (name, factor) = UNITS.iter().rev().find(fits).copied().unwrap_or(UNITS[0]);
    format!("{} {name}", (1e3 * number / factor).round() / 1e3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn amounts_are_bytes_or_blocks() {
        for (text, amount) in [
            ("100 MB", Amount::Bytes(100_000_000)),
            ("1.5kB", Amount::Bytes(1500)),
            ("7 B", Amount::Bytes(7)),
            ("2 GB", Amount::Bytes(2_000_000_000)),
            ("200000 blocks", Amount::Blocks(200_000)),
        ] {
            assert_eq!(text.parse(), Ok(amount), "{text}");
            assert_eq!(amount.to_string().parse(), Ok(amount), "{amount}");
        }
        for text in [
            "",
            "100",
            "MB",
            "0 MB",
            "-1 MB",
            "0.5 blocks",
            "1 mb",
            "1e3 MB",
            "1e20 GB",
        ] {
            assert!(text.parse::<Amount>().is_err(), "{text}");
        }
    }

    #[test]
    fn a_text_is_held_up_to_the_amount() {
        let size = TextSize::of(b"G90\nG1 X1\n");
        assert_eq!((size.bytes, size.blocks), (10, 2));
        assert!(Amount::Bytes(10).holds(size) && !Amount::Bytes(9).holds(size));
        assert!(Amount::Blocks(2).holds(size) && !Amount::Blocks(1).holds(size));
        assert_eq!(Amount::Bytes(4).parts_of(size), 3);
    }
}
