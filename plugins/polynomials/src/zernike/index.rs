//! The ways in which Zernike polynomials are numbered.

/// A numbering of the polynomials.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Indexing {
    /// Noll 1976: from 1; even numbers are cosines, odd ones sines.
    Noll,
    /// Fringe, of the University of Arizona: from 1, ordered by n + |m|; cosine before sine.
    Fringe,
    /// OSA/ANSI Z80.28: from 0, ordered by n, then by m; sines have m < 0.
    Osa,
}

/// The degree n and the order m of a polynomial; m < 0 for sin |m|θ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Order {
    /// The degree n.
    pub degree: i32,
    /// The order m.
    pub order: i32,
}

impl Indexing {
    /// The least number.
    pub fn first(self) -> i32 {
        match self {
            Self::Noll | Self::Fringe => 1,
            Self::Osa => 0,
        }
    }

    /// The number of the last polynomial whose degree is at most `degree`, such that all polynomials
    /// before it are of that degree too. In the Fringe numbering that is so for n + |m| ≤ `degree`.
    pub fn last(self, degree: i32) -> i32 {
        match self {
            Self::Noll => (degree + 1) * (degree + 2) / 2,
            Self::Fringe => (degree / 2 + 1) * (degree / 2 + 1),
            Self::Osa => (degree + 1) * (degree + 2) / 2 - 1,
        }
    }

    /// The polynomial of a number, which is at least [`first`](Self::first).
    pub fn order(self, number: i32) -> Order {
        match self {
            Self::Noll => noll(number),
            Self::Fringe => fringe(number),
            Self::Osa => osa(number),
        }
    }
}

/// The degree n whose polynomials include the one of this number, counted from 0 in order of n, and
/// its place among them.
fn row(number: i32) -> (i32, i32) {
    let mut degree = 0;
    let mut place = number;
    while place > degree {
        place -= degree + 1;
        degree += 1;
    }
    (degree, place)
}

fn noll(number: i32) -> Order {
    let (degree, place) = row(number - 1);
    // The orders grow: 0, 2, 2, 4, 4, … or 1, 1, 3, 3, …
    let order = if degree % 2 == 0 {
        2 * ((place + 1) / 2)
    } else {
        2 * (place / 2) + 1
    };
    let order = if number % 2 == 0 { order } else { -order };
    Order { degree, order }
}

fn osa(number: i32) -> Order {
    let (degree, place) = row(number);
    let order = 2 * place - degree;
    Order { degree, order }
}

fn fringe(number: i32) -> Order {
    let place = number - 1;
    // The group of n + |m| = 2g begins at g².
    let mut group = 0;
    while (group + 1) * (group + 1) <= place {
        group += 1;
    }
    let within = place - group * group;
    let order = group - within / 2;
    let sign = if within % 2 == 0 { 1 } else { -1 };
    Order {
        degree: 2 * group - order,
        order: sign * order,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn orders(indexing: Indexing, numbers: std::ops::RangeInclusive<i32>) -> Vec<(i32, i32)> {
        let order = |number| indexing.order(number);
        numbers
            .map(order)
            .map(|order| (order.degree, order.order))
            .collect()
    }

    /// Table I of Noll 1976, J. Opt. Soc. Am. 66: even numbers are cosines.
    #[test]
    fn noll_is_as_in_the_table_of_noll() {
        let table = [
            (0, 0),
            (1, 1),
            (1, -1),
            (2, 0),
            (2, -2),
            (2, 2),
            (3, -1),
            (3, 1),
            (3, -3),
            (3, 3),
            (4, 0),
            (4, 2),
            (4, -2),
            (4, 4),
            (4, -4),
            (5, 1),
            (5, -1),
            (5, 3),
            (5, -3),
            (5, 5),
            (5, -5),
            (6, 0),
        ];
        assert_eq!(orders(Indexing::Noll, 1..=22), table);
    }

    /// The list of the University of Arizona, as the manuals of design programs print it.
    #[test]
    fn fringe_is_as_in_the_lists_of_design_programs() {
        let table = [
            (0, 0),
            (1, 1),
            (1, -1),
            (2, 0),
            (2, 2),
            (2, -2),
            (3, 1),
            (3, -1),
            (4, 0),
            (3, 3),
            (3, -3),
            (4, 2),
            (4, -2),
            (5, 1),
            (5, -1),
            (6, 0),
            (4, 4),
            (4, -4),
        ];
        assert_eq!(orders(Indexing::Fringe, 1..=18), table);
        assert_eq!(orders(Indexing::Fringe, 36..=37), [(10, 0), (6, 6)]);
    }

    /// ANSI Z80.28, table of the double and the single index.
    #[test]
    fn osa_is_as_in_the_standard() {
        let table = [
            (0, 0),
            (1, -1),
            (1, 1),
            (2, -2),
            (2, 0),
            (2, 2),
            (3, -3),
            (3, -1),
            (3, 1),
            (3, 3),
            (4, -4),
            (4, -2),
            (4, 0),
        ];
        assert_eq!(orders(Indexing::Osa, 0..=12), table);
    }

    #[test]
    fn every_polynomial_up_to_the_last_has_one_number() {
        for indexing in [Indexing::Noll, Indexing::Fringe, Indexing::Osa] {
            let mut orders = orders(indexing, indexing.first()..=indexing.last(12));
            let count = orders.len();
            assert!(
                orders
                    .iter()
                    .all(|(n, m)| m.abs() <= *n && *n <= 12 && (n - m) % 2 == 0)
            );
            orders.sort_unstable();
            orders.dedup();
            assert_eq!(orders.len(), count);
        }
    }
}
