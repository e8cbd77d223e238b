//! A run for a person.

use std::path::PathBuf;

use turnpath_core::{DEG, printable_line};

use crate::errors::Tolerances;
use crate::program::ProgramReport;
use crate::run::RunReport;
use crate::verdict::Verdict;

use super::commands::commands;
use super::coverage::most_uncut;
use super::lead::lead;
use super::numbers::{LABEL, against_any, duration, grouped, line, significant, small_length};
use super::path::path;
use super::remark::{feed_cap, remarks};
use super::rough_path::rough_path;
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
        text += &program(one, tolerance, verdict);
    }
    for one in &report.rough_paths {
        text += &rough_path(one);
    }
    text += &commands(&report.controller_commands);
    text += &remarks(&report.remarks);
    for file in files {
        text += &line("file", printable_line(&file.display().to_string()));
    }
    text
}

/// The line of a post; a long name has a line of its own.
fn post_line(post: &str, text: &str) -> String {
    match post.len() < LABEL {
        true => line(post, text),
        false => format!("  {post}\n") + &line("", text),
    }
}

/// The figures that a program's header says, with their limits: they are those of its report.
pub fn verified_figures(program: &ProgramReport, tolerance: &Tolerances) -> String {
    let figure = |what: &str, value: f64, limit: Option<f64>| {
        let limit = limit.map(|limit| format!(" of {}", small_length(limit)));
        format!(
            "{what} {}{}",
            small_length(value),
            limit.unwrap_or_default()
        )
    };
    let interpolation = figure(
        "interpolation error",
        program.interpolation_error,
        tolerance.interpolation,
    );
    let residual = program.residual.and_then(|residual| residual.max);
    let residual = residual.map(|max| figure("residual", max, tolerance.residual));
    let is_judged = program.within_coverage.is_some();
    let uncut = program.coverage.filter(|_| is_judged);
    let uncut = uncut.map(|uncut| figure("coverage", uncut.largest(), tolerance.most_material()));
    let servo = program.servo_error;
    let servo = servo.map(|error| figure("servo error", error, tolerance.servo));
    let form = program.form_error;
    let form = form.map(|form| figure("form error", form, tolerance.form));
    let clearance = program.lead_clearance;
    let clearance = clearance.map(|height| figure("lead clearance", height, None));
    let all = [Some(interpolation), residual, uncut, servo, form, clearance];
    all.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// The lines on a program: its errors against their tolerances. `of_path` says which its path holds.
fn program(program: &ProgramReport, tolerance: &Tolerances, of_path: &Verdict) -> String {
    let (error, holds) = (program.interpolation_error, program.within_interpolation);
    let limit = against_any(error, tolerance.interpolation, holds);
    let mut text = post_line(&program.post, &limit);
    text += &cost(program);
    if let Some(step) = program.c_speed_step {
        let step = significant(step / DEG);
        text += &line(
            "",
            format!("C keeps its speed within a segment: it steps by up to {step} deg/s"),
        );
    }
    text += &passes(program, tolerance, of_path);
    if let (Some(error), Some(holds)) = (program.servo_error, program.within_servo) {
        let limit = against_any(error, tolerance.servo, Some(holds));
        text += &line("", format!("{limit} servo"));
    }
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
            format!("EXCEEDED: a lead digs {depth} into the wanted surface"),
        );
    }
    text
}

/// The lines on what a program's own passes leave, where they are not those of its path.
fn passes(program: &ProgramReport, tolerance: &Tolerances, of_path: &Verdict) -> String {
    let mut text = String::new();
    if let Some(max) = program.residual.and_then(|residual| residual.max) {
        let limit = against_any(max, tolerance.residual, program.within_residual);
        text += &line("", format!("{limit} residual"));
    } else if program.within_residual == Some(false) {
        text += &line("", "residual not measured: no turn has a neighbour");
    }
    if let (Some(coverage), Some(holds)) = (&program.coverage, program.within_coverage) {
        let allowed = tolerance.most_material().unwrap_or(f64::INFINITY);
        let limit = most_uncut(coverage, allowed, holds);
        text += &line("", format!("{limit} coverage"));
    }
    let verdicts = [
        (program.within_residual, of_path.residual),
        (program.within_coverage, of_path.coverage),
    ];
    if verdicts.contains(&(Some(false), Some(true))) {
        let help = match program.straight_lines.is_some() {
            true => {
                "a smaller `chord_share`, so that more lines come nearer to the path, or more \
                 `position_decimals`"
            }
            false => "more `position_decimals`, or more `velocity_decimals` where it has that key",
        };
        let text_of_help = format!("the path holds what the program exceeds: give the post {help}");
        text += &line("", text_of_help);
    }
    text
}

/// The lines on what the program costs beside its path.
fn cost(program: &ProgramReport) -> String {
    let straight = program.straight_lines.as_ref();
    let mut text = String::new();
    if let Some(raised) = program.raised_by {
        let what = match straight {
            None => "digits and times",
            Some(_) => "straight lines, digits and times",
        };
        let how = if raised < 0.0 { "lower" } else { "raise" };
        let by = small_length(raised.abs());
        text += &line("", format!("{what} {how} the error by {by}"));
    }
    if let Some(straight) = straight {
        let (lines, each) = (grouped(straight.lines), straight.per_segment);
        text += &line(
            "",
            format!("{lines} straight lines, {each:.1} for each segment of the path"),
        );
    }
    text
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
