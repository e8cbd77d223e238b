//! A trial of libraries in a process of its own, before this one loads them.
//!
//! A damaged library may pass every check of its headers and still end the process that loads it. So
//! this program starts itself once more and lets that child load all of the libraries. Only if the
//! child dies, a child for each library finds out which one is to blame.

use std::ffi::OsString;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitCode, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use turnpath::{Admission, Catalogue, LibraryFile, LoadError, Refusal};

use crate::crash::{self, TimeLimit};
use crate::message::note;

/// The variable that makes a child of this program. Its value is the limit on the time of a call.
const TRIAL: &str = "TURNPATH_TRIAL_OF_PLUGINS";
/// The child is there.
const BEGUN: u8 = b'b';
/// The child has loaded, or refused, one more library.
const NEXT: u8 = b'n';
/// How long a child may take until it is there, on a machine that has much else to do.
const START: Duration = Duration::from_secs(60);

/// Tries libraries in children of this program.
#[derive(Debug)]
pub struct Trial {
    limit: TimeLimit,
}

/// How a trial ended.
#[derive(Debug)]
enum End {
    /// Each library was loaded, or refused with a message that will come again.
    Whole,
    /// The child ended before.
    Ended(ExitStatus),
    /// A library did not come back.
    Late,
}

impl Trial {
    /// Trials in which the loading of a library may take so long.
    pub fn new(limit: TimeLimit) -> Self {
        Self { limit }
    }

    fn of(&self, libraries: &[&Path]) -> io::Result<End> {
        // The child's copies of libraries go with this folder, however the child ends.
        let scratch = tempfile::Builder::new().prefix("turnpath-").tempdir()?;
        let mut child = Command::new(std::env::current_exe()?)
            .args(libraries)
            .env(TRIAL, self.limit.to_string())
            .env("TMPDIR", scratch.path())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()?;
        let signs = signs(&mut child);
        if signs.recv_timeout(START) != Ok(BEGUN) {
            end(&mut child)?;
            return Err(io::Error::other("the program did not start again"));
        }
        for _ in libraries {
            let sign = match self.limit.duration() {
                Some(limit) => signs.recv_timeout(limit),
                None => signs.recv().map_err(RecvTimeoutError::from),
            };
            match sign {
                Ok(_) => {}
                Err(RecvTimeoutError::Timeout) => {
                    end(&mut child)?;
                    return Ok(End::Late);
                }
                Err(RecvTimeoutError::Disconnected) => return child.wait().map(End::Ended),
            }
        }
        end(&mut child)?;
        Ok(End::Whole)
    }

    /// What is wrong with a library alone; nothing if it can be loaded, or refused.
    fn problem(&self, end: &End) -> Option<String> {
        match end {
            End::Whole => None,
            End::Ended(status) => Some(format!("loading it ends the process ({})", how(status))),
            End::Late => Some(format!("loading it does not end within {}", self.limit)),
        }
    }
}

impl Admission for Trial {
    fn admit(&self, libraries: &[LibraryFile]) -> Result<(), LoadError> {
        let paths: Vec<&Path> = libraries.iter().map(LibraryFile::path).collect();
        let whole = match self.of(&paths) {
            Ok(end) => self.problem(&end).is_none(),
            Err(error) => {
                // Where no process can be started, libraries are loaded as they would be anyway.
                note(&format!("the plugins are not tried before ({error})"));
                return Ok(());
            }
        };
        if whole {
            return Ok(());
        }
        for path in &paths {
            // That this child could be started, and this one not, says nothing about the library.
            let Ok(end) = self.of(&[path]) else { continue };
            if let Some(how) = self.problem(&end) {
                return Err(LoadError::Refused {
                    path: path.to_path_buf(),
                    refusal: Refusal::FailedTrial { how },
                });
            }
        }
        Err(LoadError::NotTogether {
            paths: paths.into_iter().map(Path::to_owned).collect(),
        })
    }
}

/// What the child writes, byte by byte. A thread reads it, so that this process can wait for a byte
/// no longer than it likes.
fn signs(child: &mut Child) -> Receiver<u8> {
    let (send, receive) = mpsc::channel();
    if let Some(output) = child.stdout.take() {
        thread::spawn(move || {
            let bytes = output.bytes().map_while(Result::ok);
            // An error means that nobody waits any more.
            let _ = bytes.map(|byte| send.send(byte)).find(Result::is_err);
        });
    }
    receive
}

/// Ends a child, whatever it is at.
fn end(child: &mut Child) -> io::Result<()> {
    // It may have ended by itself.
    let _ = child.kill();
    child.wait().map(|_| ())
}

#[cfg(unix)]
fn how(status: &ExitStatus) -> String {
    use std::os::unix::process::ExitStatusExt;
    let name = |signal| match signal {
        libc::SIGABRT => "SIGABRT".to_owned(),
        libc::SIGBUS => "SIGBUS".to_owned(),
        libc::SIGFPE => "SIGFPE".to_owned(),
        libc::SIGILL => "SIGILL".to_owned(),
        libc::SIGSEGV => "SIGSEGV".to_owned(),
        other => format!("signal {other}"),
    };
    match status.signal() {
        Some(signal) => name(signal),
        None => "it calls exit".to_owned(),
    }
}

#[cfg(not(unix))]
fn how(status: &ExitStatus) -> String {
    status.to_string()
}

/// The child's part, if this process is one: loads the libraries of its arguments.
pub fn child() -> Option<ExitCode> {
    let limit = std::env::var(TRIAL).ok()?.parse().ok()?;
    let paths: Vec<PathBuf> = std::env::args_os().skip(1).map(OsString::into).collect();
    Some(match load(&paths, limit) {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) => ExitCode::FAILURE,
    })
}

fn load(paths: &[PathBuf], limit: TimeLimit) -> io::Result<()> {
    crash::leave_no_core();
    crash::take_output()?;
    // A child whose parent is gone ends too.
    crash::watch(limit);
    crash::answer_to(&[BEGUN])?;
    let mut catalogue = Catalogue::new();
    for path in paths {
        // The parent meets a refusal again, and says it.
        let _ = catalogue.add_file(path);
        crash::answer_to(&[NEXT])?;
    }
    Ok(())
}
