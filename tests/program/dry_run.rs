//! `--dry-run`: stops at the rim, and nothing near the part. The test reads the files by its own few
//! lines, apart from turnpath's readers.

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, changed};

/// Z of the plane above the rest of the path, mm, by default.
const APPROACH_HEIGHT: f64 = 5.0;
/// Half the step of 6.7 nm in which leads move for LinuxCNC, mm: by so much its path rests lower than the
/// table says, or higher.
const HALF_LEAD_STEP: f64 = 3.35e-6;

/// Where the axes stand at a stop: C, X, Z.
type Stop = [f64; 3];

/// The stops of a dry run, and the lowest Z of any of its moves.
fn stops(text: &str) -> (Vec<Stop>, f64) {
    let (mut at, mut stops, mut lowest) = ([f64::NAN; 3], Vec::new(), f64::INFINITY);
    for line in text.lines() {
        let code = line.split(';').next().unwrap_or_default();
        let code = code.split("//").next().unwrap_or_default().trim();
        if matches!(code, "STOP" | "M0" | "ProgramPause()") {
            stops.push(at);
        }
        let code = code
            .replace("MoveRapid([", "")
            .replace("], [", "")
            .replace("])", "");
        for word in code.split_whitespace() {
            let axis = ["C", "X", "Z"]
                .iter()
                .position(|axis| word.starts_with(axis));
            if let Some((axis, place)) = axis.zip(word.get(1..).and_then(|word| word.parse().ok()))
            {
                at[axis] = place;
                assert!(
                    axis == 2 || at[2].is_finite(),
                    "{line}: Z has not moved yet"
                );
                lowest = lowest.min(at[2]);
            }
        }
    }
    (stops, lowest)
}

/// The saddle with leads, with a program of every post. LinuxCNC plays its lines with a faster servo thread.
fn saddle(more: &str) -> String {
    let posts = "[output]\nposts = [\"pmac-pvt\", \"power-pmac-pvt\", \"automation1-pvt\", \"siemens-840d-poly\", \"beckhoff-poly\", \"beckhoff-g93\", \"nanotech-g93\", \"linuxcnc-g93\"]\n";
    let recipe = changed(SADDLE, "lead = false", "lead = true");
    let recipe = changed(
        &recipe,
        "k = \"0.08 /mm\"",
        "k = \"0.08 /mm\"\n\n[part.pose]\nx = \"0.5 mm\"",
    );
    let servo = "\n[output.linuxcnc-g93]\nservo_period = \"0.1 ms\"\n\n[output.nanotech-g93]\nf_means = \"s\"\n";
    format!("{recipe}\n{posts}{servo}{more}")
}

const FILES: [&str; 8] = [
    "recipe-dry-run.pmc",
    "recipe-dry-run.ppmc",
    "recipe-dry-run.ascript",
    "recipe-dry-run.mpf",
    "recipe-dry-run.ncp",
    "recipe-dry-run.cnc",
    "recipe-dry-run.nc",
    "recipe-dry-run.ngc",
];

/// The highest Z of the tip on the path, mm.
fn highest_tip(bench: &Bench) -> f64 {
    let table = bench.read("out/toolpath.csv");
    let z = table
        .lines()
        .skip(1)
        .filter_map(|row| row.split(',').nth(3));
    let highest = z
        .filter_map(|z| z.parse::<f64>().ok())
        .fold(f64::MIN, f64::max);
    highest - 1.0
}

