//! Reads a loop over depths in the words of Moore Nanotech's machines, and plays it: what Z's zero is each time.
//! This shares nothing with the writer.

use std::collections::{BTreeMap, BTreeSet};

use crate::fixed_point::{ONE, number};
use crate::g_code::without_comments;
use crate::post::{DepthLoop, behind_number};

/// Most turns of a loop that are played: far more than any part is cut with.
const MOST_TURNS: usize = 2000;
/// Most statements of a loop.
const MOST_STATEMENTS: usize = 100;
/// Whole numbers up to this one are exact as doubles.
const LARGEST_COUNT: u128 = 1 << 53;

/// A loop as it is read.
#[derive(Debug, Default)]
pub(super) struct WhileLoop {
    /// Before `WHILE`.
    before: Vec<Statement>,
    /// `WHILE[#left LT #right] DO number`.
    head: Option<Head>,
    /// Within the loop, before the path.
    above: Vec<Statement>,
    /// Within the loop, behind the path.
    below: Vec<Statement>,
    /// Whether `END` was read.
    ended: bool,
}

/// The line that begins a loop.
#[derive(Debug, Clone)]
struct Head {
    /// The loop goes on while the one is less than the other.
    left: Term,
    right: Term,
    number: String,
}

/// A number in 10⁻¹², or a variable.
#[derive(Debug, Clone)]
enum Term {
    Number(i128),
    Variable(u32),
}

/// A line within or before a loop.
#[derive(Debug, Clone)]
enum Statement {
    /// `#8 = #8 - #103`: the first term, and the second with its sign.
    Set(u32, Term, Option<(i128, Term)>),
    /// `G52 X0 Y0 Z[#8]`, or `G52 Z[#8]`.
    Shift(Term),
}

impl DepthLoop for WhileLoop {
    fn read(&mut self, code: &str, ends: bool) -> Result<(), String> {
        let code = without_comments(code)?;
        let code = behind_number(&code);
        if code.is_empty() {
            return Ok(());
        }
        if self.ended {
            return Err("a line behind the end of the loop over depths".to_owned());
        }
        if let Some(head) = head(code)? {
            let is_in_place = !ends && self.head.is_none();
            self.head = Some(head);
            return match is_in_place {
                true => Ok(()),
                false => Err("a loop within the loop over depths".to_owned()),
            };
        }
        if let Some(number) = code.strip_prefix("END") {
            self.ended = true;
            let is_same = self.head.as_ref().is_some_and(|head| head.number == number);
            return match ends && is_same {
                true => Ok(()),
                false => Err(format!("`END {number}` does not end the loop over depths")),
            };
        }
        let statements = match (ends, &self.head) {
            (true, _) => &mut self.below,
            (false, Some(_)) => &mut self.above,
            (false, None) => &mut self.before,
        };
        if statements.len() >= MOST_STATEMENTS {
            return Err("the loop over depths has too many lines".to_owned());
        }
        statements.push(statement(code)?);
        Ok(())
    }

    fn shifts(&self) -> Result<Vec<i128>, String> {
        let head = self.head.as_ref().filter(|_| self.ended);
        let head = head.ok_or("the loop over depths has no `WHILE`, or no `END`")?;
        let mut state = State {
            counters: self.counters(head),
            ..State::default()
        };
        for limit in [&head.left, &head.right] {
            if let Term::Number(value) = limit {
                refuse_part(*value)?;
            }
        }
        state.play(&self.before)?;
        let mut shifts = Vec::new();
        while state.value(&head.left)? < state.value(&head.right)? {
            state.play(&self.above)?;
            shifts.push(state.shift);
            state.play(&self.below)?;
            if shifts.len() > MOST_TURNS {
                return Err("the loop over depths does not come to its end".to_owned());
            }
        }
        match state.shift {
            0 => Ok(shifts),
            _ => Err("Z's zero is shifted behind the loop over depths".to_owned()),
        }
    }
}

impl WhileLoop {
    /// The variables on which the number of turns depends.
    fn counters(&self, head: &Head) -> BTreeSet<u32> {
        let mut counters: BTreeSet<u32> = head.left.variable().into_iter().collect();
        counters.extend(head.right.variable());
        loop {
            let before = counters.len();
            for statement in [&self.before, &self.above, &self.below]
                .into_iter()
                .flatten()
            {
                if let Statement::Set(name, first, second) = statement
                    && counters.contains(name)
                {
                    counters.extend(first.variable());
                    counters.extend(second.as_ref().and_then(|(_, term)| term.variable()));
                }
            }
            if counters.len() == before {
                return counters;
            }
        }
    }
}

