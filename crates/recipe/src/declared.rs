//! Declarations of parameters and keys as text, for messages, `turnpath explain` and the
//! documentation.

use turnpath_core::{ParamDefault, ParamInfo, ParamKind, Quantity};

/// A value as a recipe would write it, from the units used inside (mm, rad, s).
pub(crate) fn shown(kind: ParamKind, value: f64) -> String {
    match kind.quantity() {
        Some(quantity) => quantity.format(value),
        None => value.to_string(),
    }
}

/// What a value is: "a length", "a whole number", "true or false", `"sum" | "product"`.
pub fn kind(param: &ParamInfo) -> String {
    match param.kind {
        ParamKind::Quantity(quantity) => quantity.noun().to_owned(),
        ParamKind::Number => "a number".to_owned(),
        ParamKind::Count => "a whole number".to_owned(),
        ParamKind::Flag => "true or false".to_owned(),
        ParamKind::Choice(words) => in_quotes(words, " | "),
        ParamKind::ChoiceOr(words, quantity) => {
            format!("{} | {}", in_quotes(words, " | "), quantity.noun())
        }
        ParamKind::Text => "a text".to_owned(),
        ParamKind::List([]) => "a list of texts".to_owned(),
        ParamKind::List(words) => format!("a list of {}", in_quotes(words, ", ")),
        ParamKind::Rows(columns) => format!("a list of rows of {columns} numbers"),
        ParamKind::File => "a file, by its path relative to the recipe".to_owned(),
        ParamKind::Coefficients(indices, quantity) => coefficients(indices, quantity),
        ParamKind::Constants => {
            "a table of numbers, lengths, powers of lengths and angles".to_owned()
        }
    }
}

/// The same, with an example where a unit belongs: `a length, such as "5 mm"`.
pub fn kind_with_example(param: &ParamInfo) -> String {
    match param.kind.quantity() {
        Some(_) => format!("{}, such as \"{}\"", kind(param), usual_text(param)),
        None => kind(param),
    }
}

/// What counts if the recipe leaves the key out: "required", "may be left out", "default 0.5".
pub fn default(param: &ParamInfo) -> String {
    match (param.default, default_value(param)) {
        (ParamDefault::Number(value), _) => format!("default {}", shown(param.kind, value)),
        (_, Some(value)) => format!("default {value}"),
        (ParamDefault::Required, None) => "required".to_owned(),
        (_, None) => "may be left out".to_owned(),
    }
}

/// The value that counts if the recipe leaves the key out, as a recipe would write it; `None` if none
/// does.
pub fn default_value(param: &ParamInfo) -> Option<String> {
    match param.default {
        ParamDefault::Required | ParamDefault::Absent => None,
        ParamDefault::Number(value) => Some(match param.kind.quantity() {
            Some(quantity) => format!("\"{}\"", quantity.format(value)),
            None => value.to_string(),
        }),
        ParamDefault::Flag(value) => Some(value.to_string()),
        ParamDefault::Text(word) => Some(format!("\"{word}\"")),
        ParamDefault::List(words) => Some(format!("[{}]", in_quotes(words, ", "))),
    }
}

/// The limits of a number: "at least 3; at most 12"; empty if there is none.
pub fn limits(param: &ParamInfo) -> String {
    let mut parts = bounds(param);
    if param.nonzero {
        parts.push("not zero".to_owned());
    }
    parts.join("; ")
}

/// The declared range in words: "above 0 mm and at most 5 mm", "at least 3", "different from zero".
pub(crate) fn range(param: &ParamInfo) -> String {
    let mut parts = bounds(param);
    if param.nonzero {
        parts.push("different from zero".to_owned());
    }
    if parts.is_empty() {
        "a finite number".to_owned()
    } else {
        parts.join(" and ")
    }
}

fn bounds(param: &ParamInfo) -> Vec<String> {
    let limit = |value: f64| shown(param.kind, value);
    if param.min == param.max {
        return vec![limit(param.min)];
    }
    let mut parts = Vec::new();
    if param.min.is_finite() {
        let word = if param.above_min { "above" } else { "at least" };
        parts.push(format!("{word} {}", limit(param.min)));
    }
    if param.max.is_finite() {
        let word = if param.below_max { "below" } else { "at most" };
        parts.push(format!("{word} {}", limit(param.max)));
    }
    parts
}

fn in_quotes(words: &[&str], between: &str) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    quoted.join(between)
}

/// A good value as a recipe has it, without quotes: the declared example, or the usual one of the
/// quantity.
pub(crate) fn usual_text(param: &ParamInfo) -> &'static str {
    match param.kind.quantity() {
        Some(quantity) if param.example.is_empty() => quantity.example(),
        _ => param.example,
    }
}

