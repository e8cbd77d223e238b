//! Same recipe, same bytes: whatever the threads, the processor's features, and whether the
//! built-in plugins are linked in or loaded.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::OnceLock;

use crate::support::bench::{Bench, TURNPATH, answer};
use crate::support::builds::{
    BUILT_INS, bare_program, built_in_libraries, program_without_the_feature,
};
use crate::support::fixtures::file_name;
use crate::support::recipe::{SADDLE, saddle_with, with_table};
use serde_json::Value;

/// Revolutions of a block: a path with more is made in several.
const BLOCK: f64 = 64.0;

/// A name, a recipe, and `--set` arguments.
type Job = (&'static str, String, Vec<&'static str>);

/// Together they take every slot's built-ins, both
/// directions, a hole, refinement, and several blocks.
fn jobs() -> Vec<Job> {
    let waves = saddle_with(
        "surface",
        "use = \"sinusoidal-array\"\nform = \"sum\"\namplitude_x = \"5 um\"\namplitude_y = \
         \"5 um\"\nfrequency_x = \"0.4 /mm\"\nfrequency_y = \"0.4 /mm\"",
    );
    let analytic = saddle_with("velocity", "use = \"analytic\"");
    let normal = with_table(&analytic, "compensator", "use = \"normal\"");
    vec![
        ("saddle", SADDLE.to_owned(), vec!["sampler.step=20 deg"]),
        (
            "outward from a hole",
            SADDLE.to_owned(),
            vec!["path.direction=outward", "part.inner=1 mm"],
        ),
        ("waves", waves, vec!["tool.nose_radius=0.5mm"]),
        ("normal", normal, vec!["tool.nose_radius=0.2mm"]),
        (
            "FFT-adaptive",
            SADDLE.to_owned(),
            vec![
                "feed.use=fft-adaptive",
                "sampler={ use = \"fft-adaptive\" }",
            ],
        ),
        (
            "arcs",
            SADDLE.to_owned(),
            vec!["sampler={ use = \"integrated\", spacing = \"0.3 mm\" }"],
        ),
        (
            "ATS",
            SADDLE.to_owned(),
            vec!["feed.use=ats", "sampler={ use = \"ats\" }"],
        ),
    ]
}

/// Runs a job; `arrange` says how. Gives the tool path.
fn made(job: &Job, program: &Path, arrange: impl FnOnce(&mut Command)) -> (Bench, Vec<u8>) {
    let (name, recipe, sets) = job;
    let bench = Bench::with(recipe);
    let mut command = bench.command_of(program, ["run", "recipe.toml", "-o", "out"]);
    command.args(sets.iter().flat_map(|set| ["--set", set]));
    arrange(&mut command);
    let said = answer(&mut command);
    assert_eq!(said.status, Some(0), "{name}: {said}");
    let bytes = fs::read(bench.path("out/toolpath.csv")).unwrap();
    (bench, bytes)
}

fn linked(job: &Job, arrange: impl FnOnce(&mut Command)) -> Vec<u8> {
    made(job, TURNPATH.as_ref(), arrange).1
}

/// All jobs with their summaries and tool paths as the program makes them by itself, made once for all
/// tests.
fn references() -> &'static [Reference] {
    static REFERENCES: OnceLock<Vec<Reference>> = OnceLock::new();
    REFERENCES.get_or_init(|| {
        let made = |job: Job| {
            let (bench, bytes) = made(&job, TURNPATH.as_ref(), |_| ());
            let summary = summary(&bench);
            Reference {
                job,
                summary,
                bytes,
            }
        };
        jobs().into_iter().map(made).collect()
    })
}

/// A job as the program makes it by itself.
struct Reference {
    job: Job,
    summary: Value,
    bytes: Vec<u8>,
}

fn summary(bench: &Bench) -> Value {
    serde_json::from_str(&bench.read("out/summary.json")).unwrap()
}

#[test]
fn the_jobs_are_made_in_several_blocks_and_one_is_refined() {
    let mut added = 0;
    for Reference { job, summary, .. } in references() {
        let revolutions = summary["revolutions"].as_f64().unwrap();
        assert!(revolutions > BLOCK, "{}: {revolutions}", job.0);
        added += summary["points_added_by_refine"].as_u64().unwrap();
    }
    assert!(added > 0, "no job is refined");
}

#[test]
fn one_two_and_three_threads_give_the_same_bytes() {
    for job in &jobs() {
        let with = |threads: &str| {
            linked(job, |command| {
                command.args(["--threads", threads]);
            })
        };
        let one = with("1");
        assert!(one == with("2"), "{}: 2 threads", job.0);
        assert!(one == with("3"), "{}: 3 threads", job.0);
    }
}