impl Term {
    fn variable(&self) -> Option<u32> {
        match self {
            Self::Number(_) => None,
            Self::Variable(name) => Some(*name),
        }
    }
}

/// A controller counts in doubles, in which tenths are not exact: after eight steps of 0.1 it may make one more.
fn refuse_part(value: i128) -> Result<i128, String> {
    let is_exact = value % ONE == 0 && value.unsigned_abs() / ONE.unsigned_abs() <= LARGEST_COUNT;
    is_exact.then_some(value).ok_or_else(|| {
        let shown = value as f64 / ONE as f64;
        format!("the loop over depths counts by {shown}, and not in whole numbers")
    })
}

/// What the controller knows, in 10⁻¹².
#[derive(Debug, Default)]
struct State {
    /// The variables that count: their values are whole numbers.
    counters: BTreeSet<u32>,
    variables: BTreeMap<u32, i128>,
    shift: i128,
}

impl State {
    fn value(&self, term: &Term) -> Result<i128, String> {
        match term {
            Term::Number(value) => Ok(*value),
            Term::Variable(name) => {
                let value = self.variables.get(name).copied();
                value.ok_or_else(|| format!("#{name} has no value in the loop over depths"))
            }
        }
    }

    fn play(&mut self, statements: &[Statement]) -> Result<(), String> {
        for statement in statements {
            match statement {
                Statement::Shift(term) => self.shift = self.value(term)?,
                Statement::Set(name, first, second) => {
                    let counts = self.counters.contains(name);
                    let value = |term: &Term| {
                        let value = self.value(term)?;
                        if counts {
                            refuse_part(value)
                        } else {
                            Ok(value)
                        }
                    };
                    let more = match second {
                        None => 0,
                        Some((sign, term)) => sign * value(term)?,
                    };
                    let sum = value(first)?.checked_add(more);
                    let sum = sum.ok_or_else(|| format!("#{name} has too many digits"))?;
                    self.variables.insert(*name, sum);
                }
            }
        }
        Ok(())
    }
}

/// `WHILE[#5LT#100]DO2`.
fn head(code: &str) -> Result<Option<Head>, String> {
    let Some(rest) = code.strip_prefix("WHILE[") else {
        return Ok(None);
    };
    let parts = rest.split_once("]DO").and_then(|(condition, number)| {
        let (left, right) = condition.split_once("LT")?;
        Some((left, right, number))
    });
    let (left, right, number) = parts.ok_or_else(|| not_a_line(code))?;
    if !matches!(number, "1" | "2" | "3") {
        return Err(not_a_line(code));
    }
    Ok(Some(Head {
        left: term(left)?,
        right: term(right)?,
        number: number.to_owned(),
    }))
}

fn statement(code: &str) -> Result<Statement, String> {
    let shift = code.strip_prefix("G52X0Y0Z[");
    if let Some(rest) = shift.or_else(|| code.strip_prefix("G52Z[")) {
        let inside = rest.strip_suffix(']').ok_or_else(|| not_a_line(code))?;
        return Ok(Statement::Shift(term(inside)?));
    }
    let parts = code.strip_prefix('#').and_then(|rest| rest.split_once('='));
    let (name, value) = parts.ok_or_else(|| not_a_line(code))?;
    let name = variable(name).ok_or_else(|| not_a_line(code))?;
    // The sign of a number at the beginning is its own.
    let split = value.get(1..).and_then(|rest| rest.find(['+', '-']));
    let (first, second) = match split {
        None => (term(value)?, None),
        Some(at) => {
            let (first, rest) = value.split_at(at + 1);
            let sign = if rest.starts_with('-') { -1 } else { 1 };
            let second = rest.get(1..).unwrap_or_default();
            (term(first)?, Some((sign, term(second)?)))
        }
    };
    Ok(Statement::Set(name, first, second))
}

fn term(text: &str) -> Result<Term, String> {
    match text.strip_prefix('#') {
        Some(name) => {
            let name = variable(name).ok_or_else(|| not_a_line(text))?;
            Ok(Term::Variable(name))
        }
        None => number(text, text).map(Term::Number),
    }
}

fn variable(name: &str) -> Option<u32> {
    let are_digits = name.bytes().all(|byte| byte.is_ascii_digit());
    name.parse().ok().filter(|_| are_digits)
}

