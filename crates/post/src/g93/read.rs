//! Reads the lines of a path. This follows the RS274 language as far as a path needs it, and shares
//! nothing with the writer.
//!
//! Where the controller makes a feed rate of F, the reader does the same and takes the time that the
//! rate gives. A line that would come at another time than F says is refused.

use turnpath_core::toolpath::ControlPoint;

use crate::axes::{Axes, AxisWords, NAMES, steps_of};
use crate::fixed_point::{ONE, number};
use crate::g_code::{Groups, refuse_broken_numbers, split_comment, without_comments};
use crate::post::Grammar;
use crate::program_format::{FeedMeaning, ProgramFormat, Slowest};

/// Seconds of a minute.
const MINUTE: f64 = 60.0;
/// X, Z: a way that LinuxCNC's interpreter counts as none, in 10⁻¹² mm.
const TINY: u128 = 100_000;
/// By how much the time that a rate gives may differ from what F says, as a part of it: rounding alone.
const SAME_TIME: f64 = 1e-6;

/// The words besides axes that may stand in a path.
#[derive(Debug, Clone, Copy)]
pub(super) struct Words {
    /// What the program must have said before it moves.
    pub(super) needed: &'static [&'static str],
    /// What it may say too.
    pub(super) allowed: &'static [&'static str],
    /// Whether `G4 P…` waits so many seconds.
    pub(super) dwells: bool,
    /// Whether blanks may stand within numbers.
    pub(super) numbers_have_blanks: bool,
}

/// The lines of a program, in their order.
pub(super) struct LineGrammar {
    format: ProgramFormat,
    words: Words,
    axes: Axes,
    /// Which of the needed words the program has said.
    said: Vec<&'static str>,
    /// Whether straight lines are on.
    straight: bool,
    /// Where the axes stand, in 10⁻¹² mm or deg, as the program says it; `None` before the first point.
    place: Option<[i128; 3]>,
}

/// What one line says.
#[derive(Default)]
struct Line {
    /// Positions, in 10⁻¹² mm or deg.
    position: [Option<i128>; 3],
    /// F as it is written, and as a number.
    feed: Option<(i128, f64)>,
    /// P of a dwell, in 10⁻¹² s.
    wait: Option<i128>,
    dwells: bool,
    modes: Groups,
}

impl LineGrammar {
    pub(super) fn new(format: &ProgramFormat, words: Words) -> Self {
        Self {
            format: *format,
            words,
            axes: Axes::new(*format),
            said: Vec::new(),
            straight: false,
            place: None,
        }
    }

    /// Takes a word that is a letter and its number.
    fn take(&mut self, line: &mut Line, letter: char, text: &str) -> Result<(), String> {
        let axis = NAMES.iter().position(|name| name.starts_with(letter));
        match (letter, axis) {
            (_, Some(k)) => {
                let value = number(NAMES[k], text)?;
                let before = line.position[k].replace(value);
                refuse_twice(NAMES[k], before.is_some())
            }
            ('F', _) => {
                let value = (number("F", text)?, float("F", text)?);
                refuse_twice("F", line.feed.replace(value).is_some())
            }
            ('P', _) => refuse_twice("P", line.wait.replace(number("P", text)?).is_some()),
            // The number of a line does nothing.
            ('N', _) if text.bytes().all(|byte| byte.is_ascii_digit()) => Ok(()),
            ('G', _) => self.take_mode(line, text),
            _ => Err(format!("`{letter}{text}` is not a word of a path")),
        }
    }

    fn take_mode(&mut self, line: &mut Line, text: &str) -> Result<(), String> {
        let digits = text.trim_start_matches('0');
        let word = format!("G{}", if digits.is_empty() { "0" } else { digits });
        if let Ok(number) = digits.parse() {
            line.modes.take(number)?;
        }
        let is_said = |known: &&&str| **known == word;
        if word == "G1" {
            self.straight = true;
        } else if word == "G4" && self.words.dwells {
            line.dwells = true;
        } else if let Some(known) = self.words.needed.iter().find(is_said) {
            self.said.push(*known);
        } else if !self.words.allowed.iter().any(|known| is_said(&known)) {
            return Err(format!("`G{text}` is not a word of a path"));
        }
        Ok(())
    }

    /// The steps of a line that goes from where the axes stand to `to`.
    fn steps(&self, feed: (i128, f64), to: &[i128; 3]) -> Result<i64, String> {
        let (steps_per_s, longest) = (self.format.steps_per_s, self.format.longest);
        let chords = self.format.chords;
        let steps = match chords.map(|chords| chords.feed) {
            Some(FeedMeaning::Seconds) => steps_of(feed.0, steps_per_s, longest),
            _ => {
                let steps = (MINUTE * steps_per_s as f64 / feed.1).round();
                (1.0..=longest as f64)
                    .contains(&steps)
                    .then_some(steps as i64)
            }
        };
        let steps = steps
            .ok_or_else(|| format!("F{} is no time of a line, which is 1 ns to 1000 s", feed.1))?;
        let slowest = chords.and_then(|chords| chords.slowest);
        if let Some((slowest, from)) = slowest.zip(self.place) {
            let said = 1.0 / feed.1;
            let played = played_minutes(&slowest, feed.1, &from, to)?;
            if (played - said).abs() > SAME_TIME * said {
                return Err(format!(
                    "LinuxCNC plays this line in {:e} s and not in {:e} s, because its feed rate \
                     would be below {} in a minute",
                    MINUTE * played,
                    MINUTE * said,
                    slowest.rate
                ));
            }
        }
        Ok(steps)
    }

