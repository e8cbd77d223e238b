//! `turnpath verify` on files that lost a part of their path: they are not whole, and the call ends
//! with status 1.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::sync::OnceLock;

use serde_json::{Value, json};

use crate::support::bench::{Answer, Bench};
use crate::support::recipe::{SADDLE, changed, saddle_with, with_table};

/// The saddle with leads and a program, made once.
fn made() -> &'static Bench {
    static MADE: OnceLock<Bench> = OnceLock::new();
    MADE.get_or_init(|| made_of(SADDLE, "[output]\nposts = [\"pmac-pvt\"]\n"))
}

fn made_of(recipe: &str, more: &str) -> Bench {
    let bench = Bench::with(&(changed(recipe, "lead = false", "lead = true") + more));
    bench.line("run recipe.toml -o out").ends(0);
    bench
}

fn lines(bench: &Bench, file: &str) -> Vec<String> {
    bench.read(file).lines().map(String::from).collect()
}

fn verify(bench: &Bench, name: &str, lines: &[String]) -> Answer {
    bench.write(name, lines.join("\n") + "\n");
    bench.line(&format!("verify recipe.toml {name} --format json"))
}

/// The file is not whole for these reasons alone, and all else holds.
#[track_caller]
fn not_whole(said: Answer, faults: &Value) {
    let verified = said.ends(1).json();
    assert_eq!(
        &verified["wholeness"]["faults"], faults,
        "{}",
        verified["within"]
    );
    assert_eq!(verified["within"]["whole"], false);
}

#[test]
fn a_file_as_it_was_written_is_whole() {
    for file in ["out/toolpath.csv", "out/recipe.pmc"] {
        let verified = made().line(&format!("verify recipe.toml {file} --format json"));
        let verified = verified.ends(0).json();
        assert_eq!(verified["wholeness"], json!({ "faults": [] }), "{file}");
        assert_eq!(verified["within"]["whole"], true, "{file}");
    }
}

#[test]
fn a_table_that_lost_its_last_rows_is_not_whole() {
    let whole = lines(made(), "out/toolpath.csv");
    for lost in [1, 2, 10, 50] {
        let kept = &whole[..whole.len() - lost];
        assert!(kept.last().unwrap().ends_with(",2"));
        not_whole(verify(made(), "tail.csv", kept), &json!(["ends_in_motion"]));
    }
}

#[test]
fn a_table_that_lost_its_first_rows_is_not_whole() {
    let whole = lines(made(), "out/toolpath.csv");
    for lost in [1, 2, 10, 50] {
        let kept = [&whole[..1], &whole[1 + lost..]].concat();
        assert!(kept[1].ends_with(",0"));
        not_whole(
            verify(made(), "head.csv", &kept),
            &json!(["begins_in_motion"]),
        );
    }
}

#[test]
fn a_table_without_a_lead_is_not_whole() {
    let whole = lines(made(), "out/toolpath.csv");
    for (section, fault) in [(",0", "no_lead_in"), (",2", "no_lead_out")] {
        let mut kept = whole.clone();
        kept.retain(|line| !line.ends_with(section));
        not_whole(verify(made(), "lead.csv", &kept), &json!([fault]));
    }
    let mut cut = whole;
    cut.retain(|line| line.ends_with(",1") || line.starts_with("time"));
    not_whole(
        verify(made(), "cut.csv", &cut),
        &json!(["no_lead_in", "no_lead_out"]),
    );
}

#[test]
fn a_path_that_ends_in_the_cut_is_not_whole() {
    let mut kept = lines(made(), "out/toolpath.csv");
    kept.truncate(kept.len() / 2);
    not_whole(verify(made(), "half.csv", &kept), &json!(["no_lead_out"]));
}

#[test]
fn straight_lines_have_sections_alone_and_lost_rows_are_warned_of() {
    let linear = changed(
        SADDLE,
        "interpolation = \"100 nm\"",
        "interpolation = \"2 um\"",
    );
    let linear = with_table(&linear, "velocity", "use = \"linear\"");
    let bench = made_of(&linear, "");
    let whole = lines(&bench, "out/toolpath.csv");
    let verified = verify(&bench, "whole.csv", &whole).ends(0).json();
    assert_eq!(verified["within"]["whole"], true);
    let mut kept = whole.clone();
    kept.retain(|line| !line.ends_with(",2"));
    not_whole(verify(&bench, "lead.csv", &kept), &json!(["no_lead_out"]));
    let verified = verify(&bench, "tail.csv", &whole[..whole.len() - 3])
        .ends(0)
        .json();
    assert_eq!(
        verified["anomalies"]["count"], 3,
        "{}",
        verified["anomalies"]
    );
    assert_eq!(verified["anomalies"]["places"][0]["kind"], "row_lost");
    assert_eq!(verified["anomalies"]["places"][0]["by_nm"], Value::Null);
}

