//! Where a line's comment begins, in text that a person has written.

/// The code of a line: what stands before its comment, which begins with one of `comments`. Within
/// quotes nothing is a comment, and behind a quote that is not closed all is code.
pub(crate) fn code_before_comment<'a>(line: &'a str, comments: &[&str]) -> &'a str {
    let mut is_quoted = false;
    for (at, c) in line.char_indices() {
        let (code, rest) = line.split_at(at);
        if !is_quoted && comments.iter().any(|comment| rest.starts_with(comment)) {
            return code;
        }
        is_quoted ^= c == '"';
    }
    line
}

#[cfg(test)]
mod tests {
    use super::code_before_comment;

    #[test]
    fn a_comment_begins_outside_of_quotes() {
        for (line, code) in [
            ("G1 ; a", "G1 "),
            ("; a", ""),
            ("MSG(\"; a\")", "MSG(\"; a\")"),
            ("MSG(\"a\") ; \"b", "MSG(\"a\") "),
            ("MSG(\"a ; b", "MSG(\"a ; b"),
            ("G1 // a", "G1 // a"),
        ] {
            assert_eq!(code_before_comment(line, &[";"]), code, "{line}");
        }
        assert_eq!(code_before_comment("X1 // a ; b", &[";", "//"]), "X1 ");
    }
}
