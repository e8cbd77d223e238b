//! Damaged files through the whole program: data files and programs that `verify` reads, summaries
//! beside them, records of an ablation, data files that a strategy reads, and lens designs.
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use turnpath_post::POST_NAMES;

use super::call::{Call, End, Outcome, Tally, try_all, words};
use super::damage::damaged;
use super::seeded::SeededNumbers;
use crate::fuzz;
use crate::support::bench::Bench;
use crate::support::fixtures::plugin_folder;
use crate::support::recipe::{SADDLE, saddle_with};
use crate::support::repository;

const SEED: u64 = 3_000_017;
/// Files of each kind in every run of the tests, and under `cargo xtask long`.
const CASES: u64 = 6;
const MANY_CASES: u64 = 500;

/// A kind of file: which it is, and the command that reads it.
struct Kind {
    name: &'static str,
    file: &'static str,
    words: &'static [&'static str],
    line: &'static str,
}

const CSV: Kind = Kind {
    name: "toolpath.csv",
    file: "out/toolpath.csv",
    words: fuzz::csv::WORDS,
    line: "verify recipe.toml out/toolpath.csv --format json --threads 2",
};
const PROGRAM: Kind = Kind {
    name: "program",
    file: "out/recipe.pmc",
    words: fuzz::pmac::WORDS,
    line: "verify recipe.toml out/recipe.pmc --format json --threads 2",
};
const POWER_PMAC: Kind = Kind {
    name: "program for Power PMAC",
    file: "out/recipe.ppmc",
    words: fuzz::pmac::WORDS,
    line: "verify recipe.toml out/recipe.ppmc --format json --threads 2",
};
const AUTOMATION1: Kind = Kind {
    name: "program for Automation1",
    file: "out/recipe.ascript",
    words: fuzz::pmac::WORDS,
    line: "verify recipe.toml out/recipe.ascript --format json --threads 2",
};
const SIEMENS: Kind = Kind {
    name: "program for Sinumerik 840D",
    file: "out/recipe.mpf",
    words: fuzz::pmac::WORDS,
    line: "verify recipe.toml out/recipe.mpf --format json --threads 2",
};
const BECKHOFF: Kind = Kind {
    name: "program for TwinCAT CNC",
    file: "out/recipe.cnc",
    words: fuzz::pmac::WORDS,
    line: "verify recipe.toml out/recipe.cnc --format json --threads 2",
};
const BECKHOFF_POLY: Kind = Kind {
    name: "program for TwinCAT CNC with polynomials",
    file: "out/recipe.ncp",
    words: fuzz::pmac::WORDS,
    line: "verify recipe.toml out/recipe.ncp --format json --threads 2",
};
const NANOTECH: Kind = Kind {
    name: "program for Nanotech machines",
    file: "out/recipe.nc",
    words: fuzz::pmac::WORDS,
    line: "verify recipe.toml out/recipe.nc --format json --threads 2",
};
const LINUXCNC: Kind = Kind {
    name: "program for LinuxCNC",
    file: "out/recipe.ngc",
    words: fuzz::pmac::WORDS,
    line: "verify recipe.toml out/recipe.ngc --format json --threads 2",
};
const COMPRESSED: Kind = Kind {
    name: "compressed program",
    file: "compressed/recipe.pmc.zst",
    words: fuzz::pmac::WORDS,
    line: "verify recipe.toml compressed/recipe.pmc.zst --format json --threads 2",
};
/// A program of each post.
const PROGRAMS: [&Kind; 8] = [
    &PROGRAM,
    &POWER_PMAC,
    &AUTOMATION1,
    &SIEMENS,
    &BECKHOFF_POLY,
    &BECKHOFF,
    &NANOTECH,
    &LINUXCNC,
];
const SUMMARY: Kind = Kind {
    name: "summary.json",
    file: "out/summary.json",
    words: fuzz::report::WORDS,
    line: "verify recipe.toml out/toolpath.csv --format json --threads 2",
};
const SUMMARY_UNDER_A_RUN: Kind = Kind {
    name: "summary.json of an earlier run",
    file: "out/summary.json",
    words: fuzz::report::WORDS,
    line: "run recipe.toml -o out --format json --threads 2",
};
const RECORD: Kind = Kind {
    name: "record",
    file: "ablation/runs/record.json",
    words: fuzz::report::WORDS,
    line: "ablate ablation.toml -o ablation --format json --threads 2",
};

/// A small part, its files, an ablation of two runs and its records: made once.
fn originals() -> &'static Path {
    static ORIGINALS: OnceLock<Bench> = OnceLock::new();
    let bench = ORIGINALS.get_or_init(|| {
        let coarse = "[tolerance]\ninterpolation = \"1 um\"\nresidual = \"5 um\"\n";
        let fine = "[tolerance]\ninterpolation = \"100 nm\"\nresidual = \"100 nm\"\n";
        let recipe = SADDLE
            .replace("\"5 mm\"", "\"0.6 mm\"")
            .replace(fine, coarse)
            .replace("lead = false", "lead = true")
            .replace("\"9 deg\"", "\"30 deg\"");
        let bench = Bench::empty();
        let posts = POST_NAMES.join("\", \"");
        bench.write(
            "recipe.toml",
            format!("{recipe}\n[output]\nposts = [\"{posts}\"]\nnanotech-g93.f_means = \"s\"\n"),
        );
        let lists = "[ablation]\ncompensator = [{ use = \"none\" }]\n";
        bench.write("ablation.toml", format!("{recipe}\n{lists}"));
        bench.line("run recipe.toml -o out").ends(0);
        let compressed = "run recipe.toml -o compressed --set output.compress=zst --no-report";
        bench.line(compressed).ends(0);
        bench.line("ablate ablation.toml -o ablation").ends(0);
        bench
    });
    let folder = bench.path("");
    static PATH: OnceLock<PathBuf> = OnceLock::new();
    PATH.get_or_init(|| folder)
}

