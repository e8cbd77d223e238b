//! Spoiled files of five chains: which faults `turnpath verify` finds, and what each is worth. The
//! table of docs/measuring.md comes from here (`cargo xtask reference spoils`).
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::collections::BTreeSet;
use std::fs;
use std::sync::OnceLock;

use serde_json::Value;
use tempfile::TempDir;

use crate::support::bench::{Answer, Bench, answer};
use crate::support::fixtures::plugin_folder;
use crate::support::repository;

/// A small astigmatic part with leads; the chain follows.
const HEAD: &str = r#"format = 1
name = "Spoils"
[part]
aperture = "1.4 mm"
[surface]
use = "astigmatic"
k = "0.15 /mm"
[tool]
nose_radius = "1 mm"
included_angle = "120 deg"
clearance_angle = "30 deg"
[tolerance]
interpolation = "60 nm"
residual = "100 nm"
[compensator]
use = "z-direction"
"#;

/// Half the aperture, mm.
const RIM: f64 = 0.7;

/// A chain whose files are spoiled.
struct Chain {
    /// The heading of its column.
    heading: &'static str,
    tables: &'static str,
    file: &'static str,
}

const CHAINS: [Chain; 5] = [
    Chain {
        heading: "uneven steps, `triangle-rotary`",
        tables: "[sampler]\nuse = \"atpg\"\nmax_step = \"45 deg\"\n[feed]\nuse = \"atpg\"\n\
                 [velocity]\nuse = \"triangle-rotary\"\n",
        file: "toolpath.csv",
    },
    Chain {
        heading: "`three-point`",
        tables: "[sampler]\nuse = \"equal-arc\"\nspacing = \"60 um\"\n[feed]\nuse = \"constant\"\n\
                 [velocity]\nuse = \"three-point\"\n",
        file: "toolpath.csv",
    },
    Chain {
        heading: "`linear`",
        tables: "[sampler]\nuse = \"equal-angle\"\nstep = \"5 deg\"\n[feed]\nuse = \"constant\"\n\
                 [velocity]\nuse = \"linear\"\n",
        file: "toolpath.csv",
    },
    Chain {
        heading: "off the locus, two speeds",
        tables: "[sampler]\nuse = \"wavy\"\nsteps = 27\n[feed]\nuse = \"atpg\"\n\
                 [velocity]\nuse = \"analytic\"\n[spindle]\nuse = \"two-speeds\"\nslow = 0.4\n",
        file: "toolpath.csv",
    },
    Chain {
        heading: "a program (`.pmc`)",
        tables: "[sampler]\nuse = \"equal-angle\"\nstep = \"12 deg\"\n[feed]\nuse = \"constant\"\n\
                 [velocity]\nuse = \"analytic\"\n[output]\nposts = [\"pmac-pvt\"]\n",
        file: "recipe.pmc",
    },
];

/// Columns of the table and of a program's words: time, C, X, Z and the velocities.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Spoil {
    Lost,
    Swapped,
    /// A time that is wrong by a part of the time since the row before.
    Time(f64),
    /// A position of an axis that is off, mm; C along the rim.
    Off(Axis, f64),
    /// A velocity of an axis that is wrong by a part of it.
    Wrong(Axis, f64),
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Axis {
    C,
    X,
    Z,
}

/// The spoils with their names in the table.
const SPOILS: [(&str, Spoil); 9] = [
    ("a row is lost", Spoil::Lost),
    ("two rows are swapped", Spoil::Swapped),
    ("a time is off by 1 % of its step", Spoil::Time(0.01)),
    ("Z is off by 20 nm", Spoil::Off(Axis::Z, 20e-6)),
    ("X is off by 50 nm", Spoil::Off(Axis::X, 50e-6)),
    (
        "C is off by 50 nm along the rim",
        Spoil::Off(Axis::C, 50e-6),
    ),
    ("vZ is wrong by 2 %", Spoil::Wrong(Axis::Z, 0.02)),
    ("vX is wrong by 2 %", Spoil::Wrong(Axis::X, 0.02)),
    ("vC is wrong by 2 %", Spoil::Wrong(Axis::C, 0.02)),
];

