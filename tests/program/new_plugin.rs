//! `turnpath new-plugin`, and what docs/plugins.md says to do with it: its commands are read from the
//! page and called in a clean folder outside of the repository.
#![allow(
    clippy::expect_used,
    clippy::unwrap_used,
    reason = "helpers of tests may panic too"
)]

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use crate::support::bench::{Answer, Bench, answer};
use crate::support::builds::{self, target_folder};
use crate::support::fixtures::file_name;
use crate::support::repository;

const SLOTS: [&str; 6] = [
    "surface",
    "feed",
    "sampler",
    "compensator",
    "velocity",
    "spindle",
];

/// The slot and the name of the page's own commands.
const PAGE_SLOT: &str = "sampler";
const PAGE_NAME: &str = "my-steps";

/// The commands of the page for a strategy of this slot.
fn commands(slot: &str, name: &str) -> Vec<String> {
    let page = fs::read_to_string(repository().join("docs/plugins.md")).unwrap();
    let (_, block) = page.split_once("```sh\n").expect("a block of commands");
    let (block, _) = block.split_once("```").unwrap();
    block
        .lines()
        .map(|line| line.replace(PAGE_NAME, name).replace(PAGE_SLOT, slot))
        .collect()
}

/// How cargo is called by the commands of the page.
#[derive(Clone, Copy, PartialEq)]
enum Build {
    /// As the page says, but for what is compiled, which the slots share.
    AsThePageSays,
    /// With what the fixtures have compiled, in their profile, and without `cargo test`: the tests of
    /// turnpath-plugin-test check the same strategy.
    WithTheFixtures,
}

/// Calls a command of the page in a folder of the bench.
fn call(bench: &Bench, folder: &Path, words: &[&str], build: Build) -> Answer {
    let (program, rest) = words.split_first().unwrap();
    let mut command = match *program {
        "turnpath" => bench.command(rest),
        "cargo" => bench.command_of(Path::new(env!("CARGO")), rest),
        other => panic!("the page calls `{other}`"),
    };
    if *program == "cargo" {
        of_cargo(&mut command, build);
    }
    answer(command.current_dir(folder))
}

fn of_cargo(command: &mut Command, build: Build) {
    let shared = match build {
        Build::AsThePageSays => target_folder("new-plugins"),
        Build::WithTheFixtures => {
            command
                .env("CARGO_PROFILE_DEV_OPT_LEVEL", "0")
                .env("CARGO_PROFILE_DEV_DEBUG", "0");
            builds::target()
        }
    };
    // Cargo hands these of the tests on, and an author has none of them.
    for name in ["CARGO_TARGET_DIR", "CARGO_BUILD_TARGET", "TMPDIR"] {
        command.env_remove(name);
    }
    command
        .env("CARGO_BUILD_BUILD_DIR", shared)
        .env("CARGO_NET_OFFLINE", "true")
        .arg("--quiet");
}

/// Does what the page says for a slot; gives the table of the ablation.
fn follow_the_page(bench: &Bench, slot: &str, name: &str, build: Build) -> String {
    let mut folder = bench.path("");
    let mut table = String::new();
    let mut called = Vec::new();
    for line in commands(slot, name) {
        let words: Vec<&str> = line.split_whitespace().collect();
        if words[0] == "cd" {
            folder = folder.join(words[1]);
            continue;
        }
        if build == Build::WithTheFixtures && words[..2] == ["cargo", "test"] {
            continue;
        }
        let said = call(bench, &folder, &words, build).ends(0);
        called.push(words[1].to_owned());
        match words[1] {
            "list" => assert!(said.stdout.contains(&format!("  {name} ")), "{said}"),
            "run" => assert!(said.stdout.contains(name), "{said}"),
            "ablate" => table = said.stdout,
            _ => {}
        }
    }
    for word in ["new-plugin", "build", "list", "run", "ablate"] {
        assert!(called.iter().any(|one| one == word), "{word}: {called:?}");
    }
    table
}

