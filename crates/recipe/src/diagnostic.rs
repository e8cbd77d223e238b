//! Messages: a title, the line of the recipe with the span underlined, and help.

use std::error::Error;
use std::fmt;

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};

use turnpath_core::{printable, printable_line};

use crate::span::Span;

/// Most messages about one recipe. Nobody reads more, and each of them shows its line: a list of many
/// wrong values on one line would take time and room that grow with its square.
const MOST_MESSAGES: usize = 100;

/// One message about a recipe.
///
/// `Display` gives the title alone. [`render`](Self::render) gives what the user sees.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnostic {
    title: String,
    span: Option<Span>,
    label: String,
    help: Vec<String>,
}

/// One or more messages, in the order of their spans.
///
/// `Display` gives the titles, one a line. [`render`](Self::render) gives what the user sees.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnostics {
    /// At most [`MOST_MESSAGES`], and one that says how many more there are.
    messages: Vec<Diagnostic>,
    left_out: usize,
}

impl Diagnostic {
    /// A message about a span, without label and help.
    pub fn new(span: Span, title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            span: Some(span),
            label: String::new(),
            help: Vec::new(),
        }
    }

    /// A message about an error that belongs to no span. The title is the error's text, followed
    /// by the texts of its sources: `cannot read the recipe a.toml: permission denied`.
    pub fn from_error(error: &dyn Error) -> Self {
        let mut title = error.to_string();
        let mut source = error.source();
        while let Some(error) = source {
            title = format!("{title}: {error}");
            source = error.source();
        }
        Self {
            title,
            span: None,
            label: String::new(),
            help: Vec::new(),
        }
    }

    /// Sets the label, which is shown below the underlined span.
    pub fn with_label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// Adds a line of help.
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help.push(help.into());
        self
    }

    /// Adds several lines of help.
    pub fn with_helps(mut self, help: impl IntoIterator<Item = String>) -> Self {
        self.help.extend(help);
        self
    }

    /// What is wrong.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// Where it is wrong; `None` if the message belongs to no span.
    pub fn span(&self) -> Option<&Span> {
        self.span.as_ref()
    }

    /// The text below the underlined span; may be empty.
    pub fn label(&self) -> &str {
        &self.label
    }

    /// What the user can do, one item a line.
    pub fn help(&self) -> &[String] {
        &self.help
    }

    /// The message as the user sees it, without a line end; `color` adds the colours of a terminal.
    pub fn render(&self, color: bool) -> String {
        let renderer = if color {
            Renderer::styled()
        } else {
            Renderer::plain()
        };
        let group = Group::with_title(Level::ERROR.primary_title(printable(&self.title)));
        let helps = self
            .help
            .iter()
            .map(|help| Level::HELP.message(printable(help)));
        let rendered = renderer.render(&[self.with_snippet(group).elements(helps)]);
        // The renderer replaces other control characters itself.
        rendered.replace(is_late_control, "\u{fffd}")
    }

    fn with_snippet<'a>(&'a self, group: Group<'a>) -> Group<'a> {
        match &self.span {
            None => group,
            Some(span) if span.is_whole() => {
                group.element(Origin::path(printable_line(&span.source().name)))
            }
            Some(span) => {
                let label = Some(printable(&self.label)).filter(|label| !label.is_empty());
                let annotation = AnnotationKind::Primary.span(span.range()).label(label);
                let snippet = Snippet::source(span.source().text.as_str())
                    .path(printable_line(&span.source().name))
                    .annotation(annotation);
                group.element(snippet)
            }
        }
    }

    /// The recipe comes first, then the `--set` arguments; a message without a span comes last.
    fn order(&self) -> (usize, usize) {
        match &self.span {
            Some(span) => (span.source().rank, span.range().start),
            None => (usize::MAX, 0),
        }
    }
}

/// Whether a character is one of the control characters behind ASCII, from U+0080 to U+009F.
fn is_late_control(c: char) -> bool {
    c.is_control() && !c.is_ascii()
}

impl Diagnostics {
    /// All messages.
    pub fn iter(&self) -> impl Iterator<Item = &Diagnostic> {
        self.messages.iter()
    }

    /// The messages as the user sees them, with an empty line between two.
    pub fn render(&self, color: bool) -> String {
        let rendered: Vec<String> = self.messages.iter().map(|one| one.render(color)).collect();
        rendered.join("\n\n")
    }

