//! Draws the plots of a path in a file, which is read once, block by block.

use std::io::Write;
use std::path::Path;

use turnpath_core::Result as Evaluated;
use turnpath_core::toolpath::{PathBlock, Section, SegmentShape};
use turnpath_files::{Draft, FileError};
use turnpath_pipeline::{Observer, Stage};
use turnpath_post::{GsfWriter, ReadPath, XyzWriter};
use turnpath_recipe::Recipe;
use turnpath_report::unit;
use turnpath_verify::machined::{Grid, Map, Nose, ProfileLine, power_spectrum};
use turnpath_verify::{AxesSpectrum, FirstTouch};

use super::files::{MapForm, MapPlot, Plots, ProfilePlot};
use crate::diagnosis::of_measure;
use crate::error::Error;

/// Control points of a block: some 30 MB with their segments, and few blocks, since each one looks
/// at every cell within reach of it.
const BLOCK_ROWS: usize = 200_000;

/// A path and what it is measured against.
pub struct PlayedPath<'a> {
    pub recipe: &'a Recipe,
    pub touch: &'a FirstTouch,
    pub shape: SegmentShape,
    /// Largest |played − true| of the path, mm.
    pub largest_error: f64,
    /// How many control points it has.
    pub points: u64,
}

/// What measures each plot.
struct Meters {
    maps: Vec<Map>,
    profiles: Vec<ProfileLine>,
    spectrum: Option<AxesSpectrum>,
}

/// Begins the draft of the file with this name.
pub type BeginDraft<'a> = dyn Fn(&Path) -> Result<Draft, FileError> + 'a;

/// Draws the plots: files that are whole, and still without their names.
pub fn draw(
    plots: &Plots,
    played: &PlayedPath<'_>,
    reader: &mut dyn ReadPath,
    begin: &BeginDraft<'_>,
    observer: &dyn Observer,
) -> Result<Vec<Draft>, Error> {
    let failed = |error| of_measure(played.recipe, error);
    let mut meters = Meters::new(plots, played);
    observer.begin(Stage::Map, played.points.div_ceil(BLOCK_ROWS as u64));
    while let Some((section, block)) = reader.next_block(BLOCK_ROWS)? {
        if observer.is_cancelled() {
            return Err(Error::Cancelled);
        }
        if section != Section::Cutting {
            continue;
        }
        let shape = played.shape;
        meters
            .take(played, &PathBlock { shape, ..block })
            .map_err(failed)?;
        observer.advance(1);
    }
    meters.write(plots, played, begin)
}

impl Meters {
    fn new(plots: &Plots, played: &PlayedPath<'_>) -> Self {
        let part = played.touch.subject().part;
        let map = plots.map.iter().map(|map| map.grid);
        let grids = map.chain(plots.circles.iter().map(|circle| circle.grid));
        let profiles = plots.profiles.iter();
        let speed = played.recipe.spindle_speed;
        Self {
            maps: grids.map(|grid| Map::new(grid, part)).collect(),
            profiles: profiles
                .map(|profile| ProfileLine::new(profile.angle))
                .collect(),
            spectrum: plots.spectrum.as_ref().map(|_| AxesSpectrum::new(speed)),
        }
    }

    fn take(&mut self, played: &PlayedPath<'_>, block: &PathBlock) -> Evaluated<()> {
        let nose = Nose::new(played.touch, played.largest_error);
        for map in &mut self.maps {
            map.cut(&nose, block)?;
        }
        for profile in &mut self.profiles {
            profile.append(played.touch, block)?;
        }
        if let Some(spectrum) = &mut self.spectrum {
            spectrum.append(block);
        }
        Ok(())
    }

    fn write(
        self,
        plots: &Plots,
        played: &PlayedPath<'_>,
        begin: &BeginDraft<'_>,
    ) -> Result<Vec<Draft>, Error> {
        let mut written = Vec::new();
        let mut maps = self.maps.iter();
        for (plot, map) in plots.map.iter().zip(&mut maps) {
            written.push(write_map(
                begin(&plot.file)?,
                plot,
                map,
                &played.recipe.name,
            )?);
        }
        for (plot, profile) in plots.profiles.iter().zip(&self.profiles) {
            written.extend(write_profile(plot, profile, played, begin)?);
        }
        for (plot, map) in plots.circles.iter().zip(&mut maps) {
            written.push(write_circle(begin(&plot.file)?, map, played)?);
        }
        for (file, spectrum) in plots.spectrum.iter().zip(&self.spectrum) {
            written.push(write_spectrum(begin(file)?, spectrum)?);
        }
        Ok(written)
    }
}