#[test]
fn a_dry_run_stops_four_times_and_never_goes_below_the_clearance() {
    let bench = Bench::with(&saddle(""));
    bench.line("run recipe.toml -o out --dry-run").ends(0);
    let summary: serde_json::Value = serde_json::from_str(&bench.read("out/summary.json")).unwrap();
    let listed: Vec<&str> = summary["files"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|file| file["file"].as_str())
        .collect();
    let highest = highest_tip(&bench);
    for file in FILES {
        assert!(listed.contains(&file), "{listed:?}");
        let text = bench.read(format!("out/{file}"));
        let (stops, lowest) = stops(&text);
        let c: Vec<f64> = stops.iter().map(|stop| stop[0]).collect();
        assert_eq!(c, [0.0, 90.0, 180.0, 270.0], "{text}");
        assert!(stops.iter().all(|stop| stop[1] == 2.5), "{text}");
        let rounded = if file.ends_with(".ngc") {
            HALF_LEAD_STEP
        } else {
            0.0
        };
        let least = highest + APPROACH_HEIGHT - rounded;
        assert!(lowest >= least, "{file}: {lowest} {highest}");
    }
}

/// z = 0.16 (x + 0.5 mm) y: at the rim of 2.5 mm the height is 0.2 mm where y is 2.5 mm.
#[test]
fn a_dry_run_says_how_high_the_part_is_at_each_stop() {
    let bench = Bench::with(&saddle(""));
    bench.line("run recipe.toml -o out --dry-run").ends(0);
    for file in FILES {
        let text = bench.read(format!("out/{file}"));
        for says in [
            "C = 90 deg of the path: the part is 200.0 um higher than at C = 0",
            "C = 180 deg of the path: the part is as high as at C = 0",
            "C = 270 deg of the path: the part is 200.0 um lower than at C = 0",
        ] {
            assert!(text.contains(says), "{says}: {text}");
        }
    }
}

/// z = 0.16 x y is the same at all quarters of a turn, and 0.5 mm at 45 deg.
#[test]
fn a_part_that_is_alike_at_all_quarters_has_a_stop_that_shows_the_sense_of_c() {
    let recipe = saddle("").replace("\n\n[part.pose]\nx = \"0.5 mm\"", "");
    let bench = Bench::with(&recipe);
    bench.line("run recipe.toml -o out --dry-run").ends(0);
    for file in FILES {
        let text = bench.read(format!("out/{file}"));
        let (stops, _) = stops(&text);
        let c: Vec<f64> = stops.iter().map(|stop| stop[0]).collect();
        assert_eq!(c, [0.0, 45.0, 90.0, 180.0, 270.0], "{text}");
        let says = "C = 45 deg of the path: the part is 500.0 um higher than at C = 0";
        assert!(text.contains(says), "{text}");
        assert!(text.contains("it stops 5 times"), "{text}");
    }
}

#[test]
fn a_c_that_runs_against_the_paths_goes_the_other_way() {
    let turned = "\n[output.pmac-pvt]\nc_sign = -1\n\n[output.power-pmac-pvt]\nc_sign = -1\nc_wrap = \"0-360\"\n";
    let bench = Bench::with(&saddle(turned));
    bench.line("run recipe.toml -o out --dry-run").ends(0);
    let of = |file: &str| -> Vec<f64> {
        let (stops, _) = stops(&bench.read(format!("out/{file}")));
        stops.iter().map(|stop| stop[0]).collect()
    };
    assert_eq!(of(FILES[0]), [0.0, -90.0, -180.0, -270.0]);
    assert_eq!(of(FILES[1]), [0.0, 270.0, 180.0, 90.0]);
}

#[test]
fn a_run_without_the_option_has_no_dry_run_and_removes_an_old_one() {
    let bench = Bench::with(&saddle(""));
    bench.line("run recipe.toml -o out --dry-run").ends(0);
    assert!(bench.files().contains(&"out/recipe-dry-run.pmc".to_owned()));
    bench.line("run recipe.toml -o out").ends(0);
    assert!(!bench.files().iter().any(|file| file.contains("dry-run")));
}

#[test]
fn a_dry_run_of_no_program_is_refused() {
    let bench = Bench::with(SADDLE);
    let said = bench.line("run recipe.toml -o out --dry-run").ends(2);
    assert!(said.stderr.contains("write [output] posts"), "{said}");
    assert_eq!(bench.files(), ["recipe.toml"]);
}
