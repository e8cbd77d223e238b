//! Programs of straight lines: what their controller plays too fast is refused, and straight paths go
//! as they are.

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, changed};

/// A small flat part with a program for LinuxCNC, at 60 rpm and a feed.
fn flat(feed: &str) -> Bench {
    let recipe = SADDLE.replace("\"5 mm\"", "\"0.1 mm\"").replace(
        "use = \"constant\"",
        &format!("use = \"constant\"\nfeed = \"{feed}\""),
    );
    Bench::with(&format!("{recipe}\n[output]\nposts = [\"linuxcnc-g93\"]\n"))
}

const RUN: &str = "run recipe.toml -o out --set surface.k=1e-12/mm --set spindle.speed=60rpm";

#[test]
fn a_flat_part_at_60_rpm_and_1_um_a_turn_is_refused_with_its_place() {
    let bench = flat("1 um/rev");
    let said = bench.line(RUN).ends(2);
    insta::assert_snapshot!(bench.shown(&said));
    assert!(!bench.path("out").exists());
    // LinuxCNC from 2.9.0 on plays it.
    let newer = format!("{RUN} --set output.linuxcnc-g93.lowest_rate=0mm/min");
    bench.line(&newer).ends(0);
}

#[test]
fn a_path_of_straight_lines_is_carried_as_it_is() {
    let bench = flat("5 um/rev");
    let said = bench
        .line(&format!("{RUN} --set velocity.use=linear --format json"))
        .ends(0);
    let report = said.json();
    let program = &report["programs"][0];
    assert_eq!(program["straight_lines"]["per_segment"], 1.0);
    // So are its passes.
    assert!(program.get("residual").is_none(), "{program}");
    // Programs of cubics cannot carry it.
    let said = bench
        .line(&format!(
            "{RUN} --set velocity.use=linear --set output.posts=[\"linuxcnc-g93\",\"pmac-pvt\"]"
        ))
        .ends(2);
    assert!(said.stderr.contains("`pmac-pvt` cannot carry"), "{said}");
}

#[test]
fn a_flat_part_is_refused_where_its_feed_runs_out_with_leads_and_without() {
    let bench = flat("5 um/rev");
    for lead in [false, true] {
        let said = bench
            .line(&format!(
                "{RUN} --set path.lead={lead} --set path.overrun=contact"
            ))
            .ends(2);
        assert!(said.stderr.contains("no line below 0.1 mm/min"), "{said}");
        // The line is one of the cut, and not that of the lead before it.
        assert!(said.stderr.contains("at 0.00096 mm/min"), "{said}");
        assert!(!bench.path("out").exists());
    }
    for lead in [false, true] {
        bench
            .line(&format!("{RUN} --set path.lead={lead}").replace("-o out", &format!("-o {lead}")))
            .ends(0);
    }
}

/// A rough path leaves lines their share of its own tolerance, and not of the finishing path's.
#[test]
fn a_rough_path_leaves_straight_lines_their_share_of_its_own_tolerance() {
    let coarse = changed(SADDLE, "step = \"9 deg\"", "step = \"40 deg\"");
    let rough = "[passes.rough]\nallowance = \"30 um\"\ntolerance.interpolation = \"400 nm\"";
    let bench = Bench::with(&format!(
        "{coarse}\n{rough}\n\n[output]\nposts = [\"nanotech-g93\"]\nnanotech-g93.f_means = \"s\"\n"
    ));
    let report = bench
        .line("run recipe.toml -o out --format json")
        .ends(0)
        .json();
    let nm = |error: &serde_json::Value| error.as_f64().unwrap();
    for (path, program, tolerance) in [
        (
            &report["interpolation_error"]["max_nm"],
            &report["programs"][0],
            100.0,
        ),
        (
            &report["passes"][0]["interpolation_error_nm"],
            &report["passes"][0]["programs"][0],
            400.0,
        ),
    ] {
        // Half of it is the lines'. Refinement halves segments until the path holds the rest.
        let half = 0.5 * tolerance;
        assert!((0.5 * half..=half).contains(&nm(path)), "{path}");
        let played = nm(&program["interpolation_error_nm"]);
        assert!((half..=tolerance).contains(&played), "{program}");
        assert!(program["straight_lines"]["per_segment"].as_f64() > Some(1.0));
    }
}

