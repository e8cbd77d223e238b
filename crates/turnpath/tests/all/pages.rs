//! `report.html`: its data against the summary and against a profile, and how it comes and goes.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;
use std::path::Path;

use serde_json::Value;
use turnpath::report::{PathSketch, RunReport, Samples, unit};
use turnpath::{
    Catalogue, Error, Outputs, PageError, PageRequest, PlotRequest, SilentObserver, write_page,
};

use crate::support::job;

/// What `f32` and its unit change in a number.
const ROUNDING: f64 = 1e-6;

/// Runs the saddle with changes into a folder, with its page.
fn run(folder: &Path, sets: &[&str]) -> RunReport {
    let outputs = Outputs::in_folder(folder).with_page(true);
    job(sets).run(outputs, &SilentObserver).unwrap().report
}

/// The data in a page.
fn data(folder: &Path) -> Value {
    let page = fs::read_to_string(folder.join("report.html")).unwrap();
    let (_, after) = page.split_once("id=\"data\">").unwrap();
    serde_json::from_str(after.split_once("</script>").unwrap().0).unwrap()
}

fn sketch(folder: &Path) -> PathSketch {
    serde_json::from_value(data(folder)["sketch"].clone()).unwrap()
}

fn request(folder: &Path) -> PageRequest {
    PageRequest {
        folder: folder.to_owned(),
        recipe: None,
        drawings: Vec::new(),
    }
}

fn most(samples: &Samples) -> f64 {
    samples.range().unwrap().1
}

fn near(found: f64, expected: f64, share: f64, what: &str) {
    let off = (found - expected).abs();
    assert!(
        off <= share * expected.abs(),
        "{what}: {found}, not {expected}"
    );
}

#[test]
fn the_figures_of_the_page_are_those_of_the_summary() {
    let folder = tempfile::tempdir().unwrap();
    let report = run(folder.path(), &["path.lead=false"]);
    let (path, sketch) = (&report.path, sketch(folder.path()));
    let error = path.interpolation_error.max;
    near(
        most(&sketch.turns.errors),
        error,
        ROUNDING,
        "error of turns",
    );
    near(
        most(&sketch.spiral.errors),
        error,
        ROUNDING,
        "error of the spiral",
    );
    for (name, drawn, measured) in [
        ("x", &sketch.turns.x, &path.axes.x),
        ("z", &sketch.turns.z, &path.axes.z),
    ] {
        near(most(&drawn.velocity), measured.velocity.max, ROUNDING, name);
        near(
            most(&drawn.acceleration),
            measured.acceleration.max,
            ROUNDING,
            name,
        );
        near(most(&drawn.jerk), measured.jerk.max, ROUNDING, name);
    }
    let spokes = path.spokes.unwrap();
    let harmonics = &sketch.error.harmonics.0;
    let largest = (3..harmonics.len()).max_by(|a, b| harmonics[*a].total_cmp(&harmonics[*b]));
    assert_eq!(largest, Some(spokes.per_turn));
    near(
        harmonics[spokes.per_turn],
        spokes.amplitude,
        ROUNDING,
        "spokes",
    );
    let cusps = [
        most(&sketch.edges.residual),
        path.coverage.centre.unwrap().height.unwrap(),
    ];
    near(
        cusps[0].max(cusps[1]),
        path.residual.max.unwrap(),
        ROUNDING,
        "residual",
    );
    let rim = path.coverage.rim.unwrap().height.unwrap();
    assert!(
        most(&sketch.edges.rim) <= rim * (1.0 + ROUNDING) && most(&sketch.edges.rim) > 0.5 * rim
    );
    let speed = report.path.cutting_speed.unwrap();
    near(
        most(&sketch.turns.spindle),
        speed.spindle_most,
        1e-3,
        "spindle",
    );
    let points = sketch.turns.points_per_turn.0.iter().sum::<f64>();
    near(points, report.control_points as f64, 0.02, "points");
}

