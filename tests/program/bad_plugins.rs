//! Plugins that misbehave: exit status 3, a message that names the plugin, and no file left behind.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;

use crate::support::bench::{Answer, Bench, answer};
use crate::support::bench_with_plugins::{bench, refused};
use crate::support::fixtures::{file_name, library, plugin_folder};
use crate::support::recipe::{SADDLE, changed, saddle_with, with_table};
use crate::support::repository;
use tempfile::TempDir;

/// The same with a sampler of a fixture in the saddle's recipe.
#[track_caller]
fn refused_sampler(fixture: &str, name: &str) -> String {
    refused_strategy(fixture, "sampler", name)
}

#[track_caller]
fn refused_strategy(fixture: &str, slot: &str, name: &str) -> String {
    let recipe = saddle_with(slot, &format!("use = \"{name}\""));
    let bench = bench(&recipe, &[fixture]);
    let said = refused(&bench);
    assert!(said.stderr.contains(&format!("`{name}`")), "{said}");
    assert!(said.stderr.contains(&file_name(fixture)), "{said}");
    shown(&bench, &said)
}

/// The text without a panic's line and column.
fn without_lines(text: &str) -> String {
    let Some((before, after)) = text.split_once("lib.rs:") else {
        return text.to_owned();
    };
    let rest = after.trim_start_matches(|c: char| c.is_ascii_digit() || c == ':');
    format!("{before}lib.rs{rest}")
}

/// The text without the versions of the fixtures and of the plugin boundary: a release changes no
/// snapshot.
fn shown(bench: &Bench, said: &Answer) -> String {
    let text = without_lines(&bench.shown(said));
    let boundary = version("crates/plugin/Cargo.toml", "/package/version");
    let (major_minor, _) = boundary.rsplit_once('.').unwrap();
    let fixtures = version("tests/fixtures/Cargo.toml", "/workspace/package/version");
    let requirement = format!("turnpath-plugin {major_minor}\n");
    text.replace(&fixtures, "[version]")
        .replace(&boundary, "[version]")
        .replace(&requirement, "turnpath-plugin [version]\n")
}

/// The version in a manifest of the repository.
fn version(manifest: &str, pointer: &str) -> String {
    let text = fs::read_to_string(repository().join(manifest)).unwrap();
    let manifest: serde_json::Value = toml::from_str(&text).unwrap();
    manifest
        .pointer(pointer)
        .unwrap()
        .as_str()
        .unwrap()
        .to_owned()
}

#[test]
fn a_panic_in_a_constructor() {
    insta::assert_snapshot!(refused_sampler("panics", "panics-in-constructor"));
}

#[test]
fn a_panic_in_a_constructor_with_a_value_that_panics_when_dropped() {
    insta::assert_snapshot!(refused_sampler("panics", "panics-twice"));
}

#[test]
fn a_panic_in_a_call() {
    insta::assert_snapshot!(refused_sampler("panics", "panics-in-call"));
}

#[test]
fn a_sampler_with_nodes_that_are_no_numbers() {
    insta::assert_snapshot!(refused_sampler("nan", "returns-nan"));
}

#[test]
fn a_sampler_whose_nodes_lie_too_far_off_the_locus() {
    let recipe = saddle_with("sampler", "use = \"too-far\"");
    let recipe = with_table(&recipe, "velocity", "use = \"analytic\"");
    let bench = bench(&recipe, &["two-speeds"]);
    let said = refused(&bench);
    insta::assert_snapshot!(shown(&bench, &said));
}

/// A refusal of a spindle strategy of the fixture.
#[track_caller]
fn refused_spindle(name: &str) -> String {
    let recipe = saddle_with("spindle", &format!("use = \"{name}\"\nspeed = \"500 rpm\""));
    let bench = bench(&recipe, &["two-speeds"]);
    let said = refused(&bench);
    shown(&bench, &said)
}

#[test]
fn a_spindle_whose_time_falls() {
    insta::assert_snapshot!(refused_spindle("backwards"));
}

#[test]
fn a_spindle_whose_speed_jumps() {
    insta::assert_snapshot!(refused_spindle("jumps"));
}

