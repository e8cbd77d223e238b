//! A folder, memory and nowhere get the same path and the same figures.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::sync::Mutex;

use turnpath::report::RunReport;
use turnpath::{Observer, Outputs, PlotRequest, RunResult, SilentObserver, Stage, Tolerance};

use crate::support::{REFINED_LATE, job};

fn run(outputs: Outputs) -> RunResult {
    job(&[]).run(outputs, &SilentObserver).unwrap()
}

/// A report without the list of its files, which a folder alone has.
fn without_files(report: &RunReport) -> RunReport {
    RunReport {
        files: None,
        ..report.clone()
    }
}

/// A report without its programs, which nowhere does not make.
fn without_programs(report: &RunReport) -> RunReport {
    let mut report = report.clone();
    report.programs.clear();
    report.within.programs = None;
    report
}

#[test]
fn memory_has_the_rows_of_the_table_and_the_bytes_of_the_program() {
    let folder = tempfile::tempdir().unwrap();
    let in_folder = run(Outputs::in_folder(folder.path()));
    let in_memory = run(Outputs::in_memory());
    assert_eq!(without_files(&in_folder.report), in_memory.report);
    assert!(in_folder.report.files.is_some() && in_memory.report.files.is_none());
    let path = in_memory.toolpath.unwrap();
    assert_eq!(path.len() as u64, in_memory.report.rows);
    let table = std::fs::read_to_string(folder.path().join("toolpath.csv")).unwrap();
    let mut count = 0;
    for (i, row) in table.lines().skip(1).enumerate() {
        let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        let [t, c, x, z, vc, vx, vz, section] = cells[..] else {
            panic!("eight columns in {row}");
        };
        let of_path = [path.t[i], path.x[i], path.z[i], path.vx[i], path.vz[i]];
        assert_eq!([t, x, z, vx, vz], of_path, "row {i}");
        let close = |deg: f64, rad: f64| (deg - rad.to_degrees()).abs() <= 1e-12 * deg.abs();
        assert!(close(c, path.c[i]) && close(vc, path.vc[i]), "row {i}");
        assert_eq!(section as u8, path.section[i] as u8, "row {i}");
        count += 1;
    }
    assert_eq!(count, path.len());
    let [(name, program)] = &in_memory.programs[..] else {
        panic!("one program");
    };
    assert_eq!(*program, std::fs::read(folder.path().join(name)).unwrap());
    assert!(in_memory.files.is_empty());
}

/// Counts the blocks of each stage.
#[derive(Default)]
struct StageBlocks(Mutex<Vec<(Stage, u64)>>);

impl Observer for StageBlocks {
    fn begin(&self, stage: Stage, _: u64) {
        self.0.lock().unwrap().push((stage, 0));
    }

    fn advance(&self, blocks: u64) {
        if let Some((_, count)) = self.0.lock().unwrap().last_mut() {
            *count += blocks;
        }
    }
}

/// Most of the path is written when a segment of its last blocks turns out to be too long.
#[test]
fn outputs_that_drop_a_draft_have_the_refined_path_alone() {
    let job = job(&REFINED_LATE);
    let folder = tempfile::tempdir().unwrap();
    let stages = StageBlocks::default();
    // How many blocks go together depends on the number of threads.
    let threads = rayon::ThreadPoolBuilder::new().num_threads(8);
    let in_folder = threads.build().unwrap().install(|| {
        let outputs = Outputs::in_folder(folder.path());
        job.run(outputs, &stages).unwrap()
    });
    let stages = stages.0.into_inner().unwrap();
    let written = stages.iter().filter(|(stage, _)| *stage == Stage::Write);
    let written: Vec<u64> = written.map(|(_, blocks)| *blocks).collect();
    assert!(written.len() == 2 && written[0] > 60, "{stages:?}");
    let report = &in_folder.report;
    assert!(report.points_added_by_refine > 0 && report.within.holds());
    let added = report.points_added_by_refine as f64 / report.control_points as f64;
    assert!(added < 0.3, "{added}");
    let in_memory = job.run(Outputs::in_memory(), &SilentObserver).unwrap();
    assert_eq!(without_files(report), in_memory.report);
    let path = in_memory.toolpath.unwrap();
    assert_eq!(path.len() as u64, report.rows);
    assert!(path.t.is_sorted_by(|one, next| one < next));
    let table = std::fs::read_to_string(folder.path().join("toolpath.csv")).unwrap();
    assert_eq!(table.lines().count(), path.len() + 1);
    let [(name, program)] = &in_memory.programs[..] else {
        panic!("one program");
    };
    assert_eq!(*program, std::fs::read(folder.path().join(name)).unwrap());
    let nowhere = job.run(Outputs::nowhere(), &SilentObserver).unwrap();
    assert_eq!(nowhere.report, without_programs(&in_memory.report));
    let mut left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().collect();
    left.retain(|entry| !in_folder.files.contains(&entry.as_ref().unwrap().path()));
    assert!(left.is_empty(), "{left:?}");
}

