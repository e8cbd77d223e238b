//! The search for the division of a tolerance of form that a path makes good use of.
//!
//! No formula says what a path leaves of its tolerances: steps and turns rarely use them up at the
//! same place. So the path is made and measured, and made again with tolerances that are scaled by
//! what is missing. The search looks at the path alone, and not at programs, so that the path does
//! not depend on where a run puts it.

use turnpath_core::{FormBudget, Tolerance};
use turnpath_pipeline::{Observer, Outcome, Stage};
use turnpath_report::{FormSplit, unit};

use crate::error::Error;
use crate::figures::form_error;
use crate::job::Job;

/// Most paths that a search makes: the first and three more. One of them may have to be made once
/// more, so a form costs at most five.
const MOST_PATHS: usize = 4;
/// The part of the form that a path is scaled to. The rest covers what does not scale.
const AIM: f64 = 0.95;
/// A path that leaves this part of the form, or more, is not made again: at the aim it would have a
/// fortieth fewer turns, for as much work as before.
const ENOUGH: f64 = 0.9;
/// Largest factor from one path's tolerances to the next one's, either way. The first path may be
/// far off where a bound or the recipe's own feed decides; and a path for tolerances that are too
/// fine by far takes hours.
const FURTHEST: f64 = 4.0;
/// The sums of shares of all paths of a search lie within this factor of the form, either way.
pub const FARTHEST_SUM: f64 = FURTHEST * FURTHEST * FURTHEST;
/// Where the form changes by less than this part of itself between two paths, nothing follows from
/// the line through both.
const RESPONSE: f64 = 0.01;
/// The factor from one path to the next where nothing follows from the line: an error in stairs may
/// change within it.
const STEP: f64 = 2.0;
/// Where the form does not change over sums of the shares that are this far apart, it does not
/// depend on them. A larger factor would cost a path for each form that the recipe's own feed or
/// steps decide.
const INSENSITIVE: f64 = 4.0;

/// A path that was made and measured.
#[derive(Debug, Clone, Copy)]
struct Attempt {
    /// The sum of the shares that it was made for, mm.
    sum: f64,
    /// The error of its form, mm; not a number where nothing was cut.
    error: f64,
    points: u64,
}

/// The paths that were made for a form.
struct Search {
    budget: FormBudget,
    attempts: Vec<Attempt>,
    /// Why a path for other shares could not be made.
    refusal: Option<String>,
}

/// A path with what it was made for.
pub struct FormPath<T> {
    /// Where the path was put.
    pub sink: T,
    /// What was measured on it.
    pub outcome: Outcome,
    /// How the form was divided; `None` without a tolerance of form.
    pub split: Option<FormSplit>,
}

/// Makes the path of a job; with a tolerance of form as often as the search asks for. Without
/// refinement the path is made once: its steps do not depend on a measured error then. Only the
/// last path is kept, so `make` begins each time afresh.
pub fn search_split<T>(
    job: &Job,
    observer: &dyn Observer,
    make: impl Fn(&Job) -> Result<(T, Outcome), Error>,
) -> Result<FormPath<T>, Error> {
    let budget = job.recipe.tolerances.budget();
    let Some(budget) = budget.filter(|_| job.split.is_none()) else {
        let (sink, outcome) = make(job)?;
        let split = budget.and(job.split);
        return Ok(FormPath {
            sink,
            outcome,
            split: split.map(|tolerance| split_of(tolerance, 1)),
        });
    };
    let mut search = Search::new(budget);
    let mut sum = budget.form();
    loop {
        let tolerance = shares(&budget, sum);
        observer.begin(Stage::Form(search.attempts.len() as u32 + 1), 0);
        let made = make(&job.with_tolerance(tolerance));
        let (sink, outcome) = match made {
            Err(error) if search.goes_without(&error) => {
                search.refusal = Some(error.title());
                break;
            }
            made => made?,
        };
        search.include(sum, &outcome);
        let next = search.next().filter(|_| job.recipe.refine);
        if next.is_none() && search.best().is_some_and(|best| best.sum == sum) {
            let split = Some(search.split(sum));
            return Ok(FormPath {
                sink,
                outcome,
                split,
            });
        }
        match next {
            Some(next) => sum = next,
            None => break,
        }
    }
    let best = search.best().map_or(sum, |best| best.sum);
    let (sink, outcome) = make(&job.with_tolerance(shares(&budget, best)))?;
    search.include(best, &outcome);
    let split = Some(search.split(best));
    Ok(FormPath {
        sink,
        outcome,
        split,
    })
}

/// The shares of a sum as `summary.json` holds them, so that a path is made again from there with
/// the same bytes.
fn shares(budget: &FormBudget, sum: f64) -> Tolerance {
    let as_in_files = |mm: f64| unit::rounded(mm * unit::nm::PER) / unit::nm::PER;
    let Tolerance {
        interpolation,
        residual,
    } = budget.shares(sum);
    Tolerance {
        interpolation: as_in_files(interpolation),
        residual: as_in_files(residual),
    }
}

