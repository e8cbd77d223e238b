//! The parts of a program by their names, and what a dialect writes around their lines.

/// A part of a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PartName {
    /// Its file's name without the ending.
    pub stem: String,
    /// Its file's name.
    pub file: String,
    /// Its number, from 1.
    pub number: u32,
    /// Its number among all programs of a controller that calls them by numbers.
    pub program_number: u32,
}

/// The number of the program with the first part: few programs of a machine's maker have one above 100.
const FIRST: u32 = 101;
/// From this number on a Turbo PMAC runs four programs as its G, M, T and D codes, and may protect all of them
/// by a password.
const END: u32 = 1000;
/// How far the first parts of the paths of a run are apart: each path has a hundred of its own, which a person
/// knows by the first digit.
const OF_A_PATH: u32 = 100;

/// Which names a controller takes for parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PartNames {
    /// Letters, digits, `-` and `_`, as many as there are.
    Free,
    /// Letters, digits and `_`, 24 at most without the ending. The first two are letters, or `_` and a letter: the
    /// names of programs of Sinumerik, Programming Manual 6FC5398-2EP40-0BA0, pages 42 and 491.
    Sinumerik,
}

/// Most characters of a name of [`PartNames::Sinumerik`].
const MOST_OF_SINUMERIK: usize = 24;
/// Digits of the numbers of parts, for which a long name has room.
const DIGITS_OF_PARTS: usize = 4;
/// What makes any name begin as Sinumerik wants it.
const BEGIN_OF_SINUMERIK: &str = "_p";

/// The numbers of the programs with the parts of a path, and what their names look like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PartNumbers {
    first: u32,
    most: u32,
    names: PartNames,
}

impl PartNumbers {
    /// Those of a path that is the only one of its run, and of any path where parts are called by names.
    pub const ALONE: Self = Self {
        first: FIRST,
        most: END - FIRST,
        names: PartNames::Free,
    };
    /// How many rough paths have numbers beside the finishing path.
    pub const MOST_ROUGH_PATHS: u32 = END / OF_A_PATH - 2;

    /// Those of one path of several: 0 is the finishing path, 1 the first rough one. They do not depend on how
    /// many parts the other paths have. A path beyond the last numbers has none.
    pub fn of_path(path: u32) -> Self {
        Self {
            first: FIRST.saturating_add(path.saturating_mul(OF_A_PATH)),
            most: match path <= Self::MOST_ROUGH_PATHS {
                true => OF_A_PATH - 1,
                false => 0,
            },
            names: PartNames::Free,
        }
    }

    /// The same with other names.
    #[must_use]
    pub fn with_names(self, names: PartNames) -> Self {
        Self { names, ..self }
    }

    /// How many parts the path may have.
    pub fn most(&self) -> u32 {
        self.most
    }

    /// The number of the program with a part, whose own number is from 1.
    pub(crate) fn program_of(&self, part: u32) -> u32 {
        self.first.saturating_add(part).saturating_sub(1)
    }

    /// The part that a program of this number has; `None` if it has none of the path.
    pub(crate) fn part_of(&self, program: u32) -> Option<u32> {
        let part = program.checked_sub(self.first)?.checked_add(1)?;
        (part <= self.most).then_some(part)
    }
}

/// What a dialect writes for a part.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PartLines {
    /// The line of the main program that calls it.
    pub call: String,
    /// What stands before its lines, each with its line end.
    pub begin: String,
    /// What stands behind them.
    pub end: String,
}

impl PartName {
    /// The name of part `number` of a program. Controllers differ in the characters that they take in names,
    /// so only letters, digits and `-` and `_` are kept, in lower case. A character beyond ASCII becomes its number,
    /// so that programs whose names differ in it have parts of different names.
    pub fn of(program: &str, number: u32, numbers: &PartNumbers) -> Self {
        let (stem, extension) = program.rsplit_once('.').unwrap_or((program, ""));
        let plain = |c: char| match c {
            'a'..='z' | 'A'..='Z' | '0'..='9' | '-' | '_' => c.to_ascii_lowercase().to_string(),
            _ if c.is_ascii() => "_".to_owned(),
            _ => format!("_{:x}", u32::from(c)),
        };
        let stem: String = stem.chars().map(plain).collect();
        let stem = match numbers.names {
            PartNames::Free => format!("{stem}-part-{number}"),
            PartNames::Sinumerik => sinumerik_name(&stem, number),
        };
        Self::of_file(&format!("{stem}.{extension}"), number, numbers)
    }

    /// The name of part `number`, which a file has.
    pub(crate) fn of_file(file: &str, number: u32, numbers: &PartNumbers) -> Self {
        let stem = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
        Self {
            stem: stem.to_owned(),
            file: file.to_owned(),
            number,
            program_number: numbers.program_of(number),
        }
    }
}

