//! `surface`: one table, or a list of tables whose surfaces are added up.
//!
//! The path of a key within it has the place of the surface, `surface.0.radius`. Where the recipe
//! has one surface, the path need not have it.

use turnpath_core::Slot;

use crate::diagnostic::Diagnostic;
use crate::document::{Node, Table, Value, index};
use crate::span::Span;
use crate::suggest::{listed, quoted};

/// The surfaces of a recipe, each with the path of its table: `surface` for a single one, else
/// `surface.0` and so on.
pub(crate) fn surfaces(root: &Table) -> Vec<(String, &Node)> {
    let key = Slot::Surface.key();
    let Some(entry) = root.get(key) else {
        return Vec::new();
    };
    match &entry.node.value {
        Value::Array(items) => match items.as_slice() {
            [only] => vec![(key.to_owned(), only)],
            items => {
                let path = |(at, item)| (format!("{key}.{at}"), item);
                items.iter().enumerate().map(path).collect()
            }
        },
        _ => vec![(key.to_owned(), &entry.node)],
    }
}

/// A table as messages name it: `[sampler]`, and of a sum `surface.1`.
pub(crate) fn heading(path: &str) -> String {
    match path.rsplit_once('.') {
        Some((_, at)) if index(at).is_some() => format!("`{path}`"),
        _ => format!("[{path}]"),
    }
}

/// The value that the path of a setting starts from, and how many of its keys lead there: a surface
/// where the path goes into one, else nothing.
///
/// # Errors
/// When the path does not say which surface is meant, or means one that the recipe does not have.
pub(crate) fn surface_of<'t>(
    root: &'t mut Table,
    path: &[(String, Span)],
) -> Result<Option<(&'t mut Node, usize)>, Diagnostic> {
    let [(first, _), (second, span), ..] = path else {
        return Ok(None);
    };
    if first != Slot::Surface.key() {
        return Ok(None);
    }
    let at = index(second);
    let used = if at.is_some() { 2 } else { 1 };
    let Some(entry) = root.get_mut(first) else {
        return match at {
            None => Ok(None),
            Some(_) => Err(no_such_surface(second, span, 0)),
        };
    };
    let node = &mut entry.node;
    if !matches!(node.value, Value::Array(_)) {
        return match at {
            None | Some(0) => Ok(Some((node, used))),
            Some(_) => Err(no_such_surface(second, span, 1)),
        };
    }
    let Value::Array(items) = &mut node.value else {
        return Ok(None);
    };
    let count = items.len();
    let at = match at {
        None if count > 1 => return Err(which_surface(path, span, count)),
        at => at.unwrap_or(0),
    };
    match items.get_mut(at) {
        Some(item) => Ok(Some((item, used))),
        None => Err(no_such_surface(second, span, count)),
    }
}

fn no_such_surface(index: &str, span: &Span, count: usize) -> Diagnostic {
    let surfaces = match count {
        0 => "the recipe has no surface yet".to_owned(),
        1 => "the recipe has one surface, `surface.0`".to_owned(),
        count => format!(
            "the recipe has {count} surfaces, `surface.0` to `surface.{}`",
            count - 1
        ),
    };
    Diagnostic::new(
        span.clone(),
        format!("there is no surface {}", quoted(index)),
    )
    .with_label("counted from 0")
    .with_help(surfaces)
}

/// The message that a path into a sum does not say which surface is meant.
pub(crate) fn which_surface(path: &[(String, Span)], span: &Span, count: usize) -> Diagnostic {
    let keys = |path: &[(String, Span)]| -> String {
        let keys: Vec<&str> = path.iter().map(|(key, _)| key.as_str()).collect();
        keys.join(".")
    };
    let below = keys(path.get(1..).unwrap_or_default());
    let places: Vec<String> = (0..count)
        .map(|at| format!("surface.{at}.{below}"))
        .collect();
    let places: Vec<&str> = places.iter().map(String::as_str).collect();
    let title = format!(
        "`{}` does not say which of the {count} surfaces is meant",
        keys(path)
    );
    Diagnostic::new(span.clone(), title)
        .with_label("of which surface?")
        .with_help(format!("write one of {}", listed(&places)))
}