fn not_a_line(code: &str) -> String {
    let shown: String = code.chars().take(40).collect();
    format!("`{shown}` is not a line of a loop over depths")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixed_point::ONE;

    fn shifts(begin: &str, end: &str) -> Result<Vec<f64>, String> {
        let mut found = WhileLoop::default();
        for (lines, ends) in [(begin, false), (end, true)] {
            for line in lines.lines() {
                found.read(line, ends)?;
            }
        }
        let shifts = found.shifts()?;
        Ok(shifts
            .iter()
            .map(|shift| *shift as f64 / ONE as f64)
            .collect())
    }

    const BEGIN: &str = "#100 = 3 ( TOTAL PASSES OF Z )\n#103 = 0.002\n#5 = 0\n#8 = 0.006\n\
                         WHILE[#5 LT #100] DO 2\n#8 = #8 - #103\nG52 X0 Y0 Z[#8]";
    const END: &str = "#5 = #5 + 1\nEND 2";

    #[test]
    fn a_loop_is_played_as_the_controller_plays_it() {
        assert_eq!(shifts(BEGIN, END), Ok(vec![0.004, 0.002, 0.0]));
        let other = "#5=0\nwhile[#5 lt 2]do1\n#8=1-#5\nG52 X0 Y0 Z[#8]";
        let end = "#5=#5+1\nG52 X0 Y0 Z[0]\nend1";
        assert_eq!(shifts(other, end), Ok(vec![1.0, 0.0]));
        // The form of another generator of programs for these machines.
        let five = "#501=5 ( ROUGH TIMES )\n#502=0\n#503=+0.020\n#504=-0.005\n\
                    WHILE[#502LT#501]DO 1\nG52 Z[#503]";
        let end = "#503=#503+#504\n#502=#502+1\nEND 1";
        assert_eq!(shifts(five, end), Ok(vec![0.02, 0.015, 0.01, 0.005, 0.0]));
        let none = "#5 = 0\nWHILE[#5 LT 0] DO 2";
        assert_eq!(shifts(none, "END 2"), Ok(vec![]));
    }

    /// In doubles eight steps of 0.1 are less than 0.8, so that a controller makes a ninth turn.
    #[test]
    fn a_loop_that_does_not_count_in_whole_numbers_is_refused() {
        let count = (1..=8).fold(0.0_f64, |sum, _| sum + 0.1);
        assert!(count < 0.8);
        for (from, to, step) in [
            ("#100 = 3", "#100 = 0.8", "#5 = #5 + 0.1"),
            ("#100 = 3", "#100 = 3", "#5 = #5 + 0.5"),
            ("#100 = 3", "#100 = 2.5", "#5 = #5 + 1"),
            ("#5 = 0\n", "#5 = 0.1 - 0.1\n", "#5 = #5 + 1"),
            ("LT #100", "LT 2.5", "#5 = #5 + 1"),
            (
                "#5 = 0\n",
                "#5 = 0\n#7 = 0.5 + 0.5\n#6 = #7\n",
                "#5 = #5 + #6",
            ),
        ] {
            let end = format!("{step}\nEND 2");
            let said = shifts(&BEGIN.replacen(from, to, 1), &end).unwrap_err();
            assert!(said.contains("not in whole numbers"), "{to} {step}: {said}");
        }
    }

    #[test]
    fn what_is_no_loop_is_refused() {
        for (old, new, says) in [
            ("DO 2", "DO 4", "is not a line of a loop"),
            ("DO 2", "DO 1", "`END 2` does not end the loop"),
            ("LT", "GT", "is not a line of a loop"),
            ("#103 = 0.002", "", "#103 has no value"),
            ("#103 = 0.002", "#103 = 1e3", "has no number"),
            ("#103 = 0.002", "#1O3 = 2", "is not a line of a loop"),
            (
                "#8 = 0.006",
                "#8 = 0.007",
                "Z's zero is shifted behind the loop",
            ),
            ("#5 = 0\n", "", "#5 has no value"),
            (
                "WHILE[#5 LT #100] DO 2\n",
                "",
                "`END 2` does not end the loop",
            ),
            ("G52 X0 Y0", "G52 X1 Y0", "is not a line of a loop"),
            ("G52 X0 Y0", "G0", "is not a line of a loop"),
            ("[#8]", "[#8", "is not a line of a loop"),
        ] {
            assert!(BEGIN.contains(old), "{old}");
            let said = shifts(&BEGIN.replace(old, new), END).unwrap_err();
            assert!(said.contains(says), "{new}: {said}");
        }
        for (end, says) in [
            ("END 2", "does not come to its end"),
            ("#5 = #5 + 1", "has no `WHILE`, or no `END`"),
            ("#5 = #5 + 1\nEND 2\n#5 = 1", "a line behind the end"),
            ("WHILE[#5 LT 3] DO 2", "a loop within the loop"),
        ] {
            let said = shifts(BEGIN, end).unwrap_err();
            assert!(said.contains(says), "{end}: {said}");
        }
    }
}