#[test]
fn nowhere_measures_the_same_path() {
    let nowhere = run(Outputs::nowhere());
    let in_memory = run(Outputs::in_memory());
    assert_eq!(nowhere.report, without_programs(&in_memory.report));
    assert!(nowhere.toolpath.is_none() && nowhere.programs.is_empty());
}

#[test]
fn a_folder_lists_its_files_with_the_summary_last() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("new/out");
    let plots = PlotRequest {
        profiles: vec![0.0],
        ..PlotRequest::default()
    };
    let result = run(Outputs::in_folder(&target).with_plots(plots));
    let names: Vec<_> = result
        .files
        .iter()
        .map(|file| file.file_name().unwrap().to_str().unwrap())
        .collect();
    let expected = [
        "saddle.pmc",
        "profile-0deg.csv",
        "profile-0deg-spectrum.csv",
        "toolpath.csv",
        "summary.json",
    ];
    assert_eq!(names, expected);
    assert!(result.files.iter().all(|file| file.is_file()));
    let summary = std::fs::read_to_string(target.join("summary.json")).unwrap();
    let read: RunReport = turnpath::report::from_json(&summary).unwrap();
    assert_eq!(read, result.report);
    assert!(read.verdict().holds());
}

/// The path of a form is that of its split, as the report or a file of it has the split. A form
/// looks at no program, so nowhere finds the same split.
#[test]
fn a_path_for_a_form_is_made_again_from_its_split() {
    let job = job(&["tolerance={ form = \"5 um\" }"]);
    let first = job.run(Outputs::in_memory(), &SilentObserver).unwrap();
    let text = turnpath::report::to_json(&first.report);
    let read: RunReport = turnpath::report::from_json(&text).unwrap();
    let split = read.path.form.unwrap().split.unwrap();
    assert!(split.rounds > 1);
    let tolerance = Tolerance {
        interpolation: split.interpolation,
        residual: split.residual,
    };
    let again = job.with_tolerance(tolerance);
    let again = again.run(Outputs::in_memory(), &SilentObserver).unwrap();
    assert_eq!(again.toolpath, first.toolpath);
    assert_eq!(again.programs, first.programs);
    let nowhere = job.run(Outputs::nowhere(), &SilentObserver).unwrap().report;
    assert_eq!(nowhere.path.form, first.report.path.form);
}

/// The names of the files that a summary lists.
fn listed(report: &RunReport) -> Vec<&str> {
    let files = report.files.as_ref().unwrap().iter();
    files.map(|file| file.file.as_str()).collect()
}

#[test]
fn the_summary_lists_the_files_of_its_folder_and_the_recipe() {
    let folder = tempfile::tempdir().unwrap();
    let elsewhere = tempfile::tempdir().unwrap();
    let map = turnpath::MapRequest {
        file: elsewhere.path().join("map.xyz"),
        cells: 8,
        grid: turnpath::MapGrid::Cartesian,
    };
    let plots = PlotRequest {
        profiles: vec![0.0],
        map: Some(map),
        ..PlotRequest::default()
    };
    let result = run(Outputs::in_folder(folder.path()).with_plots(plots));
    assert_eq!(result.files.len(), 6);
    assert!(elsewhere.path().join("map.xyz").is_file());
    let report = turnpath::read_result(folder.path()).unwrap();
    assert_eq!(report, result.report);
    let names = [
        "saddle.pmc",
        "profile-0deg.csv",
        "profile-0deg-spectrum.csv",
        "toolpath.csv",
    ];
    assert_eq!(listed(&report), names);
    for file in report.files.iter().flatten() {
        let bytes = std::fs::read(folder.path().join(&file.file)).unwrap();
        assert_eq!(file.bytes, bytes.len() as u64);
        assert_eq!(file.sha256, turnpath_host::sha256_hex(&bytes));
    }
    let recipe = report.recipe.unwrap();
    assert_eq!(recipe.file, "saddle.toml");
    assert_eq!(recipe.sets, Vec::<String>::new());
    assert_eq!(recipe.sha256.len(), 64);
}

#[test]
fn a_summary_without_its_files_or_with_other_bytes_is_no_result() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let error = || {
        turnpath::read_result(folder.path())
            .unwrap_err()
            .to_string()
    };
    assert!(error().starts_with("cannot read"), "{}", error());
    run(Outputs::in_folder(folder.path()));
    let table = std::fs::read(path("toolpath.csv")).unwrap();
    std::fs::write(path("toolpath.csv"), &table[1..]).unwrap();
    assert!(
        error().contains("is not as summary.json lists it"),
        "{}",
        error()
    );
    std::fs::remove_file(path("toolpath.csv")).unwrap();
    assert!(
        error().contains("is not as summary.json lists it"),
        "{}",
        error()
    );
    std::fs::write(path("toolpath.csv"), &table).unwrap();
    turnpath::read_result(folder.path()).unwrap();
    std::fs::write(path("summary.json"), "{}").unwrap();
    assert!(error().contains("no summary"), "{}", error());
}
