//! The programs of `pmac-pvt` as text: how they look, and what of them is refused.

use proptest::prelude::*;
use turnpath_core::DEG;
use turnpath_core::toolpath::{Cubic, PathBlock, Section, SectionBlock};

use super::PMAC_PVT;
use crate::program_format::TURN_DEG;
use crate::program_tests::{path_of, plain, program, read, read_to_fault};
use crate::{Layout, ProgramFormat, ReadPath};

fn good() -> String {
    let steps: Vec<[f64; 6]> = (1..=4)
        .map(|k| [0.003, 9.0, 2.5 - 0.001 * f64::from(k), 1.0, -0.2, 5.0])
        .collect();
    program(&plain(&PMAC_PVT), &path_of(&steps))
}

#[test]
fn the_program_looks_like_this() {
    let text = "\
OPEN PROG 1 CLEAR
; -- cutting --
ABS
PVT1000
C0:2864.7889757 X2.5:0 Z0:-0.3333333
PVT3
C9:3000 X2.499:-0.2 Z1:5
C18:3000 X2.498:-0.2 Z1:5
C27:3000 X2.497:-0.2 Z1:5
C36:3000 X2.496:-0.2 Z1:5
; -- end of path: 5 points --
CLOSE
";
    assert_eq!(good(), text);
}

fn replaced(line: usize, new: &str) -> String {
    let text = good();
    let mut lines: Vec<&str> = text.lines().collect();
    lines[line - 1] = new;
    lines.join("\n")
}

fn refusal(text: &str) -> String {
    read(&plain(&PMAC_PVT), text.as_bytes()).unwrap_err()
}

#[test]
fn damaged_lines_are_refused_with_their_number() {
    for (new, says) in [
        (
            "C18:3000 X2.498:NaN Z1:5",
            "line 8: the velocity of X has no number",
        ),
        (
            "C18:3000 XNaN:-0.2 Z1:5",
            "line 8: `XNaN:-0.2` is not a word",
        ),
        ("C18:3000 X2.498:-0.2 Q1:5", "line 8: `Q1:5` is not a word"),
        (
            "C18:3000 X2.4.98:-0.2 Z1:5",
            "line 8: `.98:-0.2` is not a word",
        ),
        (
            "C18:3000 X2.498: Z1:5",
            "line 8: the velocity of X has no number",
        ),
        ("C18:3000 X2.498:-0.2 Z1:5 Z1:5", "line 8: Z appears twice"),
        (
            "C18:3000 X2.498:-0.2 PVT3 Z1:5",
            "line 8: a mode follows a move",
        ),
        ("C5:3000 X2.498:-0.2 Z1:5", "line 8: C turns by -4"),
        ("C1800:3000 X2.498:-0.2 Z1:5", "line 8: C turns by 1791"),
        ("PVT0", "line 8: a segment cannot take 0 ms"),
        ("PVT5000", "line 8: a segment cannot take 5000 ms"),
        ("LINEAR", "line 8: `LINEAR` is not a word"),
        (
            "; -- lead-in --",
            "line 8: `; -- lead-in --` is out of order",
        ),
        (
            "",
            "line 11: the path has 4 points, but its end mark says 5",
        ),
        ("\u{fc}", "line 8: `\u{fc}` is not a word"),
    ] {
        let message = refusal(&replaced(8, new));
        assert!(message.contains(says), "{new}: {message}");
    }
}

#[test]
fn the_first_point_must_have_positions_of_all_axes_and_a_time() {
    for (line, new, says) in [
        (3, "INC", "line 5: the first point must be a position"),
        (4, "", "line 5: a move without a `PVT` time"),
        (5, "C0:1 X2.5:0", "line 5: the first point does not give Z"),
    ] {
        let message = refusal(&replaced(line, new));
        assert!(message.contains(says), "{new}: {message}");
    }
}

#[test]
fn an_incomplete_program_is_refused() {
    let text = good();
    let cut = text.split("; -- end").next().unwrap();
    let message = refusal(cut);
    assert!(
        message.contains("line 10: the program ends without"),
        "{message}"
    );
    let message = refusal(&cut[..cut.len() - 8]);
    assert!(message.contains("line 10:"), "{message}");
    let message = refusal("OPEN PROG 1 CLEAR\nX1:2\nCLOSE\n");
    assert!(message.contains("line 3: there is no path"), "{message}");
    let message = refusal("");
    assert!(message.contains("line 1: there is no path"), "{message}");
    let message = refusal(&"X".repeat(100_000));
    assert!(message.contains("line 1: this line is longer"), "{message}");
}

