//! The tables `[surface]` of a shape.

use std::collections::BTreeMap;
use std::fmt::Display;

use turnpath_lens::{Base, Shape, ZernikeList};

/// A table of a recipe: its strategy, and its lines.
struct SurfaceTable {
    name: &'static str,
    lines: Vec<String>,
}

/// Numbers from which a power of ten reads better than zeros, and up to which.
const SHORT: std::ops::Range<f64> = 1e-4..1e9;

/// The tables of a shape, each with an empty line behind it: one `[surface]`, or several
/// `[[surface]]` that are added up.
pub fn surface_tables(shape: &Shape) -> String {
    let tables = tables(shape);
    let header = match tables.len() {
        1 => "[surface]",
        _ => "[[surface]]",
    };
    let text = |table: SurfaceTable| {
        let SurfaceTable { name, lines } = table;
        format!("{header}\nuse = \"{name}\"\n{}\n", lines.concat())
    };
    tables.into_iter().map(text).collect()
}

/// A number as a recipe has it. All digits that tell it from its neighbours are there.
pub fn number(value: f64) -> String {
    match value == 0.0 || SHORT.contains(&value.abs()) {
        true => format!("{value}"),
        false => format!("{value:e}"),
    }
}

/// A length as a recipe has it.
pub fn length(millimetres: f64) -> String {
    format!("\"{} mm\"", number(millimetres))
}

fn tables(shape: &Shape) -> Vec<SurfaceTable> {
    match shape {
        Shape::Radial { base, terms } => vec![radial(base, terms)],
        Shape::Biconic { x, y } => vec![SurfaceTable {
            name: "biconic",
            lines: vec![
                radius("radius_x", x.radius),
                radius("radius_y", y.radius),
                format!("conic_x = {}\n", number(x.conic)),
                format!("conic_y = {}\n", number(y.conic)),
            ],
        }],
        Shape::Toroid {
            rotation,
            base,
            terms,
        } => {
            let mut lines = vec![radius("radius_rotation", *rotation)];
            lines.extend(conicoid(base));
            lines.push(powers(terms));
            let name = "toroid-yz";
            vec![SurfaceTable { name, lines }]
        }
        Shape::Polynomial {
            base,
            normalization_radius,
            coefficients,
        } => {
            let key = |(i, j): &(u32, u32)| format!("\"{i},{j}\"");
            let lines = vec![
                radius("normalization_radius", Some(*normalization_radius)),
                lengths(coefficients, key),
            ];
            let name = "xy-polynomial";
            let polynomial = (!coefficients.is_empty()).then_some(SurfaceTable { name, lines });
            with_base(
                radial(base, &BTreeMap::new()),
                base.radius.is_some(),
                polynomial,
            )
        }
        Shape::Zernike {
            list,
            base,
            terms,
            normalization_radius,
            coefficients,
        } => {
            let (indexing, normalization) = match list {
                ZernikeList::Noll => ("noll", "rms"),
                ZernikeList::Fringe => ("fringe", "peak"),
            };
            let lines = vec![
                format!("indexing = \"{indexing}\"\nnormalization = \"{normalization}\"\n"),
                radius("normalization_radius", Some(*normalization_radius)),
                lengths(coefficients, u32::to_string),
            ];
            let name = "zernike";
            let zernike = (!coefficients.is_empty()).then_some(SurfaceTable { name, lines });
            let is_bent = base.radius.is_some() || !terms.is_empty();
            with_base(radial(base, terms), is_bent, zernike)
        }
    }
}

/// The base and what is added to it. A flat base adds nothing.
fn with_base(base: SurfaceTable, is_bent: bool, rest: Option<SurfaceTable>) -> Vec<SurfaceTable> {
    let base = (is_bent || rest.is_none()).then_some(base);
    base.into_iter().chain(rest).collect()
}

/// A body of revolution: the model with the fewest parameters that has it.
fn radial(base: &Base, terms: &BTreeMap<u32, f64>) -> SurfaceTable {
    let is_odd = terms.keys().any(|power| !power.is_multiple_of(2));
    let name = match (base.radius, terms.is_empty(), is_odd) {
        (Some(_), true, _) => "conic",
        (_, _, false) => "even-asphere",
        (_, _, true) => "odd-asphere",
    };
    let mut lines = conicoid(base);
    lines.push(powers(terms));
    SurfaceTable { name, lines }
}

fn conicoid(base: &Base) -> Vec<String> {
    vec![
        radius("radius", base.radius),
        match base.radius {
            Some(_) => format!("conic = {}\n", number(base.conic)),
            // A straight section has none.
            None => String::new(),
        },
    ]
}

/// A line with a radius; nothing where the section is straight.
fn radius(key: &str, radius: Option<f64>) -> String {
    radius.map_or_else(String::new, |radius| {
        format!("{key} = {}\n", length(radius))
    })
}

fn powers(terms: &BTreeMap<u32, f64>) -> String {
    let rows = terms.iter();
    table(rows.map(|(power, value)| format!("{power} = {}", number(*value))))
}

fn lengths<K>(coefficients: &BTreeMap<K, f64>, key: impl Fn(&K) -> String) -> String {
    let rows = coefficients.iter();
    table(rows.map(|(name, value)| format!("{} = {}", key(name), length(*value))))
}

/// The table of the coefficients below that of the surface; nothing without any.
fn table(rows: impl Iterator<Item = impl Display>) -> String {
    let rows: Vec<String> = rows.map(|row| format!("{row}\n")).collect();
    match rows.is_empty() {
        true => String::new(),
        false => format!("[surface.coefficients]\n{}", rows.concat()),
    }
}