/// The recipe asks for both, so it is the recipe that is wrong.
#[test]
fn a_sampler_that_needs_exact_rates_with_a_solver_that_gives_none() {
    let bench = bench(&saddle_with("sampler", "use = \"wavy\""), &["two-speeds"]);
    let said = bench
        .line("run recipe.toml -o out --plugin-dir plugins")
        .ends(2);
    insta::assert_snapshot!(bench.shown(&said));
    let said = bench.line("check recipe.toml --plugin-dir plugins").ends(2);
    assert!(said.stderr.contains("`wavy` needs exact rates"), "{said}");
}

#[test]
fn a_surface_without_height_on_the_whole_ring_of_the_part() {
    let recipe = saddle_with("surface", "use = \"nan-surface\"");
    let recipe = changed(&recipe, "[part]\n", "[part]\ninner = \"3 mm\"\n");
    let bench = bench(&recipe, &["nan"]);
    insta::assert_snapshot!(shown(&bench, &refused(&bench)));
}

#[test]
fn a_surface_without_height_near_the_rim_asks_for_a_smaller_aperture() {
    let recipe = saddle_with("surface", "use = \"nan-surface\"");
    let bench = bench(&recipe, &["nan"]);
    let said = bench.line("run recipe.toml -o out --plugin-dir plugins");
    let said = said.ends(2);
    assert!(!bench.path("out").exists());
    insta::assert_snapshot!(shown(&bench, &said));
}

#[test]
fn a_velocity_solver_without_numbers() {
    insta::assert_snapshot!(refused_strategy("nan", "velocity", "nan-velocity"));
}

#[test]
fn a_sampler_with_nodes_that_decrease() {
    insta::assert_snapshot!(refused_sampler("unordered", "decreasing-nodes"));
}

#[test]
fn a_sampler_without_nodes() {
    insta::assert_snapshot!(refused_sampler("unordered", "too-few"));
}

#[test]
fn a_sampler_with_nodes_outside_its_block() {
    insta::assert_snapshot!(refused_sampler("unordered", "outside-block"));
}

#[test]
fn a_panic_while_a_path_is_being_written_over_another_leaves_the_other() {
    let bench = bench(SADDLE, &["panics"]);
    bench.line("run recipe.toml -o out").ends(0);
    let (files, path) = (bench.files(), bench.read("out/toolpath.csv"));
    bench.write(
        "recipe.toml",
        saddle_with("sampler", "use = \"panics-in-call\""),
    );
    bench
        .line("run recipe.toml -o out --plugin-dir plugins")
        .ends(3);
    assert_eq!(bench.files(), files);
    assert_eq!(bench.read("out/toolpath.csv"), path);
}

#[test]
fn two_plugins_with_a_strategy_of_one_name() {
    let bench = bench(SADDLE, &["twins-a", "twins-b"]);
    let said = refused(&bench);
    for fixture in ["twins-a", "twins-b"] {
        assert!(said.stderr.contains(&file_name(fixture)), "{said}");
    }
    insta::assert_snapshot!(shown(&bench, &said));
}

#[test]
fn a_plugin_for_another_version_of_the_boundary() {
    let bench = bench(SADDLE, &["other-version"]);
    insta::assert_snapshot!(shown(&bench, &refused(&bench)));
}

#[test]
fn a_library_that_is_cut_short_at_whatever_length() {
    let whole = fs::read(library("constant-arc")).unwrap();
    let bench = bench(SADDLE, &[]);
    let name = format!("plugins/{}", file_name("constant-arc"));
    for parts in [1, 3, 5, 7] {
        bench.write(&name, &whole[..whole.len() * parts / 8]);
        let said = refused(&bench);
        assert!(said.stderr.contains("the file is cut short"), "{said}");
    }
    bench.write(&name, &whole[..whole.len() / 2]);
    insta::assert_snapshot!(shown(&bench, &refused(&bench)));
}

#[test]
fn a_text_file_that_is_named_like_a_library() {
    let bench = bench(SADDLE, &[]);
    bench.write(
        &format!("plugins/{}", file_name("notes")),
        "not a library\n",
    );
    insta::assert_snapshot!(shown(&bench, &refused(&bench)));
}

#[test]
fn an_empty_file_that_is_named_like_a_library() {
    let bench = bench(SADDLE, &[]);
    bench.write(&format!("plugins/{}", file_name("empty")), "");
    insta::assert_snapshot!(shown(&bench, &refused(&bench)));
}

#[test]
fn a_library_that_is_no_plugin() {
    let bench = bench(SADDLE, &["foreign"]);
    insta::assert_snapshot!(shown(&bench, &refused(&bench)));
}

