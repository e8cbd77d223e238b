//! The words of a block, as a reader finds them. This shares nothing with the writer.

use crate::axes::NAMES;
use crate::fixed_point::{ONE, number};
use crate::g_code::Groups;
use crate::post::behind_number;

/// Coefficients of a cubic.
const COEFFICIENTS: usize = 4;

/// A0 to A3 of a polynomial, in 10⁻¹² mm or deg.
pub(super) type Polynomial = [i128; COEFFICIENTS];

/// What one block says.
#[derive(Debug, Default)]
pub(super) struct Block {
    /// The numbers of its words with G.
    pub(super) modes: Vec<u32>,
    /// Their groups.
    groups: Groups,
    /// The place of the axis of time, in 10⁻¹² mm.
    pub(super) time: Option<i128>,
    /// Places of C, X and Z.
    pub(super) places: [Option<i128>; 3],
    /// Their polynomials.
    pub(super) polynomials: [Option<Polynomial>; 3],
    /// F, in 10⁻¹².
    pub(super) feed: Option<i128>,
}

impl Block {
    /// Reads the words of a block; `time_axis` is the name of the axis of time.
    pub(super) fn read(code: &str, time_axis: char) -> Result<Self, String> {
        let mut block = Self::default();
        // The language has capital letters and others alike.
        let code = without_comments(&code.to_ascii_uppercase())?;
        for word in words(&code) {
            block.take(word, time_axis)?;
        }
        Ok(block)
    }

    /// Whether it moves C, X or Z by their places.
    pub(super) fn has_places(&self) -> bool {
        self.places.iter().any(Option::is_some)
    }

    /// Whether it moves one of them by a polynomial.
    pub(super) fn has_polynomials(&self) -> bool {
        self.polynomials.iter().any(Option::is_some)
    }

    fn take(&mut self, word: &str, time_axis: char) -> Result<(), String> {
        let mut letters = word.chars();
        let letter = letters.next().unwrap_or_default();
        let rest = letters.as_str();
        let axis = NAMES.iter().position(|name| name.starts_with(letter));
        let inside = rest.strip_prefix('[');
        let before = match (letter, axis, inside) {
            (_, Some(k), Some(inside)) => {
                let inside = inside.strip_suffix(']').ok_or_else(|| not_a_word(word))?;
                let polynomial = polynomial(NAMES[k], inside)?;
                self.polynomials[k].replace(polynomial).is_some()
            }
            (_, Some(k), None) => self.places[k].replace(number(NAMES[k], rest)?).is_some(),
            ('F', ..) => self.feed.replace(number("F", rest)?).is_some(),
            // The number of a block does nothing.
            ('N', ..) if is_whole(rest) => false,
            ('G', ..) if is_whole(rest) => {
                let mode = rest.parse().map_err(|_| not_a_word(word))?;
                self.groups.take(mode)?;
                self.modes.push(mode);
                false
            }
            (letter, _, None) if letter == time_axis => {
                let place = number(&letter.to_string(), rest)?;
                self.time.replace(place).is_some()
            }
            _ => return Err(not_a_word(word)),
        };
        match before {
            true => Err(format!("{letter} appears twice on this line")),
            false => Ok(()),
        }
    }
}

/// The axes to which F refers, if a line says them: none for the controller's own setting.
pub(super) fn feed_axes(code: &str) -> Option<String> {
    let code: String = code.split_whitespace().collect();
    let code = code.to_ascii_uppercase();
    let axes = behind_number(&code).strip_prefix("#FGROUP")?;
    match axes
        .strip_prefix('[')
        .and_then(|rest| rest.strip_suffix(']'))
    {
        Some(axes) if !axes.is_empty() => Some(axes.to_owned()),
        None if axes.is_empty() => Some(String::new()),
        _ => None,
    }
}

/// The words of a line, which stand apart by blanks. Blanks within square brackets are within a word.
fn words(code: &str) -> impl Iterator<Item = &str> {
    let mut in_brackets = false;
    let words = code.split(move |c: char| {
        in_brackets = c != ']' && (in_brackets || c == '[');
        !in_brackets && c.is_whitespace()
    });
    words.filter(|word| !word.is_empty())
}

/// The code of a line with a blank in place of each comment in parentheses.
fn without_comments(code: &str) -> Result<String, String> {
    let mut kept = String::with_capacity(code.len());
    let mut inside = false;
    for c in code.chars() {
        match (c, inside) {
            ('(', false) => inside = true,
            (')', true) => {
                inside = false;
                kept.push(' ');
            }
            ('(', true) | (')', false) => return Err(format!("a `{c}` without its partner")),
            (c, false) => kept.push(c),
            (_, true) => {}
        }
    }
    match inside {
        true => Err("a `(` without its partner".to_owned()),
        false => Ok(kept),
    }
}

/// `POLY A0=2.5 A1=-0.001`: a coefficient that is left out is zero, but for A0.
fn polynomial(axis: &str, text: &str) -> Result<Polynomial, String> {
    let mut parts = text.split_whitespace();
    if parts.next() != Some("POLY") {
        return Err(format!("{axis}[…] does not begin with POLY"));
    }
    let (mut found, mut limit) = ([None; COEFFICIENTS], None);
    for part in parts {
        let word = part.split_once('=');
        let (name, value) = word.ok_or_else(|| not_a_word(part))?;
        let before = match (name, coefficient(name)) {
            ("L", _) => limit.replace(number("L", value)?),
            (_, Some(k)) => match found.get_mut(k) {
                Some(slot) => slot.replace(number(name, value)?),
                None => return Err(format!("the polynomial of {axis} is no cubic")),
            },
            _ => return Err(not_a_word(part)),
        };
        if before.is_some() {
            return Err(format!("{name} appears twice in the polynomial of {axis}"));
        }
    }
    match limit {
        Some(limit) if limit <= 0 => Err(format!(
            "L of the polynomial of {axis} must be greater than zero"
        )),
        Some(limit) if limit != ONE => Err(format!(
            "the polynomial of {axis} ends at another L than 1, which the programs of this post do not"
        )),
        _ if found[0].is_none() => Err(format!("the polynomial of {axis} has no A0")),
        _ => Ok(found.map(Option::unwrap_or_default)),
    }
}

/// The place of a coefficient by its name, `A0` to `A5`.
fn coefficient(name: &str) -> Option<usize> {
    let digit = name.strip_prefix('A')?;
    let known = matches!(digit.as_bytes(), [b'0'..=b'5']);
    digit.parse().ok().filter(|_| known)
}

fn is_whole(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

pub(super) fn not_a_word(word: &str) -> String {
    let shown: String = word.chars().take(40).collect();
    format!("`{shown}` is not a word of a path of polynomials")
}