#[test]
fn the_map_and_the_radial_mean_have_the_mean_of_the_machined_surface() {
    let folder = tempfile::tempdir().unwrap();
    let report = run(folder.path(), &[]);
    let (sketch, surface) = (sketch(folder.path()), report.path.surface_error.unwrap());
    let mean = sketch.error.radial_mean.unwrap();
    let weighted = mean
        .radius
        .0
        .iter()
        .zip(&mean.errors.0)
        .map(|(r, error)| r * error);
    let area: f64 = mean.radius.0.iter().sum();
    near(
        weighted.sum::<f64>() / area,
        surface.mean,
        1e-3,
        "radial mean",
    );
    let map = sketch.error.map.unwrap();
    assert_eq!(
        (map.cells, map.half, map.errors.0.len()),
        (300, 2.5, 300 * 300)
    );
    let known: Vec<f64> = map
        .errors
        .0
        .iter()
        .copied()
        .filter(|error| !error.is_nan())
        .collect();
    near(
        known.len() as f64,
        std::f64::consts::PI * 150.0 * 150.0,
        0.01,
        "cells",
    );
    near(
        known.iter().sum::<f64>() / known.len() as f64,
        surface.mean,
        0.01,
        "map",
    );
    let (low, high) = map.errors.range().unwrap();
    assert!(surface.lowest.error <= low && high <= surface.highest.error);
}

/// The profile is drawn from the path's file, by its own code, at 16 points a pass.
#[test]
fn the_profile_of_the_page_is_the_mean_of_the_one_that_is_drawn() {
    let folder = tempfile::tempdir().unwrap();
    // A feed as narrow as a ring.
    let sets = ["path.lead=false", "tolerance.residual=\"20 nm\""];
    run(folder.path(), &sets);
    let profile = sketch(folder.path()).profiles.remove(0);
    let plots = PlotRequest {
        profiles: vec![profile.angle],
        ..PlotRequest::default()
    };
    let other = tempfile::tempdir().unwrap();
    let outputs = Outputs::in_folder(other.path()).with_plots(plots);
    let result = job(&sets).run(outputs, &SilentObserver).unwrap();
    let file = result.files.iter().find(|file| {
        let name = file.file_name().unwrap().to_string_lossy();
        name.starts_with("profile-") && !name.contains("spectrum")
    });
    let table = fs::read_to_string(file.unwrap()).unwrap();
    let cells = |line: &str| -> (f64, f64) {
        let mut cells = line.split(',').map(|cell| cell.parse::<f64>().unwrap());
        (cells.next().unwrap(), cells.next().unwrap() / unit::nm::PER)
    };
    let drawn: Vec<(f64, f64)> = table.lines().skip(1).map(cells).collect();
    let half = 0.5 * (profile.s.0[1] - profile.s.0[0]);
    let (low, high) = profile.errors.range().unwrap();
    let mut squares = Vec::new();
    for (s, error) in profile.s.0.iter().zip(&profile.errors.0) {
        let inside = drawn.iter().filter(|(at, _)| (at - s).abs() <= half);
        let (sum, count) = inside.fold((0.0, 0.0), |(sum, count), (_, e)| (sum + e, count + 1.0));
        assert!(count > 3.0, "{count} points at {s}");
        // The ends of a ring cut a pass, and the two means weigh its parts differently.
        let off = (sum / count - error) / (high - low);
        assert!(off.abs() < 0.25, "at {s}: {error}, not {}", sum / count);
        squares.push(off * off);
    }
    let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    assert!(rms < 0.05, "{rms}");
    let compared = squares.len();
    assert_eq!(compared, 384);
}

