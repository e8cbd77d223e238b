//! The words of one line of a motion program, as far as a PVT path needs them.
//!
//! This follows the manual's description of motion programs and shares nothing with the writer.
//! Letters may be lower-case or capital. Spaces are allowed everywhere except within numbers and words.

use memchr::memchr2_iter;

use crate::fixed_point::LeadingDecimal;

/// The axes of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Axis {
    C,
    X,
    Z,
}

impl Axis {
    /// The axis of this letter, small or capital.
    pub(super) fn named(letter: &str) -> Option<Self> {
        match letter {
            "C" | "c" => Some(Self::C),
            "X" | "x" => Some(Self::X),
            "Z" | "z" => Some(Self::Z),
            _ => None,
        }
    }

    /// What messages call its position and its velocity.
    fn numbers(self) -> (&'static str, &'static str) {
        match self {
            Self::C => ("C", "the velocity of C"),
            Self::X => ("X", "the velocity of X"),
            Self::Z => ("Z", "the velocity of Z"),
        }
    }
}

/// A statement of a line. Numbers are in 10⁻¹² of the program's unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Word {
    /// `ABS` or `INC`, and the axes that it applies to, by their index.
    Absolute(bool, [bool; 3]),
    /// `PVT3`: the duration of the segments, ms.
    Time(i128),
    /// `X1.5:0.2`; without a velocity the axis ends at rest.
    Move(Axis, i128, Option<i128>),
}

/// The code of a line, before any comment, and the comment, if there is one.
pub(super) fn split_comment(line: &[u8]) -> (&[u8], Option<&[u8]>) {
    for at in memchr2_iter(b';', b'/', line) {
        let (code, rest) = line.split_at(at);
        let behind = rest.strip_prefix(b";").or(rest.strip_prefix(b"//"));
        if behind.is_some() {
            return (code, behind);
        }
    }
    (line, None)
}

/// A line, and how far it is read. Only whole characters are read.
pub(super) struct Scanner<'a> {
    code: &'a str,
    at: usize,
}

impl<'a> Scanner<'a> {
    pub(super) fn new(code: &'a str) -> Self {
        Self { code, at: 0 }
    }

    /// What is left, from the next word on; `None` at the end.
    pub(super) fn rest_unless_empty(&mut self) -> Option<&'a str> {
        self.pass_spaces();
        Some(self.rest()).filter(|rest| !rest.is_empty())
    }

    fn rest(&self) -> &'a str {
        self.code.get(self.at..).unwrap_or_default()
    }

    /// The next byte.
    fn next_byte(&self) -> Option<u8> {
        self.code.as_bytes().get(self.at).copied()
    }

    /// Takes this byte, which is one of ASCII, if it is the next.
    fn take(&mut self, byte: u8) -> bool {
        let is_next = self.next_byte() == Some(byte);
        self.at += usize::from(is_next);
        is_next
    }

    /// Passes spaces, of which there is one or none at most places.
    fn pass_spaces(&mut self) {
        self.take(b' ');
        if !matches!(self.next_byte(), Some(b'!'..=b'~') | None) {
            self.at = self.code.len() - self.rest().trim_start().len();
        }
    }

    /// The letters that come next; empty if there are none.
    pub(super) fn letters(&mut self) -> &'a str {
        let begin = self.at;
        while self
            .next_byte()
            .is_some_and(|byte| byte.is_ascii_alphabetic())
        {
            self.at += 1;
        }
        self.code.get(begin..self.at).unwrap_or_default()
    }

    /// The next word; `None` at the end. Labels of lines, `N10`, are none.
    #[inline]
    pub(super) fn next_word(&mut self) -> Result<Option<Word>, String> {
        while let Some(start) = self.rest_unless_empty() {
            let letters = self.letters();
            let is = |word: &str| letters.eq_ignore_ascii_case(word);
            if let Some(axis) = Axis::named(letters) {
                return self.axis(axis).map(Some);
            } else if is("PVT") {
                return Ok(Some(Word::Time(self.number("PVT")?)));
            } else if is("TM") {
                return Ok(Some(Word::Time(self.number("TM")?)));
            } else if is("ABS") || is("INC") {
                return Ok(Some(Word::Absolute(is("ABS"), self.axes()?)));
            } else if !is("N") {
                return Err(no_word(start));
            }
            self.number("N")?;
        }
        Ok(None)
    }

    fn axis(&mut self, axis: Axis) -> Result<Word, String> {
        let (position, velocity) = axis.numbers();
        let position = self.number(position)?;
        let velocity = match self.take(b':') {
            true => Some(self.number(velocity)?),
            false => None,
        };
        Ok(Word::Move(axis, position, velocity))
    }

    /// The axes in parentheses; all axes if there are no parentheses.
    pub(super) fn axes(&mut self) -> Result<[bool; 3], String> {
        self.pass_spaces();
        let Some(inside) = self.rest().strip_prefix('(') else {
            return Ok([true; 3]);
        };
        let (list, rest) = inside
            .split_once(')')
            .ok_or("a parenthesis is not closed")?;
        let mut axes = [false; 3];
        for letter in list.split(',') {
            match Axis::named(letter.trim()) {
                Some(axis) => axes[axis as usize] = true,
                None => {
                    let other = letter.trim().to_uppercase();
                    return Err(format!("`{other}` is not an axis of the path"));
                }
            }
        }
        self.at = self.code.len() - rest.len();
        self.pass_spaces();
        Ok(axes)
    }

    /// Reads a constant, `-12.5`, and the spaces around it.
    #[inline]
    pub(super) fn number(&mut self, name: &str) -> Result<i128, String> {
        self.pass_spaces();
        let negative = self.take(b'-');
        if !negative {
            self.take(b'+');
        }
        let rest = self.code.as_bytes().get(self.at..).unwrap_or_default();
        let Some(decimal) = LeadingDecimal::of(rest) else {
            return Err(format!("{name} has no number"));
        };
        self.at += decimal.length;
        self.pass_spaces();
        let size = decimal.size(rest);
        let size = size.ok_or_else(|| format!("{name} has too many digits"))?;
        Ok(if negative { -size } else { size })
    }
}

