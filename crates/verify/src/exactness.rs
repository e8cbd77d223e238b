//! How exact the largest error of a segment has to be: a report says the error itself, and refinement asks on which side
//! of its aim the error lies.

/// How exact an error is wanted.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Exactness<'a> {
    /// As exact as a report says it.
    Full,
    /// It has to lie on the right side of each of these amounts, mm.
    Side(&'a [f64]),
}

impl Exactness<'_> {
    /// Whether it makes a difference that an error of this amount, mm, may be larger by up to `rise`.
    pub fn distinguishes(self, error: f64, rise: f64) -> bool {
        match self {
            Self::Full => true,
            Self::Side(limits) => limits
                .iter()
                .any(|limit| (error..error + rise).contains(limit)),
        }
    }
}