#[test]
fn a_plugin_folder_that_does_not_exist() {
    let bench = Bench::with(SADDLE);
    let said = bench.line("run recipe.toml -o out --plugin-dir plugins");
    assert_eq!(bench.files(), ["recipe.toml"]);
    insta::assert_snapshot!(shown(&bench, &said.ends(2)));
}

/// Only messages about layouts have details; the tests of `cli/src/failure.rs` show them.
#[test]
fn other_refusals_are_as_short_with_the_flag_for_layouts() {
    let bench = bench(SADDLE, &["other-version"]);
    let words = "list --plugin-dir plugins --layout-details";
    let (short, long) = (
        bench.line("list --plugin-dir plugins").ends(3),
        bench.line(words).ends(3),
    );
    assert_eq!(short.stderr, long.stderr);
}

#[test]
fn other_files_in_a_plugin_folder_are_ignored() {
    let bench = bench(SADDLE, &["constant-arc"]);
    bench.write("plugins/README.md", "what these are");
    bench.write("plugins/libold.so.bak", "not a library");
    fs::create_dir(bench.path("plugins/libfolder.so")).unwrap();
    bench.line("run recipe.toml --plugin-dir plugins").ends(0);
}

#[test]
fn a_plugin_whose_parameter_has_a_name_of_the_host() {
    insta::assert_snapshot!(refused_sampler("host-keys", "hasty"));
}

#[test]
fn a_plugin_with_a_name_that_no_recipe_could_choose() {
    let bench = bench(SADDLE, &["unusable-name"]);
    let said = refused(&bench);
    insta::assert_snapshot!(shown(&bench, &said));
}

#[test]
fn list_and_explain_fail_by_a_bad_plugin_too() {
    let bench = bench(SADDLE, &["foreign"]);
    bench.line("list --plugin-dir plugins").ends(3);
    bench
        .line("explain equal-angle --plugin-dir plugins")
        .ends(3);
}

#[test]
fn a_plugin_that_is_listed_twice_is_loaded_once() {
    let folder: TempDir = plugin_folder(&["constant-arc"]);
    let dir = folder.path().to_str().unwrap();
    let bench = Bench::empty();
    let said = bench.call(["list", "sampler", "--plugin-dir", dir, "--plugin-dir", dir]);
    let said = said.ends(0);
    assert_eq!(said.stdout.matches("constant-arc  ").count(), 1, "{said}");
}

#[test]
fn a_library_under_two_names_in_one_folder_is_loaded_once() {
    let bench = bench(SADDLE, &["constant-arc"]);
    let library = bench.path("plugins").join(file_name("constant-arc"));
    fs::copy(&library, library.with_file_name(file_name("same-arc"))).unwrap();
    let said = bench.line("list sampler --plugin-dir plugins").ends(0);
    assert_eq!(said.stdout.matches("constant-arc  ").count(), 1, "{said}");
}

/// `constant-arc` and `two-speeds` work; the program refuses `host-keys` once its code is loaded.
#[test]
fn among_plugins_that_work_the_one_that_is_refused_is_named_and_no_copy_is_left() {
    let bench = bench(SADDLE, &["constant-arc", "host-keys", "two-speeds"]);
    let said = bench.line("list --plugin-dir plugins").ends(3);
    assert!(said.stderr.contains(&file_name("host-keys")), "{said}");
    assert!(bench.scratch_is_empty(), "temporary files are left");
}

// Other systems take the folder for temporary files from elsewhere.
#[cfg(unix)]
#[test]
fn a_library_that_cannot_be_copied_is_named_with_the_folder_for_temporary_files() {
    let bench = bench(SADDLE, &["constant-arc"]);
    let mut call = bench.command(["list", "--plugin-dir", "plugins"]);
    let said = answer(call.env("TMPDIR", bench.path("not-there"))).ends(4);
    for part in [
        "cannot write a copy of",
        &file_name("constant-arc"),
        "not-there",
    ] {
        assert!(said.stderr.contains(part), "{said}");
    }
}

#[test]
fn a_panic_when_a_strategy_is_dropped_changes_no_result() {
    // It gives no node, so it fails for that reason and not for its drop.
    let text = refused_sampler("panics", "panics-in-drop");
    assert!(text.contains("no node"), "{text}");
}
