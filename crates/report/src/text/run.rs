//! A run for a person.

use std::path::PathBuf;

use turnpath_core::printable_line;

use crate::errors::Tolerances;
use crate::program::ProgramReport;
use crate::run::RunReport;

use super::commands::commands;
use super::lead::lead;
use super::numbers::{against_any, duration, grouped, line, small_length};
use super::path::path;
use super::remark::{feed_cap, remarks};
use super::servo::servo;
use super::unreached::unreached;

/// The text on a run, with the files that it wrote.
pub fn run(report: &RunReport, files: &[PathBuf]) -> String {
    let verdict = report.verdict();
    let (chain, tolerance) = (&report.chain, &report.path.tolerance);
    let mut names = vec![
        chain.surface.as_str(),
        &chain.feed,
        &chain.sampler,
        &chain.compensator,
        &chain.velocity,
    ];
    // A constant speed is what everybody expects.
    names.extend(Some(chain.spindle.as_str()).filter(|name| *name != "constant"));
    let mut text = format!("{}\n", printable_line(&report.name));
    text += &line("chain", names.join(" > "));
    text += &line("points", points(report));
    text += &line("revolutions", format!("{:.2}", report.revolutions));
    text += &line("cutting time", duration(report.cutting_time));
    text += &feed_cap(&report.feed_cap);
    text += &path(&report.path, verdict);
    if let Some(report) = &report.path.lead {
        text += &lead(report, verdict.lead);
    }
    if let Some(servos) = &report.path.servo {
        text += &servo(servos, tolerance.servo, verdict.servo);
    }
    text += &unreached(report.unreached.as_ref());
    for one in &report.programs {
        text += &program(one, tolerance);
    }
    text += &commands(&report.controller_commands);
    text += &remarks(&report.remarks);
    for file in files {
        text += &line("file", printable_line(&file.display().to_string()));
    }
    text
}

/// The lines on a program: its errors against their tolerances.
fn program(program: &ProgramReport, tolerance: &Tolerances) -> String {
    let (error, holds) = (program.interpolation_error, program.within_interpolation);
    let limit = against_any(error, tolerance.interpolation, holds);
    let mut text = line(&program.post, limit);
    text += &cost(program);
    if let Some(holds) = program.within_form {
        let limit = against_any(
            program.form_error.unwrap_or(f64::NAN),
            tolerance.form,
            Some(holds),
        );
        text += &line("", format!("{limit} form"));
    }
    if let (Some(clearance), Some(false)) = (program.lead_clearance, program.within_lead) {
        let depth = small_length(-clearance);
        text += &line(
            "",
            format!("EXCEEDED: a lead plunges {depth} below first touch"),
        );
    }
    text
}

/// The line on what the program costs beside its path.
fn cost(program: &ProgramReport) -> String {
    let Some(added) = program.added_error else {
        return String::new();
    };
    let added = small_length(added.max(0.0));
    let Some(straight) = &program.straight_lines else {
        return line("", format!("digits and times add {added}"));
    };
    let (lines, each) = (grouped(straight.lines), straight.per_segment);
    line(
        "",
        format!(
            "straight lines, digits and times add {added}; {lines} lines, {each:.1} for each segment \
             of the path"
        ),
    )
}

fn points(report: &RunReport) -> String {
    let points = grouped(report.control_points);
    match report.refine {
        false => format!("{points} (not refined)"),
        true => {
            let added = grouped(report.points_added_by_refine);
            format!("{points} ({added} added by refine)")
        }
    }
}
