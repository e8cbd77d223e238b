//! No output takes the place of a file that the same command reads, nor that of a file of another kind.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::process::Stdio;

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, changed};

/// The saddle's recipe, and one that takes its surface from a map of it.
fn bench() -> Bench {
    let bench = Bench::with(SADDLE);
    bench.line("sag recipe.toml --grid 25 -o map.gsf").ends(0);
    let map = "use = \"grid-sag\"\nfile = \"map.gsf\"\n";
    let surface = "use = \"astigmatic\"\nk = \"0.08 /mm\"\n";
    bench.write("mapped.toml", changed(SADDLE, surface, map));
    bench
}

#[track_caller]
fn assert_stays(bench: &Bench, file: &str, lines: &[&str], words: &str) {
    let before = std::fs::read(bench.path(file)).unwrap();
    for line in lines {
        let said = bench.line(line).ends(2);
        assert!(said.stderr.contains(words), "{line}: {said}");
        assert!(std::fs::read(bench.path(file)).unwrap() == before, "{line}");
    }
}

#[test]
fn a_run_and_verify_leave_the_map_that_the_recipe_reads() {
    let bench = bench();
    bench.line("check mapped.toml").ends(0);
    bench.line("run recipe.toml -o out").ends(0);
    let lines = [
        "run mapped.toml -o . --map map.gsf",
        "run mapped.toml -o new --map ../map.gsf",
        "run mapped.toml -o out --map ../map.gsf",
        "verify mapped.toml out/toolpath.csv --map map.gsf",
    ];
    assert_stays(&bench, "map.gsf", &lines, "is read here");
    #[cfg(unix)]
    {
        let link = bench.path("link.gsf");
        std::os::unix::fs::symlink(bench.path("map.gsf"), link).unwrap();
        let lines = ["run mapped.toml -o out --map ../link.gsf"];
        assert_stays(&bench, "map.gsf", &lines, "is read here");
    }
    bench
        .line("run mapped.toml -o new --map ../other.gsf")
        .ends(0);
    assert!(bench.path("other.gsf").is_file());
}

/// The result before lists the map, and the one that is made from it does not.
#[test]
fn a_run_leaves_the_map_of_the_result_that_it_replaces() {
    let bench = bench();
    let map = "file = \"out/m.gsf\"\nscale = 1e-4";
    let second = changed(&bench.read("mapped.toml"), "file = \"map.gsf\"", map);
    bench.write("second.toml", second);
    bench
        .line("run recipe.toml -o out --map m.gsf --map-size 40")
        .ends(0);
    bench.line("check second.toml").ends(0);
    bench.line("run second.toml -o out -q").ends(0);
    assert!(!bench.read("out/summary.json").contains("\"m.gsf\""));
    assert!(bench.path("out/m.gsf").is_file());
    bench.line("check second.toml").ends(0);
}

#[test]
fn a_result_does_not_replace_its_recipe_whatever_the_recipe_is_called() {
    let bench = Bench::empty();
    let recipe = format!("{SADDLE}\n[output]\nposts = [\"pmac-pvt\"]\n");
    for name in ["toolpath.csv", "summary.json", "report.html", "part.pmc"] {
        bench.write(name, &recipe);
        let line = format!("run {name} -o .");
        assert_stays(&bench, name, &[&line], "is read here");
        std::fs::remove_file(bench.path(name)).unwrap();
    }
}

#[test]
fn verify_leaves_the_files_of_a_result() {
    let bench = bench();
    bench
        .line("run recipe.toml -o out --map m.gsf --map-size 20")
        .ends(0);
    let lines = ["verify recipe.toml out/toolpath.csv --map m.gsf --map-size 30 -o out"];
    assert_stays(&bench, "out/m.gsf", &lines, "is a file of a result");
    bench
        .line("verify recipe.toml out/toolpath.csv --map other.gsf --map-size 30 -o out")
        .ends(0);
    bench.line("report out").ends(0);
}

#[test]
fn an_import_leaves_the_design() {
    let bench = Bench::empty();
    let design = include_str!("../../docs/recipes/telescope-mirror.zmx");
    bench.write("design.zmx", design);
    let lines = [
        "import design.zmx -o design.zmx --force",
        "import design.zmx -o ./design.zmx --force",
    ];
    assert_stays(&bench, "design.zmx", &lines, "is read here");
}

#[test]
fn a_lock_replaces_a_lock_alone() {
    let bench = Bench::with(SADDLE);
    let lines = ["list --lock=recipe.toml"];
    assert_stays(&bench, "recipe.toml", &lines, "is no lock of plugins");
    bench.line("list --lock=plugins.lock").ends(0);
    bench.line("list --lock=plugins.lock").ends(0);
}

/// More lines than a pipe holds.
#[test]
fn a_reader_of_a_surface_may_go() {
    let bench = Bench::with(SADDLE);
    let mut command = bench.command("sag recipe.toml --grid 300 -o -".split(' '));
    let mut child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let said = child.wait_with_output().unwrap();
    assert_eq!(
        said.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&said.stderr)
    );
}
