//! What the axes mean, for a person.

use crate::axis_notes::AxisNotes;

use super::numbers::line;

/// Three lines on the axes.
pub fn axis_notes(notes: &AxisNotes) -> String {
    let rows = [("X", &notes.x), ("Z", &notes.z), ("C", &notes.c)];
    let rows = rows.map(|(axis, note)| line(axis, note));
    rows.concat()
}
