//! The groups of words with G. A controller takes one word of a group in a block; which of two it would take
//! is nowhere said.

/// The words with G of one block.
#[derive(Debug, Default)]
pub(crate) struct Groups {
    found: Vec<u32>,
}

impl Groups {
    /// Takes a word by its number.
    ///
    /// # Errors
    /// When the block has a word of its group already.
    pub(crate) fn take(&mut self, number: u32) -> Result<(), String> {
        let group = first_of_group(number);
        if self.found.contains(&group) {
            return Err(format!(
                "`G{number}` is the second word of its group on this line"
            ));
        }
        self.found.push(group);
        Ok(())
    }
}

/// The first word of a word's group, which stands for all of it.
fn first_of_group(number: u32) -> u32 {
    match number {
        0..=3 => 0,
        // X is a diameter or a radius.
        7 | 8 | 51 | 52 => 7,
        17..=19 => 17,
        20 | 21 | 70 | 71 | 700 | 710 => 20,
        40..=42 => 40,
        // What happens at corners.
        60 | 61 | 64 | 359 | 360 => 60,
        90 | 91 => 90,
        93..=95 => 93,
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_has_one_word_of_a_group() {
        let mut groups = Groups::default();
        for number in [40, 52, 71, 90, 93, 359, 1, 4, 54] {
            groups.take(number).unwrap();
        }
        for number in [0, 1, 51, 20, 91, 94, 360, 54] {
            assert!(groups.take(number).is_err(), "{number}");
        }
    }
}