#[test]
fn a_processor_without_fma_and_avx2_gives_the_same_bytes() {
    for Reference { job, bytes, .. } in references() {
        let lesser = linked(job, |command| {
            command.env("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-FMA,-AVX2,-FMA4");
        });
        assert!(*bytes == lesser, "{}", job.0);
    }
}

/// Of vector registers that the CPU lacks, the widest that it has take the place. The figures are the same
/// too: nothing that is measured rounds otherwise.
#[test]
fn vector_registers_of_every_width_give_the_same_bytes_and_figures() {
    for Reference {
        job,
        summary: figures,
        bytes,
    } in references()
    {
        for width in ["base", "avx2", "avx512"] {
            let (bench, others) = made(job, TURNPATH.as_ref(), |command| {
                command.env("TURNPATH_LANES", width);
            });
            assert!(*bytes == others, "{}: {width}", job.0);
            assert_eq!(*figures, summary(&bench), "{}: {width}", job.0);
        }
    }
}

/// A program without strategies inside makes the paths of the program that has them.
fn assert_loaded_is_linked(bare: &Path) {
    let libraries = built_in_libraries();
    for Reference { job, bytes, .. } in references() {
        let (_, loaded) = made(job, bare, |command| {
            command.arg("--plugin-dir").arg(libraries.path());
        });
        assert!(*bytes == loaded, "{}", job.0);
    }
}

#[test]
fn plugins_from_a_folder_give_the_same_bytes_as_those_inside() {
    assert_loaded_is_linked(bare_program());
}

/// The fast tests take a program whose catalogue is empty; here nothing is linked in.
#[test]
#[ignore = "builds the program once more; `cargo xtask long` runs it"]
fn long_the_program_without_its_feature_has_no_strategy_and_gives_the_same_bytes() {
    let bare = program_without_the_feature();
    let bench = Bench::empty();
    let list = answer(&mut bench.command_of(&bare, ["list", "sampler"])).ends(0);
    insta::assert_snapshot!("bare_list", list.stdout);
    assert_loaded_is_linked(&bare);
}

#[test]
fn the_plugin_path_serves_as_well_as_the_option() {
    let libraries = built_in_libraries();
    let empty = tempfile::tempdir().unwrap();
    let path = std::env::join_paths([empty.path(), libraries.path()]).unwrap();
    let Reference { job, bytes, .. } = &references()[0];
    let (_, loaded) = made(job, bare_program(), |command| {
        command.env("TURNPATH_PLUGIN_PATH", &path);
    });
    assert!(*bytes == loaded);
}

#[test]
fn the_summary_names_file_and_hash_of_every_plugin_that_was_loaded() {
    let libraries = built_in_libraries();
    let (bench, _) = made(&jobs()[0], bare_program(), |command| {
        command.arg("--plugin-dir").arg(libraries.path());
    });
    let summary = summary(&bench);
    let plugins = summary["plugins"].as_array().unwrap();
    let mut names: Vec<&str> = Vec::new();
    for plugin in plugins {
        let name = plugin["name"].as_str().unwrap();
        let file = libraries.path().join(file_name(name));
        let file = fs::canonicalize(file).unwrap();
        assert_eq!(plugin["file"].as_str(), file.to_str());
        let hash = turnpath_host::sha256_hex_of_file(&file).unwrap();
        assert_eq!(plugin["sha256"].as_str(), Some(hash.as_str()));
        names.push(name);
    }
    names.sort_unstable();
    let idle = [
        "turnpath-atpg",
        "turnpath-ats",
        "turnpath-fft-adaptive",
        "turnpath-formula",
        "turnpath-grid",
        "turnpath-minimax",
        "turnpath-polynomials",
        "turnpath-spindle",
    ];
    let used = BUILT_INS.into_iter().filter(|name| !idle.contains(name));
    assert!(names.into_iter().eq(used), "{plugins:?}");
}

#[test]
fn a_program_without_plugins_reports_how_to_give_them() {
    let bench = Bench::with(SADDLE);
    let list = answer(&mut bench.command_of(bare_program(), ["list", "sampler"])).ends(0);
    insta::assert_snapshot!("bare_list", list.stdout);
    let run = answer(&mut bench.command_of(bare_program(), ["run", "recipe.toml"])).ends(2);
    insta::assert_snapshot!("bare_run", bench.shown(&run));
}

#[test]
fn a_built_in_that_is_given_once_more_is_two_of_one_name() {
    let libraries = built_in_libraries();
    let bench = Bench::empty();
    let mut command = bench.command(["list"]);
    let said = answer(command.arg("--plugin-dir").arg(libraries.path())).ends(3);
    assert!(said.stderr.contains("(built in)"), "{said}");
    assert!(said.stderr.contains("leave one of the two out"), "{said}");
}
