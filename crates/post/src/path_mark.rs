//! The marks of a program: comments that say where its path begins and ends, and what lies around it.

use turnpath_core::toolpath::Section;

use crate::program_format::{
    APPROACH_MARK, DEPTHS_MARK, END_MARK, END_OF_DEPTHS_MARK, RETREAT_MARK, mark,
};

/// A mark, in the order of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PathMark {
    /// The lines that begin a loop over depths follow.
    Depths,
    /// The approach follows.
    Approach,
    /// A section follows.
    Section(Section),
    /// The retreat follows.
    Retreat,
    /// The lines that end the loop follow.
    EndOfDepths,
    /// The path ends.
    End {
        /// The number of its points, if the mark gives it.
        points: Option<u64>,
    },
}

impl PathMark {
    /// The mark that a comment is; `None` if it is another comment. `text` has small letters alone.
    pub(crate) fn of(text: &str) -> Option<Self> {
        let sections = [Section::LeadIn, Section::Cutting, Section::LeadOut];
        let section = sections.into_iter().find(|section| text == mark(*section));
        match text {
            DEPTHS_MARK => Some(Self::Depths),
            APPROACH_MARK => Some(Self::Approach),
            RETREAT_MARK => Some(Self::Retreat),
            END_OF_DEPTHS_MARK => Some(Self::EndOfDepths),
            _ => section.map(Self::Section).or_else(|| {
                let points = said_points(text.strip_prefix(END_MARK)?);
                Some(Self::End { points })
            }),
        }
    }
}

/// The points that an end mark says, by what stands behind its first words: `: 12 points`, and two
/// dashes that may be missing.
fn said_points(said: &str) -> Option<u64> {
    let number = said.trim_start().strip_prefix(':')?.trim_start();
    let end = number.find(|c: char| !c.is_ascii_digit())?;
    let (digits, rest) = number.split_at(end);
    let points = rest.trim_start().strip_prefix("points")?;
    let is_whole = matches!(points.trim_start(), "" | "--");
    digits.parse().ok().filter(|_| is_whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_mark_that_a_program_has_is_known() {
        for (text, mark) in [
            ("-- depths --", PathMark::Depths),
            ("-- approach --", PathMark::Approach),
            ("-- lead-in --", PathMark::Section(Section::LeadIn)),
            ("-- cutting --", PathMark::Section(Section::Cutting)),
            ("-- lead-out --", PathMark::Section(Section::LeadOut)),
            ("-- retreat --", PathMark::Retreat),
            ("-- end of depths --", PathMark::EndOfDepths),
        ] {
            assert_eq!(PathMark::of(text), Some(mark), "{text}");
        }
        assert_eq!(PathMark::of("-- part 1 --"), None);
        assert_eq!(PathMark::of("-- cutting"), None);
    }

    #[test]
    fn an_end_mark_gives_the_number_of_points_or_none() {
        for (text, points) in [
            ("-- end of path: 12 points --", Some(12)),
            ("-- end of path: 12 points", Some(12)),
            ("-- end of path : 12 points --", Some(12)),
            ("-- end of path --", None),
            ("-- end of path: points --", None),
            ("-- end of path: 12 points or more --", None),
        ] {
            assert_eq!(PathMark::of(text), Some(PathMark::End { points }), "{text}");
        }
    }
}
