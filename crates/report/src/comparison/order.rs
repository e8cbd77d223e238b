//! The order of the rows.

use crate::ablation::AblationRun;

use super::column::{Best, Column};

/// The runs with the best of a column first; those without the figure come last, in their order.
pub fn sorted(runs: &[AblationRun], column: &Column) -> Vec<AblationRun> {
    let figure = |run: &AblationRun| {
        let number = run.measured().and_then(|run| column.tidied(run));
        let number = number.filter(|number| !number.is_nan());
        match column.best {
            Best::Largest => number.map_or(f64::INFINITY, |number| -number),
            Best::Smallest | Best::None => number.unwrap_or(f64::INFINITY),
        }
    };
    let mut rows = runs.to_vec();
    rows.sort_by(|one, other| figure(one).total_cmp(&figure(other)));
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comparison::by_name;
    use crate::sample::{failed_run, measured_run};

    #[test]
    fn the_best_comes_first_and_what_failed_last() {
        let run = |points: u64| measured_run(Vec::new(), |run| run.report.control_points = points);
        let runs = [failed_run(Vec::new(), "no"), run(3), run(1), run(2)];
        let points = |run: &AblationRun| run.measured().map(|run| run.report.control_points);
        let sorted = sorted(&runs, by_name("points").unwrap());
        let order: Vec<_> = sorted.iter().map(points).collect();
        assert_eq!(order, [Some(1), Some(2), Some(3), None]);
    }
}