    /// The value if there is no message, else the messages in the order of their spans.
    pub(crate) fn unless_any<T>(value: Option<T>, diagnostics: Vec<Diagnostic>) -> Result<T, Self> {
        match value {
            Some(value) if diagnostics.is_empty() => Ok(value),
            _ => Err(Self::sorted(diagnostics)),
        }
    }

    /// These and more, in the order of their spans.
    pub(crate) fn and(mut self, more: impl IntoIterator<Item = Diagnostic>) -> Self {
        self.messages.truncate(MOST_MESSAGES);
        self.messages.extend(more);
        self.messages.sort_by_key(Diagnostic::order);
        Self::limited(self.messages, self.left_out)
    }

    fn sorted(mut diagnostics: Vec<Diagnostic>) -> Self {
        diagnostics.sort_by_key(Diagnostic::order);
        Self::limited(diagnostics, 0)
    }

    /// The first messages, and how many more there are besides those that were left out before.
    fn limited(mut messages: Vec<Diagnostic>, left_out_before: usize) -> Self {
        let left_out = left_out_before + messages.len().saturating_sub(MOST_MESSAGES);
        if left_out > 0 {
            messages.truncate(MOST_MESSAGES);
            messages.push(Diagnostic {
                title: format!("messages left out: {left_out} more"),
                span: None,
                label: String::new(),
                help: Vec::new(),
            });
        }
        Self { messages, left_out }
    }
}

impl FromIterator<Diagnostic> for Diagnostics {
    /// Messages in the order in which they come.
    fn from_iter<I: IntoIterator<Item = Diagnostic>>(diagnostics: I) -> Self {
        Self::limited(diagnostics.into_iter().collect(), 0)
    }
}

impl From<Diagnostic> for Diagnostics {
    fn from(one: Diagnostic) -> Self {
        Self::limited(vec![one], 0)
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.title)
    }
}

impl Error for Diagnostic {}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let titles: Vec<&str> = self.messages.iter().map(Diagnostic::title).collect();
        f.write_str(&titles.join("\n"))
    }
}

impl Error for Diagnostics {}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::span::Source;

    fn span(start: usize) -> Span {
        let source = Source {
            name: "a.toml".to_owned(),
            text: "radius = 0".to_owned(),
            rank: 0,
        };
        Span::new(Arc::new(source), start..start + 1)
    }

    #[test]
    fn control_characters_of_the_text_do_not_reach_a_terminal() {
        for control in (0..0xa0_u32).filter_map(char::from_u32) {
            if !control.is_control() || control == '\n' {
                continue;
            }
            let source = Source {
                name: "a.toml".to_owned(),
                text: format!("[f{control}m"),
                rank: 0,
            };
            let message = Diagnostic::new(Span::new(Arc::new(source), 1..2), "wrong");
            let rendered = message.render(false);
            let strange = |c: char| c.is_control() && c != '\n';
            assert!(!rendered.contains(strange), "{rendered:?}");
        }
    }

    #[test]
    fn the_text_of_several_messages_is_their_titles_one_a_line() {
        let messages = vec![
            Diagnostic::new(span(9), "second").with_label("a label"),
            Diagnostic::new(span(0), "first").with_help("some help"),
        ];
        let error = Diagnostics::unless_any(Some(()), messages).unwrap_err();
        assert_eq!(error.to_string(), "first\nsecond");
    }

    #[test]
    fn of_very_many_messages_the_first_are_kept_and_the_rest_is_counted() {
        let messages = (0..=MOST_MESSAGES).map(|which| Diagnostic::new(span(9), which.to_string()));
        let kept: Vec<String> = Diagnostics::from_iter(messages.clone())
            .iter()
            .map(|one| one.title().to_owned())
            .collect();
        assert_eq!(kept.len(), MOST_MESSAGES + 1);
        assert_eq!(kept[MOST_MESSAGES - 1], (MOST_MESSAGES - 1).to_string());
        assert_eq!(kept[MOST_MESSAGES], "messages left out: 1 more");
        let all = Diagnostics::from_iter(messages.take(MOST_MESSAGES));
        assert_eq!(all.iter().count(), MOST_MESSAGES);
    }

    #[test]
    fn an_errors_message_has_the_texts_of_its_sources() {
        #[derive(Debug, thiserror::Error)]
        #[error("cannot read a.toml")]
        struct Outer(#[source] std::io::Error);

        let error = Outer(std::io::Error::other("the disk is gone"));
        let diagnostic = Diagnostic::from_error(&error);
        assert_eq!(diagnostic.title(), "cannot read a.toml: the disk is gone");
        assert_eq!(diagnostic.span(), None);
    }
}
