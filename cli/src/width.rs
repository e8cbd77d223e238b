//! How wide a table may be.

use terminal_size::{Width, terminal_size_of};

use crate::crash::output_is_terminal;

/// Widest table, however wide the terminal.
const WIDEST: usize = 100;
/// Narrowest: a label and a few figures. What is narrower still breaks the lines itself.
const NARROWEST: usize = 40;

/// `COLUMNS` where it is set, else what the terminal has; 100 at most, and elsewhere.
pub fn of_terminal() -> usize {
    let set = std::env::var("COLUMNS").ok();
    let set = set.and_then(|text| text.trim().parse().ok());
    within(set.filter(|columns| *columns > 0).or_else(of_stdout))
}

fn of_stdout() -> Option<usize> {
    let (Width(columns), _) = terminal_size_of(output_is_terminal()?)?;
    Some(usize::from(columns)).filter(|columns| *columns > 0)
}

fn within(columns: Option<usize>) -> usize {
    columns.unwrap_or(WIDEST).clamp(NARROWEST, WIDEST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_as_wide_as_the_terminal_within_40_and_100() {
        let widths = [None, Some(1), Some(40), Some(72), Some(100), Some(400)].map(within);
        assert_eq!(widths, [100, 40, 40, 72, 100, 100]);
    }
}