#[test]
fn a_program_that_lost_its_last_moves_is_refused_or_not_whole() {
    let whole = lines(made(), "out/recipe.pmc");
    let is_move = |line: &String| line.starts_with('C') && line.contains(" X");
    let moves: Vec<usize> = (0..whole.len()).filter(|i| is_move(&whole[*i])).collect();
    let mut short = whole.clone();
    for line in moves.iter().rev().take(3) {
        short.remove(*line);
    }
    let said = verify(made(), "short.pmc", &short).ends(4);
    assert!(said.stderr.contains("but its end mark says"), "{said}");
    let (all, left) = (moves.len().to_string(), (moves.len() - 3).to_string());
    let mark = short
        .iter_mut()
        .find(|line| line.contains("end of path"))
        .unwrap();
    *mark = mark.replace(&all, &left);
    not_whole(
        verify(made(), "short.pmc", &short),
        &json!(["ends_in_motion"]),
    );
    let mut open = whole;
    open.retain(|line| !line.contains("end of path"));
    let said = verify(made(), "open.pmc", &open).ends(4);
    assert!(said.stderr.contains("it is not complete"), "{said}");
}

/// Layouts of a program in which positions and velocities are read back differently.
#[test]
fn a_program_of_any_layout_is_whole_and_as_the_recipe_gives_it() {
    for layout in [
        "c_wrap = \"0-360\"",
        "c_sign = -1\nc_wrap = \"0-360\"\npositioning = \"incremental\"",
        "positioning = \"incremental\"",
        "velocity_per = \"min\"",
        "position_decimals = 5\nvelocity_decimals = 4",
    ] {
        let analytic = saddle_with("velocity", "use = \"analytic\"");
        let more = format!(
            "[output]\nposts = [\"pmac-pvt\"]\nz_reference = \"centre\"\n[output.pmac-pvt]\n{layout}\n"
        );
        let recipe = changed(&analytic, "aperture = \"5 mm\"", "aperture = \"1 mm\"");
        let bench = Bench::with(&(changed(&recipe, "lead = false", "lead = true") + &more));
        let run = bench.line("run recipe.toml -o out");
        assert!(matches!(run.status, Some(0 | 1)), "{layout}: {run}");
        let said = bench.line("verify recipe.toml out/recipe.pmc --format json");
        let verified = said.json();
        assert_eq!(
            verified["within"]["whole"], true,
            "{layout}: {}",
            verified["wholeness"]
        );
        let anomalies = &verified["anomalies"];
        assert_eq!(
            anomalies["compared_with"], "recipe",
            "{layout}: {anomalies}"
        );
        assert_eq!(anomalies["count"], 0, "{layout}: {anomalies}");
    }
}

/// A path without leads begins and ends in motion: the file itself does not show what it lost.
#[test]
fn of_a_path_without_leads_the_rows_of_the_recipe_show_what_is_lost() {
    let bench = Bench::with(SADDLE);
    bench.line("run recipe.toml -o out").ends(0);
    let whole = lines(&bench, "out/toolpath.csv");
    let kept = [&whole[..1], &whole[3..whole.len() - 5]].concat();
    let verified = verify(&bench, "cut.csv", &kept).json();
    assert_eq!(verified["wholeness"], Value::Null);
    assert_eq!(verified["within"].get("whole"), None);
    assert_eq!(
        verified["anomalies"]["count"], 7,
        "{}",
        verified["anomalies"]
    );
    let kinds = verified["anomalies"]["places"].as_array().unwrap();
    assert!(kinds.iter().all(|place| place["kind"] == "row_lost"));
    // A turn and more is lost at the rim: the reach shows it, and the call ends with 1.
    let kept = [&whole[..1], &whole[81..]].concat();
    let verified = verify(&bench, "rim.csv", &kept).ends(1).json();
    assert_eq!(verified["within"]["reach"], false);
}

#[test]
fn the_text_says_why_a_file_is_not_whole() {
    let whole = lines(made(), "out/toolpath.csv");
    made().write("tail.csv", whole[..whole.len() - 4].join("\n") + "\n");
    let said = made().line("verify recipe.toml tail.csv").ends(1);
    let line = "  whole           NOT WHOLE: the last row is in motion, but a lead-out ends at rest: rows \
                after it are missing\n";
    assert!(said.stdout.contains(line), "{said}");
    let said = made().line("verify recipe.toml out/toolpath.csv").ends(0);
    assert!(
        said.stdout
            .contains("  whole           from lead-in to lead-out; holds\n"),
        "{said}"
    );
}