#[test]
fn reasonable_edits_by_hand_are_accepted() {
    let format = plain(&PMAC_PVT);
    let edited = "\
&1 I42=0 whatever the header says
;   -- CUTTING --
abs // all axes
  pvt 1000 z 0:-.3333333 x+2.5 C0:2864.7889757   ; another order
PVT3.0 C9:3000 X2.499:-0.2 Z1:5

INC(C)
N20 c9:3000 x 2.498 : -0.2 Z1.:5.0
TM3
C9:3000 X2.497:-0.2
ABS (C)
C36:3000 X2.496:-0.2 Z1:5\r
; -- END OF PATH: 5 points
whatever the footer says";
    let mut expected = read(&format, good().as_bytes()).unwrap();
    // Without a word, Z keeps its position and ends at rest.
    expected[3].vz = 0.0;
    assert_eq!(read(&format, edited.as_bytes()).unwrap(), expected);
}

#[test]
fn what_a_program_cannot_carry_is_refused_with_its_place() {
    let refused = |format: ProgramFormat, steps: &[[f64; 6]]| {
        let mut block = PathBlock::default();
        path_of(steps)
            .into_iter()
            .for_each(|point| block.push(point));
        let stretch = SectionBlock {
            section: Section::Cutting,
            opens_section: true,
            before: &[],
            points: &block,
        };
        let layout = Layout {
            format,
            ..plain(&PMAC_PVT)
        };
        layout.lines(&stretch).unwrap_err().to_string()
    };
    let plain_format = plain(&PMAC_PVT).format;
    let short = refused(plain_format, &[[1e-7, 9.0, 1.0, 1.0, 0.0, 0.0]]);
    assert!(
        short.contains("less than the controller's time step"),
        "{short}"
    );
    let wrapped = ProgramFormat {
        c_wrapped: true,
        ..plain_format
    };
    let turned = refused(wrapped, &[[0.1, 180.0, 1.0, 1.0, 0.0, 0.0]]);
    assert!(turned.contains("half a revolution"), "{turned}");
    let fine = ProgramFormat {
        position_decimals: 12,
        ..plain_format
    };
    let digits = refused(fine, &[[0.1, 9.0, 1e4, 1.0, 0.0, 0.0]]);
    assert!(
        digits.contains("X = 10000 at 0.100000 s has too many digits"),
        "{digits}"
    );
}

#[test]
fn wrapped_c_is_written_within_one_revolution_and_read_unwrapped() {
    let steps: Vec<[f64; 6]> = (0..100).map(|_| [0.003, 9.0, 1.0, 1.0, 0.0, 0.0]).collect();
    for c_reversed in [false, true] {
        let plain = plain(&PMAC_PVT);
        let format = Layout {
            format: ProgramFormat {
                c_wrapped: true,
                c_reversed,
                ..plain.format
            },
            ..plain
        };
        let text = program(&format, &path_of(&steps));
        for line in text
            .lines()
            .filter(|line| line.starts_with('C') && *line != "CLOSE")
        {
            let c: f64 = line[1..].split(':').next().unwrap().parse().unwrap();
            assert!((0.0..TURN_DEG as f64).contains(&c), "{line}");
        }
        let read = read(&format, text.as_bytes()).unwrap();
        assert!((read[100].c / DEG - 900.0).abs() < 1e-9);
    }
}

#[test]
fn the_default_velocity_digits_cost_less_than_a_position_digit() {
    let format = plain(&PMAC_PVT).format;
    let half = |decimals: u32| 0.5 / 10u64.pow(decimals) as f64;
    let velocity = half(format.velocity_decimals);
    // The worst case: both ends off by half a digit, one up, one down, over a second.
    let off = Cubic::hermite(0.0, velocity, 0.0, -velocity, 1.0);
    let largest = (0..=100)
        .map(|k| off.value(f64::from(k) / 100.0))
        .fold(0.0, f64::max);
    assert!(largest < 0.51 * half(format.position_decimals), "{largest}");
}

