//! Anomalies for a person: the worst first, and how many there are.

use crate::anomalies::{Anomalies, Anomaly, AnomalyKind, Column, Standard};

use super::numbers::{grouped, line, path_place, small_length};

/// Anomalies that a person is shown.
const SHOWN: usize = 5;

/// The lines on anomalies of a file with so many rows.
pub fn anomalies(anomalies: &Anomalies, rows: u64) -> String {
    let mut text = String::new();
    let mut add = |words: String| {
        let label = if text.is_empty() { "anomalies" } else { "" };
        text += &line(label, words);
    };
    let by_recipe = anomalies.compared_with == Standard::Recipe;
    if let Some(reason) = &anomalies.not_compared_because {
        add(format!(
            "the rows were not compared with those of the recipe: {reason}"
        ));
        add(guesses(anomalies.count));
    } else if by_recipe {
        add(differences(anomalies.count, rows));
    }
    for place in anomalies.places.iter().take(SHOWN) {
        add(place_of(place));
        add(difference(place));
    }
    let shown = anomalies.places.len().min(SHOWN) as u64;
    let more = anomalies.count.saturating_sub(shown);
    match more {
        0 => {}
        1 => add("and 1 place more".to_owned()),
        more => add(format!("and {} places more", grouped(more))),
    }
    text
}

/// How many rows differ from those of the recipe.
fn differences(count: u64, rows: u64) -> String {
    let worst = "by how far each moves the played path";
    match count {
        0 => format!(
            "none: all {} rows are as the recipe gives them",
            grouped(rows)
        ),
        1 => "1 row is not as the recipe gives it, a warning".to_owned(),
        _ => format!(
            "{} rows are not as the recipe gives them, a warning; the worst first, {worst}",
            grouped(count)
        ),
    }
}

/// How many places stand out among their neighbours.
fn guesses(count: u64) -> String {
    let guess = "compared with their neighbours instead";
    match count {
        0 => format!("{guess}, none stands out"),
        1 => format!("{guess}, 1 place stands out, which may be honest"),
        _ => format!(
            "{guess}, {} places stand out, which may be honest; the most prominent first",
            grouped(count)
        ),
    }
}

fn place_of(anomaly: &Anomaly) -> String {
    let point = grouped(anomaly.point);
    format!("point {point}, {}", path_place(&anomaly.at))
}

fn difference(anomaly: &Anomaly) -> String {
    let by = small_length(anomaly.by);
    let what = match anomaly.kind {
        AnomalyKind::RowLost => return format!("  a row is lost: {}", moves(anomaly.by)),
        AnomalyKind::RowAdded => return format!("  a row was added: {}", moves(anomaly.by)),
        AnomalyKind::RowDiffers => {
            let columns = names(&anomaly.columns);
            return format!("  wrong: {columns}; {}", moves(anomaly.by));
        }
        AnomalyKind::ZPosition => "Z is off the first touch by",
        AnomalyKind::CMotion => "C is not smooth: as if off by",
        AnomalyKind::XMotion => "X is not smooth: as if off by",
        AnomalyKind::ZMotion => "Z is not smooth: as if off by",
        AnomalyKind::Gap => "a row is missing: the step along the rim is",
    };
    match anomaly.neighbours {
        Some(neighbours) => {
            let neighbours = small_length(neighbours);
            format!("  {what} {by}; its neighbours have {neighbours}")
        }
        None => format!("  {what} {by}"),
    }
}

fn moves(by: f64) -> String {
    match by.is_finite() {
        true => format!("the played path moves by {}", small_length(by)),
        false => "nothing is played there to compare with".to_owned(),
    }
}

fn names(columns: &[Column]) -> String {
    let name = |column: &Column| match column {
        Column::Time => "the time",
        Column::C => "C",
        Column::X => "X",
        Column::Z => "Z",
        Column::Vc => "vC",
        Column::Vx => "vX",
        Column::Vz => "vZ",
        Column::Section => "the section",
    };
    let names: Vec<&str> = columns.iter().map(name).collect();
    names.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::place::PathPlace;

    fn anomaly(kind: AnomalyKind, columns: Vec<Column>, by: f64) -> Anomaly {
        Anomaly {
            point: 2000,
            at: PathPlace { c: 1.0, x: 2.0 },
            kind,
            columns,
            by,
            neighbours: None,
        }
    }

    #[test]
    fn a_file_that_is_as_it_was_made_is_said_to_be_so() {
        let none = Anomalies {
            compared_with: Standard::Recipe,
            ..Anomalies::default()
        };
        assert_eq!(
            anomalies(&none, 4243),
            "  anomalies       none: all 4,243 rows are as the recipe gives them\n"
        );
        assert_eq!(anomalies(&Anomalies::default(), 4243), "");
    }

    #[test]
    fn the_worst_comes_first_and_the_rest_are_counted() {
        let places = vec![
            anomaly(AnomalyKind::RowLost, Vec::new(), f64::NAN),
            anomaly(AnomalyKind::RowDiffers, vec![Column::Z, Column::Vz], 2e-5),
        ];
        let found = Anomalies {
            compared_with: Standard::Recipe,
            not_compared_because: None,
            count: 7,
            places,
        };
        assert_eq!(
            anomalies(&found, 4243),
            "  anomalies       7 rows are not as the recipe gives them, a warning; the worst first, \
             by how far each moves the played path\n\
             \x20                 point 2,000, C = 57.30 deg, X = 2.0000 mm\n\
             \x20                   a row is lost: nothing is played there to compare with\n\
             \x20                 point 2,000, C = 57.30 deg, X = 2.0000 mm\n\
             \x20                   wrong: Z, vZ; the played path moves by 20.00 nm\n\
             \x20                 and 5 places more\n"
        );
    }

    #[test]
    fn a_guess_is_said_to_be_one() {
        let guess = Anomaly {
            neighbours: Some(1e-9),
            ..anomaly(AnomalyKind::ZMotion, Vec::new(), 5e-5)
        };
        let found = Anomalies {
            compared_with: Standard::Neighbours,
            not_compared_because: Some("it is another maker's".to_owned()),
            count: 1,
            places: vec![guess],
        };
        let text = anomalies(&found, 100);
        assert!(
            text.contains("of the recipe: it is another maker's\n"),
            "{text}"
        );
        assert!(
            text.contains("1 place stands out, which may be honest\n"),
            "{text}"
        );
        assert!(
            text.ends_with(
                "Z is not smooth: as if off by 50.00 nm; its neighbours have 1.0e-3 nm\n"
            ),
            "{text}"
        );
    }
}
