//! A trial of libraries in a process of its own, before this one loads them.
//!
//! A damaged library may pass every check of its headers and still end the process that loads it. So
//! this program starts itself once more and lets that child load all of the libraries, and end as a
//! program does. Only if the child dies, a child for each library finds out which one is to blame.

mod child;
mod death;

use std::io::{self, BufReader, Read};
use std::process::{Child, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

use turnpath::{Admission, LibraryFile, LoadError, Loadable, Refusal};

use crate::crash::TimeLimit;
use crate::message::note;
pub use child::child;
use child::{BEGUN, FAILED, command};
use death::{cause, is_from_outside};

/// How long a child may take until it is there, on a machine that has much else to do.
const START: Duration = Duration::from_secs(60);
/// How often a child that is to end is looked at.
const LOOK: Duration = Duration::from_micros(200);

/// Tries libraries in children of this program.
#[derive(Debug)]
pub struct Trial {
    limit: TimeLimit,
}

/// A library that the loader would get.
struct Candidate<'a> {
    library: &'a LibraryFile,
    loadable: Loadable,
}

/// The libraries that no check refuses.
fn candidates(libraries: &[LibraryFile]) -> Vec<Candidate<'_>> {
    let all = libraries.iter().filter_map(|library| {
        let loadable = library.loadable()?;
        Some(Candidate { library, loadable })
    });
    all.collect()
}

/// How a trial ended.
#[derive(Debug)]
struct End {
    /// How many libraries were loaded or refused before.
    tried: usize,
    kind: EndKind,
}

#[derive(Debug)]
enum EndKind {
    /// Each library was loaded, or refused with a message that will come again, and the child ended
    /// as a program does.
    Whole,
    /// The child died.
    Death(ExitStatus),
    /// A library did not come back.
    Late,
}

impl Trial {
    /// Trials in which the loading of a library may take so long.
    pub fn new(limit: TimeLimit) -> Self {
        Self { limit }
    }

    /// Tries these libraries in one child. An error says nothing about the libraries.
    fn of(&self, libraries: &[Candidate<'_>]) -> io::Result<End> {
        let mut child = command(libraries.iter().map(|candidate| &candidate.loadable))?
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()?;
        // The child ends when this pipe closes, whatever ends this process.
        let _alive = child.stdin.take();
        let end = self.watch(&mut child, libraries.len());
        // It may have ended by itself.
        let _ = child.kill();
        child.wait()?;
        end
    }

    fn watch(&self, child: &mut Child, libraries: usize) -> io::Result<End> {
        let signs = signs(child);
        if signs.recv_timeout(START) != Ok(BEGUN) {
            return Err(io::Error::other("the program did not start again"));
        }
        for tried in 0..libraries {
            let sign = match self.limit.duration() {
                Some(limit) => signs.recv_timeout(limit),
                None => signs.recv().map_err(RecvTimeoutError::from),
            };
            let kind = match sign {
                Ok(FAILED) => return Err(io::Error::other("the trial itself failed")),
                Ok(_) => continue,
                Err(RecvTimeoutError::Timeout) => EndKind::Late,
                Err(RecvTimeoutError::Disconnected) => self.death(child)?,
            };
            return Ok(End { tried, kind });
        }
        let tried = libraries;
        let kind = match self.death(child)? {
            EndKind::Death(status) if status.success() => EndKind::Whole,
            other => other,
        };
        Ok(End { tried, kind })
    }

    /// How a child ended that is about to.
    fn death(&self, child: &mut Child) -> io::Result<EndKind> {
        let begun = Instant::now();
        let status = loop {
            if let Some(status) = child.try_wait()? {
                break status;
            }
            if self
                .limit
                .duration()
                .is_some_and(|limit| begun.elapsed() > limit)
            {
                return Ok(EndKind::Late);
            }
            thread::sleep(LOOK);
        };
        match is_from_outside(&status) {
            true => Err(io::Error::other(
                "somebody ended the process that tries them",
            )),
            false => Ok(EndKind::Death(status)),
        }
    }

    /// What is wrong with a library alone; nothing if it can be loaded, or refused.
    fn problem(&self, end: &End) -> Option<String> {
        let loads = end.tried == 0;
        match &end.kind {
            EndKind::Whole => None,
            EndKind::Death(status) if loads => {
                Some(format!("loading it ends the process ({})", cause(status)))
            }
            EndKind::Death(status) => Some(format!(
                "a process that has loaded it does not end well ({})",
                cause(status)
            )),
            EndKind::Late if loads => {
                Some(format!("loading it does not end within {}", self.limit))
            }
            EndKind::Late => Some(format!(
                "a process that has loaded it does not end within {}",
                self.limit
            )),
        }
    }
}

impl Admission for Trial {
    fn admit(&self, libraries: &[LibraryFile]) -> Result<(), LoadError> {
        let all = candidates(libraries);
        if all.is_empty() {
            return Ok(());
        }
        let end = match self.of(&all) {
            Ok(end) => end,
            Err(error) => return untried(&error),
        };
        let Some(how) = self.problem(&end) else {
            return Ok(());
        };
        if let [candidate] = &all[..] {
            return Err(refused(candidate.library, how));
        }
        // The one that was being loaded when the child died is tried first.
        let (before, from) = all.split_at(end.tried.min(all.len()));
        let mut without_answer = None;
        for candidate in from.iter().chain(before) {
            let alone = std::slice::from_ref(candidate);
            match self.of(alone).map(|end| self.problem(&end)) {
                Ok(None) => {}
                Ok(Some(how)) => return Err(refused(candidate.library, how)),
                Err(error) => without_answer = Some(error),
            }
        }
        match without_answer {
            Some(error) => untried(&error),
            None => Err(LoadError::NotTogether {
                paths: all
                    .iter()
                    .map(|candidate| candidate.library.path().to_owned())
                    .collect(),
            }),
        }
    }
}

/// Where libraries cannot be tried, they are loaded as they would be anyway.
fn untried(error: &io::Error) -> Result<(), LoadError> {
    note(&format!("the plugins are not tried before ({error})"));
    Ok(())
}

fn refused(library: &LibraryFile, how: String) -> LoadError {
    LoadError::Refused {
        path: library.path().to_owned(),
        refusal: Refusal::FailedTrial { how },
    }
}

/// What the child writes, byte by byte. A thread reads it, so that this process can wait for a byte
/// no longer than it likes.
fn signs(child: &mut Child) -> Receiver<u8> {
    let (send, receive) = mpsc::channel();
    if let Some(output) = child.stdout.take() {
        thread::spawn(move || {
            let bytes = BufReader::new(output).bytes().map_while(Result::ok);
            // An error means that nobody waits any more.
            let _ = bytes.map(|byte| send.send(byte)).find(Result::is_err);
        });
    }
    receive
}
