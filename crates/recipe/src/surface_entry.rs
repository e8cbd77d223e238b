//! The surfaces that a recipe adds up.

use turnpath_core::{Placement, Slot};

use crate::choice::Choice;
use crate::diagnostic::Diagnostic;
use crate::document::Value;
use crate::read::Sections;
use crate::surface_list::surfaces;
use crate::tables;

/// A surface of the sum: its strategy, and its place.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceEntry {
    /// The strategy, with its parameters.
    pub choice: Choice,
    /// Its place in the sum.
    pub placement: Placement,
}

/// Reads `[surface]`, or each `[[surface]]`; `None` if something is wrong.
pub(crate) fn surface_entries(sections: &mut Sections<'_>) -> Option<Vec<SurfaceEntry>> {
    let found = surfaces(sections.root);
    if found.is_empty() {
        report_empty(sections);
        return None;
    }
    let mut entries = Vec::new();
    for (path, node) in &found {
        // What is no table has its message already.
        let Value::Table(table) = &node.value else {
            continue;
        };
        let mut section = sections.open_table(path, table, node.span.clone());
        let choice = Choice::read(Slot::Surface, &mut section);
        let placement = tables::placement(&mut section);
        if let (Some(choice), Some(placement)) = (choice, placement) {
            entries.push(SurfaceEntry { choice, placement });
        }
    }
    (entries.len() == found.len()).then_some(entries)
}

fn report_empty(sections: &mut Sections<'_>) {
    let key = Slot::Surface.key();
    let Some(entry) = sections.root.get(key) else {
        // The message that the table is missing.
        Choice::read(Slot::Surface, &mut sections.open(key));
        return;
    };
    let diagnostic = Diagnostic::new(entry.node.span.clone(), "the list of surfaces is empty")
        .with_label("nothing to cut")
        .with_help("write [[surface]] and its keys below it, once for each surface of the sum");
    sections.diagnostics.push(diagnostic);
}
