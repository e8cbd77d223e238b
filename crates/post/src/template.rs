//! Headers and footers: text with placeholders.

use crate::comment::code_before_comment;

/// The names that may appear in braces.
pub const PLACEHOLDERS: &[&str] = &[
    "name",
    "recipe",
    "sha256",
    "changes",
    "turnpath",
    "points",
    "revolutions",
    "time_s",
    "z_reference",
    "c_range",
    "axis_x",
    "axis_z",
    "axis_c",
    "velocity_unit",
    "ix90",
    "ends",
    "f_means",
    "increments",
    "time_axis",
    "interpolation_error_nm",
    "form_error_nm",
    "lead_clearance_nm",
    "verified",
];

/// Placeholders whose values are words of a person. They are allowed only in comments, which no
/// controller reads as code.
const FREE_TEXT: &[&str] = &["name", "recipe", "changes"];
/// Longest value that is not shortened, in characters: a controller's lines have a limit.
const LONGEST_VALUE: usize = 200;

/// A text with placeholders such as `{name}`. A literal brace is written twice.
#[derive(Debug, Clone, PartialEq)]
pub struct Template(Vec<Part>);

#[derive(Debug, Clone, PartialEq)]
enum Part {
    Text(String),
    Placeholder(String),
}

/// Why a text is not a template.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TemplateError {
    /// There is no such placeholder.
    #[error("no placeholder named `{{{0}}}`")]
    Unknown(String),
    /// A person's words could be read as code.
    #[error("`{{{name}}}` is outside a comment: put a `{comment}` before it on its line")]
    OutsideComment {
        /// The placeholder.
        name: String,
        /// What begins a comment.
        comment: &'static str,
    },
    /// A reader would take a line for a mark of the path.
    #[error("a comment that begins with `--` would be taken for a mark of the path")]
    Mark,
    /// A reader would take a line for a mark of the path once its placeholders have their values.
    #[error(
        "with the values of its placeholders, the comment of the line `{0}` begins with `--` and \
         would be taken for a mark of the path"
    )]
    FilledMark(String),
    /// A brace has no partner.
    #[error("a single brace; write a literal brace twice: `{{{{` or `}}}}`")]
    SingleBrace,
}

impl Template {
    /// Reads a text whose comments begin with `comment`.
    ///
    /// ```
    /// # use turnpath_post::Template;
    /// let template = Template::parse("; {name}, {points} points", ";").unwrap();
    /// let filled = template.fill(|placeholder| match placeholder {
    ///     "name" => "Mirror".to_owned(),
    ///     _ => "4160".to_owned(),
    /// });
    /// assert_eq!(filled, "; Mirror, 4160 points\n");
    /// assert!(Template::parse("{nam}", ";").is_err());
    /// ```
    ///
    /// # Errors
    /// When a placeholder is unknown or its words would be code, a brace is single, or a reader would
    /// take a line for a mark of the path.
    pub fn parse(text: &str, comment: &'static str) -> Result<Self, TemplateError> {
        if text.lines().any(is_mark) {
            return Err(TemplateError::Mark);
        }
        let mut parts = Vec::new();
        let mut rest = text;
        while let Some(at) = rest.find(['{', '}']) {
            let (before, after) = rest.split_at(at);
            parts.push(Part::Text(before.to_owned()));
            let (part, after_part) = part(after)?;
            if let Part::Placeholder(name) = &part {
                let read = text.len() - rest.len() + before.len();
                let line = text[..read].rsplit('\n').next().unwrap_or_default();
                let is_code = code_before_comment(line, &[comment]) == line;
                if FREE_TEXT.contains(&name.as_str()) && is_code {
                    let name = name.clone();
                    return Err(TemplateError::OutsideComment { name, comment });
                }
            }
            parts.push(part);
            rest = after_part;
        }
        parts.push(Part::Text(rest.to_owned()));
        Ok(Self(parts))
    }

    /// Characters of its own text: about the length of the filled one.
    pub fn len(&self) -> usize {
        let parts = self.0.iter().map(|part| match part {
            Part::Text(text) | Part::Placeholder(text) => text.len(),
        });
        parts.sum()
    }

    /// Whether there is nothing in it.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Checks the text with these values of its placeholders.
    ///
    /// # Errors
    /// When a reader would take one of its lines for a mark of the path.
    pub fn check(&self, value: impl Fn(&str) -> String) -> Result<(), TemplateError> {
        let filled = self.fill(value);
        match filled.lines().find(|line| is_mark(line)) {
            None => Ok(()),
            Some(line) => Err(TemplateError::FilledMark(line.to_owned())),
        }
    }

    /// The text with the values of its placeholders and a line end. Line ends and characters beyond
    /// ASCII in a value are replaced, because a controller may fail on them.
    pub fn fill(&self, value: impl Fn(&str) -> String) -> String {
        let mut text = String::new();
        for part in &self.0 {
            match part {
                Part::Text(own) => text.extend(own.chars().map(|c| match c {
                    '\n' => c,
                    c => plain(c),
                })),
                Part::Placeholder(name) => text.push_str(&harmless(&value(name))),
            }
        }
        if !text.is_empty() && !text.ends_with('\n') {
            text.push('\n');
        }
        text
    }
}

