//! Recipes that the tests start from, and changes to them.

/// The saddle z = 0.16 x y on 5 mm: 104 revolutions, two blocks, half a second of work at most.
pub const SADDLE: &str = r#"format = 1
name = "Saddle"

[part]
aperture = "5 mm"

[surface]
use = "astigmatic"
k = "0.08 /mm"

[tool]
nose_radius = "1 mm"
included_angle = "120 deg"
clearance_angle = "30 deg"

[tolerance]
interpolation = "100 nm"
residual = "100 nm"

[spindle]
speed = "500 rpm"

[path]
overrun = "none"
lead = false

[feed]
use = "constant"

[sampler]
use = "equal-angle"
step = "9 deg"

[compensator]
use = "z-direction"

[velocity]
use = "triangle-rotary"
"#;

/// The text with one passage changed, which must be there.
#[track_caller]
pub fn changed(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "the recipe has no `{from}`");
    text.replacen(from, to, 1)
}

/// The text with other lines in one of its tables.
#[track_caller]
pub fn with_table(text: &str, name: &str, lines: &str) -> String {
    let header = format!("[{name}]\n");
    let (before, after) = text
        .split_once(&header)
        .unwrap_or_else(|| panic!("the recipe has no `[{name}]`"));
    let rest = after.split_once("\n\n").map_or("", |(_, rest)| rest);
    format!("{before}{header}{lines}\n\n{rest}")
}

/// The saddle with another strategy in one slot.
pub fn saddle_with(slot: &str, lines: &str) -> String {
    with_table(SADDLE, slot, lines)
}