#[test]
fn a_program_reads_the_same_from_a_file_and_from_memory() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("path.pmc");
    std::fs::write(&path, good()).unwrap();
    let format = plain(&PMAC_PVT);
    let mut file = format.open(&path).unwrap();
    let good = good();
    let mut memory = format.read(good.as_bytes(), "memory");
    loop {
        let (one, other) = (file.next_point().unwrap(), memory.next_point().unwrap());
        assert_eq!(one, other);
        if one.is_none() {
            break;
        }
    }
    assert_eq!(file.read_count().points(), 5);
}

#[test]
fn a_line_longer_than_any_is_refused_though_all_of_its_words_are_good() {
    let with_zeros = |count: usize| {
        let zeros = "0".repeat(count);
        let text = format!("; -- cutting --\nABS\nPVT3\nC0:1 X2:1 Z0:1\nC9:1 X{zeros}1:1 Z1:1\n");
        read_to_fault(&plain(&PMAC_PVT), text.as_bytes())
    };
    assert_eq!(with_zeros(10).0.len(), 2);
    let (points, fault) = with_zeros(70_000);
    assert_eq!(points.len(), 1);
    assert!(fault.unwrap().contains("longer than any line"));
}

/// A word that a program may have by mistake: a number of any length, or none.
fn spoiled_word() -> impl Strategy<Value = String> {
    prop_oneof![
        2 => "-?[0-9]{0,22}(\\.[0-9]{0,22})?",
        1 => "[+-]?[0-9A-Z:. -]{0,4}",
    ]
}

const LINES: usize = 6;
/// The words of a line with the time before it: time, velocity of C, position and velocity of X and Z.
const WORDS: usize = 6;

fn good_words() -> impl Strategy<Value = [String; WORDS]> {
    let time = "([1-9][0-9]{0,2}(\\.[0-9]{1,3})?)?";
    let position = "-?[0-9]{1,3}(\\.[0-9]{1,9})?";
    let velocity = "-?[0-9]{1,4}(\\.[0-9]{1,9})?";
    [time, velocity, position, velocity, position, velocity]
}

/// A program with these words; `blank` stands in places where it has no meaning.
fn program_of(mode: &str, lines: &[[String; WORDS]], blank: &str) -> String {
    let mut text = format!("; -- cutting --\nABS\nPVT1000\nC0:1 X2:1 Z0:1\n{mode}\n");
    for (k, [time, vc, x, vx, z, vz]) in lines.iter().enumerate() {
        if !time.is_empty() {
            text += &format!("PVT{time}{blank}\n");
        }
        text += &format!("C{}:{vc} {blank}X{x}:{vx} Z{z}:{vz}{blank}\n", 9 * k + 9);
    }
    text + &format!("; -- end of path: {} points --\n", lines.len() + 1)
}

proptest! {
    /// Lines that are written as nearly all are have the meaning that they have with more blanks, and their
    /// faults too: those go through the reader of any line.
    #[test]
    fn lines_in_one_go_mean_what_they_mean_word_by_word(
        mut lines in proptest::collection::vec(good_words(), LINES),
        mode in "ABS|INC|ABS\nINC\\(X\\)|",
        mantissa_bits in proptest::option::of(20u32..53),
        spoiled in proptest::option::of((0..LINES, 0..WORDS, spoiled_word())),
    ) {
        let whole_lines = spoiled.as_ref().map_or(LINES, |(line, ..)| *line);
        if let Some((line, word, text)) = spoiled {
            lines[line][word] = text;
        }
        let layout = plain(&PMAC_PVT);
        let format = ProgramFormat { mantissa_bits, ..layout.format };
        let layout = Layout { format, ..layout };
        let [at_once, by_word] = ["", " "].map(|blank| {
            let (points, fault) = read_to_fault(&layout, program_of(&mode, &lines, blank).as_bytes());
            (points.len(), format!("{points:?} {fault:?}"))
        });
        prop_assert_eq!(&at_once, &by_word);
        prop_assert!(at_once.0 > whole_lines, "{} of {whole_lines} lines", at_once.0);
    }
}