/// The part that begins with a brace, and the rest of the text.
fn part(text: &str) -> Result<(Part, &str), TemplateError> {
    for (twice, brace) in [("{{", "{"), ("}}", "}")] {
        if let Some(behind) = text.strip_prefix(twice) {
            return Ok((Part::Text(brace.to_owned()), behind));
        }
    }
    let inside = text.strip_prefix('{').and_then(|text| text.split_once('}'));
    let (name, behind) = inside.ok_or(TemplateError::SingleBrace)?;
    match PLACEHOLDERS.contains(&name) {
        true => Ok((Part::Placeholder(name.to_owned()), behind)),
        false => Err(TemplateError::Unknown(name.to_owned())),
    }
}

/// What begins a comment in some dialect; a reader may know more than one.
const COMMENTS: [&str; 3] = [";", "//", "("];

/// Whether a reader of any dialect would take a comment of the line for a mark.
fn is_mark(line: &str) -> bool {
    let begins = |comment: &str| {
        let mut said = line.split(comment).skip(1);
        said.any(|said| said.trim_start().starts_with("--"))
    };
    COMMENTS.into_iter().any(begins)
}

/// A value that is neither a mark of the path nor code nor an endless line.
fn harmless(value: &str) -> String {
    let short: String = value.chars().take(LONGEST_VALUE).map(plain).collect();
    short.replace("--", "- -")
}

/// A person's words in ASCII, on one line.
pub(crate) fn plain_text(text: &str) -> String {
    harmless(text)
}

fn plain(c: char) -> char {
    match c {
        ' '..='~' => c,
        c if c.is_whitespace() || c.is_control() => ' ',
        _ => '?',
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled(text: &str) -> String {
        Template::parse(text, ";")
            .unwrap()
            .fill(|name| format!("<{name}>"))
    }

    #[test]
    fn placeholders_are_replaced_and_double_braces_kept() {
        assert_eq!(filled("; a{name}b{points}"), "; a<name>b<points>\n");
        assert_eq!(filled("{{name}}\n"), "{name}\n");
        assert_eq!(filled(""), "");
    }

    #[test]
    fn values_stay_on_their_line_and_in_ascii() {
        let name = Template::parse("; {name}", ";").unwrap();
        assert_eq!(name.fill(|_| "a\nX1:2 µ".to_owned()), "; a X1:2 ?\n");
    }

    #[test]
    fn unknown_placeholders_and_single_braces_are_refused() {
        let unknown = Template::parse("{nam}", ";").unwrap_err();
        assert_eq!(unknown.to_string(), "no placeholder named `{nam}`");
        assert_eq!(
            Template::parse("{name", ";"),
            Err(TemplateError::SingleBrace)
        );
        assert_eq!(
            Template::parse("name}", ";"),
            Err(TemplateError::SingleBrace)
        );
    }

    #[test]
    fn words_of_a_person_are_neither_code_nor_marks() {
        let outside = TemplateError::OutsideComment {
            name: "name".to_owned(),
            comment: ";",
        };
        assert_eq!(Template::parse("CLOSE\n{name}", ";"), Err(outside));
        for (text, comment) in [
            ("; -- cutting --", ";"),
            ("end // -- x", "//"),
            ("(-- cutting --)", ";"),
        ] {
            assert_eq!(Template::parse(text, comment), Err(TemplateError::Mark));
        }
        assert_eq!(
            Template::parse("CLOSE ;-- end of path --", ";"),
            Err(TemplateError::Mark)
        );
        // A semicolon within quotes begins no comment.
        for text in ["MSG(\"; {name}\")", "MSG(\"{name}\")", "MSG(\"a\" ; {name}"] {
            let outside = Template::parse(text, ";");
            let refused = matches!(outside, Err(TemplateError::OutsideComment { .. }));
            assert_eq!(refused, !text.contains("\"a\""), "{text}: {outside:?}");
        }
        for (text, name) in [("; -{name}-", "- cutting -"), (";\u{1}{name}-", "-- x")] {
            let filled = Template::parse(text, ";")
                .unwrap()
                .check(|_| name.to_owned());
            let refused = matches!(filled, Err(TemplateError::FilledMark(_)));
            assert_eq!(refused, text.starts_with("; -"), "{text}: {filled:?}");
        }
        let control = Template::parse(";\u{1}-- cutting --", ";").unwrap();
        assert!(control.check(|_| String::new()).is_err());
        let filled = Template::parse("; {name}\n", ";")
            .unwrap()
            .fill(|_| format!("-- cutting --\nOPEN{}", "x".repeat(1000)));
        assert!(filled.starts_with("; - - cutting - - OPENx"), "{filled}");
        assert!(filled.len() < 250 && filled.lines().count() == 1);
    }
}