fn write_map(draft: Draft, plot: &MapPlot, map: &Map, name: &str) -> Result<Draft, FileError> {
    let rows = 0..plot.grid.rows();
    if let (MapForm::Gsf, Grid::Cartesian { count, half }) = (plot.form, plot.grid) {
        let title = format!("{name}: surface error");
        let mut writer = GsfWriter::begin(draft, &title, count, half)?;
        for row in rows {
            writer.row(map.row(row).map(f64::from))?;
        }
        return Ok(writer.whole());
    }
    let mut writer = XyzWriter::new(draft);
    for row in rows {
        for (column, error) in map
            .row(row)
            .enumerate()
            .filter(|(_, error)| !error.is_nan())
        {
            let (x, y) = plot.grid.point(row, column);
            writer.point(x, y, error)?;
        }
    }
    Ok(writer.whole())
}

fn write_profile(
    plot: &ProfilePlot,
    profile: &ProfileLine,
    played: &PlayedPath<'_>,
    begin: &BeginDraft<'_>,
) -> Result<[Draft; 2], Error> {
    let failed = |error| of_measure(played.recipe, error);
    let places = profile.points(played.touch).map_err(failed)?;
    let cut = places.iter().filter(|place| !place.error.is_nan());
    let rows = cut.map(|place| [place.s, place.error, place.wanted]);
    let table = write_errors(begin(&plot.file)?, "s_mm", rows)?;
    let step = match places.as_slice() {
        [first, second, ..] => second.s - first.s,
        _ => 1.0,
    };
    let errors: Vec<f64> = places.iter().map(|place| place.error).collect();
    let mut draft = begin(&plot.spectrum)?;
    let mut text = "frequency_per_mm,psd_nm2_mm\n".to_owned();
    for line in power_spectrum(&errors, step) {
        let density = line.density * unit::nm::PER * unit::nm::PER;
        text += &format!("{:.9e},{density:.6e}\n", line.frequency);
    }
    put(&mut draft, &text)?;
    Ok([table, draft])
}

fn write_circle(draft: Draft, map: &Map, played: &PlayedPath<'_>) -> Result<Draft, Error> {
    let grid = map.grid();
    let places = (0..grid.columns()).map(|column| grid.point(0, column));
    let (x, y): (Vec<f64>, Vec<f64>) = places.unzip();
    let mut wanted = vec![f64::NAN; x.len()];
    let surface = &played.touch.subject().surface;
    surface
        .heights(&x, &y, &mut wanted)
        .map_err(|error| of_measure(played.recipe, error))?;
    let rows = map.row(0).zip(&wanted).enumerate();
    let rows = rows.filter(|(_, (error, _))| !error.is_nan());
    let degrees = |column: usize| 360.0 * column as f64 / grid.columns() as f64;
    let rows = rows.map(|(column, (error, wanted))| [degrees(column), f64::from(error), *wanted]);
    Ok(write_errors(draft, "c_deg", rows)?)
}

fn write_spectrum(mut draft: Draft, spectrum: &AxesSpectrum) -> Result<Draft, FileError> {
    let mut text = "frequency_hz,x_um2_per_hz,z_um2_per_hz\n".to_owned();
    for line in spectrum.lines() {
        let [x, z] = [line.x, line.z].map(|density| density * unit::um::PER * unit::um::PER);
        text += &format!("{:.9e},{x:.6e},{z:.6e}\n", line.frequency);
    }
    put(&mut draft, &text)?;
    Ok(draft)
}

/// A table of (place, error in mm, wanted z): places without an error are left out.
fn write_errors(
    mut draft: Draft,
    place: &str,
    rows: impl Iterator<Item = [f64; 3]>,
) -> Result<Draft, FileError> {
    let mut text = format!("{place},error_nm,wanted_mm,machined_mm\n");
    for [at, error, wanted] in rows {
        let (nm, machined) = (error * unit::nm::PER, wanted + error);
        text += &format!("{at:.9},{nm:.6},{wanted:.12},{machined:.12}\n");
    }
    put(&mut draft, &text)?;
    Ok(draft)
}

fn put(draft: &mut Draft, text: &str) -> Result<(), FileError> {
    draft.write_all(text.as_bytes()).map_err(|error| FileError {
        path: draft.path().to_owned(),
        error,
    })
}
