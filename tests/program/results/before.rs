//! A folder with a result, over which runs are spoilt.

use std::fs;
use std::path::Path;

use turnpath_files::ResultFolder;

use super::whole::{FolderState, entries, left_behind, state_of};
use super::{Bench, tiny};

/// The arguments of the new run. It has a profile and a map in another folder.
pub const RUN: &str = "run new.toml -o out --threads 1 --profile 45deg --map ../elsewhere/map.xyz \
                       --map-size 8";

/// How a spoilt run ended: which result is there after the next writer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum After {
    Old,
    New,
}

/// The result before: it has a circle, which the new one has not.
pub struct Before {
    bench: Bench,
    pub result: FolderState,
}

impl Before {
    /// A folder with the result.
    pub fn make() -> Self {
        let bench = Bench::with(&tiny());
        let words = "run recipe.toml -o out --circle 0.5mm --set spindle.speed=300rpm";
        bench.line(words).ends(0);
        let result = state_of(&bench.path("out"));
        assert!(matches!(result, FolderState::Result(_)), "{result:?}");
        Self { bench, result }
    }

    /// A folder in which a child runs over a copy of the result.
    pub fn copy(&self) -> Bench {
        let bench = Bench::empty();
        bench.write("new.toml", tiny());
        for folder in ["out", "elsewhere"] {
            fs::create_dir(bench.path(folder)).unwrap();
        }
        for name in entries(&self.bench.path("out")) {
            let from = self.bench.path("out").join(&name);
            fs::copy(from, bench.path("out").join(name)).unwrap();
        }
        bench
    }

    /// Checks a folder after a run over the result that was spoilt, and after the next writer: it has
    /// the result before or the new one, and nothing is left over. A summary always fits its files.
    /// Only where a commit is not complete there may be none, or still the one before: then the next
    /// writer gives the new one, and nowhere else anything but what was there.
    pub fn settle(&self, out: &Path, new: &FolderState, case: &str) -> After {
        let at_once = state_of(out);
        let has_commit = out.join(".turnpath/commit/summary.json").exists();
        let whole = at_once == self.result || at_once == *new;
        assert!(
            whole || (has_commit && at_once == FolderState::Nothing),
            "{case}: {at_once:?}"
        );
        drop(ResultFolder::open(out).unwrap());
        let after = state_of(out);
        let expected = if has_commit { new } else { &at_once };
        assert_eq!(after, *expected, "{case}: {at_once:?} before");
        assert_eq!(left_behind(out), Vec::<String>::new(), "{case}");
        match after == *new {
            true => After::New,
            false => After::Old,
        }
    }
}
