//! A check for a person.

use turnpath_core::printable_line;

use crate::check::{CheckReport, ProgramEstimate, RoughPathEstimate};

use super::axis_notes::axis_notes;
use super::commands::commands;
use super::form::first_split;
use super::machine::limits;
use super::numbers::{bytes, duration, grouped, line};
use super::part_shape::part_shape;
use super::remark::{feed_cap, remarks};
use super::tool_fit::tool_fit;
use super::unreached::unreached;

/// The text on a check.
pub fn check(report: &CheckReport) -> String {
    let mut text = format!("{}\n", printable_line(&report.name));
    text += &report.part.as_ref().map(part_shape).unwrap_or_default();
    text += &tool_fit(&report.tool_fit);
    text += &unreached(report.unreached.as_ref());
    if let Some(machine) = &report.machine {
        text += &limits(machine);
    }
    text += &report.form.as_ref().map(first_split).unwrap_or_default();
    let expected = &report.expected;
    let points = grouped(expected.control_points);
    text += &line("points", format!("about {points}"));
    text += &line("revolutions", format!("{:.2}", expected.revolutions));
    text += &line("cutting time", duration(expected.cutting_time));
    text += &feed_cap(&report.feed_cap);
    let size = bytes(expected.toolpath_bytes as f64);
    text += &line("toolpath.csv", format!("about {size}"));
    text += &programs(&expected.programs);
    for rough in &report.rough_paths {
        text += &rough_path(rough);
    }
    text += &report
        .axis_notes
        .as_ref()
        .map(|notes| axis_notes(notes, &expected.programs))
        .unwrap_or_default();
    text += &commands(&report.controller_commands);
    text + &remarks(&report.remarks)
}

fn programs(programs: &[ProgramEstimate]) -> String {
    programs.iter().map(program).collect()
}

fn program(program: &ProgramEstimate) -> String {
    let (size, file) = (bytes(program.bytes as f64), &program.file);
    let parts = program.parts.map(|parts| format!(", in {parts} parts"));
    let parts = parts.unwrap_or_default();
    let of_text = if file.ends_with(".zst") {
        " of text"
    } else {
        ""
    };
    line("program", format!("about {size}{of_text}{parts}: {file}"))
}

/// The lines on a path before the finishing one.
fn rough_path(rough: &RoughPathEstimate) -> String {
    let expected = &rough.expected;
    let (points, time) = (
        grouped(expected.control_points),
        duration(expected.cutting_time),
    );
    let what = format!("about {points} points, {time}");
    let size = bytes(expected.toolpath_bytes as f64);
    let table = format!("about {size}: toolpath-{}.csv", rough.name);
    line(&format!("pass {}", rough.name), what)
        + &line("toolpath", table)
        + &programs(&expected.programs)
}
