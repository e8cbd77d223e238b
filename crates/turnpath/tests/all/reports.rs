//! Reports as JSON: read back they are the same, and every number has its unit in its key.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::num::NonZero;

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use turnpath::report::{AblationReport, RunReport, from_json, to_json};
use turnpath::{AblationOptions, Catalogue, Outputs, PlotRequest, SilentObserver, ablate, verify};

use crate::support::{SADDLE, job, recipe};

/// Variants that between them fill every part of a report, and leave every optional part out.
const VARIANTS: &[&[&str]] = &[
    &[],
    &[
        "machine.preset=generic-sts",
        "machine.c_velocity=200 rpm",
        "servo.bandwidth=60 Hz",
    ],
    &["path.lead=false", "path.overrun=none", "output.posts=[]"],
    &[
        "path.overrun=0.2 mm",
        "velocity.use=linear",
        "output.posts=[]",
        "refine=false",
        "machine.z_jerk=1 m/s^3",
    ],
    &["part.inner=1 mm", "compensator.use=normal"],
    &["output.posts=[\"beckhoff-g93\"]"],
    &[
        "tolerance={ form = \"5 um\", servo = \"1 um\" }",
        "servo.bandwidth=60 Hz",
        "refine=true",
    ],
    &[
        "tool.interference=cut-what-fits",
        "tool.nose_radius=8 mm",
        "part.aperture=1 mm",
        "path.overrun=none",
        "feed={ use = \"constant\", feed = \"50 um/rev\" }",
        "sampler={ use = \"equal-angle\", step = \"10 deg\" }",
        "refine=false",
    ],
];

/// Keys of numbers without a unit: counts, and parts of a whole.
const PURE: &[&str] = &[
    "format",
    "control_points",
    "rows",
    "points_added_by_refine",
    "revolutions",
    "turns_in",
    "turns_out",
    "area_fraction",
    "point",
    "count",
    "rounds",
    "per_turn",
    "blocks",
    "parts",
    "cells",
    "lines",
    "per_segment",
    "position_decimals",
    "delivered_decimals",
];
/// What a unit in a key ends in.
const UNITS: &[&str] = &[
    "_nm", "_um", "_mm", "_mm3", "_per_mm", "_s", "_s2", "_s3", "_deg", "_arcsec", "_urad", "_rpm",
    "_percent", "_bytes", "bytes",
];

#[track_caller]
fn numbers_have_units(key: &str, value: &Value) {
    match value {
        Value::Number(_) => assert!(
            PURE.contains(&key) || UNITS.iter().any(|unit| key.ends_with(unit)),
            "the number `{key}` has no unit"
        ),
        Value::Object(entries) => entries
            .iter()
            .for_each(|(key, value)| numbers_have_units(key, value)),
        Value::Array(items) => items.iter().for_each(|item| numbers_have_units(key, item)),
        _ => {}
    }
}

#[track_caller]
fn round_trip<T: Serialize + DeserializeOwned + PartialEq + std::fmt::Debug>(report: &T) {
    let text = to_json(report);
    let read: T = from_json(&text).unwrap();
    assert_eq!(read, *report);
    assert_eq!(to_json(&read), text);
    let value: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(value["format"], 2);
    numbers_have_units("", &value);
}

#[test]
fn the_report_of_a_check_is_the_same_when_it_is_read_back() {
    for sets in VARIANTS {
        round_trip(&job(sets).check(&SilentObserver).unwrap());
    }
}

#[test]
fn a_run_agrees_with_its_file_and_both_reports_are_the_same_when_they_are_read_back() {
    let catalogue = Catalogue::linked().unwrap();
    for sets in VARIANTS {
        let folder = tempfile::tempdir().unwrap();
        let run = job(sets)
            .run(Outputs::in_folder(folder.path()), &SilentObserver)
            .unwrap();
        let (recipe, file) = (recipe(sets), folder.path().join("toolpath.csv"));
        let (plots, observer) = (PlotRequest::default(), SilentObserver);
        let report = verify(&recipe, &catalogue, &file, &plots, folder.path(), &observer).unwrap();
        round_trip(&run.report);
        round_trip(&RunReport {
            files: None,
            ..run.report.clone()
        });
        round_trip(&report);
        let (here, there) = (&report.path, &run.report.path);
        let (error, other) = (here.interpolation_error.max, there.interpolation_error.max);
        assert!((error / other - 1.0).abs() < 1e-6, "{error}, {other}");
        assert_eq!(report.control_points, run.report.control_points);
        assert_eq!(report.verdict().residual, run.report.verdict().residual);
    }
}

#[test]
fn the_report_of_an_ablation_is_the_same_when_it_is_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let lists = "[ablation]\nvelocity = [{ use = \"analytic\" }, { use = \"linear\" }]\n";
    let text = format!("{SADDLE}{lists}");
    let recipe = turnpath::Recipe::parse(&text, "saddle.toml", &[]).unwrap();
    let options = AblationOptions {
        folder: folder.path().to_owned(),
        fresh: false,
        threads: NonZero::new(2),
    };
    let catalogue = Catalogue::linked().unwrap();
    let result = ablate(&recipe, &catalogue, &options, &SilentObserver).unwrap();
    assert_eq!((result.report.runs.len(), result.failures.len()), (3, 1));
    round_trip(&result.report);
    let file = std::fs::read_to_string(folder.path().join("ablation.json")).unwrap();
    let read: AblationReport = from_json(&file).unwrap();
    assert_eq!(read, result.report);
    let again = ablate(&recipe, &catalogue, &options, &SilentObserver).unwrap();
    assert_eq!(again.reused, 2);
    assert_eq!(again.report, result.report);
}
