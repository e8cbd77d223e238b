//! Reports as JSON: of a run, a file, an ablation. What is read is written, read and written again as
//! the same text, and can be shown to a person.

use serde_json::Value;
use turnpath::report::{
    AblationReport, FileReport, MeasuredRun, RunReport, comparison, from_json, text, to_json,
};

/// Words of such texts.
pub const WORDS: &[&str] = &[
    "null",
    "true",
    "false",
    "{}",
    "[]",
    "\"\"",
    "{",
    "}",
    "[",
    "]",
    ":",
    ",",
    "0",
    "-1",
    "1e308",
    "-1e-308",
    "1e999",
    "18446744073709551615",
    "\"max_nm\": ",
    "\"at\": ",
    "\"c_deg\": ",
    "\"format\": 2",
    "\"runs\": ",
    "\"within\": ",
    "\"\\u001b[2J\"",
];

/// Widths of a terminal, from none to wide.
const WIDTHS: [usize; 4] = [0, 1, 80, 1000];

/// Reads a report of each kind.
pub fn read(bytes: &[u8]) {
    let Ok(json) = std::str::from_utf8(bytes) else {
        return;
    };
    if let Ok(report) = from_json::<RunReport>(json) {
        let _ = text::run(&report, &["toolpath.csv".into()]);
        let _ = text::run(&report.clone().with_verdict(), &[]);
        assert_stays(&report);
    }
    if let Ok(report) = from_json::<FileReport>(json) {
        let _ = text::file(&report);
        let _ = text::file(&report.clone().with_verdict());
        assert_stays(&report);
    }
    if let Ok(run) = from_json::<MeasuredRun>(json) {
        assert_stays(&run);
    }
    if let Ok(report) = from_json::<AblationReport>(json) {
        show(&report);
        assert_stays(&report);
    }
}

/// The table of an ablation in all widths, and its CSV.
fn show(report: &AblationReport) {
    for width in WIDTHS {
        let _ = comparison::table(&report.runs, &comparison::all(), width, report.runs.first());
        let _ = comparison::table(&report.runs, &comparison::usual(), width, None);
    }
    let table = comparison::csv_table(&report.runs).expect("memory takes a table");
    assert!(std::str::from_utf8(&table).is_ok());
}

/// From the first text that turnpath writes on, nothing changes any more.
fn assert_stays<T>(report: &T)
where
    T: serde::Serialize + serde::de::DeserializeOwned,
{
    let first = to_json(report);
    let again: T = from_json(&first).unwrap_or_else(|error| panic!("{error:?}: {first}"));
    let second = to_json(&again);
    if first != second {
        let [one, other] = [&first, &second].map(|text| serde_json::from_str::<Value>(text).ok());
        panic!("{one:?}\nbecame\n{other:?}");
    }
}
