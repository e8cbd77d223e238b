//! Figures for papers, as a person asks for them: `--plot` of `run` and of `report`.

use std::fs;

use serde_json::Value;

use crate::support::bench::Bench;
use crate::support::recipe::SADDLE;

const FIGURES: [&str; 5] = ["map", "spiral", "feed", "axes", "spectrum"];

#[test]
fn a_run_draws_its_figures_as_files_of_the_result_on_any_number_of_threads() {
    let bench = Bench::with(SADDLE);
    let plots = FIGURES.map(|name| format!("--plot {name}.svg --plot {name}.png"));
    let run = |folder: &str, more: &str| {
        let plots = plots.join(" ");
        bench
            .line(&format!("run recipe.toml -o {folder} {plots} {more}"))
            .ends(0);
    };
    run("one", "--threads 1");
    run("two", "--threads 2 --no-report");
    let summary: Value = serde_json::from_str(&bench.read("one/summary.json")).unwrap();
    let files = summary["files"].as_array().unwrap();
    let listed: Vec<&str> = files
        .iter()
        .filter_map(|file| file["file"].as_str())
        .collect();
    for name in FIGURES {
        for ending in ["svg", "png"] {
            let file = format!("{name}.{ending}");
            assert!(listed.contains(&file.as_str()), "{file}: {listed:?}");
            let [one, two] = ["one", "two"].map(|folder| fs::read(bench.path(folder).join(&file)));
            assert!(one.unwrap() == two.unwrap(), "{file} has other bytes");
        }
    }
    let map = bench.read("one/map.svg");
    assert!(
        map.contains("width=\"85mm\" height=\"72mm\""),
        "{}",
        &map[..200]
    );
}

#[test]
fn a_result_gets_figures_later_of_any_size_and_keeps_its_own_files() {
    let bench = Bench::with(SADDLE);
    bench.line("run recipe.toml -o out --plot map.svg").ends(0);
    let said = bench
        .line(
            "report out --plot map=error.png --plot map=error.svg --plot-size 60x50 --plot-dpi 100",
        )
        .ends(0);
    assert!(said.stdout.contains("error.svg"), "{said}");
    let error = bench.read("out/error.svg");
    assert!(
        error.contains("width=\"60mm\" height=\"50mm\""),
        "{}",
        &error[..200]
    );
    let png = fs::read(bench.path("out/error.png")).unwrap();
    // 60 mm at 100 dots an inch: the width stands first in the header.
    assert_eq!(png[16..20], 236_u32.to_be_bytes());
    // What the summary lists keeps its bytes.
    let said = bench.line("report out --plot map.svg --plot-size 60x50");
    assert_eq!(said.status, Some(2), "{said}");
    assert!(said.stderr.contains("is a file of the result"), "{said}");
    bench.line("verify recipe.toml out/toolpath.csv").ends(0);
}

#[test]
fn what_cannot_be_drawn_is_refused_before_the_work() {
    let bench = Bench::with(SADDLE);
    for (words, says) in [
        (
            "--plot fig3.svg",
            "there are map, spiral, feed, axes, spectrum",
        ),
        ("--plot maps=a.svg", "there is no figure `maps`"),
        ("--plot map=a.pdf", "a plot ends in .svg or .png"),
        (
            "--plot map=a.svg --plot feed=a.svg",
            "two plots would be one file",
        ),
        (
            "--plot map.svg --plot-size 85",
            "give width and height in mm, such as 85x60",
        ),
        (
            "--plot map.svg --plot-size 2x60",
            "each side has 40 mm to 1200 mm",
        ),
        (
            "--plot axes.svg --plot-size 50x50",
            "the figure `axes` at 50 mm x 50 mm: it needs 60 mm x 45 mm at the least",
        ),
        ("--plot map.png --plot-dpi 9", "a PNG has 50 to 2400"),
        (
            "--plot map.png --plot-dpi 2400 --plot-size 1200x1200",
            "ask for fewer dots an inch",
        ),
        ("--plot-size 85x60", "--plot"),
    ] {
        let said = bench.line(&format!("run recipe.toml -o out {words}"));
        assert_eq!(said.status, Some(2), "{words}: {said}");
        assert!(said.stderr.contains(says), "{words}: {said}");
        assert!(!bench.path("out").exists(), "{words}");
    }
}
