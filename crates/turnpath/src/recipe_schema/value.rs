//! The schema of one declared key.

use serde_json::{Map, Value, json};
use turnpath_core::{ParamDefault, ParamInfo, ParamKind, Quantity};
use turnpath_recipe::declared;

/// A number as a recipe writes it in a text, without its sign.
const NUMBER: &str = r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+\-−]?[0-9]+)?";

/// What a declared key may have.
pub fn of_key(key: &ParamInfo) -> Value {
    let mut schema = of_kind(key);
    let about = schema.as_object_mut();
    if let Some(about) = about {
        about.insert("description".to_owned(), description(key).into());
        about.extend(default(key).map(|value| ("default".to_owned(), value)));
    }
    schema
}

fn description(key: &ParamInfo) -> String {
    match declared::limits(key) {
        limits if limits.is_empty() => key.help.to_owned(),
        limits => format!("{} ({limits})", key.help),
    }
}

fn default(key: &ParamInfo) -> Option<Value> {
    match key.default {
        ParamDefault::Required | ParamDefault::Absent => None,
        ParamDefault::Number(number) => Some(match key.kind.quantity() {
            Some(quantity) => quantity.format(number).into(),
            None => number.into(),
        }),
        ParamDefault::Flag(flag) => Some(flag.into()),
        ParamDefault::Text(word) => Some(word.into()),
        ParamDefault::List(words) => Some(words.into()),
    }
}

fn of_kind(key: &ParamInfo) -> Value {
    match key.kind {
        ParamKind::Quantity(quantity) => of_quantity(quantity, key),
        ParamKind::Number => of_number("number", key),
        ParamKind::Count => of_number("integer", key),
        ParamKind::Flag => json!({ "type": "boolean" }),
        ParamKind::Choice(words) => json!({ "enum": words }),
        ParamKind::ChoiceOr(words, quantity) => {
            json!({ "anyOf": [{ "enum": words }, of_quantity(quantity, key)] })
        }
        ParamKind::Text => json!({ "type": "string" }),
        ParamKind::List([]) => json!({ "type": "array", "items": { "type": "string" } }),
        ParamKind::List(words) => json!({ "type": "array", "items": { "enum": words } }),
        ParamKind::Rows(columns) => json!({
            "type": "array",
            "items": {
                "type": "array",
                "items": { "type": "number" },
                "minItems": columns,
                "maxItems": columns,
            },
        }),
        ParamKind::File => json!({ "type": "string", "pattern": r"\S" }),
        ParamKind::Coefficients(indices, quantity) => coefficients(indices, quantity),
        ParamKind::Constants => json!({
            "type": "object",
            "additionalProperties": { "type": ["number", "string"] },
        }),
    }
}

fn of_number(kind: &str, key: &ParamInfo) -> Value {
    let mut schema = Map::from_iter([("type".to_owned(), kind.into())]);
    let bounds = [
        (key.min, key.above_min, "minimum", "exclusiveMinimum"),
        (key.max, key.below_max, "maximum", "exclusiveMaximum"),
    ];
    for (bound, is_excluded, including, excluding) in bounds {
        if bound.is_finite() {
            let word = if is_excluded { excluding } else { including };
            schema.insert(word.to_owned(), bound.into());
        }
    }
    if key.nonzero {
        schema.insert("not".to_owned(), json!({ "const": 0 }));
    }
    schema.into()
}

/// A text with a number and a unit. A pattern knows signs and zero, and no other bound.
fn of_quantity(quantity: Quantity, key: &ParamInfo) -> Value {
    let sign = if key.min >= 0.0 { r"\+?" } else { r"[+\-−]?" };
    let excludes_zero = key.nonzero || (key.min >= 0.0 && (key.above_min || key.min > 0.0));
    let some_digit = if excludes_zero {
        r"(?=[0-9.]*[1-9])"
    } else {
        ""
    };
    let number = format!("{sign}{some_digit}{NUMBER}");
    json!({ "type": "string", "pattern": with_unit(&number, quantity) })
}

fn with_unit(number: &str, quantity: Quantity) -> String {
    let units: Vec<String> = quantity.accepted_units().map(unit).collect();
    format!(r"^\s*{number}\s*(?:{})\s*$", units.join("|"))
}

/// A unit in all of its spellings.
fn unit(symbol: &str) -> String {
    let spelled = |symbol: &str| {
        symbol
            .replace('u', "[u\u{b5}\u{3bc}]")
            .replace("^2", r"(?:\^2|²)")
            .replace("^3", r"(?:\^3|³)")
            .replace('/', r"\s*/\s*")
    };
    match symbol.strip_prefix('/') {
        Some(base) => {
            let base = spelled(base);
            format!(r"1?\s*/\s*{base}|{base}(?:\^-1|⁻¹)")
        }
        None => spelled(symbol),
    }
}

fn coefficients(indices: usize, quantity: Option<Quantity>) -> Value {
    let more = r"\s*,\s*-?[0-9]+".repeat(indices.saturating_sub(1));
    let key = format!(r"^\s*-?[0-9]+{more}\s*$");
    let value = match quantity {
        Some(quantity) => {
            let number = format!(r"[+\-−]?{NUMBER}");
            json!({ "type": "string", "pattern": with_unit(&number, quantity) })
        }
        None => json!({ "type": "number" }),
    };
    json!({ "type": "object", "patternProperties": { key: value }, "additionalProperties": false })
}
