//! The child's part of a trial: it loads the libraries of its arguments, says how far it is, and ends
//! as a program does.

use std::ffi::OsString;
use std::io::{self, ErrorKind, Read};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::process::{Command, ExitCode};

use turnpath::Loadable;

use crate::background;
use crate::crash;
use crate::signals;

/// The variable that makes a child of this program. The arguments of a child are pairs: the symbol of a
/// library's entry, and the file that the loader is to get.
const TRIAL: &str = "TURNPATH_TRIAL_OF_PLUGINS";
/// The child is there.
pub const BEGUN: u8 = b'b';
/// The child has loaded, or refused, one more library.
pub const NEXT: u8 = b'n';
/// The child itself failed, and no library.
pub const FAILED: u8 = b'f';

/// The child's part, if this process is one.
pub fn child() -> Option<ExitCode> {
    std::env::var_os(TRIAL)?;
    let loaded = catch_unwind(AssertUnwindSafe(load));
    Some(match loaded {
        Ok(Ok(())) => ExitCode::SUCCESS,
        _ => {
            // If nobody hears of it, nobody waits.
            let _ = crash::answer_to(&[FAILED]);
            ExitCode::FAILURE
        }
    })
}

/// A child of this program that is to load these.
pub fn command<'a>(libraries: impl IntoIterator<Item = &'a Loadable>) -> io::Result<Command> {
    let mut command = Command::new(std::env::current_exe()?);
    command.env(TRIAL, "1");
    for library in libraries {
        command.arg(&library.symbol).arg(&library.file);
    }
    Ok(command)
}

fn load() -> io::Result<()> {
    crash::leave_no_core();
    crash::take_output()?;
    let libraries: Vec<Loadable> = libraries().collect();
    let copies = libraries.iter().map(|library| library.file.clone());
    end_with_parent(crash::take_input()?, copies.collect())?;
    signals::remove_drafts_on_signals();
    crash::answer_to(&[BEGUN])?;
    for library in libraries {
        // The parent meets a refusal again, and says it.
        library.try_load();
        crash::answer_to(&[NEXT])?;
    }
    Ok(())
}

/// Removes the parent's copies, which it cannot do any more.
fn remove_copies(files: &[PathBuf]) {
    // Each removal is tried: what is not there is gone already.
    for file in files {
        let _ = std::fs::remove_file(file);
    }
    for folder in files.iter().filter_map(|file| file.parent()) {
        let _ = std::fs::remove_dir(folder);
    }
}

/// The libraries of the arguments.
fn libraries() -> impl Iterator<Item = Loadable> {
    let mut args = std::env::args_os().skip(1);
    std::iter::from_fn(move || {
        let (symbol, file): (OsString, OsString) = args.next().zip(args.next())?;
        Some(Loadable {
            file: PathBuf::from(file),
            symbol: symbol.to_string_lossy().into_owned(),
        })
    })
}

/// Ends this process when the parent does: then `input` is at its end. The parent's copies of libraries go
/// with it.
fn end_with_parent(mut input: impl Read + Send + 'static, copies: Vec<PathBuf>) -> io::Result<()> {
    let wait = move || {
        let mut byte = [0];
        loop {
            match input.read(&mut byte) {
                Ok(read) if read > 0 => {}
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                _ => {
                    remove_copies(&copies);
                    crash::end_unheard()
                }
            }
        }
    };
    background::start("parent", wait)
}
