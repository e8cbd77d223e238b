//! Answers of parallel work, in order. The error that counts is the first one along the path,
//! whichever thread met one first.

use rayon::prelude::*;

/// All answers, or the first error among them.
pub fn in_order<T: Send, E: Send>(
    answers: impl IndexedParallelIterator<Item = Result<T, E>>,
) -> Result<Vec<T>, E> {
    // One answer at a time: each is the work of milliseconds, and a thread that has none left takes the next.
    let answers: Vec<Result<T, E>> = answers.with_max_len(1).collect();
    answers.into_iter().collect()
}