/// A part with passes so far apart that the chords of X, which swings within the turn, move them apart by more
/// than the residual leaves.
const WIDE_PASSES: &str = r#"format = 1

[part]
aperture = "2 mm"

[surface]
use = "astigmatic"
k = "0.02 /mm"

[tool]
nose_radius = "1 mm"

[tolerance]
interpolation = "1 um"
residual = "500 nm"

[spindle]
speed = "200 rpm"

[feed]
use = "ats"

[sampler]
use = "atpg"

[compensator]
use = "z-direction"

[velocity]
use = "triangle-rotary"

[output]
posts = ["beckhoff-g93", "pmac-pvt"]
"#;

/// What a program of straight lines leaves is not what its path leaves. `run` says of it what `verify` says of
/// the file.
#[test]
fn straight_lines_that_move_passes_too_far_apart_exceed_the_residual_in_run_and_verify() {
    let bench = Bench::with(WIDE_PASSES);
    for (share, status) in [("0.5", 1), ("0.1", 0)] {
        let set = format!("--set output.beckhoff-g93.chord_share={share}");
        let run = format!("run recipe.toml -o out-{share} {set}");
        let report = bench
            .line(&format!("{run} --format json"))
            .ends(status)
            .json();
        assert_eq!(report["within"]["residual"], true, "{report}");
        assert_eq!(report["within"]["programs"], status == 0, "{report}");
        let [lines, cubics] = ["cnc", "pmc"].map(|end| {
            let file = format!("out-{share}/recipe.{end}");
            let verify = format!("verify recipe.toml {file} --format json {set}");
            let status = if end == "cnc" { status } else { 0 };
            bench.line(&verify).ends(status).json()
        });
        let [straight, cubic] = [0_usize, 1].map(|number| &report["programs"][number]);
        for key in ["residual", "coverage"] {
            let within = format!("within_{key}");
            assert_eq!(straight[key], lines[key], "{share}: {straight}");
            assert_eq!(straight[&within], lines["within"][key], "{share}");
            // The passes of a program of cubics are those of its path.
            assert_eq!(cubics["within"][key], true, "{share}");
            assert!(cubic.get(key).is_none(), "{cubic}");
            assert!(cubic.get(&within).is_none(), "{cubic}");
        }
        assert_eq!(straight["within_residual"], status == 0, "{straight}");
    }
    let said = bench.line("run recipe.toml -o out-0.5").ends(1);
    assert!(said.stdout.contains("EXCEEDED residual\n"), "{said}");
    assert!(said.stdout.contains("EXCEEDED coverage\n"), "{said}");
    assert!(
        said.stdout.contains("a smaller `chord_share`, so that"),
        "{said}"
    );
    let header = bench.read("out-0.5/recipe.cnc");
    assert!(header.contains("nm of 500.00 nm, coverage "), "{said}");
}

/// Nobody has a manual that says what F means on a Moore Nanotech, so no default stands for it.
#[test]
fn what_f_means_must_be_said() {
    let asked = format!("{SADDLE}\n[output]\nposts = [\"nanotech-g93\"]\n");
    let bench = Bench::with(&asked);
    let said = bench.line("run recipe.toml -o out").ends(2);
    let lacks = "the recipe lacks the table [output.nanotech-g93]";
    assert!(said.stderr.contains(lacks), "{said}");
    assert!(said.stderr.contains("f_means"), "{said}");
    let said = bench
        .line("check recipe.toml --set output.nanotech-g93.decimals=6")
        .ends(2);
    assert!(said.stderr.contains("lacks `f_means`"), "{said}");
    let seconds = "--set output.nanotech-g93.f_means=s";
    bench
        .line(&format!("run recipe.toml -o out {seconds}"))
        .ends(0);
    bench.write("recipe.toml", SADDLE);
    let said = bench
        .line("verify recipe.toml out/recipe.nc -o again")
        .ends(2);
    let unread = "a program of `nanotech-g93` cannot be read without `f_means`";
    assert!(said.stderr.contains(unread), "{said}");
    let verify = format!("verify recipe.toml out/recipe.nc -o again {seconds}");
    bench.line(&verify).ends(0);
}
