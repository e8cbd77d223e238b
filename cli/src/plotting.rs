//! Maps, profiles, circles and the axes' spectrum of the path in a file, read once, block by block.

use std::io::Write;
use std::path::Path;

use turnpath_core::Result as Evaluated;
use turnpath_core::toolpath::{PathBlock, Section, SegmentShape};
use turnpath_pipeline::{PipelineError, Progress, Stage};
use turnpath_post::{Draft, FileError, GsfWriter, ReadPath, XyzWriter};
use turnpath_recipe::Recipe;
use turnpath_verify::machined::{Grid, Map, Nose, ProfileLine, power_spectrum};
use turnpath_verify::{AxesSpectrum, FirstTouch};

use crate::failure::Failure;
use crate::job::of_pipeline;
use crate::plots::{MapFormat, MapWish, Wishes};
use crate::summary::{NM_PER_MM, UM_PER_MM};

/// Control points of a block: some 30 MB with their segments, and few blocks, since each one looks
/// at every cell within reach of it.
const BLOCK_ROWS: usize = 200_000;

/// A path, and what cuts it.
pub struct Played<'a> {
    pub recipe: &'a Recipe,
    pub touch: &'a FirstTouch,
    pub shape: SegmentShape,
    /// Largest |played − true| of the path, mm.
    pub largest_error: f64,
    /// How many control points it has.
    pub points: u64,
}

/// All that is asked for, in the making.
struct Plots {
    maps: Vec<Map>,
    profiles: Vec<ProfileLine>,
    spectrum: Option<AxesSpectrum>,
}

/// Makes what is asked for: files that are whole, still without their names.
pub fn plot(
    wishes: &Wishes,
    played: &Played<'_>,
    reader: &mut dyn ReadPath,
    progress: &dyn Progress,
) -> Result<Vec<Draft>, Failure> {
    let failed = |error| of_pipeline(played.recipe, PipelineError::Measure(error));
    let mut plots = Plots::of(wishes, played);
    progress.begin(Stage::Map, played.points.div_ceil(BLOCK_ROWS as u64));
    while let Some((section, block)) = reader.next_block(BLOCK_ROWS)? {
        if section != Section::Cutting {
            continue;
        }
        let shape = played.shape;
        plots
            .take(played, &PathBlock { shape, ..block })
            .map_err(failed)?;
        progress.advance(1);
    }
    plots.write(wishes, played)
}

impl Plots {
    fn of(wishes: &Wishes, played: &Played<'_>) -> Self {
        let part = played.touch.subject().part;
        let map = wishes.map.iter().map(|map| map.grid);
        let grids = map.chain(wishes.circles.iter().map(|circle| circle.grid));
        let profiles = wishes.profiles.iter();
        let speed = played.recipe.spindle_speed;
        Self {
            maps: grids.map(|grid| Map::new(grid, part)).collect(),
            profiles: profiles
                .map(|profile| ProfileLine::new(profile.angle))
                .collect(),
            spectrum: wishes.spectrum.as_ref().map(|_| AxesSpectrum::new(speed)),
        }
    }

