//! A file of a tool path for a person.

use turnpath_core::printable_line;

use crate::file::FileReport;
use crate::reach::{Radial, Radii, Reach};
use crate::result_check::ResultCheck;
use crate::unit;
use crate::wholeness::Wholeness;

use super::anomalies::anomalies;
use super::commands::{commands_of_file, missing_commands};
use super::lead::lead;
use super::numbers::{grouped, line, millimetres, significant};
use super::path::path;
use super::servo::servo;
use super::unreached::unreached;

/// The text on a file.
pub fn file(report: &FileReport) -> String {
    let verdict = report.verdict();
    let mut text = format!("{}\n", printable_line(&report.name));
    text += &line("file", printable_line(&report.file));
    text += &result(report.result.as_ref());
    text += &line("surface", &report.surface);
    let (cutting, rows) = (grouped(report.control_points), grouped(report.rows));
    text += &line("points", format!("{cutting} that cut, of {rows} rows"));
    text += &reach(&report.reach);
    text += &wholeness(report.wholeness.as_ref());
    text += &path(&report.path, verdict);
    text += &spindle(report);
    if let Some(report) = &report.path.lead {
        text += &lead(report, verdict.lead);
    }
    text += &anomalies(&report.anomalies, report.rows);
    text += &commands_of_file(&report.controller_commands);
    text += &missing_commands(&report.missing_commands);
    if let Some(servos) = &report.path.servo {
        text += &servo(servos, report.path.tolerance.servo, verdict.servo);
    }
    text += &unreached(report.unreached.as_ref());
    for file in &report.files {
        text += &line("file", printable_line(file));
    }
    text
}

/// What the summary beside the file says of it.
fn result(result: Option<&ResultCheck>) -> String {
    let Some(result) = result else {
        return line("result", "no summary beside it lists it");
    };
    let summary = printable_line(&result.summary);
    let verdict = match result.holds {
        true => format!("as {summary} lists it"),
        false => format!("NOT AS {summary} lists it"),
    };
    let notes = result
        .notes
        .iter()
        .map(|note| line("", printable_line(note)));
    line("result", verdict) + &notes.collect::<String>()
}

/// The line on a spindle that turns faster than the recipe's; empty otherwise.
fn spindle(report: &FileReport) -> String {
    match (report.within.spindle, report.spindle_limit) {
        (Some(false), Some(limit)) => {
            let speed = &report.path.axes.c.velocity;
            let [rms, most, limit] =
                [speed.rms, speed.max, limit].map(|speed| significant(speed * unit::rpm::PER));
            let text = format!(
                "EXCEEDED: C turns at {rms} rpm rms and {most} rpm at most, and the recipe's speed is {limit} rpm"
            );
            line("spindle", text)
        }
        _ => String::new(),
    }
}

fn reach(reach: &Reach) -> String {
    let of = match reach.of {
        Radial::Centre => "X or contact",
        Radial::Contact => "contact",
    };
    let verdict = match reach.covers_part() {
        true => "holds".to_owned(),
        false => format!("EXCEEDED: the part reaches {}", from_to(&reach.part)),
    };
    line("reach", format!("{of} {}; {verdict}", from_to(&reach.path)))
}

/// Whether the path is whole; empty if the file does not show it.
fn wholeness(wholeness: Option<&Wholeness>) -> String {
    let Some(wholeness) = wholeness else {
        return String::new();
    };
    if wholeness.is_whole() {
        return line("whole", "from lead-in to lead-out; holds");
    }
    let mut text = String::new();
    for (i, fault) in wholeness.faults.iter().enumerate() {
        let label = if i == 0 { "whole" } else { "" };
        text += &line(label, format!("NOT WHOLE: {}", fault.words()));
    }
    text
}

fn from_to(radii: &Radii) -> String {
    let (inner, outer) = (millimetres(radii.inner, 3), millimetres(radii.outer, 3));
    format!("from {inner} to {outer}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reach_line(inner: f64, outer: f64, of: Radial) -> String {
        reach(&Reach {
            path: Radii { inner, outer },
            of,
            part: Radii {
                inner: 2.0,
                outer: 10.0,
            },
        })
    }

    #[test]
    fn a_person_reads_what_is_missing() {
        assert_eq!(
            reach_line(2.0, 2.5, Radial::Centre),
            "  reach           X or contact from 2.000 mm to 2.500 mm; EXCEEDED: the part reaches from \
             2.000 mm to 10.000 mm\n"
        );
        assert_eq!(
            reach_line(2.0, 10.0, Radial::Contact),
            "  reach           contact from 2.000 mm to 10.000 mm; holds\n"
        );
    }
}
