//! The surface of a recipe against a map: the check before cutting, and a measurement after it.

use std::path::{Path, PathBuf};

use turnpath_core::{Part, SurfaceModel};
use turnpath_files::{Draft, read_bounded};
use turnpath_host::Catalogue;
use turnpath_maps::{Conventions, Format, Map, MapError};
use turnpath_pipeline::Link;
use turnpath_post::GridPoints;
use turnpath_recipe::{Diagnostic, Recipe};
use turnpath_report::{FORMAT, MapComparison, MapPlace};

use super::grid_file::{GridForm, GridWriter, not_written};
use crate::data_files::DataFiles;
use crate::diagnosis::of_pipeline;
use crate::error::Error;
use crate::input_files::refuse_as_output;
use crate::surface::surface;

/// Largest map that is read: that of a data file.
const MOST_BYTES: u64 = 1 << 30;

/// Points on the edge of the aperture count, whatever the rounding of their places, mm.
const EDGE: f64 = 1e-9;

/// A map, and what its file does not say.
#[derive(Debug, Clone, PartialEq)]
pub struct MapSource {
    /// The file.
    pub file: PathBuf,
    /// The format; without it as the first bytes or the name say.
    pub format: Option<Format>,
    /// Unit of x, y and distances, mm; without it that of the file.
    pub xy_unit: Option<f64>,
    /// Unit of heights, mm; without it that of the file.
    pub z_unit: Option<f64>,
    /// Distance of neighbouring points, mm; without it that of the file.
    pub pitch: Option<f64>,
    /// Whether x changes its sign.
    pub flip_x: bool,
}

/// Compares the recipe's surface with a map, at the map's points on the part, and writes the
/// difference, map minus surface, into `output`. The ending of its name chooses the form: `.gsf`,
/// `.DAT` (Zemax), or CSV for all others.
///
/// # Errors
/// When the map cannot be read or no point of it can be compared, when the surface is not there or
/// fails, when the output is the map or another file that is read here, or when the file cannot be
/// written.
pub fn compare_with_map(
    recipe: &Recipe,
    catalogue: &Catalogue,
    source: &MapSource,
    output: Option<&Path>,
) -> Result<MapComparison, Error> {
    let map = read_map(source)?;
    let files = DataFiles::default();
    let surface = surface(recipe, catalogue, &files)?;
    if let Some(output) = output {
        let read = files.paths();
        let named = [source.file.as_path(), recipe.path()];
        let read = read.iter().map(|file| file.as_path());
        refuse_as_output(output, read.chain(named))?;
    }
    let difference = Difference::new(recipe, &surface, &map)?;
    let Some(report) = difference.report(recipe, source) else {
        let nothing = NoPoints {
            file: source.file.clone(),
        };
        return Err(Error::refused_by(
            turnpath_recipe::Diagnostics::from(Diagnostic::from_error(&nothing)),
            nothing,
        ));
    };
    if let Some(output) = output {
        difference.write(recipe, output)?;
    }
    Ok(report)
}

/// A map and a part without a common point.
#[derive(Debug, thiserror::Error)]
#[error("no point of {} that has a height lies where the part has one", file.display())]
struct NoPoints {
    file: PathBuf,
}

/// Why a file is no map, with the file.
#[derive(Debug, thiserror::Error)]
#[error("{}: {error}", file.display())]
struct NoMap {
    file: PathBuf,
    error: MapError,
}

fn read_map(source: &MapSource) -> Result<Map, Error> {
    let file = &source.file;
    let bytes = read_bounded(file, MOST_BYTES).map_err(|source| Error::Unreadable {
        path: file.clone(),
        source,
    })?;
    let conventions = Conventions {
        format: source.format,
        xy_unit: source.xy_unit,
        z_unit: source.z_unit,
        pitch_x: source.pitch,
        pitch_y: source.pitch,
        ..Conventions::default()
    };
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let mut map = turnpath_maps::read(&name, &bytes, &conventions).map_err(|error| {
        let file = file.clone();
        let error = NoMap { file, error };
        let options =
            "these keys of a recipe are options here: --map-format, --xy-unit, --z-unit, --pitch";
        let diagnostic = Diagnostic::from_error(&error).with_helps([options.to_owned()]);
        Error::refused_by(turnpath_recipe::Diagnostics::from(diagnostic), error)
    })?;
    if source.flip_x {
        map.flip_x();
    }
    Ok(map)
}

/// Map minus surface at the points of a map.
struct Difference<'a> {
    map: &'a Map,
    /// Row by row from the bottom, mm; NaN where nothing is compared.
    values: Vec<f64>,
    beyond_part: u64,
    without_height: u64,
    without_surface: u64,
}

