//! A file of a tool path for a person.

use crate::anomalies::{Anomalies, Anomaly, AnomalyKind};
use crate::file::FileReport;
use crate::reach::{Radial, Radii, Reach};

use super::lead::lead;
use super::numbers::{grouped, line, millimetres, path_place, small_length};
use super::path::path;
use super::servo::servo;
use super::unreached::unreached;

/// Anomalies that a person is shown.
const SHOWN: usize = 3;

/// The text on a file.
pub fn file(report: &FileReport) -> String {
    let verdict = report.verdict();
    let mut text = format!("{}\n", report.name);
    text += &line("file", &report.file);
    text += &line("surface", &report.surface);
    let (cutting, rows) = (grouped(report.control_points), grouped(report.rows));
    text += &line("points", format!("{cutting} that cut, of {rows} rows"));
    text += &reach(&report.reach);
    text += &path(&report.path, verdict);
    if let Some(report) = &report.path.lead {
        text += &lead(report, verdict.lead);
    }
    text += &anomalies(&report.anomalies);
    if let Some(servos) = &report.path.servo {
        text += &servo(servos, report.path.tolerance.servo, verdict.servo);
    }
    text += &unreached(report.unreached.as_ref());
    for file in &report.files {
        text += &line("file", file);
    }
    text
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

fn from_to(radii: &Radii) -> String {
    let (inner, outer) = (millimetres(radii.inner, 3), millimetres(radii.outer, 3));
    format!("from {inner} to {outer}")
}

/// The lines on anomalies; empty where there is none.
fn anomalies(anomalies: &Anomalies) -> String {
    let mut text = String::new();
    let shown = anomalies.places.iter().take(SHOWN);
    for (i, place) in shown.clone().enumerate() {
        let label = if i == 0 { "anomalies" } else { "" };
        text += &line(label, place_of(place));
        text += &line("", difference(place));
    }
    let more = anomalies.count.saturating_sub(shown.len() as u64);
    if more > 0 {
        text += &line("", format!("and {} places more", grouped(more)));
    }
    text
}

fn place_of(anomaly: &Anomaly) -> String {
    let point = grouped(anomaly.point);
    format!("point {point}, {}", path_place(&anomaly.at))
}

fn difference(anomaly: &Anomaly) -> String {
    let what = match anomaly.kind {
        AnomalyKind::ZPosition => "Z is off the first touch by",
        AnomalyKind::CMotion => "C is not smooth: as if off by",
        AnomalyKind::XMotion => "X is not smooth: as if off by",
        AnomalyKind::ZMotion => "Z is not smooth: as if off by",
        AnomalyKind::Gap => "a row is missing: the step along the rim is",
    };
    let (by, neighbours) = (small_length(anomaly.by), small_length(anomaly.neighbours));
    format!("{what} {by}; its neighbours have {neighbours}")
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
