//! Messages: what is wrong, the line with the place underlined, and what to do.

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};

use crate::place::Place;

/// One message about a recipe.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnostic {
    /// What is wrong, in one line.
    pub title: String,
    /// Where; none if it stands nowhere.
    pub place: Option<Place>,
    /// What stands below the underlined place; may be empty.
    pub label: String,
    /// What to do, one line each.
    pub help: Vec<String>,
}

/// One or more messages, in the order of their places.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnostics(Vec<Diagnostic>);

impl Diagnostic {
    /// A message about a place, with neither label nor help yet.
    pub fn new(place: Place, title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            place: Some(place),
            label: String::new(),
            help: Vec::new(),
        }
    }

    /// With words below the underlined place.
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// With one more line on what to do.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help.push(help.into());
        self
    }

    /// With lines on what to do, if there are any.
    pub(crate) fn helps(mut self, help: impl IntoIterator<Item = String>) -> Self {
        self.help.extend(help);
        self
    }

    /// The message as the user sees it, without a line end; `color` for a terminal.
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
        renderer.render(&[self.shown(group).elements(helps)])
    }

    fn shown<'a>(&'a self, group: Group<'a>) -> Group<'a> {
        match &self.place {
            None => group,
            Some(place) if place.is_whole() => {
                group.element(Origin::path(place.source().name.as_str()))
            }
            Some(place) => {
                let label = Some(printable(&self.label)).filter(|label| !label.is_empty());
                let annotation = AnnotationKind::Primary.span(place.span()).label(label);
                let snippet = Snippet::source(place.source().text.as_str())
                    .path(place.source().name.as_str())
                    .annotation(annotation);
                group.element(snippet)
            }
        }
    }

    fn order(&self) -> (usize, usize) {
        match &self.place {
            Some(place) => (place.source().rank, place.span().start),
            None => (usize::MAX, 0),
        }
    }
}

impl Diagnostics {
    /// All messages.
    pub fn iter(&self) -> impl Iterator<Item = &Diagnostic> {
        self.0.iter()
    }

    /// The messages as the user sees them, an empty line between two.
    pub fn render(&self, color: bool) -> String {
        let rendered: Vec<String> = self.0.iter().map(|one| one.render(color)).collect();
        rendered.join("\n\n")
    }

    /// The value if nothing was found wrong, else the messages in the order of their places.
    pub(crate) fn unless_any<T>(value: Option<T>, found: Vec<Diagnostic>) -> Result<T, Self> {
        match value {
            Some(value) if found.is_empty() => Ok(value),
            _ => Err(Self::sorted(found)),
        }
    }

    fn sorted(mut found: Vec<Diagnostic>) -> Self {
        found.sort_by_key(Diagnostic::order);
        Self(found)
    }
}

impl From<Diagnostic> for Diagnostics {
    fn from(one: Diagnostic) -> Self {
        Self(vec![one])
    }
}

impl std::fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.title)
    }
}

impl std::error::Error for Diagnostic {}

impl std::fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let titles: Vec<&str> = self.0.iter().map(|one| one.title.as_str()).collect();
        f.write_str(&titles.join("; "))
    }
}

impl std::error::Error for Diagnostics {}

/// The text without control characters, which a recipe could use to repaint the terminal.
fn printable(text: &str) -> String {
    text.chars()
        .map(|c| {
            if c.is_control() && c != '\n' {
                '\u{FFFD}'
            } else {
                c
            }
        })
        .collect()
}
