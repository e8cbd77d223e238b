//! The text of a recipe for a surface of a design.

use std::path::Path;

use turnpath_core::printable_line;
use turnpath_lens::{DesignSurface, Shape, Side};

use super::surface_tables::{length, surface_tables};

/// The tables of a body of revolution from `[tolerance]` on: those of
/// `docs/recipes/surfaces/even-asphere.toml`.
const OF_REVOLUTION: &str = r#"[feed]
use = "constant"            # the largest that holds the residual everywhere

[sampler]
use = "equal-angle"
step = "30 deg"             # a body of revolution: Z follows the slow feed alone

[compensator]
use = "normal"              # the contact, not the nose centre, moves by the feed

[velocity]
use = "analytic"
"#;

/// The same for other shapes: those of `docs/recipes/surfaces/off-axis-conic.toml`.
const FREEFORM: &str = r#"[feed]
use = "atpg"

[sampler]
use = "atpg"

[compensator]
use = "z-direction"

[velocity]
use = "triangle-rotary"
"#;

/// What no design says: the values of the ready recipes.
const TO_BE_SET: &str = r#"[tool]
nose_radius = "0.8 mm"      # to be set: that of your tool
# included_angle = "90 deg"     # to be set: without it the edge's ends are not checked
# clearance_angle = "10 deg"    # to be set: without it the flank is not checked

[tolerance]
interpolation = "20 nm"     # to be set
residual = "50 nm"          # to be set

[spindle]
speed = "200 rpm"           # to be set

# [machine]                 # to be set: without limits the path is checked against none
# preset = "generic-sts"

[path]
direction = "inward"

"#;

/// The text of a recipe for a surface of this file.
pub fn recipe_text(surface: &DesignSurface, file: &Path) -> String {
    let is_turned = surface.shape.is_of_revolution() && is_centred(surface);
    let chain = if is_turned { OF_REVOLUTION } else { FREEFORM };
    [
        head(surface, file),
        part(surface),
        surface_tables(&surface.shape),
        TO_BE_SET.to_owned(),
        chain.to_owned(),
    ]
    .concat()
}

fn is_centred(surface: &DesignSurface) -> bool {
    surface.aperture.x == 0.0 && surface.aperture.y == 0.0
}

/// The comments on where the surface comes from, and the job's name.
fn head(surface: &DesignSurface, file: &Path) -> String {
    let file_name = file.file_name().unwrap_or(file.as_os_str());
    let file_name = file_name.to_string_lossy();
    let DesignSurface { number, kind, .. } = surface;
    let line = surface.line;
    let mut comments = vec![format!(
        "Surface {number} of {file_name}, {kind}, from line {line} on."
    )];
    if let Some(title) = &surface.title {
        comments.push(format!("The design: {title}"));
    }
    let (side, frame) = match surface.side {
        Side::MinusZ => ("-z", "x and z here are -x and -z of the design, y is y."),
        Side::PlusZ => ("+z", "x, y and z here are those of the design."),
    };
    comments.push(format!(
        "The tool stands on the side of {side} of the design, {}.",
        reason(surface.side_origin)
    ));
    comments.push(frame.to_owned());
    if surface.shape.is_plane() {
        comments.push("The surface is a plane.".to_owned());
    }
    if let Shape::Zernike { .. } = surface.shape {
        comments.push("The Zernike terms go on beyond their normalization radius.".to_owned());
    }
    comments.extend(
        surface
            .notes
            .iter()
            .map(|note| format!("Line {}: {}.", note.line, note.text)),
    );
    let name = surface.comment.clone().unwrap_or_else(|| {
        let stem = file.file_stem().unwrap_or_default().to_string_lossy();
        format!("{stem}, surface {number}")
    });
    let comments = comments.iter();
    let comments: String = comments
        .map(|text| format!("# {}\n", printable_line(text)))
        .collect();
    format!("{comments}format = 1\nname = {}\n\n", quoted(&name))
}

/// A reason as a part of a sentence.
fn reason(origin: &str) -> String {
    match origin {
        "as asked for" => origin.to_owned(),
        other => format!("since {other}"),
    }
}

/// A text as a TOML string.
fn quoted(text: &str) -> String {
    toml::Value::String(printable_line(text).into_owned()).to_string()
}

fn part(surface: &DesignSurface) -> String {
    let aperture = &surface.aperture;
    let mut text = format!(
        "[part]\naperture = {:<15} # {}\n",
        length(2.0 * aperture.radius),
        printable_line(&aperture.origin)
    );
    if aperture.inner > 0.0 {
        text += &format!("inner = {}\n", length(2.0 * aperture.inner));
    }
    text.push('\n');
    if !is_centred(surface) {
        text += &format!(
            "[part.pose]                 # the middle of the aperture on the surface below\n\
             x = {}\ny = {}\n\
             level = true                # laid flat: the normal there is the spindle's axis\n\n",
            length(aperture.x),
            length(aperture.y)
        );
    }
    text
}