/// The name of a part as Sinumerik takes it. Of a long one the sum of its letters is kept, so that programs with
/// the same beginning have parts of different names.
fn sinumerik_name(stem: &str, number: u32) -> String {
    let mut stem = stem.replace('-', "_");
    let begins_well = matches!(stem.as_bytes(), [b'a'..=b'z' | b'_', b'a'..=b'z', ..]);
    if !begins_well {
        stem.insert_str(0, BEGIN_OF_SINUMERIK);
    }
    let end = format!("_part_{number}");
    // All parts of a program begin alike.
    let longest_end = end.len().max("_part_".len() + DIGITS_OF_PARTS);
    let room = MOST_OF_SINUMERIK.saturating_sub(longest_end);
    if stem.len() > room {
        let sum = format!("_{:04x}", sum_of(&stem));
        stem.truncate(room.saturating_sub(sum.len()));
        stem += &sum;
    }
    stem + &end
}

/// A sum of the letters of a name: FNV-1a of 32 bits, folded to 16.
fn sum_of(name: &str) -> u32 {
    const BASIS: u32 = 0x811C_9DC5;
    const PRIME: u32 = 0x0100_0193;
    let sum = name.bytes().fold(BASIS, |sum, byte| {
        (sum ^ u32::from(byte)).wrapping_mul(PRIME)
    });
    (sum >> 16) ^ (sum & 0xFFFF)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_for_sinumerik_have_the_characters_that_its_manual_allows() {
        let numbers = PartNumbers::ALONE.with_names(PartNames::Sinumerik);
        let of = |program: &str, number| PartName::of(program, number, &numbers).file;
        assert_eq!(of("mirror.mpf", 1), "mirror_part_1.mpf");
        assert_eq!(of("Lens-A.mpf", 12), "lens_a_part_12.mpf");
        assert_eq!(of("5mm.mpf", 1), "_p5mm_part_1.mpf");
        assert_eq!(of("r.mpf", 1), "_pr_part_1.mpf");
        assert_eq!(of("_a.mpf", 1), "_a_part_1.mpf");
        let long = [
            "off-axis-paraboloid-213mm.mpf",
            "off-axis-paraboloid-213mm-rough.mpf",
        ];
        let [one, other] = long.map(|program| of(program, 99_999));
        assert_ne!(one, other);
        let stem_of = |number| {
            of(long[0], number)
                .split_once("_part_")
                .map(|(stem, _)| stem.to_owned())
        };
        assert_eq!(stem_of(9), stem_of(1000));
        for program in [
            "-",
            "é",
            "__",
            "a",
            "very long name of a lens array.mpf",
            long[0],
        ] {
            for number in [1, 99_999] {
                let name = PartName::of(program, number, &numbers).stem;
                let bytes = name.as_bytes();
                let is_allowed = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
                assert!(name.len() <= 24 && bytes.iter().all(is_allowed), "{name}");
                assert!(bytes[0].is_ascii_alphabetic() || bytes[0] == b'_', "{name}");
                assert!(bytes[1].is_ascii_alphabetic(), "{name}");
            }
        }
    }

    #[test]
    fn names_that_differ_in_a_letter_of_any_alphabet_have_parts_of_different_names() {
        let of = |program: &str| PartName::of(program, 7, &PartNumbers::ALONE).file;
        assert_eq!(of("Linse 5-A_b.mpf"), "linse_5-a_b-part-7.mpf");
        assert_eq!(of("Linse Ä.mpf"), "linse__c4-part-7.mpf");
        assert_eq!(of("Linse Ö.mpf"), "linse__d6-part-7.mpf");
    }

    /// The hundreds of the paths do not meet, and none reaches the programs of codes.
    #[test]
    fn no_two_paths_of_a_run_have_a_number_in_common() {
        let mut seen = Vec::new();
        for path in 0..=PartNumbers::MOST_ROUGH_PATHS {
            let numbers = PartNumbers::of_path(path);
            assert_eq!(numbers.most(), 99);
            for part in 1..=numbers.most() {
                let program = numbers.program_of(part);
                assert!((101..1000).contains(&program) && !seen.contains(&program));
                assert_eq!(numbers.part_of(program), Some(part));
                seen.push(program);
            }
            assert_eq!(numbers.part_of(numbers.program_of(100)), None);
            assert_eq!(numbers.part_of(numbers.program_of(1) - 1), None);
        }
        let beyond = PartNumbers::of_path(PartNumbers::MOST_ROUGH_PATHS + 1);
        assert_eq!((beyond.most(), beyond.part_of(1001)), (0, None));
        assert_eq!(PartNumbers::ALONE.program_of(899), 999);
        assert_eq!(PartNumbers::of_path(u32::MAX).most(), 0);
    }
}
