//! Reads the blocks of a path. This follows the manual's description of polynomial interpolation, and
//! shares nothing with the writer.

use turnpath_core::toolpath::ControlPoint;

use crate::axes::{NAMES, times};
use crate::fixed_point::number;
use crate::g_code::Groups;
use crate::polynomial::{Cubic, CubicAxes};
use crate::post::Grammar;
use crate::program_format::ProgramFormat;

/// Seconds of a minute.
const MINUTE: f64 = 60.0;

/// The blocks of a program, in their order.
pub(super) struct PolyGrammar {
    format: ProgramFormat,
    /// The axes, once the first block said where they stand.
    axes: Option<CubicAxes>,
    modes: Modes,
    /// Whether `POLY` is on.
    poly: bool,
}

/// What the program has said of its numbers. A controller begins with what the program before has left.
#[derive(Default)]
struct Modes {
    /// `G71` or `G710`: lengths are in mm.
    metric: bool,
    /// `G90`: positions.
    absolute: bool,
    /// `G93`: F is one over minutes.
    inverse_time: bool,
    /// `G64`: the path is not stopped at the ends of blocks.
    goes_on: bool,
    /// `FGROUP()`: F refers to no chosen axis, as the way to the first point needs it.
    no_chosen_axis: bool,
    /// `FGROUP(C)`: C alone is the path to which F refers.
    c_is_path: bool,
    /// `UPATH`: the other axes follow the parameter.
    by_parameter: bool,
}

/// A polynomial, in 10⁻¹² mm or deg: its end, a2 and a3.
type Polynomial = [i128; 3];

impl PolyGrammar {
    pub(super) fn new(format: &ProgramFormat) -> Self {
        Self {
            format: *format,
            axes: None,
            modes: Modes::default(),
            poly: false,
        }
    }

    /// The steps of a block with `F`, one over its minutes.
    fn steps(&self, feed: f64) -> Result<i64, String> {
        let steps = MINUTE * self.format.steps_per_s as f64 / feed;
        if steps.round() >= 1.0 && steps.round() <= self.format.longest as f64 {
            return Ok(steps.round() as i64);
        }
        let range = times(self.format.steps_per_s, self.format.longest, "s");
        Err(format!(
            "F{feed} is no segment that the controller plays: 60/F must be {range}"
        ))
    }

    fn straight(&mut self, words: &[(usize, i128)]) -> Result<(), String> {
        let mut position = [None; 3];
        for (k, value) in words {
            if position[*k].replace(*value).is_some() {
                return Err(twice(NAMES[*k]));
            }
        }
        let missing = position.iter().position(Option::is_none);
        if let Some(k) = missing {
            return Err(format!("the first point does not give {}", NAMES[k]));
        }
        let position = position.map(Option::unwrap_or_default);
        self.axes = Some(CubicAxes::new(&self.format, position));
        Ok(())
    }

    fn polynomials(
        &mut self,
        found: [Option<Polynomial>; 3],
        steps: i64,
        points: &mut Vec<ControlPoint>,
    ) -> Result<(), String> {
        let axes = self.axes.as_mut();
        let axes = axes.ok_or("a polynomial before the first point")?;
        let position = axes.position();
        let mut cubics = position.map(|to| Cubic {
            to,
            begin: 0,
            end: 0,
        });
        for (k, polynomial) in found.into_iter().enumerate() {
            let from = position[k];
            // An axis without a polynomial stays where it is.
            // Numbers have 15 digits before the point at the most, so these sums are far from the end of
            // 128 bits.
            let [to, square, cube] = polynomial.unwrap_or([from, 0, 0]);
            let begin = to - from - square - cube;
            let end = begin + 2 * square + 3 * cube;
            cubics[k] = Cubic { to, begin, end };
            if k == 0 && [to - from, square, cube] == [0; 3] {
                return Err(
                    "C stands still: with `FGROUP(C)` and `UPATH` nothing says when and how the \
                     other axes move"
                        .to_owned(),
                );
            }
        }
        axes.play(cubics, steps, points)
    }
}