fn split_of(tolerance: Tolerance, rounds: u32) -> FormSplit {
    FormSplit {
        residual: tolerance.residual,
        interpolation: tolerance.interpolation,
        rounds,
        search_ended_because: None,
        decided_by_recipe: false,
    }
}

impl Search {
    fn new(budget: FormBudget) -> Self {
        Self {
            budget,
            attempts: Vec::new(),
            refusal: None,
        }
    }

    fn include(&mut self, sum: f64, outcome: &Outcome) {
        let clearance = outcome.lead.as_ref().map(|lead| lead.figures.clearance);
        self.attempts.push(Attempt {
            sum,
            error: form_error(outcome.form.as_ref(), clearance).unwrap_or(f64::NAN),
            points: outcome.control_points,
        });
    }

    /// Whether a path that could not be made ends the search, and not the run: a strategy may refuse
    /// tolerances that are finer, or coarser, than those of the paths before. A strategy that panics
    /// or gives a bad answer is wrong whatever the tolerances.
    fn goes_without(&self, error: &Error) -> bool {
        !self.attempts.is_empty() && error.is_refusal()
    }

    fn holds(&self, attempt: &Attempt) -> bool {
        attempt.error <= self.budget.form()
    }

    /// Of the paths that hold the form the one with the fewest points, else the one that comes
    /// nearest. Where the last one comes as near, it is not worth another path.
    fn best(&self) -> Option<Attempt> {
        let attempts = || self.attempts.iter().copied();
        let holding = attempts().filter(|attempt| self.holds(attempt));
        let fewest = holding.min_by(|a, b| a.points.cmp(&b.points));
        let nearest = || {
            let nearest = attempts().min_by(|a, b| a.error.total_cmp(&b.error))?;
            let last = attempts().last()?;
            let is_alike = last.error - nearest.error <= RESPONSE * nearest.error;
            Some(if is_alike { last } else { nearest })
        };
        fewest.or_else(nearest)
    }

    fn split(&self, sum: f64) -> FormSplit {
        FormSplit {
            search_ended_because: self.refusal.clone(),
            decided_by_recipe: self.last_is_insensitive(),
            ..split_of(shares(&self.budget, sum), self.attempts.len() as u32)
        }
    }

    /// The sum of the shares for the next path; `None` where the last path will do, or where no
    /// other would be better.
    fn next(&self) -> Option<f64> {
        let last = self.attempts.last()?;
        let form = self.budget.form();
        let will_do = self.holds(last) && last.error >= ENOUGH * form;
        let scales = last.error > 0.0;
        if will_do || self.attempts.len() == MOST_PATHS || !scales {
            return None;
        }
        let wanted = match self.attempts.len().checked_sub(2) {
            None => last.sum * AIM * form / last.error,
            Some(before) => self.along_line(self.attempts.get(before)?, last)?,
        };
        let wanted = wanted.clamp(last.sum / FURTHEST, last.sum * FURTHEST);
        let next = self.between_known(wanted);
        let changes = shares(&self.budget, next) != shares(&self.budget, last.sum);
        changes.then_some(next)
    }

    /// Where the line through the errors of two paths meets the aim. A part of the error may depend
    /// on no tolerance: the cusps of the recipe's own feed, the digits of a surface. Where this part
    /// exceeds the aim, half of what is left up to the form is aimed at; where it exceeds the form,
    /// no path will hold.
    fn along_line(&self, before: &Attempt, last: &Attempt) -> Option<f64> {
        let (rise, run) = (last.error - before.error, last.sum - before.sum);
        let form = self.budget.form();
        if rise.abs() <= RESPONSE * last.error {
            return self.step(last);
        }
        let slope = rise / run;
        if slope <= 0.0 {
            return Some(last.sum * AIM * form / last.error);
        }
        let rest = last.error - slope * last.sum;
        let aim = match rest < AIM * form {
            true => AIM * form,
            false => 0.5 * (rest + form),
        };
        (rest < form).then(|| (aim - rest) / slope)
    }

    /// The next sum where the last path has the error of others: finer if the form does not hold, and
    /// coarser if it does. `None` where the paths of this error are far enough apart.
    fn step(&self, last: &Attempt) -> Option<f64> {
        (!self.is_insensitive(last)).then_some(match self.holds(last) {
            true => last.sum * STEP,
            false => last.sum / STEP,
        })
    }

    /// Whether paths whose sums are far apart have the error of this one.
    fn is_insensitive(&self, last: &Attempt) -> bool {
        let is_alike = |other: &&Attempt| (other.error - last.error).abs() <= RESPONSE * last.error;
        let alike = || self.attempts.iter().filter(is_alike).map(|other| other.sum);
        let least = alike().fold(f64::INFINITY, f64::min);
        let most = alike().fold(0.0, f64::max);
        most >= INSENSITIVE * least
    }

