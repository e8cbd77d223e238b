//! A drawing as PNG.

use png::{BitDepth, ColorType, Compression, Encoder, PixelDimensions, Unit};
use tiny_skia::{
    Color, FillRule, FilterQuality, LineJoin, Paint, Path, PathBuilder, Pixmap, PixmapPaint,
    PixmapRef, Stroke, StrokeDash, Transform,
};

use crate::request::{Dots, DrawingError};
use crate::shape::{Area, Colour, Ink, Pixels, Shape, Step};
use crate::sheet::Sheet;

/// Millimetres of a metre.
const METRE: f64 = 1000.0;

/// The file.
///
/// # Errors
/// When it has too many pixels.
pub fn png(drawing: &Sheet, dots: Dots) -> Result<Vec<u8>, DrawingError> {
    let per_mm = dots.per_mm();
    let [width, height] = drawing.size.pixels(dots)?;
    let mut pixmap = Pixmap::new(width, height).ok_or(DrawingError::Pixels { width, height })?;
    pixmap.fill(Color::WHITE);
    let to_pixels = Transform::from_scale(per_mm as f32, per_mm as f32);
    for shape in &drawing.shapes {
        paint_shape(&mut pixmap, shape, to_pixels);
    }
    let pixels = Pixels {
        width,
        height,
        // White lies below everything, so all is opaque.
        bytes: pixmap.take(),
    };
    Ok(encoded(&pixels, Some((per_mm * METRE).round() as u32)))
}

/// Pixels as PNG; `per_metre` says how large they are.
pub fn encoded(pixels: &Pixels, per_metre: Option<u32>) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, pixels.width, pixels.height);
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Balanced);
    encoder.set_pixel_dims(per_metre.map(|per_metre| PixelDimensions {
        xppu: per_metre,
        yppu: per_metre,
        unit: Unit::Meter,
    }));
    // Writing to memory fails only for pixels that do not fill their rows, which none here do.
    let written = encoder
        .write_header()
        .and_then(|mut writer| writer.write_image_data(&pixels.bytes));
    debug_assert!(written.is_ok(), "{written:?}");
    file
}

fn paint_shape(pixmap: &mut Pixmap, shape: &Shape, to_pixels: Transform) {
    match shape {
        Shape::Outline {
            steps, ink, colour, ..
        } => {
            if let Some(path) = path(steps) {
                paint_path(pixmap, &path, (*ink, *colour), to_pixels);
            }
        }
        Shape::Picture { pixels, area } => paint_picture(pixmap, pixels, *area, to_pixels),
        Shape::Group { shapes, .. } => {
            for shape in shapes {
                paint_shape(pixmap, shape, to_pixels);
            }
        }
    }
}

fn paint_path(
    pixmap: &mut Pixmap,
    path: &Path,
    (ink, [r, g, b]): (Ink, Colour),
    to_pixels: Transform,
) {
    let mut paint = Paint::default();
    paint.set_color_rgba8(r, g, b, 255);
    match ink {
        Ink::Fill => pixmap.fill_path(path, &paint, FillRule::Winding, to_pixels, None),
        Ink::Line { width, dash } => {
            let dash = dash.and_then(|dash| StrokeDash::new(vec![dash as f32; 2], 0.0));
            let stroke = Stroke {
                width: width as f32,
                line_join: LineJoin::Round,
                dash,
                ..Stroke::default()
            };
            pixmap.stroke_path(path, &paint, &stroke, to_pixels, None);
        }
    }
}

fn path(steps: &[Step]) -> Option<Path> {
    let mut path = PathBuilder::new();
    for step in steps {
        match step {
            Step::Move([x, y]) => path.move_to(*x as f32, *y as f32),
            Step::Line([x, y]) => path.line_to(*x as f32, *y as f32),
            Step::Curve([x1, y1], [x, y]) => {
                path.quad_to(*x1 as f32, *y1 as f32, *x as f32, *y as f32);
            }
            Step::Close => path.close(),
        }
    }
    path.finish()
}

/// Each pixel of a picture becomes a rectangle without shades at its edges.
fn paint_picture(pixmap: &mut Pixmap, pixels: &Pixels, area: Area, to_pixels: Transform) {
    let Some(picture) = PixmapRef::from_bytes(&pixels.bytes, pixels.width, pixels.height) else {
        return;
    };
    let (x, y) = (
        area.width / f64::from(pixels.width),
        area.height / f64::from(pixels.height),
    );
    let to_area = Transform::from_row(
        x as f32,
        0.0,
        0.0,
        y as f32,
        area.left as f32,
        area.top as f32,
    );
    let paint = PixmapPaint {
        quality: FilterQuality::Nearest,
        ..PixmapPaint::default()
    };
    pixmap.draw_pixmap(0, 0, picture, &paint, to_pixels.pre_concat(to_area), None);
}
