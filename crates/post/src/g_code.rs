//! What controllers of G code share: the words of a line, the commands of headers and footers, and the moves
//! before and after a path.

mod commands;
mod groups;
mod read;
mod travel_words;
mod words;
mod write;

pub(crate) use commands::{commands, ends_program};
pub(crate) use groups::Groups;
pub(crate) use read::read_travel;
pub(crate) use travel_words::{TravelWords, read_spaced_travel};
pub(crate) use words::{refuse_broken_numbers, split_comment, without_comments};
pub(crate) use write::push_travel;