#[test]
fn a_page_that_is_made_again_shows_the_same() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &["path.lead=true"]);
    let before = data(folder.path());
    let first = sketch(folder.path());
    fs::remove_file(folder.path().join("report.html")).unwrap();
    let catalogue = Catalogue::linked().unwrap();
    let page = write_page(&request(folder.path()), &catalogue, &SilentObserver).unwrap();
    assert_eq!(page, [folder.path().join("report.html")]);
    let (after, again) = (data(folder.path()), sketch(folder.path()));
    assert_eq!(
        (&before["report"], &before["surface"]),
        (&after["report"], &after["surface"])
    );
    let pairs = [
        (&first.turns.feed, &again.turns.feed),
        (&first.turns.errors, &again.turns.errors),
        (&first.error.harmonics, &again.error.harmonics),
        (&first.edges.residual, &again.edges.residual),
        (&first.edges.rim, &again.edges.rim),
        (&first.spiral.x, &again.spiral.x),
        (&first.profiles[1].errors, &again.profiles[1].errors),
    ];
    for (one, other) in pairs {
        assert_eq!(one.0.len(), other.0.len());
        let scale = most(one);
        for (one, other) in one.0.iter().zip(&other.0) {
            assert!(
                (one - other).abs() <= ROUNDING * scale,
                "{one}, not {other}"
            );
        }
    }
}

#[test]
fn a_path_without_a_table_is_read_from_its_program() {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &["output.data=[]"]);
    assert!(!folder.path().join("toolpath.csv").exists());
    let first = sketch(folder.path());
    let catalogue = Catalogue::linked().unwrap();
    write_page(&request(folder.path()), &catalogue, &SilentObserver).unwrap();
    let again = sketch(folder.path());
    near(
        most(&again.turns.z.velocity),
        most(&first.turns.z.velocity),
        1e-3,
        "velocity",
    );
    run(folder.path(), &["output.data=[]", "output.posts=[]"]);
    assert!(!data(folder.path())["sketch"].is_null());
    // The page of the run has more than a new one would.
    let refused = write_page(&request(folder.path()), &catalogue, &SilentObserver);
    let refused = refused.unwrap_err();
    assert!(
        matches!(refused, Error::Page(PageError::NoPath { .. })),
        "{refused}"
    );
    assert!(!data(folder.path())["sketch"].is_null());
    fs::remove_file(folder.path().join("report.html")).unwrap();
    write_page(&request(folder.path()), &catalogue, &SilentObserver).unwrap();
    assert!(data(folder.path())["sketch"].is_null());
}

#[test]
fn a_result_without_a_page_has_none_of_an_earlier_run() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("report.html");
    run(folder.path(), &[]);
    let listed = turnpath::read_result(folder.path()).unwrap().files.unwrap();
    assert!(page.is_file() && listed.iter().all(|file| file.file != "report.html"));
    let without = || {
        job(&[])
            .run(Outputs::in_folder(folder.path()), &SilentObserver)
            .unwrap()
    };
    without();
    assert!(!page.exists());
    fs::write(&page, "<!DOCTYPE html>\n<p>mine").unwrap();
    without();
    assert!(page.is_file());
}

#[test]
fn a_page_of_another_recipe_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let catalogue = Catalogue::linked().unwrap();
    let refusal = |request: &PageRequest| match write_page(request, &catalogue, &SilentObserver) {
        Err(Error::Page(error)) => error,
        other => panic!("{other:?}"),
    };
    let none = refusal(&request(folder.path()));
    assert!(matches!(none, PageError::NoResult { .. }), "{none}");
    run(folder.path(), &[]);
    let other = folder.path().join("other.toml");
    fs::write(&other, format!("# changed\n{}", crate::support::SADDLE)).unwrap();
    let with_other = PageRequest {
        recipe: Some(other),
        ..request(folder.path())
    };
    assert!(matches!(
        refusal(&with_other),
        PageError::OtherRecipe { .. }
    ));
    let summary = folder.path().join("summary.json");
    let text = fs::read_to_string(&summary).unwrap();
    let mut summary_of_before: Value = serde_json::from_str(&text).unwrap();
    summary_of_before["recipe"]
        .as_object_mut()
        .unwrap()
        .remove("text");
    fs::write(&summary, summary_of_before.to_string()).unwrap();
    let without_text = refusal(&request(folder.path()));
    assert!(
        matches!(without_text, PageError::NoRecipe),
        "{without_text}"
    );
    let recipe = folder.path().join("saddle.toml");
    fs::write(&recipe, crate::support::SADDLE).unwrap();
    let with_recipe = PageRequest {
        recipe: Some(recipe),
        ..request(folder.path())
    };
    write_page(&with_recipe, &catalogue, &SilentObserver).unwrap();
}