    fn last_is_insensitive(&self) -> bool {
        let last = self.attempts.last();
        last.is_some_and(|last| self.is_insensitive(last))
    }

    /// The sum, or the middle between the largest sum that held and the smallest that did not, where
    /// it is not between the two.
    fn between_known(&self, sum: f64) -> f64 {
        let sums = |held: bool| {
            let attempts = self.attempts.iter();
            let of_kind = attempts.filter(move |attempt| self.holds(attempt) == held);
            of_kind.map(|attempt| attempt.sum)
        };
        let low = sums(true).fold(0.0, f64::max);
        let high = sums(false).fold(f64::INFINITY, f64::min);
        match low < high && !(low < sum && sum < high) {
            true if low > 0.0 && high.is_finite() => (low * high).sqrt(),
            _ => sum,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The paths of a search whose errors are `error` of the shares. Gives the errors and the split
    /// of the best.
    fn search(budget: FormBudget, error: impl Fn(Tolerance) -> f64) -> (Vec<f64>, Option<Attempt>) {
        let mut search = Search::new(budget);
        let mut next = Some(budget.form());
        while let Some(sum) = next {
            let shares = shares(&budget, sum);
            let points = 1e9 / shares.residual.sqrt() / shares.interpolation.sqrt().sqrt();
            search.attempts.push(Attempt {
                sum,
                error: error(shares),
                points: points as u64,
            });
            next = search.next();
        }
        let errors = search
            .attempts
            .iter()
            .map(|attempt| attempt.error)
            .collect();
        (errors, search.best())
    }

    const FORM: FormBudget = FormBudget::new(150.0, None, None);

    #[track_caller]
    fn assert_good_use(found: &(Vec<f64>, Option<Attempt>), paths: usize) {
        let best = found.1.unwrap().error;
        assert!((ENOUGH * 150.0..=150.0).contains(&best), "{found:?}");
        assert!(found.0.len() <= paths, "{found:?}");
    }

    #[test]
    fn a_path_that_leaves_a_part_of_its_tolerances_is_made_twice() {
        for part in [0.3, 0.6, 0.85, 1.2, 2.5] {
            let found = search(FORM, |shares| {
                part * (shares.residual + 2.0 * shares.interpolation)
            });
            assert_good_use(&found, 2);
        }
        let at_once = search(FORM, |_| 140.0);
        assert_eq!(at_once.0.len(), 1);
    }

    #[test]
    fn where_the_feed_is_given_the_steps_alone_take_what_is_left() {
        for cusps in [30.0, 90.0, 120.0, 140.0] {
            let found = search(FORM, |shares| cusps + 2.0 * shares.interpolation);
            assert_good_use(&found, 4);
        }
    }

    #[test]
    fn a_bound_is_kept_and_the_other_share_grows() {
        let budget = FormBudget::new(150.0, None, Some(20.0));
        let found = search(budget, |shares| {
            assert!(shares.residual <= 20.0);
            0.7 * shares.residual + 1.2 * shares.interpolation
        });
        assert_good_use(&found, 3);
    }

    /// An error that a finer path does not change at first. The search goes on until it does, or until
    /// the sums are far apart.
    #[test]
    fn a_search_does_not_end_on_a_stair() {
        let stairs = |shares: Tolerance| if shares.residual > 60.0 { 160.0 } else { 120.0 };
        let (errors, best) = search(FORM, stairs);
        assert_eq!(best.unwrap().error, 120.0, "{errors:?}");
        let flat = search(FORM, |_| 160.0);
        assert!(flat.0.len() <= MOST_PATHS, "{flat:?}");
    }

    /// Neither share matters, too much is left whatever they are, or both have bounds.
    #[test]
    fn where_no_path_can_be_better_the_search_ends_at_once() {
        assert_eq!(search(FORM, |_| 1e4).0.len(), 2);
        let stubborn = search(FORM, |shares| 170.0 + shares.interpolation);
        assert_eq!(stubborn.0.len(), 2);
        let bounds = FormBudget::new(150.0, Some(5.0), Some(5.0));
        assert_eq!(search(bounds, |shares| shares.residual).0.len(), 1);
        let nothing_cut = search(FORM, |_| f64::NAN);
        assert_eq!(nothing_cut.0.len(), 1);
    }

    /// An error in steps: the aim lies on neither.
    #[test]
    fn the_best_that_holds_is_kept() {
        let stairs = |shares: Tolerance| if shares.residual > 81.0 { 190.0 } else { 100.0 };
        let (errors, best) = search(FORM, stairs);
        assert!(errors.len() <= MOST_PATHS);
        let best = best.unwrap();
        assert_eq!(best.error, 100.0);
        let none = search(FORM, |shares| 200.0 + shares.residual);
        assert_eq!(
            none.1.unwrap().error,
            none.0.into_iter().fold(1e9, f64::min)
        );
    }
}