fn no_word(start: &str) -> String {
    let until_space = start.chars().take_while(|c| !c.is_whitespace());
    let word: String = until_space.take(40).collect();
    format!("`{word}` is not a word of a PVT path")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixed_point::ONE;

    fn words(code: &str) -> Result<Vec<Word>, String> {
        let mut scanner = Scanner::new(code);
        std::iter::from_fn(|| scanner.next_word().transpose()).collect()
    }

    #[test]
    fn spaces_case_and_order_do_not_matter() {
        let tight = words("PVT3X1.5:-.5Z-2").unwrap();
        assert_eq!(
            tight,
            [
                Word::Time(3 * ONE),
                Word::Move(Axis::X, 3 * ONE / 2, Some(-ONE / 2)),
                Word::Move(Axis::Z, -2 * ONE, None),
            ]
        );
        assert_eq!(words(" n10 pvt 3 x +1.50 : -0.5  z -2.\t").unwrap(), tight);
        assert_eq!(words("").unwrap(), []);
    }

    #[test]
    fn modes_may_be_for_some_axes() {
        assert_eq!(words("ABS").unwrap(), [Word::Absolute(true, [true; 3])]);
        assert_eq!(
            words("inc (C, x)").unwrap(),
            [Word::Absolute(false, [true, true, false])]
        );
    }

    #[test]
    fn numbers_are_exact_to_twelve_places() {
        assert_eq!(
            words("TM0.0002441406254").unwrap(),
            [Word::Time(244_140_625)]
        );
        assert_eq!(words("TM0.0000000000005").unwrap(), [Word::Time(1)]);
    }

    #[test]
    fn the_error_names_what_is_not_a_word() {
        for (line, says) in [
            ("X1:2 Y3:4", "`Y3:4` is not a word"),
            ("XNaN:2", "`XNaN:2` is not a word"),
            ("X1e5:2", "`e5:2` is not a word"),
            ("X:2", "X has no number"),
            ("X1:", "the velocity of X has no number"),
            ("PVT", "PVT has no number"),
            ("X1:2:3", "`:3` is not a word"),
            ("X(P1):2", "X has no number"),
            ("INC(Y)", "`Y` is not an axis"),
            ("INC(X", "parenthesis"),
            ("X1234567890123456:1", "X has too many digits"),
        ] {
            let message = words(line).unwrap_err();
            assert!(message.contains(says), "{line}: {message}");
        }
    }

    #[test]
    fn comments_begin_at_a_semicolon_or_two_slashes() {
        assert_eq!(split_comment(b"X1;a//b"), (&b"X1"[..], Some(&b"a//b"[..])));
        assert_eq!(split_comment(b"X1//a;b"), (&b"X1"[..], Some(&b"a;b"[..])));
        assert_eq!(split_comment(b"X1"), (&b"X1"[..], None));
    }
}
