//! Rows of a file that says how far it is from point to point. One distance that is wrong, lost or added
//! moves all rows behind it, and only one of them is at fault.

use turnpath_core::toolpath::ControlPoint;

use super::row::{HalfDigits, PathRow};

/// How far C, X and Z of such rows are moved.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Shift([f64; 3]);

/// What a row of the file is to the row of the recipe's path that is compared next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kinship {
    /// Its partner.
    Partner,
    /// The partner of the row after: the recipe's row is lost.
    PartnerOfNext,
    /// Nobody's partner: it was added.
    Added,
}

/// The next rows of both paths, and the last two that belong together.
pub(super) struct Neighbourhood<'a> {
    /// The last rows that belong together, of the file and of the recipe's path.
    pub last: [&'a PathRow; 2],
    /// The next rows of the file.
    pub file: [Option<&'a PathRow>; 2],
    /// The next rows of the recipe's path.
    pub remade: [Option<&'a PathRow>; 2],
}

impl Shift {
    /// How far a row of the file lies beside its partner, rounded to a whole number of the file's last digits.
    pub fn between(file: &PathRow, remade: &PathRow, digits: &HalfDigits) -> Self {
        let (file, remade, half_digits) = (file.place(), remade.place(), digits.of_place());
        Self(std::array::from_fn(|axis| {
            let (apart, digit) = (file[axis] - remade[axis], 2.0 * half_digits[axis]);
            match digit > 0.0 {
                true => digit * (apart / digit).round(),
                false => apart,
            }
        }))
    }

    /// A row of the file where it would be without its shift.
    pub fn taken_from(&self, row: &PathRow) -> PathRow {
        let Self([c, x, z]) = self;
        let point = ControlPoint {
            c: row.point.c - c,
            x: row.point.x - x,
            z: row.point.z - z,
            ..row.point
        };
        PathRow { point, ..*row }
    }
}

impl Neighbourhood<'_> {
    /// What the file's next row is, by the distances before and behind it; `None` if they do not show it.
    pub fn kinship(&self, digits: &HalfDigits) -> Option<Kinship> {
        let ([last_file, last_remade], [file, file_after]) = (self.last, self.file);
        let [remade, remade_after] = self.remade;
        let to_file = file.map(|row| [last_file, row]);
        let beyond_file = file.zip(file_after).map(<[_; 2]>::from);
        let to_remade = remade.map(|row| [last_remade, row]);
        let beyond_remade = remade.zip(remade_after).map(<[_; 2]>::from);
        let same = |file: Option<[&PathRow; 2]>, remade: Option<[&PathRow; 2]>| {
            let both = file.zip(remade);
            both.is_some_and(|(file, remade)| digits.same_way(file, remade))
        };
        if same(to_file, to_remade) || same(beyond_file, beyond_remade) {
            Some(Kinship::Partner)
        } else if same(to_file, beyond_remade) {
            Some(Kinship::PartnerOfNext)
        } else if same(beyond_file, to_remade) {
            Some(Kinship::Added)
        } else {
            None
        }
    }
}
