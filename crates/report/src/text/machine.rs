//! The lines on the machine's limits.

use crate::machine::{HighestSpindle, LimitFigure, MachineLimits, MachineReport, all_hold};
use crate::unit;

use super::numbers::{limit_amount, limit_name, line, path_place, significant};

/// The lines on limits that do not hold, each after the name of what was measured.
pub fn exceeded(limits: &[LimitFigure], of: &str) -> String {
    let lines = limits.iter().filter_map(|figure| exceeded_line(figure, of));
    lines.collect()
}

fn exceeded_line(figure: &LimitFigure, of: &str) -> Option<String> {
    let (amount, at) = figure
        .decisive()
        .filter(|_| figure.holds() == Some(false))?;
    let amount = amount_of_limit(figure, amount);
    let text = format!(
        "{amount} EXCEEDED, at {}{}",
        path_place(&at),
        with_digits(figure)
    );
    // A label may be as long as its column, and an amount too.
    Some(line(&format!("{of}{} ", name(figure)), text))
}

/// The lines on limits that hold, and above which last digits reach, each after the name of what was measured.
pub fn by_digits(limits: &[LimitFigure], of: &str) -> String {
    let figures = limits.iter().filter(|figure| figure.holds_without_digits());
    let lines = figures.filter_map(|figure| {
        let (amount, _) = figure.decisive()?;
        let amount = amount_of_limit(figure, amount);
        let text = format!("{amount} holds{}", with_digits(figure));
        Some(line(&format!("{of}{} ", name(figure)), text))
    });
    lines.collect()
}

/// An amount and its limit.
fn amount_of_limit(figure: &LimitFigure, amount: f64) -> String {
    let [amount, most] = [amount, figure.limit.value].map(|it| limit_amount(&figure.limit, it));
    format!("{amount:>12} of {most:<11}")
}

/// What was measured, where last digits have a part in it.
fn with_digits(figure: &LimitFigure) -> String {
    let measured = figure.measured.filter(|_| figure.certain.is_some());
    measured.map_or_else(String::new, |(amount, _)| {
        let amount = limit_amount(&figure.limit, amount);
        format!("; {amount} with rounding")
    })
}

fn name(figure: &LimitFigure) -> String {
    limit_name(figure.limit.axis, figure.limit.derivative)
}

/// The lines on a path.
pub fn machine(report: &MachineReport) -> String {
    let mut text = exceeded(&report.limits, "");
    text += &by_digits(&report.limits, "");
    let machine = report.machine.name();
    let unmeasured = report.limits.iter().filter(|one| one.measured.is_none());
    let unmeasured: Vec<String> = unmeasured.map(name).collect();
    text += &match (all_hold(&report.limits), unmeasured.as_slice()) {
        (Some(true), []) => line("machine", format!("{machine}: all limits hold")),
        (Some(true), _) => line("machine", format!("{machine}: the other limits hold")),
        _ => String::new(),
    };
    if !unmeasured.is_empty() {
        let unmeasured = unmeasured.join(", ");
        text += &line(
            "",
            format!("not measured on straight segments: {unmeasured}"),
        );
    }
    text
}

/// The lines before there is a path.
pub fn limits(machine: &MachineLimits) -> String {
    let all = machine.limits.iter().map(|figure| {
        let most = limit_amount(&figure.limit, figure.limit.value);
        format!("{} {most}", name(figure))
    });
    let mut text = line("machine", machine.machine.name());
    text += &line("", all.collect::<Vec<_>>().join(", "));
    if let Some(source) = &machine.machine.source {
        text += &line("", format!("source: {source}"));
    }
    let mut limits = machine.limits.iter().map(|figure| figure.limit);
    if let Some(limit) = limits.find(|limit| limit.key() == "c_velocity") {
        let [speed, most] = [machine.spindle, limit.value];
        let [speed, most] = [speed, most].map(|speed| significant(speed * unit::rpm::PER));
        text += &line("spindle", format!("{speed} rpm of {most} rpm holds"));
    }
    text
}

/// The line on the highest speed of the spindle; empty without a bound.
pub fn highest_spindle(highest: Option<&HighestSpindle>) -> String {
    highest.map_or_else(String::new, |highest| {
        let rpm = significant(highest.speed * unit::rpm::PER);
        let limit = limit_name(highest.bound_by.0, highest.bound_by.1);
        line(
            "spindle",
            format!("the cut holds all limits up to {rpm} rpm; {limit} binds"),
        )
    })
}

#[cfg(test)]
mod tests {
    use turnpath_core::{Axis, DEG, Derivative, Limit};

    use super::*;
    use crate::place::PathPlace;

    fn line_of(axis: Axis, derivative: Derivative, value: f64, amount: f64) -> String {
        let at = PathPlace {
            c: 90.0 * DEG,
            x: 1.25,
        };
        let limit = Limit {
            axis,
            derivative,
            value,
        };
        let measured = Some((amount, at));
        let certain = None;
        exceeded(
            &[LimitFigure {
                limit,
                measured,
                certain,
            }],
            "",
        )
    }

    #[test]
    fn a_limit_that_does_not_hold_is_reported_with_its_place() {
        assert_eq!(
            line_of(Axis::X, Derivative::Acceleration, 1000.0, 1300.0),
            "  X acceleration    1.300 m/s² of 1.000 m/s²  EXCEEDED, at C = 90.00 deg, \
             X = 1.2500 mm\n"
        );
        let at = PathPlace { c: DEG, x: 2.5 };
        let of = |certain: f64| LimitFigure {
            limit: Limit {
                axis: Axis::X,
                derivative: Derivative::Jerk,
                value: 60.0,
            },
            measured: Some((156.0, at)),
            certain: Some((certain, at)),
        };
        let limits = [of(0.0), of(80.0)];
        assert_eq!(
            exceeded(&limits, ""),
            "  X jerk           80.00 mm/s³ of 60.00 mm/s³ EXCEEDED, at C = 1.00 deg, X = 2.5000 mm; \
             156.0 mm/s³ with rounding\n"
        );
        assert_eq!(
            by_digits(&limits, ""),
            "  X jerk               0 mm/s³ of 60.00 mm/s³ holds; 156.0 mm/s³ with rounding\n"
        );
        let rpm = unit::rpm::PER.recip();
        let text = line_of(Axis::C, Derivative::Velocity, 10.0 * rpm, 20.0 * rpm);
        assert!(text.contains("20.00 rpm of 10.00 rpm"), "{text}");
    }
}
