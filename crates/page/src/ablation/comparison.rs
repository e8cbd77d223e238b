//! Two figures of all runs against each other, and the runs that no other run beats in one of them without
//! losing in the other.

use serde::Serialize;
use turnpath_report::MeasuredRun;
use turnpath_report::comparison::{NOISE, by_name};
use turnpath_report::unit;

/// Two figures of all runs; of both, less is better.
#[derive(Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// The place of its figure on the page.
    pub id: &'static str,
    #[serde(skip)]
    pub title: &'static str,
    x_title: &'static str,
    y_title: &'static str,
    /// Numbers in the units of the titles; `None` for a run without one of them.
    places: Vec<Option<[f64; 2]>>,
    /// The indices of the runs on the front, by their x.
    front: Vec<usize>,
}

/// The comparisons of runs with their names.
pub fn comparisons(runs: &[(String, &MeasuredRun)]) -> Vec<Comparison> {
    let points = |run: &MeasuredRun| {
        let error = run.report.path.interpolation_error.max * unit::nm::PER;
        Some([run.report.control_points as f64, error])
    };
    // The law's own figure shows how feeds differ, if all runs have it.
    let of_law = runs.iter().all(|(_, run)| run.report.axes_of_law.is_some());
    let time = |run: &MeasuredRun| {
        let axes = match of_law {
            true => run.report.axes_of_law?,
            false => run.report.path.axes,
        };
        let acceleration = axes.x.acceleration.rms;
        let tidied = by_name("x-acceleration").map(|column| column.tidy(acceleration));
        Some([run.report.cutting_time, tidied.unwrap_or(acceleration)])
    };
    let x_acceleration = match of_law {
        true => "X acceleration of the law, RMS / mm/s²",
        false => "X acceleration, RMS / mm/s²",
    };
    vec![
        Comparison::of(
            ("points-error", "Points against error"),
            ["control points", "interpolation error / nm"],
            runs.iter().map(|(_, run)| points(run)),
        ),
        Comparison::of(
            ("time-acceleration", "Time against X acceleration"),
            ["cutting time / s", x_acceleration],
            runs.iter().map(|(_, run)| time(run)),
        ),
    ]
}

impl Comparison {
    fn of(
        (id, title): (&'static str, &'static str),
        [x_title, y_title]: [&'static str; 2],
        places: impl Iterator<Item = Option<[f64; 2]>>,
    ) -> Self {
        let finite = |place: &[f64; 2]| place.iter().all(|value| value.is_finite());
        let places = places.map(|place| place.filter(finite));
        let places: Vec<_> = places.collect();
        Self {
            id,
            title,
            x_title,
            y_title,
            front: front(&places),
            places,
        }
    }
}

/// The places that no other place beats in one figure without losing in the other. A place that is better
/// by noise alone is not on the front, and of equal ones the first is.
fn front(places: &[Option<[f64; 2]>]) -> Vec<usize> {
    let known = places.iter().enumerate();
    let mut known: Vec<(usize, [f64; 2])> = known
        .filter_map(|(index, place)| Some((index, (*place)?)))
        .collect();
    known.sort_by(|(_, one), (_, other)| {
        one[0]
            .total_cmp(&other[0])
            .then(one[1].total_cmp(&other[1]))
    });
    let mut least: Option<f64> = None;
    let mut front = Vec::new();
    for (index, [_, y]) in known {
        if least.is_none_or(|least| y < least - NOISE * least.abs()) {
            least = Some(y);
            front.push(index);
        }
    }
    front
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_has_the_runs_that_no_other_beats() {
        let places = [
            Some([5.0, 1.0]),
            Some([1.0, 9.0]),
            Some([2.0, 9.0]),
            None,
            Some([3.0, 4.0]),
            Some([3.0, 5.0]),
            Some([6.0, 1.0]),
        ];
        assert_eq!(front(&places), [1, 4, 0]);
        assert_eq!(front(&[None]), Vec::<usize>::new());
        // Two more points for a better last digit are no step of the front.
        let noise = [
            [23983.0, 9.597_265_8],
            [23985.0, 9.597_265_6],
            [24032.0, 9.596_16],
        ];
        assert_eq!(front(&noise.map(Some)), [0]);
    }
}
