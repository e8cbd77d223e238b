//! The child's part of a trial: it loads the libraries of its arguments, says how far it is, and ends
//! as a program does.

use std::ffi::OsString;
use std::io::{self, ErrorKind, Read};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use turnpath::{Admission, Catalogue, LibraryFile, LoadError, Refusal};
use turnpath_files::{DraftKind, Registration};

use crate::background;
use crate::crash;
use crate::signals;

/// The variable that makes a child of this program. The arguments of a child are pairs: the SHA-256 of
/// a library, and its path.
pub const TRIAL: &str = "TURNPATH_TRIAL_OF_PLUGINS";
/// The child is there.
pub const BEGUN: u8 = b'b';
/// The child has loaded, or refused, one more library.
pub const NEXT: u8 = b'n';
/// The file of a library is not the one that was asked about.
pub const CHANGED: u8 = b'c';
/// The child itself failed, and no library.
pub const FAILED: u8 = b'f';

/// Loads only the bytes that the parent has read.
#[derive(Debug)]
struct SameBytes {
    sha256: String,
    /// Whether it had them before it.
    met: AtomicBool,
}

impl Admission for SameBytes {
    fn admit(&self, libraries: &[LibraryFile]) -> Result<(), LoadError> {
        match libraries
            .iter()
            .find(|library| library.sha256() != self.sha256)
        {
            Some(other) => Err(LoadError::Refused {
                path: other.path().to_owned(),
                refusal: Refusal::FailedTrial {
                    how: "its file changed".to_owned(),
                },
            }),
            None => {
                self.met.store(true, Ordering::Relaxed);
                Ok(())
            }
        }
    }
}

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

fn load() -> io::Result<()> {
    crash::leave_no_core();
    crash::take_output()?;
    end_with_parent(crash::take_input()?)?;
    signals::remove_drafts_on_signals();
    // The parent's folder for this child goes by whoever of the two lives longer.
    let folder = std::env::var_os("TMPDIR").map(PathBuf::from);
    let _scratch = folder.map(|folder| Registration::new(DraftKind::Folder, &folder));
    crash::answer_to(&[BEGUN])?;
    let mut args = std::env::args_os().skip(1);
    while let Some((sha256, path)) = args.next().zip(args.next()) {
        crash::answer_to(&[add(sha256, Path::new(&path))])?;
    }
    Ok(())
}

/// Loads a library, and gives the sign of how that went.
fn add(sha256: OsString, path: &Path) -> u8 {
    let same = Arc::new(SameBytes {
        sha256: sha256.to_string_lossy().into_owned(),
        met: AtomicBool::new(false),
    });
    let admission: Arc<dyn Admission> = same.clone();
    let mut catalogue = Catalogue::new().with_admission(admission);
    // The parent meets a refusal again, and says it.
    let _ = catalogue.add_file(path);
    match same.met.load(Ordering::Relaxed) {
        true => NEXT,
        false => CHANGED,
    }
}

/// Ends this process when the parent does: then `input` is at its end.
fn end_with_parent(mut input: impl Read + Send + 'static) -> io::Result<()> {
    let wait = move || {
        let mut byte = [0];
        loop {
            match input.read(&mut byte) {
                Ok(read) if read > 0 => {}
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                _ => crash::end_unheard(),
            }
        }
    };
    background::start("parent", wait)
}