/// The numbers of a row, in the units and digits of its file: time, C, X, Z, vC, vX, vZ.
type Numbers = [f64; 7];

impl Axis {
    fn position(self) -> usize {
        1 + self as usize
    }

    fn velocity(self) -> usize {
        4 + self as usize
    }
}

/// The file that a chain itself makes, as lines, and which of them are rows.
struct OwnFile {
    bench: Bench,
    plugins: TempDir,
    lines: Vec<String>,
    rows: Vec<usize>,
    is_program: bool,
}

impl OwnFile {
    fn new(chain: &Chain) -> Self {
        let has_spindle = chain.tables.contains("[spindle]");
        let speed = "speed = \"300 rpm\"\n";
        let spindle = if has_spindle { "" } else { "[spindle]\n" };
        let bench = Bench::with(&format!("{HEAD}{}{spindle}{speed}", chain.tables));
        let plugins = plugin_folder(if has_spindle { &["two-speeds"] } else { &[] });
        let mut file = Self {
            bench,
            plugins,
            lines: Vec::new(),
            rows: Vec::new(),
            is_program: chain.file.ends_with("pmc"),
        };
        let ran = file.call("run recipe.toml -o out");
        assert!(
            matches!(ran.status, Some(0 | 1)),
            "{}: {ran}",
            chain.heading
        );
        let text = file.bench.read(format!("out/{}", chain.file));
        file.lines = text.lines().map(String::from).collect();
        let all = 0..file.lines.len();
        file.rows = all.filter(|line| file.is_row(*line)).collect();
        file
    }

    fn is_row(&self, line: usize) -> bool {
        let text = &self.lines[line];
        match self.is_program {
            true => text.starts_with('C') && text.contains(" X"),
            false => line > 0,
        }
    }

    fn call(&self, words: &str) -> Answer {
        let mut command = self.bench.command(words.split_whitespace());
        answer(command.arg("--plugin-dir").arg(self.plugins.path()))
    }

    fn verify(&self, lines: &[String]) -> Answer {
        let name = match self.is_program {
            true => "spoiled.pmc",
            false => "spoiled.csv",
        };
        self.bench.write(name, lines.join("\n") + "\n");
        self.call(&format!("verify recipe.toml {name} --format json"))
    }

    /// The numbers of a row of a program, its time excepted, or of a table.
    fn numbers(&self, row: usize) -> Numbers {
        let line = &self.lines[self.rows[row]];
        let mut numbers = [0.0; 7];
        if self.is_program {
            for (k, word) in line.split(' ').enumerate() {
                let (p, v) = word[1..].split_once(':').unwrap();
                numbers[1 + k] = p.parse().unwrap();
                numbers[4 + k] = v.parse().unwrap();
            }
            return numbers;
        }
        for (number, text) in numbers.iter_mut().zip(line.split(',')) {
            *number = text.parse().unwrap();
        }
        numbers
    }

    fn line(&self, row: usize, numbers: Numbers) -> String {
        let [t, c, x, z, vc, vx, vz] = numbers;
        match self.is_program {
            true => format!("C{c:.7}:{vc:.7} X{x:.7}:{vx:.7} Z{z:.7}:{vz:.7}"),
            false => {
                let section = self.lines[self.rows[row]].rsplit(',').next().unwrap();
                format!("{t},{c},{x},{z},{vc},{vx},{vz},{section}")
            }
        }
    }

    /// The first row of each section, and the number of rows.
    fn borders(&self) -> [usize; 3] {
        let section_after = |mark: &str| {
            let line = self
                .lines
                .iter()
                .position(|line| line.contains(mark))
                .unwrap();
            self.rows.partition_point(|row| *row < line)
        };
        let last = self.rows.len();
        if self.is_program {
            return [
                section_after("-- cutting"),
                section_after("-- lead-out"),
                last,
            ];
        }
        let of = |section: &str| {
            let ends = |row: &usize| self.lines[*row].ends_with(section);
            self.rows.iter().position(ends).unwrap()
        };
        [of(",1"), of(",2"), last]
    }

