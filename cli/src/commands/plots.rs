//! `--map`, `--profile`, `--circle` and `--spectrum` as a request to the library.

use turnpath::{MapGrid, MapRequest, PlotRequest};
use turnpath_core::Quantity;

use super::output::refuse_output;
use crate::args::{self, PlotArgs};
use crate::failure::Failure;

/// What the arguments ask for.
pub fn request(args: &PlotArgs) -> Result<PlotRequest, Failure> {
    refuse_output(args.map.as_deref(), "--map")?;
    let map = args.map.as_ref().map(|file| MapRequest {
        file: file.clone(),
        cells: args.map_size as usize,
        grid: match args.map_grid {
            args::MapGrid::Cartesian => MapGrid::Cartesian,
            args::MapGrid::Polar => MapGrid::Polar,
        },
    });
    Ok(PlotRequest {
        map,
        profiles: each(Quantity::Angle, "--profile", &args.profile)?,
        circles: each(Quantity::Length, "--circle", &args.circle)?,
        spectrum: args.spectrum,
    })
}

fn each(quantity: Quantity, option: &str, texts: &[String]) -> Result<Vec<f64>, Failure> {
    let value = |text: &String| {
        let value = quantity.parse(text);
        value.map_err(|error| Failure::Call(format!("{option}: {error}")))
    };
    texts.iter().map(value).collect()
}
