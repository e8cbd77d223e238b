//! Writes a loop over depths in the words of Moore Nanotech's machines.
//!
//! The form is that of published programs for a 650 FG: variables with `#`, `WHILE[… LT …] DO 2` to `END 2`, and
//! `G52` with the place of the zero.

use crate::decimal::push;
use crate::program_format::{Depths, ProgramFormat};

/// The lines that begin the loop, and those that end it.
pub(super) fn depth_lines(format: &ProgramFormat, depths: &Depths) -> [String; 2] {
    let decimals = format.position_decimals;
    let mm = |digits: i64| {
        let mut text = Vec::new();
        push(&mut text, digits, decimals);
        String::from_utf8_lossy(&text).into_owned()
    };
    let Depths { count, step } = *depths;
    let above = mm(depths.rise().saturating_add(step));
    let (first, step) = (mm(depths.rise()), mm(step));
    let begin = format!(
        "; {count} depths of {step} mm; the first is {first} mm above the path, the last is the path\n\
         #100 = {count}\n\
         #103 = {step}\n\
         #5 = 0\n\
         #8 = {above}\n\
         WHILE[#5 LT #100] DO 2\n\
         #8 = #8 - #103\n\
         G52 X0 Y0 Z[#8]\n"
    );
    [begin, "#5 = #5 + 1\nEND 2\n".to_owned()]
}