    /// Rows that are spoiled: in both leads, beside both joins, at the beginning, in the middle and at
    /// the end of the cut. At these rows or soon after them, `change` changes the row.
    fn places(&self, changes: impl Fn(usize) -> bool) -> Vec<usize> {
        let [cut, out, end] = self.borders();
        let along = |part: f64| cut + (part * (out - cut) as f64) as usize;
        let wanted = [
            6,
            cut / 2,
            cut - 10,
            cut + 1,
            along(0.25),
            along(0.5),
            along(0.75),
            out - 8,
            out + 2,
            (out + end) / 2,
        ];
        let mut places: Vec<usize> = Vec::new();
        for place in wanted {
            let after = places.last().map_or(2, |last| last + 5);
            let found = (place.max(after)..end - 3).find(|row| changes(*row));
            places.extend(found);
        }
        places
    }

    /// The row with one fault; `None` if the fault is no change in the digits of the file.
    fn spoiled_row(&self, row: usize, spoil: Spoil) -> Option<String> {
        let mut numbers = self.numbers(row);
        match spoil {
            Spoil::Lost | Spoil::Swapped => return None,
            Spoil::Time(part) => {
                numbers[0] += part * (numbers[0] - self.numbers(row - 1)[0]);
            }
            Spoil::Off(Axis::C, along) => numbers[1] += (along / RIM).to_degrees(),
            Spoil::Off(axis, by) => numbers[axis.position()] += by,
            Spoil::Wrong(axis, part) => {
                let velocity = &mut numbers[axis.velocity()];
                // At rest, and where an axis turns, a hundredth of nothing is nothing.
                if velocity.abs() < 1e-4 {
                    return None;
                }
                *velocity *= 1.0 + part;
            }
        }
        let line = self.line(row, numbers);
        (line != self.line(row, self.numbers(row))).then_some(line)
    }
}

/// What `verify` says of one spoil.
struct SpoilResult {
    places: usize,
    /// In how many of them the file was refused, with the number of the line.
    refused: usize,
    /// The worths in nm, the smallest first.
    worths: Vec<f64>,
    /// Whether all tolerances still held in the files that were not refused.
    holds: bool,
}

impl SpoilResult {
    /// A cell of the table.
    fn cell(&self) -> String {
        let all = format!("{} of {0}", self.places);
        if self.refused == self.places {
            return format!("{all}; refused");
        }
        let all = match self.refused {
            0 => all,
            refused => format!("{all}; {refused} refused"),
        };
        let number = |worth: f64| match worth {
            w if w < 0.005 => "0".to_owned(),
            w if w < 1.0 => format!("{w:.2}"),
            w if w < 100.0 => format!("{w:.1}"),
            w => format!("{w:.0}"),
        };
        let (least, most) = (self.worths[0], self.worths[self.worths.len() - 1]);
        let (least, most) = (number(least), number(most));
        let worth = match least == most {
            true => least,
            false => format!("{least} to {most}"),
        };
        let verdict = if self.holds { "holds" } else { "exceeded" };
        format!("{all}; {worth} nm; {verdict}")
    }
}

/// The anomalies are these rows and no others, and the worst comes first.
#[track_caller]
fn exactly(said: &Answer, rows: &BTreeSet<u64>, what: &str) -> Vec<f64> {
    assert!(matches!(said.status, Some(0 | 1)), "{what}: {said}");
    let verified = said.json();
    let anomalies = &verified["anomalies"];
    assert_eq!(anomalies["compared_with"], "recipe", "{what}: {anomalies}");
    let places = anomalies["places"].as_array().unwrap();
    let found: BTreeSet<u64> = places
        .iter()
        .map(|p| p["point"].as_u64().unwrap())
        .collect();
    assert_eq!(&found, rows, "{what}: {anomalies}");
    assert_eq!(anomalies["count"], rows.len(), "{what}");
    let worths = places.iter().map(|p| p["by_nm"].as_f64().unwrap());
    let worths: Vec<f64> = worths.collect();
    assert!(
        worths.is_sorted_by(|one, other| one >= other),
        "{what}: {worths:?}"
    );
    worths.into_iter().rev().collect()
}

