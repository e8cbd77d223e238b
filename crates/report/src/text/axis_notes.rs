//! What the axes mean, for a person.

use crate::axis_notes::AxisNotes;
use crate::check::ProgramEstimate;

use super::numbers::line;

/// Three lines on the axes; where C does not mean the same in all programs, a line for each of them.
pub fn axis_notes(notes: &AxisNotes, programs: &[ProgramEstimate]) -> String {
    let mut text = line("X", &notes.x) + &line("Z", &notes.z);
    let meanings = programs.iter().filter_map(|program| {
        let meaning = program.c_means.as_ref()?;
        Some((program, meaning))
    });
    match meanings.clone().all(|(_, meaning)| *meaning == notes.c) {
        true => text += &line("C", &notes.c),
        false => text.extend(
            meanings.map(|(program, meaning)| line("C", format!("{meaning} ({})", program.file))),
        ),
    }
    text
}
