//! The text of a lens file, whatever its encoding: UTF-16 with its mark, as the design program
//! writes it today, UTF-8, or the ANSI code page of older versions.

use crate::error::{LensProblem, ProblemKind};

/// Control characters that a text may have: tab, line ends, the end of a page, and the end of a file
/// on old systems.
const ALLOWED: [char; 5] = ['\t', '\n', '\r', '\u{c}', '\u{1a}'];

/// The text of these bytes.
///
/// Bytes that are no UTF-8 are taken as Latin-1. Only comments and names have such characters, so
/// another code page changes no number.
///
/// # Errors
/// When the bytes are no text.
pub fn decode(bytes: &[u8]) -> Result<String, LensProblem> {
    let text = match bytes {
        [0xff, 0xfe, rest @ ..] => utf16(rest, u16::from_le_bytes)?,
        [0xfe, 0xff, rest @ ..] => utf16(rest, u16::from_be_bytes)?,
        [0xef, 0xbb, 0xbf, rest @ ..] => utf8_or_latin(rest),
        all => utf8_or_latin(all),
    };
    match text.find(|c: char| c.is_control() && !ALLOWED.contains(&c) && !c.is_c1()) {
        None => Ok(text),
        Some(at) => Err(ProblemKind::NoText.at(line_of(text.get(..at).unwrap_or_default()))),
    }
}

fn utf8_or_latin(bytes: &[u8]) -> String {
    match str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect(),
    }
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Result<String, LensProblem> {
    let (pairs, rest) = bytes.as_chunks::<2>();
    let mut text = String::with_capacity(pairs.len());
    for decoded in char::decode_utf16(pairs.iter().map(|pair| unit(*pair))) {
        match decoded {
            Ok(character) => text.push(character),
            Err(_) => return Err(ProblemKind::NoText.at(line_of(&text))),
        }
    }
    match rest.is_empty() {
        true => Ok(text),
        false => Err(ProblemKind::NoText.at(line_of(&text))),
    }
}

/// The line at the end of a text.
fn line_of(before: &str) -> usize {
    1 + before.bytes().filter(|byte| *byte == b'\n').count()
}

/// Characters from 0x80 to 0x9f: letters in the code pages of Windows.
trait CodePage {
    fn is_c1(&self) -> bool;
}

impl CodePage for char {
    fn is_c1(&self) -> bool {
        ('\u{80}'..='\u{9f}').contains(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "UNIT MM\r\n  COMM Größe µ\r\n";

    #[test]
    fn all_encodings_of_a_text_give_it() {
        let little: Vec<u8> = TEXT.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = TEXT.encode_utf16().flat_map(u16::to_be_bytes).collect();
        let latin: Vec<u8> = TEXT.chars().map(|c| c as u8).collect();
        let all = [
            [&[0xff, 0xfe], little.as_slice()].concat(),
            [&[0xfe, 0xff], big.as_slice()].concat(),
            [&[0xef, 0xbb, 0xbf], TEXT.as_bytes()].concat(),
            TEXT.as_bytes().to_vec(),
            latin,
        ];
        for bytes in all {
            assert_eq!(decode(&bytes).as_deref(), Ok(TEXT));
        }
    }

    #[test]
    fn rubbish_is_refused_with_its_line() {
        let problem = decode(b"UNIT MM\nSURF \0 1\n").unwrap_err();
        assert_eq!(problem.to_string(), "line 2: this is not a text");
        // Half a character, and half of a pair.
        for bytes in [&[0xff, 0xfe, b'U'][..], &[0xff, 0xfe, 0x00, 0xd8, b'U', 0]] {
            assert_eq!(decode(bytes).unwrap_err().line, Some(1));
        }
    }
}