/// The file's path in a folder. The name of a record is that of its key.
fn file_of(kind: &Kind, folder: &Path) -> PathBuf {
    let file = folder.join(kind.file);
    if !file.ends_with("record.json") {
        return file;
    }
    let runs = fs::read_dir(file.parent().expect("the records")).expect("the records");
    let mut records: Vec<PathBuf> = runs.flatten().map(|entry| entry.path()).collect();
    records.sort();
    records.first().expect("a record").clone()
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("a folder");
    for entry in fs::read_dir(from).expect("a folder").flatten() {
        let (path, copy) = (entry.path(), to.join(entry.file_name()));
        if path.is_dir() {
            self::copy(&path, &copy);
        } else {
            fs::copy(&path, &copy).expect("a copy");
        }
    }
}

fn outcome(kind: &Kind, bench: &Bench, case: u64) -> Outcome {
    let mut random = SeededNumbers::of_case(SEED, case);
    copy(originals(), &bench.path(""));
    let file = file_of(kind, &bench.path(""));
    let bytes = fs::read(&file).expect("the original");
    let bytes = damaged(&bytes, &bytes, kind.words, &mut random);
    fs::write(&file, &bytes).expect("the damaged file");
    let call = Call::new(bench, &words(kind.line));
    let complaint = call.complaint().or_else(|| {
        let documented = matches!(call.end, End::Status(0 | 1 | 4));
        (!documented).then(|| format!("neither measured nor refused: {call}"))
    });
    Outcome {
        end: call.end,
        complaint,
    }
}

fn try_kind(kind: &Kind, cases: u64) -> Tally {
    originals();
    try_all(kind.name, 0..cases, |bench, case| {
        outcome(kind, bench, case)
    })
}

#[test]
fn damaged_files_are_measured_or_refused() {
    let others = [&CSV, &COMPRESSED, &SUMMARY, &SUMMARY_UNDER_A_RUN, &RECORD];
    for kind in others.into_iter().chain(PROGRAMS) {
        try_kind(kind, CASES);
    }
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_five_hundred_damaged_files_of_each_kind_are_measured_or_refused() {
    for kind in [&CSV, &COMPRESSED].into_iter().chain(PROGRAMS) {
        let tally = try_kind(kind, MANY_CASES);
        let refused = tally.count(End::Status(4));
        assert!(refused > 50, "{}: few are refused: {tally}", kind.name);
    }
    for kind in [&SUMMARY, &SUMMARY_UNDER_A_RUN, &RECORD] {
        try_kind(kind, MANY_CASES);
    }
}

/// The strategy's own data file: the host hands its bytes over, whatever they are.
fn data_file_outcome(plugins: &Path, bench: &Bench, case: u64) -> Outcome {
    let mut random = SeededNumbers::of_case(SEED, case);
    let recipe = saddle_with("surface", "use = \"bowl-file\"\nfile = \"bowl.txt\"");
    bench.write("recipe.toml", recipe.replace("\"5 mm\"", "\"0.6 mm\""));
    let numbers = ["nan", "inf", "-1e300", "0", "1e-300", "\u{b5}", "1"];
    bench.write(
        "bowl.txt",
        damaged(b"-0.02\n", b"7.5e-3", &numbers, &mut random),
    );
    let mut args = words("run recipe.toml -o out --format json --threads 2 --plugin-dir");
    args.push(plugins.display().to_string());
    let call = Call::new(bench, &args);
    Outcome {
        end: call.end,
        complaint: call.complaint(),
    }
}

fn try_data_files(cases: u64) {
    let plugins = plugin_folder(&["bowl-file"]);
    try_all("data file", 0..cases, |bench, case| {
        data_file_outcome(plugins.path(), bench, case)
    });
}

#[test]
fn damaged_data_files_of_a_strategy_are_read_or_refused() {
    try_data_files(CASES);
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_five_hundred_damaged_data_files_of_a_strategy_are_read_or_refused() {
    try_data_files(MANY_CASES);
}

/// A lens design, and the recipe that `import` makes of it.
fn design_outcome(bench: &Bench, case: u64) -> Outcome {
    let mut random = SeededNumbers::of_case(SEED, case);
    let folder = repository().join("tests/reference/lens/files");
    let read = |name: &str| fs::read(folder.join(name)).expect("a design");
    let (first, second) = (read("zernike.zmx"), read("off-axis-asphere.zmx"));
    let bytes = damaged(&first, &second, fuzz::lens::WORDS, &mut random);
    bench.write("design.zmx", &bytes);
    let call = Call::new(bench, &words("import design.zmx -o recipe.toml"));
    let complaint = call.complaint().or_else(|| match call.end {
        End::Status(2) => None,
        // A recipe that is made is one that the program takes.
        End::Status(0) => {
            let check = Call::new(bench, &words("sag recipe.toml --grid 3 -o sag.csv"));
            let reads = matches!(check.end, End::Status(0 | 2));
            check
                .complaint()
                .or_else(|| (!reads).then(|| format!("not read: {check}")))
        }
        _ => Some(format!("neither imported nor refused: {call}")),
    });
    Outcome {
        end: call.end,
        complaint,
    }
}

#[test]
fn damaged_designs_are_imported_or_refused() {
    try_all("design", 0..CASES, design_outcome);
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_five_hundred_damaged_designs_are_imported_or_refused() {
    let tally = try_all("design", 0..MANY_CASES, design_outcome);
    let (made, refused) = (tally.count(End::Status(0)), tally.count(End::Status(2)));
    assert!(made > 10 && refused > 50, "{tally}");
}