    fn go_to(&mut self, line: &Line) -> Result<ControlPoint, String> {
        let missing = self
            .words
            .needed
            .iter()
            .find(|word| !self.said.contains(word));
        if let Some(word) = missing {
            return Err(format!("a move before `{word}`"));
        }
        if !self.straight {
            return Err("a move before `G1`".to_owned());
        }
        let feed = line.feed.ok_or("a move without F, which `G93` needs")?;
        let mut to = self.place.unwrap_or_default();
        let mut words: AxisWords = [None; 3];
        for (k, word) in words.iter_mut().enumerate() {
            to[k] = line.position[k].unwrap_or(to[k]);
            *word = line.position[k].map(|position| (position, None));
        }
        let steps = self.steps(feed, &to)?;
        let point = self.axes.go_to(&words, [true; 3], steps)?;
        self.place = Some(to);
        Ok(point)
    }

    fn wait(&mut self, line: &Line) -> Result<ControlPoint, String> {
        let wait = line
            .wait
            .ok_or("`G4` without P, the seconds that it waits")?;
        if line.position != [None; 3] {
            return Err("an axis moves in a line with `G4`".to_owned());
        }
        if self.place.is_none() {
            return Err("`G4` before the first point".to_owned());
        }
        let steps = steps_of(wait, self.format.steps_per_s, self.format.longest);
        let steps = steps.ok_or("`G4` waits 1 ns to 1000 s")?;
        self.axes.go_to(&[None; 3], [true; 3], steps)
    }
}

impl Grammar for LineGrammar {
    fn split_comment<'a>(&self, line: &'a [u8]) -> (&'a [u8], Option<&'a [u8]>) {
        split_comment(line)
    }

    fn read(&mut self, code: &str, points: &mut Vec<ControlPoint>) -> Result<(), String> {
        if !self.words.numbers_have_blanks {
            refuse_broken_numbers(code)?;
        }
        let code = without_comments(code)?;
        let mut line = Line::default();
        let mut rest = code.as_str();
        let mut letters = rest.chars();
        while let Some(letter) = letters.next() {
            rest = letters.as_str();
            if !letter.is_ascii_alphabetic() {
                return Err(format!("`{letter}` where a word begins"));
            }
            let end = rest.find(|c: char| !matches!(c, '0'..='9' | '.' | '-' | '+'));
            let (number, behind) = rest.split_at(end.unwrap_or(rest.len()));
            self.take(&mut line, letter, number)?;
            letters = behind.chars();
        }
        match (line.dwells, line.position != [None; 3]) {
            (true, _) => points.push(self.wait(&line)?),
            (false, _) if line.wait.is_some() => return Err("P without `G4`".to_owned()),
            (false, true) => points.push(self.go_to(&line)?),
            (false, false) => {}
        }
        Ok(())
    }
}

/// The minutes in which LinuxCNC plays a line, by its interpreter's rule: F becomes a feed rate.
fn played_minutes(
    slowest: &Slowest,
    feed: f64,
    from: &[i128; 3],
    to: &[i128; 3],
) -> Result<f64, String> {
    let way = |k: usize| (to[k] - from[k]) as f64 / ONE as f64;
    let size = |k: usize| to[k].abs_diff(from[k]);
    let (moves, counts) = (size(1) + size(2) > 0, size(1).max(size(2)) > TINY);
    let length = match (moves, counts) {
        (true, true) => (way(1) * way(1) + way(2) * way(2)).sqrt(),
        (false, _) => way(0).abs(),
        (true, false) => {
            return Err(
                "X and Z move by no more than 1e-7 mm, which LinuxCNC takes for a line of C alone"
                    .to_owned(),
            );
        }
    };
    if length == 0.0 {
        return Err(
            "no axis moves: LinuxCNC plays such a line in no time; `G4 P…` waits".to_owned(),
        );
    }
    Ok(length / (length * feed).max(slowest.rate))
}

fn refuse_twice(name: &str, twice: bool) -> Result<(), String> {
    match twice {
        true => Err(format!("{name} appears twice on this line")),
        false => Ok(()),
    }
}

/// A positive decimal number as a double.
fn float(what: &str, text: &str) -> Result<f64, String> {
    let value: Option<f64> = text.parse().ok();
    let positive = value.filter(|value| *value > 0.0 && value.is_finite());
    positive.ok_or_else(|| format!("{what} is no positive number"))
}