/// A value that the declaration admits, as a recipe would write it.
pub(crate) fn example(param: &ParamInfo) -> String {
    if !param.example.is_empty() {
        return match param.kind {
            ParamKind::Number
            | ParamKind::Count
            | ParamKind::Flag
            | ParamKind::Rows(_)
            | ParamKind::Coefficients(..)
            | ParamKind::Constants => param.example.to_owned(),
            ParamKind::List(_) => format!("[\"{}\"]", param.example),
            _ => format!("\"{}\"", param.example),
        };
    }
    match (param.kind, param.default) {
        (ParamKind::Flag, ParamDefault::Flag(flag)) => flag.to_string(),
        (ParamKind::Flag, _) => "true".to_owned(),
        (ParamKind::Choice(_) | ParamKind::ChoiceOr(..), ParamDefault::Text(word)) => {
            format!("\"{word}\"")
        }
        (ParamKind::Choice(words) | ParamKind::ChoiceOr(words, _), _) => {
            format!("\"{}\"", words.first().unwrap_or(&""))
        }
        (ParamKind::Text, _) => "\"…\"".to_owned(),
        (ParamKind::List(words), _) => format!("[\"{}\"]", words.first().unwrap_or(&"…")),
        (ParamKind::Rows(columns), _) => example_rows(columns),
        (ParamKind::File, _) => "\"data.csv\"".to_owned(),
        (ParamKind::Coefficients(indices, quantity), _) => example_coefficients(indices, quantity),
        (ParamKind::Constants, _) => "{ k = \"0.08 /mm\" }".to_owned(),
        (_, ParamDefault::Number(value)) => written(param.kind, value),
        _ => written(param.kind, example_number(param)),
    }
}

fn written(kind: ParamKind, value: f64) -> String {
    match kind.quantity() {
        Some(quantity) => format!("\"{}\"", quantity.format(value)),
        None => value.to_string(),
    }
}

fn example_rows(columns: usize) -> String {
    let row: Vec<&str> = (0..columns)
        .map(|column| if column == 0 { "2" } else { "0" })
        .collect();
    format!("[[{}]]", row.join(", "))
}

/// What a table of coefficients is: "a table of lengths, under whole numbers".
fn coefficients(indices: usize, quantity: Option<Quantity>) -> String {
    let values = match quantity {
        Some(Quantity::Length) => "lengths".to_owned(),
        Some(quantity) => format!("values, each {}", quantity.noun()),
        None => "numbers".to_owned(),
    };
    let keys = match indices {
        1 => "whole numbers".to_owned(),
        several => format!("{several} whole numbers each"),
    };
    format!("a table of {values}, under {keys}")
}

fn example_coefficients(indices: usize, quantity: Option<Quantity>) -> String {
    let key = match indices {
        1 => "4".to_owned(),
        several => format!("\"2{}\"", ",0".repeat(several.saturating_sub(1))),
    };
    match quantity {
        Some(quantity) => format!("{{ {key} = \"{}\" }}", quantity.example()),
        None => format!("{{ {key} = 0.5 }}"),
    }
}

/// The usual value of the kind if it is in range, else a larger or smaller value that is.
fn example_number(param: &ParamInfo) -> f64 {
    let usual = match (param.kind, param.kind.quantity()) {
        (ParamKind::Count, _) => 36.0,
        (_, Some(quantity)) => quantity.parse(quantity.example()).unwrap_or(1.0),
        _ => 0.5,
    };
    let sizes = [1.0, 0.1, 10.0, 0.01, 100.0, 1e-3, 1e3, 1e-6, 1e6];
    let candidates = sizes.iter().flat_map(|size| [usual * size, -usual * size]);
    let limits = [param.min, param.max];
    let whole = |value: &f64| param.kind != ParamKind::Count || value.floor() == *value;
    candidates
        .chain(limits)
        .find(|value| whole(value) && param.admits(*value))
        .unwrap_or(usual)
}

#[cfg(test)]
mod tests {
    use turnpath_core::{DEG, Param};

    fn range<K>(param: Param<K>) -> String {
        super::range(&param.info())
    }

    fn example<K>(param: Param<K>) -> String {
        super::example(&param.info())
    }

    #[test]
    fn ranges_have_readable_units() {
        let step = Param::angle("max_step", "").positive().max(180.0 * DEG);
        assert_eq!(range(step), "above 0 deg and at most 180 deg");
        assert_eq!(range(Param::count("at_least", "").min(3)), "at least 3");
        assert_eq!(
            range(Param::length("radius", "").nonzero()),
            "different from zero"
        );
    }

    #[test]
    fn examples_are_in_range() {
        assert_eq!(example(Param::length("spacing", "").positive()), "\"5 mm\"");
        assert_eq!(
            example(Param::length("spacing", "").positive().max(0.1)),
            "\"50 um\""
        );
        assert_eq!(example(Param::feed("feed", "").positive()), "\"10 um/rev\"");
        assert_eq!(example(Param::count("at_least", "").min(50)), "360");
        assert_eq!(example(Param::number("conic", "").max(-0.75)), "-5");
        assert_eq!(example(Param::rows("terms", 3, "")), "[[2, 0, 0]]");
        assert_eq!(
            example(Param::angle("max_step", "").default(45.0 * DEG)),
            "\"45 deg\""
        );
        assert_eq!(
            example(Param::choice("form", &["sum", "product"], "")),
            "\"sum\""
        );
        assert_eq!(
            example(Param::coefficients("coefficients", 1, "")),
            "{ 4 = 0.5 }"
        );
        assert_eq!(
            example(Param::length_coefficients("coefficients", 2, "")),
            "{ \"2,0\" = \"5 mm\" }"
        );
    }
}