impl<'a> Difference<'a> {
    fn new(recipe: &Recipe, surface: &Link<dyn SurfaceModel>, map: &'a Map) -> Result<Self, Error> {
        let mut difference = Self {
            map,
            values: Vec::with_capacity(map.heights().len()),
            beyond_part: 0,
            without_height: 0,
            without_surface: 0,
        };
        let x: Vec<f64> = (0..map.columns()).map(|column| map.x(column)).collect();
        let mut z = vec![f64::NAN; x.len()];
        for row in 0..map.rows() {
            let y = vec![map.y(row); x.len()];
            let heights = surface.strategy.heights(&x, &y, &mut z);
            heights.map_err(|error| of_pipeline(recipe, surface.failed("at the map", error)))?;
            for (column, (x, z)) in x.iter().zip(&z).enumerate() {
                let height = map.height(column, row);
                let value = difference.value(&recipe.part, [*x, map.y(row)], height, *z);
                difference.values.push(value);
            }
        }
        Ok(difference)
    }

    /// The difference at a point, and the count of what is left out.
    fn value(&mut self, part: &Part, [x, y]: [f64; 2], height: f64, surface: f64) -> f64 {
        let radius = (x * x + y * y).sqrt();
        let on_part = radius <= part.aperture_radius + EDGE && radius >= part.inner_radius - EDGE;
        if !on_part {
            self.beyond_part += 1;
        } else if height.is_nan() {
            self.without_height += 1;
        } else if surface.is_nan() {
            self.without_surface += 1;
        } else {
            return height - surface;
        }
        f64::NAN
    }

    /// The points that are compared, each with its place in the map.
    fn compared(&self) -> impl Iterator<Item = (usize, f64)> {
        let all = self.values.iter().copied().enumerate();
        all.filter(|(_, value)| !value.is_nan())
    }

    fn place(&self, index: usize, difference: f64) -> MapPlace {
        let columns = self.map.columns();
        MapPlace {
            difference,
            x: self.map.x(index % columns),
            y: self.map.y(index / columns),
        }
    }

    /// The figures; `None` where no point is compared.
    fn report(&self, recipe: &Recipe, source: &MapSource) -> Option<MapComparison> {
        let (first, value) = self.compared().next()?;
        let (mut highest, mut lowest) = ((first, value), (first, value));
        let (mut count, mut sum) = (0, 0.0);
        for (index, value) in self.compared() {
            if value > highest.1 {
                highest = (index, value);
            }
            if value < lowest.1 {
                lowest = (index, value);
            }
            count += 1;
            sum += value;
        }
        let mean = sum / count as f64;
        let about = |middle: f64| {
            let squares = self
                .compared()
                .map(|(_, value)| (value - middle) * (value - middle));
            (squares.sum::<f64>() / count as f64).sqrt()
        };
        let worst = if highest.1.abs() >= lowest.1.abs() {
            highest
        } else {
            lowest
        };
        Some(MapComparison {
            format: FORMAT,
            name: recipe.name.clone(),
            map: source.file.display().to_string(),
            points: count,
            beyond_part: self.beyond_part,
            without_height: self.without_height,
            without_surface: self.without_surface,
            pv: highest.1 - lowest.1,
            rms: about(0.0),
            mean,
            rms_without_piston: about(mean),
            worst: self.place(worst.0, worst.1),
            highest: self.place(highest.0, highest.1),
            lowest: self.place(lowest.0, lowest.1),
        })
    }

    fn write(&self, recipe: &Recipe, file: &Path) -> Result<(), Error> {
        let map = self.map;
        let points = GridPoints {
            columns: map.columns(),
            rows: map.rows(),
            pitch: [map.pitch_x(), map.pitch_y()],
            middle: [
                0.5 * (map.x(0) + map.x(map.columns() - 1)),
                0.5 * (map.y(0) + map.y(map.rows() - 1)),
            ],
        };
        let title = format!("{}: map minus surface", recipe.name);
        let Some(mut writer) = GridWriter::begin(GridForm::of(file), file, &title, &points)? else {
            return self.write_csv(file);
        };
        for row in self.values.chunks_exact(map.columns()).rev() {
            writer.row(row.iter().copied())?;
        }
        Ok(writer.complete()?)
    }

    /// Lines of the points that are compared.
    fn write_csv(&self, file: &Path) -> Result<(), Error> {
        let mut draft = Draft::begin(file)?;
        let mut rows = csv::Writer::from_writer(&mut draft);
        rows.write_record(["x_mm", "y_mm", "difference_mm"])
            .map_err(|error| not_written(file, error))?;
        for (index, value) in self.compared() {
            let MapPlace { difference, x, y } = self.place(index, value);
            let written = rows.serialize([x, y, difference]);
            written.map_err(|error| not_written(file, error))?;
        }
        rows.flush().map_err(|error| not_written(file, error))?;
        drop(rows);
        draft.complete()?;
        Ok(())
    }
}
