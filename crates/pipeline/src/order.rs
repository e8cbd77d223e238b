//! Answers of parallel work, in order.

use rayon::prelude::*;

/// All answers, or the first error among them, whichever thread met one first. One answer at a time: each is
/// the work of milliseconds, and a thread that has none left takes the next.
pub fn one_at_a_time<T: Send, E: Send>(
    answers: impl IndexedParallelIterator<Item = Result<T, E>>,
) -> Result<Vec<T>, E> {
    turnpath_verify::in_order(answers.with_max_len(1))
}
