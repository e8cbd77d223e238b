//! Text of others on its way to a terminal: names, messages of plugins, names of files.

use std::borrow::Cow;

/// The text with its control characters written out, `\u{1b}` for ESC, so that it can neither move
/// the cursor, nor ring, nor turn the direction of writing. Line ends and tabs stay.
///
/// ```
/// use turnpath_core::printable;
/// assert_eq!(printable("a\u{1b}[2J\nb"), "a\\u{1b}[2J\nb");
/// ```
pub fn printable(text: &str) -> Cow<'_, str> {
    written_out(text, |c| acts_on_a_terminal(c) && c != '\n' && c != '\t')
}

/// The same for a text within a line: line ends and tabs are written out too.
///
/// ```
/// use turnpath_core::printable_line;
/// assert_eq!(printable_line("lab\n1"), "lab\\n1");
/// ```
pub fn printable_line(text: &str) -> Cow<'_, str> {
    written_out(text, acts_on_a_terminal)
}

fn written_out(text: &str, must_be: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.chars().any(&must_be) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        match must_be(c) {
            true => shown.extend(c.escape_default()),
            false => shown.push(c),
        }
    }
    Cow::Owned(shown)
}

/// Control characters, and the marks that turn the direction of writing.
fn acts_on_a_terminal(c: char) -> bool {
    c.is_control()
        || matches!(
            c,
            '\u{200e}' | '\u{200f}' | '\u{061c}' | '\u{2028}' | '\u{2029}'
        )
        || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_control_character_is_left() {
        let all: String = ('\0'..='\u{ffff}').collect();
        let left = |text: &str| text.chars().filter(|c| c.is_control()).count();
        assert_eq!(left(&printable_line(&all)), 0);
        assert_eq!(left(&printable(&all)), 2);
        assert!(!printable(&all).contains('\u{202e}'));
    }

    #[test]
    fn ordinary_text_stays_as_it_is() {
        let text = "Spiegel Ø 5 µm, “α”, 鏡";
        assert_eq!(printable_line(text), text);
        assert!(matches!(printable(text), Cow::Borrowed(_)));
    }
}
