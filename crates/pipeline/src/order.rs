//! Parallel answers in order: the error that counts is the first one along the path, whichever
//! thread came upon one first.

use rayon::prelude::*;

use crate::Result;

/// All answers, or the first error among them.
pub fn in_order<T: Send>(
    answers: impl IndexedParallelIterator<Item = Result<T>>,
) -> Result<Vec<T>> {
    let answers: Vec<Result<T>> = answers.collect();
    answers.into_iter().collect()
}