/// Spoils the file in many places at once and looks for exactly these.
fn spoil(file: &OwnFile, spoil: Spoil, what: &str) -> SpoilResult {
    match spoil {
        Spoil::Lost => lose(file, what),
        Spoil::Swapped => swap(file, what),
        Spoil::Time(part) if file.is_program => retime(file, part, what),
        _ => {
            let places = file.places(|row| file.spoiled_row(row, spoil).is_some());
            let mut lines = file.lines.clone();
            for row in &places {
                lines[file.rows[*row]] = file.spoiled_row(*row, spoil).unwrap();
            }
            let said = file.verify(&lines);
            let rows = places.iter().map(|row| *row as u64 + 1).collect();
            result_of(&said, &rows, what)
        }
    }
}

fn result_of(said: &Answer, rows: &BTreeSet<u64>, what: &str) -> SpoilResult {
    SpoilResult {
        places: rows.len(),
        refused: 0,
        worths: exactly(said, rows, what),
        holds: said.status == Some(0),
    }
}

fn lose(file: &OwnFile, what: &str) -> SpoilResult {
    let places = file.places(|_| true);
    let mut lines = file.lines.clone();
    for row in places.iter().rev() {
        lines.remove(file.rows[*row]);
    }
    if file.is_program {
        // The end mark has the count; somebody who edits a program by hand edits it too.
        let all = file.rows.len();
        let mark = lines
            .iter_mut()
            .find(|line| line.contains("end of path"))
            .unwrap();
        *mark = mark.replace(&all.to_string(), &(all - places.len()).to_string());
    }
    let said = file.verify(&lines);
    // Every row that is lost before it makes the number of a row smaller by one.
    let numbers = places.iter().enumerate();
    let rows = numbers.map(|(lost, row)| (row + 1 - lost) as u64).collect();
    result_of(&said, &rows, what)
}

/// Rows that are swapped where C must grow are refused; elsewhere one row seems lost and one added.
fn swap(file: &OwnFile, what: &str) -> SpoilResult {
    let places = file.places(|_| true);
    let mut refused = 0;
    let mut worths = Vec::new();
    let mut holds = true;
    for row in &places {
        let mut lines = file.lines.clone();
        lines.swap(file.rows[*row], file.rows[*row + 1]);
        let said = file.verify(&lines);
        if said.status == Some(4) {
            assert!(said.stderr.contains(", line "), "{what}: {said}");
            refused += 1;
            continue;
        }
        holds &= said.status == Some(0);
        let verified = said.json();
        let count = verified["anomalies"]["count"].as_u64().unwrap();
        assert!(
            (1..=3).contains(&count),
            "{what}, row {row}: {}",
            verified["anomalies"]
        );
        worths.push(
            verified["anomalies"]["places"][0]["by_nm"]
                .as_f64()
                .unwrap(),
        );
    }
    worths.sort_by(f64::total_cmp);
    SpoilResult {
        places: places.len(),
        refused,
        worths,
        holds,
    }
}

/// A segment of a program takes another time; all that follows comes as much later.
fn retime(file: &OwnFile, part: f64, what: &str) -> SpoilResult {
    let stands = |line: usize| {
        let times = file.lines[..line].iter().rev();
        let mut times = times.filter_map(|line| line.strip_prefix("PVT"));
        times.next().unwrap().parse::<f64>().unwrap()
    };
    let places = file.places(|_| true);
    let mut lines = file.lines.clone();
    for row in places.iter().rev() {
        let line = file.rows[*row];
        let own = stands(line);
        // The controller's steps of time are 1/4096 ms.
        let wrong = (own * (1.0 + part) * 4096.0).round() / 4096.0;
        assert!(wrong != own, "{what}");
        let next = lines[line + 1..]
            .iter()
            .position(|line| line.starts_with('C'));
        if lines[line + 1..]
            .first()
            .is_some_and(|line| line.starts_with('C'))
            && next == Some(0)
        {
            lines.insert(line + 1, format!("PVT{own}"));
        }
        lines.insert(line, format!("PVT{wrong}"));
    }
    let said = file.verify(&lines);
    let rows = places.iter().map(|row| *row as u64 + 1).collect();
    result_of(&said, &rows, what)
}

