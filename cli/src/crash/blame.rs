//! Who ended the process, as far as the marks of the host's calls show it.

use turnpath::calls::{self, Callee};

/// Strategies that are named where one of several ended the process: a chain has six slots.
const MOST_NAMED: usize = 6;
/// The pieces of a message: its beginning, two for each name, what may follow the names, the thread,
/// what was done, and the end of the line.
pub const PIECES: usize = 2 * MOST_NAMED + 5;

/// Who ended the process.
#[derive(Clone, Copy)]
pub enum Blame {
    /// What this thread called.
    Caller(&'static Callee),
    /// Somebody on a thread that is not marked: a plugin may start threads. Strategies of libraries
    /// that other threads were calling; the first one is there.
    OneOf(Suspects),
}

/// Strategies of which one may have ended the process.
#[derive(Clone, Copy, Default)]
pub struct Suspects {
    named: [Option<&'static Callee>; MOST_NAMED],
    /// Whether there were more than are named.
    has_more: bool,
}

impl Blame {
    /// The strategy that this thread calls, or else those of libraries that other threads call. A
    /// signal handler may ask this.
    pub fn find() -> Option<Self> {
        if let Some(callee) = calls::on_this_thread() {
            return Some(Self::Caller(callee));
        }
        let mut suspects = Suspects::default();
        calls::each_of_a_library(|callee| suspects.include(callee));
        suspects.named[0].map(|_| Self::OneOf(suspects))
    }

    /// The message in pieces; `what` follows the names. The pieces are there already, so that nothing
    /// allocates. Where another thread than the caller's ended the process, it may be one of the
    /// program's own, so the strategies are named and not accused.
    pub fn message(&self, what: &'static str) -> [&'static str; PIECES] {
        let mut pieces = [""; PIECES];
        match self {
            Self::Caller(callee) => {
                pieces[..4].copy_from_slice(&["error: ", callee.text(), what, "\n"]);
            }
            Self::OneOf(suspects) => suspects.write(&mut pieces, what),
        }
        pieces
    }
}

impl Suspects {
    fn include(&mut self, callee: &'static Callee) {
        for place in &mut self.named {
            match place {
                Some(known) if std::ptr::eq(*known, callee) => return,
                Some(_) => {}
                None => {
                    *place = Some(callee);
                    return;
                }
            }
        }
        self.has_more = true;
    }

    fn write(&self, pieces: &mut [&'static str; PIECES], what: &'static str) {
        let is_one = self.named[1].is_none();
        let begin = if is_one { "error: " } else { "error: one of " };
        let more = if self.has_more { " or another" } else { "" };
        let named = self.named.iter().flatten().enumerate();
        let names = named.flat_map(|(index, callee)| {
            let between = if index == 0 { "" } else { ", " };
            [between, callee.text()]
        });
        let rest = [more, " may have, on a thread of its own,", what, "\n"];
        let all = std::iter::once(begin).chain(names).chain(rest);
        for (place, piece) in pieces.iter_mut().zip(all) {
            *place = piece;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(names: &[&str]) -> String {
        let mut suspects = Suspects::default();
        for name in names {
            suspects.include(Callee::new((*name).to_owned(), true));
        }
        Blame::OneOf(suspects)
            .message(" ended the program")
            .concat()
    }

    #[test]
    fn one_suspect_is_named_once_however_many_threads_call_it() {
        let text = message(&["the sampler `a`", "the sampler `a`"]);
        let expected =
            "error: the sampler `a` may have, on a thread of its own, ended the program\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn of_several_suspects_none_is_accused() {
        let text = message(&["the sampler `a`", "the surface `b`"]);
        let expected = "error: one of the sampler `a`, the surface `b` may have, on a thread of its \
                        own, ended the program\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn beyond_those_that_are_named_there_is_another() {
        let names: Vec<String> = (0..=MOST_NAMED)
            .map(|k| format!("the feed `{k}`"))
            .collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let text = message(&names);
        assert!(text.contains("the feed `5` or another may have"), "{text}");
        assert!(text.ends_with(" ended the program\n"), "{text}");
    }
}
