//! The words of a line of G code, which stand with spaces between them or without, and with comments in
//! parentheses anywhere.

/// The code of a line in capitals, without spaces and without comments in parentheses.
pub(crate) fn without_comments(code: &str) -> Result<String, String> {
    let mut kept = String::with_capacity(code.len());
    let mut inside = false;
    for c in code.chars() {
        match c {
            '(' if !inside => inside = true,
            ')' if inside => inside = false,
            '(' | ')' => return Err(format!("a `{c}` without its partner")),
            _ if inside || c.is_ascii_whitespace() => {}
            c => kept.push(c.to_ascii_uppercase()),
        }
    }
    match inside {
        true => Err("a `(` without its partner".to_owned()),
        false => Ok(kept),
    }
}

/// Refuses a blank within a number, where a controller ends the number at a blank.
pub(crate) fn refuse_broken_numbers(code: &str) -> Result<(), String> {
    let is_of_number = |c: char| c.is_ascii_digit() || c == '.';
    let (mut last, mut inside, mut is_apart) = (' ', false, false);
    for c in code.chars() {
        match c {
            '(' => inside = true,
            ')' => inside = false,
            _ if inside => {}
            c if c.is_ascii_whitespace() => is_apart = true,
            c if is_apart && is_of_number(last) && is_of_number(c) => {
                return Err(
                    "a blank stands within a number: this controller ends the number there"
                        .to_owned(),
                );
            }
            c => (last, is_apart) = (c, false),
        }
    }
    Ok(())
}

/// A word without the zeros before its number: `G00` is `G0`.
pub(super) fn numbered(word: &str) -> String {
    let (letter, number) = word.split_at_checked(1).unwrap_or((word, ""));
    let is_whole = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
    match number.trim_start_matches('0') {
        _ if !is_whole => word.to_owned(),
        "" => format!("{letter}0"),
        number => format!("{letter}{number}"),
    }
}

/// The words of a line in capitals with a space between them, without its comments.
pub(super) fn spaced(code: &str) -> Result<String, String> {
    let mut spaced = String::with_capacity(2 * code.len());
    for c in without_comments(code)?.chars() {
        if c.is_ascii_alphabetic() {
            spaced.push(' ');
        }
        spaced.push(c);
    }
    Ok(spaced)
}

/// The code of a line, and the comment behind it or the one that is all of the line.
pub(crate) fn split_comment(line: &[u8]) -> (&[u8], Option<&[u8]>) {
    let text = line.trim_ascii();
    if let [b'(', inside @ .., b')'] = text
        && !inside.contains(&b'(')
        && !inside.contains(&b')')
    {
        return (b"", Some(inside));
    }
    let mut inside = false;
    for (at, byte) in line.iter().enumerate() {
        match byte {
            b'(' => inside = true,
            b')' => inside = false,
            b';' if !inside => return (&line[..at], Some(&line[at + 1..])),
            _ => {}
        }
    }
    (line, None)
}
