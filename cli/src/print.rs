//! Printing an answer.

use std::io::{self, Write};

use anstyle::{AnsiColor, Style};
use serde::Serialize;
use turnpath::report::to_json;
use turnpath_core::printable;

use crate::args::Format;
use crate::crash::{answer_to, output_is_terminal};
use crate::failure::Failure;

/// The variable that asks for no colours.
const NO_COLOR: &str = "NO_COLOR";
/// The verdicts as the reports write them.
const EXCEEDED: &str = "EXCEEDED";
const HOLDS: &str = "holds";
const BAD: Style = AnsiColor::Red.on_default().bold();
const GOOD: Style = AnsiColor::Green.on_default();

/// Writes a text to standard output. A reader that has gone, such as `head`, is no failure.
pub fn print(text: &str) -> Result<(), Failure> {
    match answer_to(text.as_bytes()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(Failure::Output(error)),
        Ok(()) => Ok(()),
    }
}

/// Standard output as a writer, for more text than should be held at once.
pub struct Output;

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        answer_to(bytes)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Writes a report in the form that was asked for, if any was; `text` is the one for a person.
pub fn print_report<T: Serialize>(
    format: Option<Format>,
    report: &T,
    text: impl FnOnce(&T) -> String,
) -> Result<(), Failure> {
    match format {
        None => Ok(()),
        Some(Format::Json) => print(&to_json(report)),
        Some(Format::Human) => {
            let text = printable(&text(report)).into_owned();
            let in_colour = output_is_terminal().is_some() && std::env::var_os(NO_COLOR).is_none();
            print(&if in_colour { coloured(&text) } else { text })
        }
    }
}

/// The text with its verdicts in colour, of which a missed one is the first to be seen.
fn coloured(text: &str) -> String {
    let verdicts = [(EXCEEDED, BAD), (HOLDS, GOOD)];
    verdicts
        .iter()
        .fold(text.to_owned(), |text, (word, style)| {
            let shown = format!("{style}{word}{style:#}");
            text.replace(word, &shown)
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_verdict_stands_out_and_the_rest_stays() {
        let text = "residual  99 nm of 50 nm   EXCEEDED\nlead      lowest 1 nm; holds\n";
        let shown = coloured(text);
        assert!(
            shown.contains(&format!("{BAD}EXCEEDED{BAD:#}\n")),
            "{shown:?}"
        );
        assert!(
            shown.contains(&format!("; {GOOD}holds{GOOD:#}\n")),
            "{shown:?}"
        );
        let colours = [format!("{BAD}"), format!("{GOOD}"), format!("{BAD:#}")];
        let bare = colours
            .iter()
            .fold(shown, |text, colour| text.replace(colour, ""));
        assert_eq!(bare, text);
    }
}
