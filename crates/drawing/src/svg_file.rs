//! A drawing as SVG.

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use crate::png_file::encoded;
use crate::shape::{Area, Colour, Ink, Pixels, Place, Shape, Step};
use crate::sheet::Sheet;

/// Digits after the point of places, mm: a micrometre on paper.
const DIGITS: usize = 3;

/// The whole file.
pub fn svg(drawing: &Sheet) -> String {
    let (width, height) = (number(drawing.size.width), number(drawing.size.height));
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}mm\" height=\"{height}mm\" \
         viewBox=\"0 0 {width} {height}\">\n<title>{}</title>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n",
        escaped(&drawing.title)
    );
    for shape in &drawing.shapes {
        write_shape(&mut text, shape);
    }
    text += "</svg>\n";
    text
}

fn write_shape(text: &mut String, shape: &Shape) {
    match shape {
        Shape::Outline {
            steps,
            ink,
            colour,
            label,
        } => {
            let label = label.as_ref().map_or_else(String::new, |label| {
                format!(" aria-label=\"{}\"", escaped(label))
            });
            let (ink, steps) = (ink_text(*ink, *colour), steps_text(steps));
            *text += &format!("<path{label} {ink} d=\"{steps}\"/>\n");
        }
        Shape::Picture { pixels, area } => *text += &picture(pixels, *area),
        Shape::Group { name, shapes } => {
            *text += &format!("<g id=\"{}\">\n", escaped(name));
            for shape in shapes {
                write_shape(text, shape);
            }
            *text += "</g>\n";
        }
    }
}

fn ink_text(ink: Ink, [r, g, b]: Colour) -> String {
    match ink {
        Ink::Fill => format!("fill=\"#{r:02x}{g:02x}{b:02x}\""),
        Ink::Line { width, dash } => {
            let dash = dash.map_or_else(String::new, |dash| {
                format!(" stroke-dasharray=\"{}\"", number(dash))
            });
            let width = number(width);
            format!(
                "fill=\"none\" stroke=\"#{r:02x}{g:02x}{b:02x}\" stroke-width=\"{width}\" \
                 stroke-linejoin=\"round\"{dash}"
            )
        }
    }
}

fn steps_text(steps: &[Step]) -> String {
    let mut text = String::new();
    let mut add = |letter: char, places: &[Place]| {
        text.push(letter);
        for (at, [x, y]) in places.iter().enumerate() {
            let before = if at == 0 { "" } else { " " };
            // Writing to a string cannot fail.
            let _ = write!(text, "{before}{} {}", number(*x), number(*y));
        }
    };
    for step in steps {
        match step {
            Step::Move(place) => add('M', &[*place]),
            Step::Line(place) => add('L', &[*place]),
            Step::Curve(control, place) => add('Q', &[*control, *place]),
            Step::Close => add('Z', &[]),
        }
    }
    text
}

fn picture(pixels: &Pixels, area: Area) -> String {
    let [x, y, width, height] = [area.left, area.top, area.width, area.height].map(number);
    let png = STANDARD.encode(encoded(pixels, None));
    format!(
        "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" \
         preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\" \
         href=\"data:image/png;base64,{png}\"/>\n"
    )
}

/// A number with no more digits than it needs.
fn number(value: f64) -> String {
    let text = format!("{value:.DIGITS$}");
    let short = text.trim_end_matches('0').trim_end_matches('.');
    if short == "-0" { "0" } else { short }.to_owned()
}

/// A text for XML, which has no control characters.
fn escaped(text: &str) -> String {
    let text = text.replace(char::is_control, " ");
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    text.replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::request::Size;

    #[test]
    fn numbers_are_short_and_texts_end_no_element() {
        assert_eq!(
            [0.0, -1e-9, 12.5, 1.0 / 3.0].map(number),
            ["0", "0", "12.5", "0.333"]
        );
        let drawing = Sheet {
            title: "</title><script>\u{0}\"&".to_owned(),
            size: Size::new(85.0, 60.0).unwrap(),
            shapes: Vec::new(),
        };
        let title = "<title>&lt;/title&gt;&lt;script&gt; &quot;&amp;</title>";
        assert!(svg(&drawing).contains(title), "{}", svg(&drawing));
    }

    #[test]
    fn sides_are_in_millimetres() {
        let drawing = Sheet {
            title: String::new(),
            size: Size::new(85.0, 60.5).unwrap(),
            shapes: Vec::new(),
        };
        let begin = "width=\"85mm\" height=\"60.5mm\" viewBox=\"0 0 85 60.5\"";
        assert!(svg(&drawing).contains(begin), "{}", svg(&drawing));
    }
}
