//! `--plot`, `--plot-size` and `--plot-dpi` as requests to the library.

use std::path::{Path, PathBuf};

use turnpath::{Dots, DrawingError, DrawingRequest, Figure, Size};

use super::output::refuse_output;
use crate::args::DrawingArgs;
use crate::failure::Failure;

/// What stands between a figure and its file.
const IS: char = '=';

/// The figures that the arguments ask for.
pub fn requests(args: &DrawingArgs) -> Result<Vec<DrawingRequest>, Failure> {
    let refused = |option: &str, error: DrawingError| Failure::Call(format!("{option}: {error}"));
    let size = args.plot_size.as_deref().map(size).transpose()?;
    let dots = Dots::per_inch(args.plot_dpi).map_err(|error| refused("--plot-dpi", error))?;
    let request = |text: &String| {
        let (figure, file) = figure(text)?;
        refuse_output(Some(&file), "--plot")?;
        Ok(DrawingRequest {
            figure,
            file,
            size,
            dots,
        })
    };
    args.plot.iter().map(request).collect()
}

/// The figure and the file of `FIGURE=FILE`, or of a file that has the name of a figure.
fn figure(text: &str) -> Result<(Figure, PathBuf), Failure> {
    let (name, file) = match text.split_once(IS) {
        Some((name, file)) => (name.to_owned(), file),
        None => {
            let stem = Path::new(text).file_stem().unwrap_or_default();
            (stem.to_string_lossy().into_owned(), text)
        }
    };
    match Figure::named(&name) {
        Some(figure) => Ok((figure, file.into())),
        None => {
            let names = Figure::ALL.map(Figure::name).join(", ");
            Err(Failure::Call(format!(
                "--plot {text}: there is no figure `{}`; there are {names}. Write the figure before \
                 its file, such as map=error.svg, or call the file map.svg",
                turnpath_core::printable_line(&name)
            )))
        }
    }
}

/// A size such as 85x60, in mm.
fn size(text: &str) -> Result<Size, Failure> {
    let side = |text: &str| text.trim().parse::<f64>().ok();
    let sides = text.split_once(['x', '×']);
    let sides = sides.and_then(|(width, height)| Some((side(width)?, side(height)?)));
    let Some((width, height)) = sides else {
        return Err(Failure::Call(format!(
            "--plot-size {text}: give width and height in mm, such as 85x60"
        )));
    };
    Size::new(width, height).map_err(|error| Failure::Call(format!("--plot-size: {error}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(text: &str) -> Option<(Figure, PathBuf)> {
        figure(text).ok()
    }

    #[test]
    fn a_figure_is_named_before_its_file_or_by_it() {
        let map = |file: &str| Some((Figure::Map, PathBuf::from(file)));
        assert_eq!(asked("map=paper/fig3.svg"), map("paper/fig3.svg"));
        assert_eq!(asked("paper/map.png"), map("paper/map.png"));
        assert_eq!(asked("fig3.svg"), None);
        assert_eq!(asked("fig3=map.svg"), None);
        assert_eq!(asked(""), None);
    }

    #[test]
    fn a_size_has_two_sides_in_mm() {
        assert_eq!(size("85x60").ok(), Size::new(85.0, 60.0).ok());
        assert_eq!(size("85.5 x 60").ok(), Size::new(85.5, 60.0).ok());
        for wrong in ["85", "85x", "x60", "85x60mm", "85x60x3", "1x1", "NaNx60"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }
}
