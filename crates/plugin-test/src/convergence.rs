//! Whether a series continues the values along its curve: the rest falls as the first term left out.
//!
//! At t = H, H/2, H/4 … the rest r(t) = f(t) − Σ c_k t^k of a right series of order n falls by 2^(n+1)
//! from step to step, or faster, until it is rounding. A wrong coefficient c_k makes it fall by 2^k
//! alone. At a crease or at a knot the rest falls by no power, so such curves say nothing.

use turnpath_core::fit::evaluate;
use turnpath_core::{ORDER, Series};

/// Steps of the ladder: from a part of the part's radius down to where values are rounding.
pub const STEPS: usize = 20;
/// How far a ratio of two rests may be from a power of two, as a part of it: the share of the next
/// term on steps that are not small.
const POWER_SLACK: f64 = 0.12;
/// A rest below this part of the largest value along the curve counts as rounding.
const ROUNDING: f64 = 1e-12;
/// How many of the curves that say something must show a wrong term. A crease within the last steps of
/// a curve looks like one, which happens on hardly any curve.
const SHARE: f64 = 0.05;
/// Fewest curves that must show it.
const FEWEST: usize = 3;

/// The t at which a curve's values are taken.
pub fn ladder() -> [f64; STEPS] {
    std::array::from_fn(|i| 1.0 / (1u32 << i) as f64)
}

/// A coefficient that the values do not confirm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WrongTerm {
    /// The curve, by its number.
    pub curve: usize,
    /// The power of t.
    pub order: usize,
    /// The coefficient of the series.
    pub found: f64,
    /// The one that the values give.
    pub measured: f64,
}

/// What the values along one curve say.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Finding {
    /// They differ by rounding, or at a knot.
    Nothing,
    /// The series is right.
    Right,
    /// This coefficient is wrong, and would be the other one.
    Wrong { order: usize, measured: f64 },
}

/// Looks for a wrong term of order `last` or below in series along many curves; `values` has
/// [`STEPS`] values for each, on the [`ladder`].
pub fn wrong_term(series: &[Series], values: &[f64], last: usize) -> Option<WrongTerm> {
    let curves = series.iter().zip(values.chunks(STEPS));
    let findings: Vec<Finding> = curves
        .map(|(series, values)| finding(series, values, last))
        .collect();
    let telling = findings.iter().filter(|one| **one != Finding::Nothing);
    let telling = telling.count() as f64;
    let wrong = findings.iter().enumerate().filter_map(|(curve, finding)| {
        let Finding::Wrong { order, measured } = *finding else {
            return None;
        };
        Some(WrongTerm {
            curve,
            order,
            found: series[curve][order],
            measured,
        })
    });
    let wrong: Vec<WrongTerm> = wrong.collect();
    let enough = wrong.len() >= FEWEST && wrong.len() as f64 > SHARE * telling;
    let lowest = wrong.into_iter().min_by_key(|term| term.order);
    lowest.filter(|_| enough)
}

/// The finest three steps whose rests are no rounding decide.
fn finding(series: &Series, values: &[f64], last: usize) -> Finding {
    let largest = values.iter().fold(series[0].abs(), |m, v| m.max(v.abs()));
    let rounding = ROUNDING * largest.max(f64::MIN_POSITIVE);
    let steps = ladder();
    let mut cut = *series;
    cut[(last + 1).min(ORDER + 1)..].fill(0.0);
    let rest = |i: usize| values[i] - evaluate(&cut, steps[i]);
    let decides = |i: &usize| (*i..*i + 3).all(|i| rest(i).abs() > rounding);
    let Some(i) = (0..STEPS - 2).rev().find(decides) else {
        return Finding::Nothing;
    };
    let [wide, middle, fine] = [rest(i), rest(i + 1), rest(i + 2)];
    let falls_by = |power: usize| {
        let factor = (1u32 << power) as f64;
        let close = |ratio: f64| (ratio / factor - 1.0).abs() <= POWER_SLACK;
        close(wide / middle) && close(middle / fine)
    };
    match (0..=last).find(|order| falls_by(*order)) {
        Some(order) => Finding::Wrong {
            order,
            measured: series[order] + fine * (0..order).fold(1.0, |p, _| p / steps[i + 2]),
        },
        None if (wide / fine).abs() >= falls_at_least(last) => Finding::Right,
        None => Finding::Nothing,
    }
}

/// By how much the rest of a right series falls over two steps, at least.
fn falls_at_least(last: usize) -> f64 {
    let step = (1u32 << (last + 1)) as f64 * (1.0 - POWER_SLACK);
    step * step
}

#[cfg(test)]
mod tests {
    use turnpath_core::Scalar;

    use super::*;

    /// sin(0.7 + t) by its derivatives, with one coefficient changed.
    fn sine(wrong: Option<usize>) -> (Vec<Series>, Vec<f64>) {
        let (mut series, mut values) = (Vec::new(), Vec::new());
        for curve in 0..6 {
            let middle = 0.7 + 0.2 * f64::from(curve);
            let (s, c) = Scalar::sin_cos(middle);
            let mut one = [s, c, -s / 2.0, -c / 6.0, s / 24.0];
            if let Some(order) = wrong {
                one[order] *= 1.01;
            }
            series.push(one);
            values.extend(ladder().map(|t| Scalar::sin(middle + t)));
        }
        (series, values)
    }

    #[test]
    fn right_series_pass_and_each_wrong_term_is_found_with_its_value() {
        let (series, values) = sine(None);
        assert_eq!(wrong_term(&series, &values, ORDER), None);
        assert_eq!(wrong_term(&series, &values, 1), None);
        for order in 0..=ORDER {
            let (series, values) = sine(Some(order));
            let found = wrong_term(&series, &values, ORDER).unwrap();
            assert_eq!(found.order, order, "{found:?}");
            let exact = found.found / 1.01;
            assert!((found.measured / exact - 1.0).abs() < 1e-2, "{found:?}");
        }
    }

    #[test]
    fn a_crease_within_reach_of_the_curve_is_no_wrong_term() {
        let (mut series, mut values) = (Vec::new(), Vec::new());
        for curve in 0..20 {
            let crease = 0.003 + 0.013 * f64::from(curve);
            let height = |t: f64| 0.5 * t * t + 0.1 * (t - crease).max(0.0);
            series.push([0.0, 0.0, 0.5, 0.0, 0.0]);
            values.extend(ladder().map(height));
        }
        assert_eq!(wrong_term(&series, &values, ORDER), None);
    }
}