impl Grammar for PolyGrammar {
    fn split_comment<'a>(&self, line: &'a [u8]) -> (&'a [u8], Option<&'a [u8]>) {
        match line.iter().position(|byte| *byte == b';') {
            Some(at) => (&line[..at], Some(&line[at + 1..])),
            None => (line, None),
        }
    }

    fn read(&mut self, code: &str, points: &mut Vec<ControlPoint>) -> Result<(), String> {
        // The language has capital letters and others alike.
        let code = code.to_ascii_uppercase();
        let (mut straight, mut found, mut feed) = (Vec::new(), [None; 3], None);
        let mut is_straight = false;
        let mut groups = Groups::default();
        for word in without_number(&code)?.split_whitespace() {
            if let Some(Ok(number)) = word.strip_prefix('G').map(str::parse) {
                groups.take(number)?;
            }
            match word {
                "G71" | "G710" => self.modes.metric = true,
                "G90" => self.modes.absolute = true,
                "G93" => self.modes.inverse_time = true,
                "FGROUP(C)" => {
                    self.modes.c_is_path = true;
                    self.modes.no_chosen_axis = false;
                }
                "FGROUP()" => {
                    self.modes.c_is_path = false;
                    self.modes.no_chosen_axis = true;
                }
                "UPATH" => self.modes.by_parameter = true,
                "G64" => self.modes.goes_on = true,
                "G1" | "G01" if self.axes.is_some() => {
                    return Err("`G1` ends the path of polynomials".to_owned());
                }
                "G1" | "G01" => is_straight = true,
                "POLY" => self.poly = true,
                word => match word.as_bytes() {
                    [b'P', b'O', b'[', ..] => {
                        let (k, polynomial) = polynomial(word)?;
                        if found[k].replace(polynomial).is_some() {
                            return Err(twice(NAMES[k]));
                        }
                    }
                    [b'F', ..] => {
                        if feed.replace(feed_of(word)?).is_some() {
                            return Err(twice("F"));
                        }
                    }
                    _ => straight.push(axis_word(word)?),
                },
            }
        }
        let moves = found.iter().any(Option::is_some);
        if !moves && straight.is_empty() {
            return Ok(());
        }
        let modes = &self.modes;
        let needed = [
            (modes.metric, "G71"),
            (modes.absolute, "G90"),
            (modes.inverse_time, "G93"),
            (modes.goes_on, "G64"),
            (moves || modes.no_chosen_axis, "FGROUP()"),
        ];
        if let Some((_, word)) = needed.iter().find(|(is_said, _)| !is_said) {
            return Err(format!("a move before `{word}`"));
        }
        if moves && !(modes.c_is_path && modes.by_parameter) {
            return Err("a polynomial before `FGROUP(C)` and `UPATH`".to_owned());
        }
        let steps = self.steps(feed.ok_or("a move without F, which `G93` needs")?)?;
        match (is_straight, moves) {
            (true, false) => self.straight(&straight),
            (false, true) if self.poly && straight.is_empty() => {
                self.polynomials(found, steps, points)
            }
            _ => {
                Err("this block is neither a straight line to the path nor polynomials".to_owned())
            }
        }
    }

    fn holds_point(&self) -> bool {
        self.axes.as_ref().is_some_and(CubicAxes::holds_point)
    }

    fn finish(&mut self) -> Option<ControlPoint> {
        self.axes.as_mut().and_then(CubicAxes::finish)
    }
}

/// `PO[X]=(1.5,0.1)`: the axis and its polynomial. A coefficient that is left out is zero.
fn polynomial(word: &str) -> Result<(usize, Polynomial), String> {
    let parts = word.strip_prefix("PO[").and_then(|rest| {
        let (axis, list) = rest.split_once("]=(")?;
        Some((axis, list.strip_suffix(')')?))
    });
    let (axis, list) = parts.ok_or_else(|| not_a_word(word))?;
    let k = axis_of(axis, word)?;
    let mut polynomial = [0; 3];
    for (place, text) in list.split(',').enumerate() {
        let slot = polynomial.get_mut(place);
        let slot = slot.ok_or_else(|| format!("the polynomial of {axis} is no cubic"))?;
        *slot = number(axis, text)?;
    }
    Ok((k, polynomial))
}

/// `X1.5`.
fn axis_word(word: &str) -> Result<(usize, i128), String> {
    let axis = word.get(..1).ok_or_else(|| not_a_word(word))?;
    let k = axis_of(axis, word)?;
    let value = number(axis, word.get(1..).unwrap_or_default())?;
    Ok((k, value))
}

fn axis_of(axis: &str, word: &str) -> Result<usize, String> {
    let k = NAMES.iter().position(|name| *name == axis);
    k.ok_or_else(|| not_a_word(word))
}

fn feed_of(word: &str) -> Result<f64, String> {
    let digits = word.get(1..).unwrap_or_default();
    let is_number = digits.bytes().all(|b| b.is_ascii_digit() || b == b'.');
    let feed = digits.parse::<f64>().ok().filter(|_| is_number);
    feed.ok_or_else(|| not_a_word(word))
}

/// The words of a block behind its number, `N10`, which need not be there.
pub(super) fn without_number(code: &str) -> Result<&str, String> {
    let code = code.trim_start();
    let Some(numbered) = code.strip_prefix('N') else {
        return Ok(code);
    };
    let end = numbered.find(|c: char| !c.is_ascii_digit());
    let (digits, rest) = numbered.split_at(end.unwrap_or(numbered.len()));
    let is_number = !digits.is_empty() && !rest.starts_with(|c: char| !c.is_whitespace());
    is_number.then_some(rest).ok_or_else(|| {
        let word = code.split_whitespace().next().unwrap_or_default();
        not_a_word(word)
    })
}

fn twice(word: &str) -> String {
    format!("{word} appears twice on this line")
}

fn not_a_word(word: &str) -> String {
    let shown: String = word.chars().take(40).collect();
    format!("`{shown}` is not a word of a path of polynomials")
}
