//! The text of a formula as numbers, names and signs.

use std::ops::Range;

use crate::complaint::{Complaint, Mistake};

/// The kind of a token.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// A number.
    Number(f64),
    /// A name.
    Name,
    /// An operator, a parenthesis or a comma.
    Sign(char),
    /// The end of the text.
    End,
}

/// A token and its bytes.
#[derive(Debug, Clone, PartialEq)]
pub struct Token {
    /// What it is.
    pub kind: Kind,
    /// Where it is.
    pub place: Range<usize>,
}

/// The tokens of a text; the last one is its end.
///
/// # Errors
/// For a character that no formula has, and for digits that are no finite number.
pub fn tokens(text: &str) -> Result<Vec<Token>, Complaint> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(rest) = text.get(at..).filter(|rest| !rest.is_empty()) {
        let first = rest.chars().next().unwrap_or(' ');
        let length = length(rest, first);
        let place = at..at + length;
        at = place.end;
        if first.is_whitespace() {
            continue;
        }
        let kind = kind(rest.get(..length).unwrap_or_default(), first)
            .map_err(|mistake| mistake.at(place.clone()))?;
        tokens.push(Token { kind, place });
    }
    let place = text.len()..text.len();
    let kind = Kind::End;
    tokens.push(Token { kind, place });
    Ok(tokens)
}

/// The names of a text; `None` if it is no formula.
pub fn names(text: &str) -> Option<Vec<&str>> {
    let tokens = tokens(text).ok()?;
    let names = tokens.into_iter().filter(|token| token.kind == Kind::Name);
    Some(names.filter_map(|token| text.get(token.place)).collect())
}

fn kind(word: &str, first: char) -> Result<Kind, Mistake> {
    match first {
        '+' | '-' | '*' | '/' | '^' | '(' | ')' | ',' => Ok(Kind::Sign(first)),
        // The signs that texts from elsewhere have.
        '−' => Ok(Kind::Sign('-')),
        '·' | '×' => Ok(Kind::Sign('*')),
        _ if starts_number(first) => match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(Kind::Number(number)),
            _ => Err(Mistake::Number(word.to_owned())),
        },
        _ if is_of_name(first) => Ok(Kind::Name),
        _ => Err(Mistake::Character(first)),
    }
}

fn starts_number(first: char) -> bool {
    first.is_ascii_digit() || first == '.'
}

/// Whether a character can be in a name. No name begins with a digit.
pub fn is_of_name(character: char) -> bool {
    character.is_alphanumeric() || character == '_'
}

fn length(rest: &str, first: char) -> usize {
    if starts_number(first) {
        number_length(rest.as_bytes())
    } else if is_of_name(first) {
        rest.find(|c| !is_of_name(c)).unwrap_or(rest.len())
    } else {
        first.len_utf8()
    }
}

/// The bytes of a number such as `1`, `.5`, `2.5e-3`.
fn number_length(text: &[u8]) -> usize {
    let digits = |from: usize| {
        let rest = text.iter().skip(from);
        from + rest.take_while(|byte| byte.is_ascii_digit()).count()
    };
    let is = |at: usize, bytes: &[u8]| text.get(at).is_some_and(|byte| bytes.contains(byte));
    let mut end = digits(0);
    if is(end, b".") {
        end = digits(end + 1);
    }
    if is(end, b"eE") {
        let sign = usize::from(is(end + 1, b"+-"));
        let exponent = digits(end + 1 + sign);
        if exponent > end + 1 + sign {
            end = exponent;
        }
    }
    end
}
