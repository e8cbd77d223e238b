//! The figures, a file each.

mod along_radius;
mod axes;
mod feed;
mod map;
mod spectrum;
mod spiral;
mod square_part;

use turnpath_report::{PathSketch, RunReport};

use crate::drawing::Drawing;
use crate::request::{DrawingError, Figure, Size};
use crate::shape::Area;
use crate::sheet::Sheet;

/// Draws a figure of a run. Where the run has nothing of it, its frame is empty.
///
/// # Errors
/// When the size is below the least size of the figure.
pub fn draw(
    figure: Figure,
    (report, sketch): (&RunReport, &PathSketch),
    size: Size,
) -> Result<Drawing, DrawingError> {
    figure.allows(size)?;
    let sheet = Area {
        left: 0.0,
        top: 0.0,
        width: size.width,
        height: size.height,
    };
    let shapes = match figure {
        Figure::Map => map::map(sketch, sheet),
        Figure::Spiral => spiral::spiral(sketch, sheet),
        Figure::Feed => feed::feed(sketch, sheet),
        Figure::Axes => axes::axes(report, sketch, sheet),
        Figure::Spectrum => spectrum::spectrum(report, sketch, sheet),
    };
    let title = format!(
        "{}, {} by turnpath {}",
        report.name,
        figure.name(),
        report.turnpath
    );
    Ok(Drawing::of(Sheet {
        title,
        size,
        shapes,
    }))
}