#[test]
fn a_new_sampler_is_a_row_of_the_comparison_by_the_commands_of_the_page() {
    let bench = Bench::empty();
    let table = follow_the_page(&bench, PAGE_SLOT, PAGE_NAME, Build::WithTheFixtures);
    for name in [PAGE_NAME, "equal-angle", "atpg", "minimax"] {
        assert!(table.contains(name), "{name}\n{table}");
    }
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_new_plugins_of_all_slots_are_rows_by_the_commands_of_the_page() {
    // Nothing is compiled yet for the first one, whose time is that of a newcomer.
    let _ = fs::remove_dir_all(target_folder("new-plugins"));
    let first = SLOTS.iter().position(|slot| *slot == PAGE_SLOT).unwrap();
    let mut slots = SLOTS;
    slots.swap(0, first);
    for slot in slots {
        let (bench, name, begin) = (Bench::empty(), format!("my-{slot}"), Instant::now());
        let table = follow_the_page(&bench, slot, &name, Build::AsThePageSays);
        let took = begin.elapsed();
        println!("{slot}: {:.1} s\n{table}", took.as_secs_f64());
        assert!(table.contains(&name), "{slot}\n{table}");
    }
}

/// What `new-plugin` writes for a slot.
#[test]
fn a_new_plugin_of_each_slot_has_its_files_and_checks_before_it_is_built() {
    let bench = Bench::empty();
    for slot in SLOTS {
        let name = format!("lab-{slot}");
        bench
            .call(["new-plugin", &name, "--slot", slot, "--dir", "labs"])
            .ends(0);
        let folder = format!("labs/{name}");
        let template = format!("crates/turnpath/templates/{slot}.rs");
        let template = fs::read_to_string(repository().join(template)).unwrap();
        let source = bench.read(format!("{folder}/src/lib.rs"));
        let differ = source.lines().zip(template.lines());
        let differ: Vec<&str> = differ
            .filter(|(one, other)| one != other)
            .map(|(one, _)| one.trim())
            .collect();
        assert!(
            differ.contains(&format!("const NAME: &'static str = \"{name}\";").as_str()),
            "{differ:?}"
        );
        assert!(differ.len() <= 2, "{differ:?}");
        assert_eq!(source.lines().count(), template.lines().count());
        let manifest = bench.read(format!("{folder}/Cargo.toml"));
        let manifest: toml::Table = manifest.parse().unwrap();
        let path = manifest["dependencies"]["turnpath-plugin"]["path"].as_str();
        assert!(Path::new(path.unwrap()).join("Cargo.toml").is_file());
        // The recipe asks for a strategy that is not there yet, and for nothing else that is wrong.
        let recipe = format!("{folder}/recipe.toml");
        let said = bench.call(["check", &recipe]).ends(2);
        assert!(said.stderr.contains(&format!("named `{name}`")), "{said}");
        assert_eq!(said.stderr.matches("error: ").count(), 1, "{said}");
    }
    assert!(bench.scratch_is_empty());
}

#[test]
fn crates_come_from_git_or_from_the_registry_where_the_call_says_so() {
    let bench = Bench::empty();
    for (name, crates, words) in [
        (
            "by-git",
            "https://lab.example/turnpath.git#v0.2.0",
            "turnpath-plugin = { git = \"https://lab.example/turnpath.git\", rev = \"v0.2.0\" }",
        ),
        ("by-version", "registry", "turnpath-plugin = \"0."),
    ] {
        bench
            .call(["new-plugin", name, "--slot", "feed", "--crates", crates])
            .ends(0);
        let manifest = bench.read(format!("{name}/Cargo.toml"));
        assert!(manifest.contains(words), "{manifest}");
        assert!(!bench.path(name).join("Cargo.lock").exists());
    }
}

#[test]
fn wrong_names_folders_and_sources_are_wrong_calls() {
    let bench = Bench::empty();
    fs::create_dir(bench.path("taken")).unwrap();
    let wrong = [
        "new-plugin My_Steps --slot sampler",
        "new-plugin match --slot sampler",
        "new-plugin turnpath-plugin --slot sampler",
        "new-plugin equal-angle --slot sampler",
        "new-plugin taken --slot sampler",
        "new-plugin steps --slot sampler --crates taken",
        "new-plugin steps --slot samplers",
    ];
    let said = wrong.map(|words| {
        let said = bench.line(words).ends(2);
        assert_eq!(said.stdout, "");
        format!("$ turnpath {words}\n{}", bench.shown(&said))
    });
    assert_eq!(bench.files(), Vec::<String>::new());
    let version = format!("turnpath-integrated {}", env!("CARGO_PKG_VERSION"));
    let text = said
        .join("\n")
        .replace(&version, "turnpath-integrated [version]");
    insta::assert_snapshot!(text);
}

#[test]
fn a_folder_that_takes_no_files_is_a_failure_of_files() {
    let bench = Bench::empty();
    bench.write("file", "");
    let said = bench.line("new-plugin steps --slot sampler --dir file");
    let said = said.ends(4);
    assert!(said.stderr.contains("file"), "{said}");
    assert_eq!(bench.files(), ["file"]);
}

#[test]
fn the_library_of_a_new_plugin_has_the_name_that_the_page_says() {
    let page = fs::read_to_string(repository().join("docs/plugins.md")).unwrap();
    let name = file_name(PAGE_NAME);
    assert!(page.contains(&name), "{name}");
}