/// The rows of the table, of all chains.
fn table() -> &'static str {
    static TABLE: OnceLock<String> = OnceLock::new();
    TABLE.get_or_init(|| {
        let columns: Vec<Vec<SpoilResult>> = std::thread::scope(|scope| {
            let work = |chain: &'static Chain| scope.spawn(move || column(chain));
            let workers: Vec<_> = CHAINS.iter().map(work).collect();
            workers
                .into_iter()
                .map(|worker| worker.join().unwrap())
                .collect()
        });
        let headings = CHAINS.map(|chain| chain.heading).join(" | ");
        let mut text = format!(
            "| fault | {headings} |\n|---|{}\n",
            "---|".repeat(CHAINS.len())
        );
        for (i, (name, _)) in SPOILS.iter().enumerate() {
            let cells = columns.iter().map(|column| column[i].cell());
            let cells: Vec<String> = cells.collect();
            text += &format!("| {name} | {} |\n", cells.join(" | "));
        }
        text
    })
}

/// All spoils of one chain.
fn column(chain: &Chain) -> Vec<SpoilResult> {
    let file = OwnFile::new(chain);
    let own = file.verify(&file.lines);
    exactly(&own, &BTreeSet::new(), chain.heading);
    let all = SPOILS.iter();
    let found = all.map(|(name, one)| spoil(&file, *one, &format!("{}, {name}", chain.heading)));
    let found: Vec<SpoilResult> = found.collect();
    for ((name, spoil), found) in SPOILS.iter().zip(&found) {
        assert!(
            found.places >= 4,
            "{}, {name}: {} places",
            chain.heading,
            found.places
        );
        if let Spoil::Off(Axis::Z, by) = spoil {
            let by = 1e6 * by;
            let right = found
                .worths
                .iter()
                .all(|worth| (worth / by - 1.0).abs() < 0.01);
            assert!(right, "{}: {:?}", chain.heading, found.worths);
        }
    }
    found
}

const BEGIN: &str = "<!-- cargo xtask reference spoils writes this table -->\n";
const END: &str = "<!-- end -->\n";

#[test]
fn every_spoil_is_found_with_its_worth_as_the_page_says() {
    let page = repository().join("docs/measuring.md");
    let text = fs::read_to_string(&page).unwrap();
    let (before, rest) = text.split_once(BEGIN).expect("the mark before the table");
    let (shown, after) = rest.split_once(END).expect("the mark after the table");
    if std::env::var_os("SPOILS_PAGE").is_some() {
        fs::write(page, format!("{before}{BEGIN}{}{END}{after}", table())).unwrap();
        return;
    }
    assert_eq!(
        shown,
        table(),
        "`cargo xtask reference spoils` writes the table"
    );
}

/// 4/27 of δv · h is the largest displacement that a velocity wrong by δv makes in a segment of h.
#[test]
fn a_velocity_that_is_wrong_by_5_percent_and_moves_the_path_by_23_nm_of_60_is_found() {
    let file = OwnFile::new(&CHAINS[0]);
    let worth = |row: usize| {
        let [before, here, after] = [row - 1, row, row + 1].map(|row| file.numbers(row));
        let step = (after[0] - here[0]).max(here[0] - before[0]);
        0.05 * here[6].abs() * step * 4.0 / 27.0 * 1e6
    };
    let [cut, out, _] = file.borders();
    let off = |row: &usize| (worth(*row) - 23.0).abs();
    let row = (cut + 2..out - 2).min_by(|one, other| off(one).total_cmp(&off(other)));
    let row = row.unwrap();
    assert!((worth(row) - 23.0).abs() < 1.0, "{} nm", worth(row));
    let mut lines = file.lines.clone();
    let line = file.spoiled_row(row, Spoil::Wrong(Axis::Z, 0.05)).unwrap();
    lines[file.rows[row]] = line;
    let said = file.verify(&lines);
    let found = exactly(&said, &BTreeSet::from([row as u64 + 1]), "5 % of vZ");
    assert!(
        (found[0] / worth(row) - 1.0).abs() < 0.03,
        "{found:?}, {}",
        worth(row)
    );
    let place: &Value = &said.json()["anomalies"]["places"][0];
    assert_eq!(place["columns"], serde_json::json!(["vz"]));
}
