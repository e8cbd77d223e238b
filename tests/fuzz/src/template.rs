//! Headers and footers of programs: what a template makes of a person's words is comments.

use turnpath_core::Params;
use turnpath_post::{Layout, POSTS, Post, ReadPath, Template};

/// Words of templates.
pub const WORDS: &[&str] = &[
    "{name}",
    "{recipe}",
    "{changes}",
    "{sha256}",
    "{points}",
    "{z_reference}",
    "{ends}",
    "{{",
    "}}",
    "{",
    "}",
    ";",
    "; ",
    "//",
    "--",
    "; -- cutting --",
    "-- end of path",
    "\n",
    "\r",
    "\r\n",
    "\u{2028}",
    "\u{85}",
    "CLOSE",
    "M3",
];

/// A person's words that would be code, a mark or a line of their own, were they not made harmless.
const WORDS_OF_A_PERSON: &str = "a\r\nX9:9\u{2028}-- cutting --\n; -- cutting --\u{b5}";
/// What shows that such words got out of their comment.
const CODE: &str = "X9:9";

/// Fills the text as a template of each post.
pub fn read(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    for post in POSTS {
        read_for(post, text);
    }
}

fn read_for(post: &'static Post, text: &str) {
    let Ok(template) = Template::parse(text, post.comment) else {
        return;
    };
    let filled = template.fill(|_| WORDS_OF_A_PERSON.to_owned());
    assert!(filled.is_ascii(), "the program is ASCII: {filled:?}");
    let strange = |c: char| c.is_control() && c != '\n';
    assert!(!filled.contains(strange), "no control characters");
    assert!(filled.is_empty() || filled.ends_with('\n'));
    // The values of `{name}`, `{recipe}` and `{changes}` alone are a person's words.
    let words = |name: &str| match name {
        "name" | "recipe" | "changes" => WORDS_OF_A_PERSON.to_owned(),
        _ => "1".to_owned(),
    };
    if template.check(words).is_err() {
        // A person's words and the template's own make a mark together: such a template is refused.
        return;
    }
    if !text.contains(CODE) {
        for line in template.fill(words).lines() {
            let code = line.split(post.comment).next().unwrap_or_default();
            assert!(!code.contains(CODE), "a person's words are code: {line}");
        }
    }
    let filled = template.fill(words);
    let format = post.format(&Params::new(), 0.0, 1e-4);
    let mut reader = Layout { post, format }.read(filled.as_bytes(), "part.program");
    let read = reader.next_point();
    let said = read.expect_err("a header has no path").to_string();
    assert!(said.contains("there is no path"), "{said}: {filled}");
}
