//! The words of one line of a motion program, as far as a PVT path needs them.
//!
//! This follows the manual's description of motion programs and shares nothing with the writer.
//! Letters may be lower-case or capital. Spaces are allowed everywhere except within numbers and words.

use crate::fixed_point::fixed;

/// The axes of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Axis {
    C,
    X,
    Z,
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
    let slashes = line.windows(2).position(|pair| pair == b"//");
    let semicolon = line.iter().position(|byte| *byte == b';');
    match (slashes, semicolon) {
        (_, Some(at)) if slashes.is_none_or(|slashes| at < slashes) => {
            (&line[..at], Some(&line[at + 1..]))
        }
        (Some(at), _) => (&line[..at], Some(&line[at + 2..])),
        _ => (line, None),
    }
}

/// The words of a line's code.
pub(super) fn words(code: &str) -> Result<Vec<Word>, String> {
    let mut scanner = Scanner::new(code);
    let mut words = Vec::new();
    while !scanner.rest.is_empty() {
        words.extend(scanner.word()?);
    }
    Ok(words)
}

/// What is still to be read of a line.
pub(super) struct Scanner<'a> {
    rest: &'a str,
}

impl<'a> Scanner<'a> {
    pub(super) fn new(code: &'a str) -> Self {
        let rest = code.trim_start();
        Self { rest }
    }

    /// What is left, from the next word on; `None` at the end.
    pub(super) fn rest_unless_empty(&mut self) -> Option<&'a str> {
        self.rest = self.rest.trim_start();
        Some(self.rest).filter(|rest| !rest.is_empty())
    }

    /// The letters that come next, as capitals; empty if there are none.
    pub(super) fn letters(&mut self) -> String {
        self.take_while(|c| c.is_ascii_alphabetic()).to_uppercase()
    }

    /// The next word; `None` for a line's label, `N10`.
    fn word(&mut self) -> Result<Option<Word>, String> {
        let start = self.rest;
        let letters = self.letters();
        match letters.as_str() {
            "ABS" => Ok(Some(Word::Absolute(true, self.axes()?))),
            "INC" => Ok(Some(Word::Absolute(false, self.axes()?))),
            "PVT" | "TM" => Ok(Some(Word::Time(self.number(&letters)?))),
            "C" => self.axis(Axis::C, &letters),
            "X" => self.axis(Axis::X, &letters),
            "Z" => self.axis(Axis::Z, &letters),
            "N" => self.number(&letters).map(|_| None),
            _ => {
                let word: String = start
                    .chars()
                    .take_while(|c| !c.is_whitespace())
                    .take(40)
                    .collect();
                Err(format!("`{word}` is not a word of a PVT path"))
            }
        }
    }

    fn axis(&mut self, axis: Axis, letter: &str) -> Result<Option<Word>, String> {
        let position = self.number(letter)?;
        let velocity = match self.rest.strip_prefix(':') {
            Some(rest) => {
                self.rest = rest.trim_start();
                Some(self.number(&format!("the velocity of {letter}"))?)
            }
            None => None,
        };
        Ok(Some(Word::Move(axis, position, velocity)))
    }

    /// The axes in parentheses; all axes if there are no parentheses.
    pub(super) fn axes(&mut self) -> Result<[bool; 3], String> {
        self.rest = self.rest.trim_start();
        let Some(inside) = self.rest.strip_prefix('(') else {
            return Ok([true; 3]);
        };
        let (list, rest) = inside
            .split_once(')')
            .ok_or("a parenthesis is not closed")?;
        let mut axes = [false; 3];
        for letter in list.split(',') {
            match letter.trim().to_uppercase().as_str() {
                "C" => axes[0] = true,
                "X" => axes[1] = true,
                "Z" => axes[2] = true,
                other => return Err(format!("`{other}` is not an axis of the path")),
            }
        }
        self.rest = rest.trim_start();
        Ok(axes)
    }

    /// Reads a constant, `-12.5`, and the spaces around it.
    pub(super) fn number(&mut self, name: &str) -> Result<i128, String> {
        self.rest = self.rest.trim_start();
        let negative = self.rest.starts_with('-');
        self.rest = self.rest.strip_prefix(['-', '+']).unwrap_or(self.rest);
        let whole = self.take_digits();
        let fraction = match self.rest.strip_prefix('.') {
            Some(rest) => {
                self.rest = rest;
                self.take_digits()
            }
            None => "",
        };
        if whole.is_empty() && fraction.is_empty() {
            return Err(format!("{name} has no number"));
        }
        self.rest = self.rest.trim_start();
        let size = fixed(whole, fraction).ok_or_else(|| format!("{name} has too many digits"))?;
        Ok(if negative { -size } else { size })
    }

    fn take_digits(&mut self) -> &'a str {
        self.take_while(|c| c.is_ascii_digit())
    }

    fn take_while(&mut self, matches: impl Fn(char) -> bool) -> &'a str {
        let end = self.rest.find(|c| !matches(c)).unwrap_or(self.rest.len());
        let (start, rest) = self.rest.split_at(end);
        self.rest = rest;
        start
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixed_point::ONE;

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
