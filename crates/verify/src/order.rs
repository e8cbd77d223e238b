//! Answers of parallel work, in order. The error that counts is the first one in this order, whichever
//! thread met one first.

use rayon::prelude::*;

/// All answers, or the first error among them. All work runs to its end, also after an error.
///
/// # Errors
/// The first error in the order of the answers, whatever the number of threads.
pub fn in_order<T: Send, E: Send>(
    answers: impl IndexedParallelIterator<Item = Result<T, E>>,
) -> Result<Vec<T>, E> {
    let answers: Vec<Result<T, E>> = answers.collect();
    answers.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    /// The first part of the answers takes its time, the last ones end at once.
    #[test]
    fn the_first_error_counts_even_where_it_comes_last() {
        let threads = rayon::ThreadPoolBuilder::new().num_threads(4).build();
        let answer = |i: usize| {
            std::thread::sleep(Duration::from_millis(if i < 8 { 5 } else { 0 }));
            if i % 10 == 7 { Err(i) } else { Ok(i) }
        };
        let found = threads
            .unwrap()
            .install(|| in_order((0..64).into_par_iter().map(answer)));
        assert_eq!(found, Err(7));
        assert_eq!(
            in_order([Ok::<_, ()>(3), Ok(1)].into_par_iter()),
            Ok(vec![3, 1])
        );
    }
}
