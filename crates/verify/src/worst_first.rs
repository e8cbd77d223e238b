//! A list that keeps the worst of many and counts all, in bounded memory.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// Largest number of anomalies that are kept. All are counted. So many fill some megabytes of JSON,
/// and nobody reads more.
pub const MOST_KEPT: usize = 10_000;

/// The worst of all items that were added.
#[derive(Debug, Clone)]
pub struct WorstFirst<T> {
    count: u64,
    kept: BinaryHeap<Reverse<Ranked<T>>>,
}

impl<T> Default for WorstFirst<T> {
    fn default() -> Self {
        Self {
            count: 0,
            kept: BinaryHeap::new(),
        }
    }
}

/// An item with how bad it is. The earlier of two that are as bad is the worse one.
#[derive(Debug, Clone)]
struct Ranked<T> {
    badness: f64,
    number: u64,
    item: T,
}

impl<T> WorstFirst<T> {
    /// Adds an item. What is no number is worse than all that is.
    pub fn add(&mut self, badness: f64, item: T) {
        let badness = match badness.is_nan() {
            true => f64::INFINITY,
            false => badness,
        };
        let number = self.count;
        self.count += 1;
        self.kept.push(Reverse(Ranked {
            badness,
            number,
            item,
        }));
        if self.kept.len() > MOST_KEPT {
            self.kept.pop();
        }
    }

    /// How many items were added.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The worst items, the worst one first.
    pub fn into_items(self) -> Vec<T> {
        let ranked = self.kept.into_sorted_vec().into_iter();
        ranked.map(|Reverse(ranked)| ranked.item).collect()
    }
}

impl<T> Ord for Ranked<T> {
    fn cmp(&self, other: &Self) -> Ordering {
        let badness = self.badness.total_cmp(&other.badness);
        badness.then(other.number.cmp(&self.number))
    }
}

impl<T> PartialOrd for Ranked<T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<T> PartialEq for Ranked<T> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl<T> Eq for Ranked<T> {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_come_first_and_the_earlier_of_two_that_are_as_bad() {
        let mut list = WorstFirst::default();
        for (badness, name) in [(1.0, "a"), (3.0, "b"), (f64::NAN, "c"), (3.0, "d")] {
            list.add(badness, name);
        }
        assert_eq!(list.count(), 4);
        assert_eq!(list.into_items(), ["c", "b", "d", "a"]);
    }

    #[test]
    fn the_least_are_dropped_and_counted() {
        let mut list = WorstFirst::default();
        let all = MOST_KEPT as u64 + 500;
        for i in 0..all {
            // Every badness once, in an order that is not sorted: 7919 is prime.
            list.add((i * 7919 % all) as f64, i);
        }
        assert_eq!(list.count(), all);
        let kept = list.into_items();
        assert_eq!(kept.len(), MOST_KEPT);
        let badness = |i: &u64| i * 7919 % all;
        assert_eq!(badness(&kept[0]), all - 1);
        assert_eq!(badness(&kept[MOST_KEPT - 1]), 500);
    }
}