    fn take(&mut self, played: &Played<'_>, block: &PathBlock) -> Evaluated<()> {
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

    fn write(self, wishes: &Wishes, played: &Played<'_>) -> Result<Vec<Draft>, Failure> {
        let mut written = Vec::new();
        let mut maps = self.maps.iter();
        for (wish, map) in wishes.map.iter().zip(&mut maps) {
            written.push(write_map(wish, map, &played.recipe.name)?);
        }
        for (wish, profile) in wishes.profiles.iter().zip(&self.profiles) {
            written.extend(write_profile(&wish.file, &wish.spectrum, profile, played)?);
        }
        for (wish, map) in wishes.circles.iter().zip(&mut maps) {
            written.push(write_circle(&wish.file, map, played)?);
        }
        for (file, spectrum) in wishes.spectrum.iter().zip(&self.spectrum) {
            written.push(write_spectrum(file, spectrum)?);
        }
        Ok(written)
    }
}

fn write_map(wish: &MapWish, map: &Map, name: &str) -> Result<Draft, FileError> {
    let rows = 0..wish.grid.rows();
    if let (MapFormat::Gsf, Grid::Cartesian { count, half }) = (wish.format, wish.grid) {
        let title = format!("{name}: surface error");
        let mut writer = GsfWriter::begin(&wish.file, &title, count, half)?;
        for row in rows {
            writer.row(map.row(row))?;
        }
        return Ok(writer.whole());
    }
    let mut writer = XyzWriter::begin(&wish.file)?;
    for row in rows {
        for (column, error) in map
            .row(row)
            .enumerate()
            .filter(|(_, error)| !error.is_nan())
        {
            let (x, y) = wish.grid.place(row, column);
            writer.point(x, y, error)?;
        }
    }
    Ok(writer.whole())
}

fn write_profile(
    file: &Path,
    spectrum: &Path,
    profile: &ProfileLine,
    played: &Played<'_>,
) -> Result<[Draft; 2], Failure> {
    let failed = |error| of_pipeline(played.recipe, PipelineError::Measure(error));
    let places = profile.places(played.touch).map_err(failed)?;
    let cut = places.iter().filter(|place| !place.error.is_nan());
    let rows = cut.map(|place| [place.s, place.error, place.wanted]);
    let table = write_errors(file, "s_mm", rows)?;
    let step = match places.as_slice() {
        [first, second, ..] => second.s - first.s,
        _ => 1.0,
    };
    let errors: Vec<f64> = places.iter().map(|place| place.error).collect();
    let mut draft = Draft::begin(spectrum)?;
    let mut text = "frequency_per_mm,psd_nm2_mm\n".to_owned();
    for line in power_spectrum(&errors, step) {
        let density = line.density * NM_PER_MM * NM_PER_MM;
        text += &format!("{:.9e},{density:.6e}\n", line.frequency);
    }
    put(&mut draft, &text)?;
    Ok([table, draft])
}

fn write_circle(file: &Path, map: &Map, played: &Played<'_>) -> Result<Draft, Failure> {
    let grid = map.grid();
    let places = (0..grid.columns()).map(|column| grid.place(0, column));
    let (x, y): (Vec<f64>, Vec<f64>) = places.unzip();
    let mut wanted = vec![f64::NAN; x.len()];
    let surface = &played.touch.subject().surface;
    surface
        .heights(&x, &y, &mut wanted)
        .map_err(|error| of_pipeline(played.recipe, PipelineError::Measure(error)))?;
    let rows = map.row(0).zip(&wanted).enumerate();
    let rows = rows.filter(|(_, (error, _))| !error.is_nan());
    let degrees = |column: usize| 360.0 * column as f64 / grid.columns() as f64;
    let rows = rows.map(|(column, (error, wanted))| [degrees(column), f64::from(error), *wanted]);
    Ok(write_errors(file, "c_deg", rows)?)
}

fn write_spectrum(file: &Path, spectrum: &AxesSpectrum) -> Result<Draft, FileError> {
    let mut draft = Draft::begin(file)?;
    let mut text = "frequency_hz,x_um2_per_hz,z_um2_per_hz\n".to_owned();
    for line in spectrum.lines() {
        let [x, z] = [line.x, line.z].map(|density| density * UM_PER_MM * UM_PER_MM);
        text += &format!("{:.9e},{x:.6e},{z:.6e}\n", line.frequency);
    }
    put(&mut draft, &text)?;
    Ok(draft)
}

/// A table of (place, error in mm, wanted z): places without an error are left out.
fn write_errors(
    file: &Path,
    place: &str,
    rows: impl Iterator<Item = [f64; 3]>,
) -> Result<Draft, FileError> {
    let mut draft = Draft::begin(file)?;
    let mut text = format!("{place},error_nm,wanted_mm,machined_mm\n");
    for [at, error, wanted] in rows {
        let (nm, machined) = (error * NM_PER_MM, wanted + error);
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
