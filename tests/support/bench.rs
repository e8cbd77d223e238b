//! A folder in which a test calls the program, and the program's answer.

use std::ffi::OsStr;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

/// The program under test.
pub const TURNPATH: &str = env!("CARGO_BIN_EXE_turnpath");

/// A folder for a test's files, and another for temporary files, which the program must remove.
pub struct Bench {
    folder: TempDir,
    scratch: TempDir,
}

/// The end of a call: its status and what it printed.
pub struct Answer {
    /// The exit status; none when a signal ended the program.
    pub status: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Bench {
    /// An empty folder.
    pub fn empty() -> Self {
        let new = || tempfile::tempdir().expect("a temporary folder");
        Self {
            folder: new(),
            scratch: new(),
        }
    }

    /// A folder with `recipe.toml` in it.
    pub fn with(recipe: &str) -> Self {
        let bench = Self::empty();
        bench.write("recipe.toml", recipe);
        bench
    }

    /// A path in the folder.
    pub fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file in the folder.
    pub fn write(&self, name: &str, contents: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        fs::write(&path, contents).expect("a file in the temporary folder");
        path
    }

    /// Reads a text in the folder.
    pub fn read(&self, name: impl AsRef<Path>) -> String {
        let path = self.path(name);
        fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    /// All files below the folder, sorted.
    pub fn files(&self) -> Vec<String> {
        let mut found = Vec::new();
        gather(self.folder.path(), self.folder.path(), &mut found);
        found.sort();
        found
    }

    /// Whether the program has left no temporary file.
    pub fn scratch_is_empty(&self) -> bool {
        let mut entries = fs::read_dir(self.scratch.path()).expect("the scratch folder");
        entries.next().is_none()
    }

    /// A call of the program in the folder, not yet made.
    pub fn command<S: AsRef<OsStr>>(&self, args: impl IntoIterator<Item = S>) -> Command {
        self.command_of(TURNPATH.as_ref(), args)
    }

    /// A call of another build of the program in the folder, not yet made.
    pub fn command_of<S: AsRef<OsStr>>(
        &self,
        program: &Path,
        args: impl IntoIterator<Item = S>,
    ) -> Command {
        let mut command = Command::new(program);
        command
            .args(args)
            .current_dir(self.folder.path())
            .stdin(Stdio::null())
            .env("TMPDIR", self.scratch.path())
            .env_remove("TURNPATH_PLUGIN_PATH")
            .env_remove("COLUMNS");
        command
    }

    /// Calls the program in the folder.
    pub fn call<S: AsRef<OsStr>>(&self, args: impl IntoIterator<Item = S>) -> Answer {
        answer(&mut self.command(args))
    }

    /// Calls the program with the words of a line.
    pub fn line(&self, words: &str) -> Answer {
        self.call(words.split_whitespace())
    }

    /// An answer for a snapshot: status and messages, without this folder's name.
    pub fn shown(&self, said: &Answer) -> String {
        let folder = fs::canonicalize(self.folder.path()).expect("the folder");
        let status = said.status.map_or("none".to_owned(), |s| s.to_string());
        format!("exit {status}\n{}", said.stderr)
            .replace(&folder.display().to_string(), "[folder]")
            .replace(&self.folder.path().display().to_string(), "[folder]")
    }
}

/// Runs a command to its end.
pub fn answer(command: &mut Command) -> Answer {
    let output = command.output().expect("the program starts");
    output.into()
}

impl From<Output> for Answer {
    fn from(output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).expect("the program prints UTF-8");
        Self {
            status: output.status.code(),
            stdout: text(output.stdout),
            stderr: text(output.stderr),
        }
    }
}

impl Answer {
    /// The answer itself, if the call ended with this status; otherwise the test fails with it.
    #[track_caller]
    pub fn ends(self, status: i32) -> Self {
        assert_eq!(self.status, Some(status), "{self}");
        let of_a_panic = ["thread '", "panicked at", "RUST_BACKTRACE"];
        let found = of_a_panic.iter().any(|words| self.stderr.contains(words));
        assert!(!found, "{self}");
        self
    }

    /// Standard output as JSON.
    #[track_caller]
    pub fn json(&self) -> serde_json::Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|error| panic!("{error}\n{self}"))
    }
}

impl fmt::Display for Answer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            status,
            stdout,
            stderr,
        } = self;
        write!(f, "status {status:?}\n{stdout}\n{stderr}")
    }
}

fn gather(root: &Path, folder: &Path, found: &mut Vec<String>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            gather(root, &path, found);
        } else {
            let name = path.strip_prefix(root).expect("a path below the root");
            found.push(name.display().to_string());
        }
    }
}
