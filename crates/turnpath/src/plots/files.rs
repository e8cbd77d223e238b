//! The plots of one part with their files, checked before the work.

use std::fs;
use std::path::{Component, Path, PathBuf};

use turnpath_core::{DEG, Part};
use turnpath_files::{Draft, FileError, FolderError, ResultFolder};
use turnpath_recipe::{DataFormat, Recipe};
use turnpath_verify::machined::Grid;

use super::request::{MapGrid, MapRequest, PlotError, PlotRequest, check_grid};
use crate::error::Error;
use crate::summary::{FolderSummary, folder_of, lists};

/// Places of a circle: every hundredth of a degree.
const CIRCLE_PLACES: usize = 36_000;
/// The spectrum of the axes.
const SPECTRUM: &str = "spectrum.csv";
/// Largest angle of a profile, with room for rounding, rad.
const WHOLE_TURN: f64 = 360.000_001 * DEG;
/// Digits after the point of angles and radii in the names of files.
const NAME_DIGITS: f64 = 1e6;

/// How a map is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapForm {
    /// Gwyddion Simple Field.
    Gsf,
    /// Lines of x, y and z.
    Xyz,
}

/// A map and its file.
#[derive(Debug)]
pub struct MapPlot {
    pub file: PathBuf,
    pub form: MapForm,
    pub grid: Grid,
}

/// A profile and its files.
#[derive(Debug)]
pub struct ProfilePlot {
    /// rad.
    pub angle: f64,
    pub file: PathBuf,
    pub spectrum: PathBuf,
}

/// A circle and its file.
#[derive(Debug)]
pub struct CirclePlot {
    pub grid: Grid,
    pub file: PathBuf,
}

/// All plots of a part.
#[derive(Debug)]
pub struct Plots {
    pub map: Option<MapPlot>,
    pub profiles: Vec<ProfilePlot>,
    pub circles: Vec<CirclePlot>,
    pub spectrum: Option<PathBuf>,
}

impl Plots {
    /// The plots that are asked for; files without a folder of their own go to `folder`.
    ///
    /// # Errors
    /// When one cannot be drawn so, or its file cannot be made.
    pub fn new(request: &PlotRequest, part: &Part, folder: &Path) -> Result<Self, Error> {
        let map = request.map.as_ref().map(|map| map_plot(map, part, folder));
        let profiles = request.profiles.iter();
        let circles = request.circles.iter();
        let plots = Self {
            map: map.transpose()?,
            profiles: profiles
                .map(|angle| profile_plot(*angle, folder))
                .collect::<Result<_, _>>()?,
            circles: circles
                .map(|radius| circle_plot(*radius, part, folder))
                .collect::<Result<_, _>>()?,
            spectrum: request.spectrum.then(|| folder.join(SPECTRUM)),
        };
        plots.names_differ()?;
        for file in plots.files() {
            can_be_made(file, folder)?;
        }
        Ok(plots)
    }

    fn names_differ(&self) -> Result<(), PlotError> {
        let mut files: Vec<&Path> = self.files().collect();
        files.sort_unstable();
        match files.windows(2).find(|pair| pair[0] == pair[1]) {
            None => Ok(()),
            Some(pair) => Err(PlotError::SameFile {
                file: pair[0].to_owned(),
            }),
        }
    }

    /// Refuses plots of a run that writes no `toolpath.csv`.
    pub fn need_toolpath(&self, recipe: &Recipe) -> Result<(), PlotError> {
        match !self.is_empty() && !recipe.output.data.contains(&DataFormat::Csv) {
            true => Err(PlotError::NoToolPath),
            false => Ok(()),
        }
    }

    /// Finds before the work whether the folder takes files, where it is there. A result does that by
    /// its claim.
    pub fn try_folder(&self, folder: &Path) -> Result<(), FileError> {
        let mut files = self.files().filter(|file| file.parent() == Some(folder));
        match files.next().filter(|_| folder.exists()) {
            Some(file) => Draft::begin(file).map(drop),
            None => Ok(()),
        }
    }

    /// Refuses files of a result that could not be part of it.
    pub fn can_be_in_result(&self, folder: &Path) -> Result<(), FolderError> {
        let members = self
            .files()
            .filter_map(|file| ResultFolder::member(folder, file));
        for name in members {
            ResultFolder::can_have(folder, &name)?;
        }
        Ok(())
    }

    /// Refuses files that the result of their folder lists, also behind links.
    pub fn leave_results(&self) -> Result<(), PlotError> {
        let is_listed = |file: &&Path| {
            let file = &fs::canonicalize(file).unwrap_or_else(|_| file.to_path_buf());
            let folder = folder_of(file);
            matches!(FolderSummary::of(&folder), FolderSummary::Read(report) if lists(&report, &folder, file))
        };
        match self.files().find(is_listed) {
            Some(file) => Err(PlotError::InResult {
                file: file.to_owned(),
            }),
            None => Ok(()),
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.files().next().is_none()
    }

    /// The files that will be written.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        let maps = self.map.iter().map(|map| &map.file);
        let profiles = self.profiles.iter();
        let profiles = profiles.flat_map(|profile| [&profile.file, &profile.spectrum]);
        let circles = self.circles.iter().map(|circle| &circle.file);
        let files = maps.chain(profiles).chain(circles);
        files.chain(&self.spectrum).map(PathBuf::as_path)
    }
}

fn map_plot(request: &MapRequest, part: &Part, folder: &Path) -> Result<MapPlot, PlotError> {
    let ending = request.file.extension().unwrap_or_default();
    let form = match ending.to_string_lossy().to_ascii_lowercase().as_str() {
        "gsf" => MapForm::Gsf,
        "xyz" => MapForm::Xyz,
        _ => {
            let file = request.file.clone();
            return Err(PlotError::MapForm { file });
        }
    };
    if form == MapForm::Gsf && request.grid == MapGrid::Polar {
        return Err(PlotError::PolarGsf);
    }
    check_grid(request.cells)?;
    let grid = match request.grid {
        MapGrid::Cartesian => Grid::cartesian(part, request.cells),
        MapGrid::Polar => Grid::polar(part, request.cells, request.cells),
    };
    let file = place_of(&request.file, folder);
    Ok(MapPlot { file, form, grid })
}

fn profile_plot(angle: f64, folder: &Path) -> Result<ProfilePlot, PlotError> {
    if angle.is_nan() || angle.abs() > WHOLE_TURN {
        return Err(PlotError::ProfileAngle { angle });
    }
    let name = format!("profile-{}deg", for_name(angle / DEG));
    Ok(ProfilePlot {
        angle,
        file: folder.join(format!("{name}.csv")),
        spectrum: folder.join(format!("{name}-spectrum.csv")),
    })
}

fn circle_plot(radius: f64, part: &Part, folder: &Path) -> Result<CirclePlot, PlotError> {
    let (inner, outer) = (part.inner_radius, part.aperture_radius);
    if radius <= 0.0 || !(inner..=outer).contains(&radius) {
        return Err(PlotError::CircleOffPart {
            radius,
            inner,
            outer,
        });
    }
    Ok(CirclePlot {
        grid: Grid::circle(radius, CIRCLE_PLACES),
        file: folder.join(format!("circle-{}mm.csv", for_name(radius))),
    })
}

fn for_name(value: f64) -> f64 {
    (value * NAME_DIGITS).round() / NAME_DIGITS
}

/// Finds before the work what would stop it at its end. The folder of all files may still have to
/// be made, and who writes in it finds out whether it takes files; any other must be there.
pub fn can_be_made(file: &Path, folder: &Path) -> Result<(), FileError> {
    let parent = file.parent().filter(|parent| *parent != Path::new(""));
    let parent = parent.unwrap_or(Path::new("."));
    Draft::can_be(file)?;
    if parent == folder {
        return Ok(());
    }
    Draft::begin(file).map(drop)
}

/// Where the file of a picture goes whose name is taken from a folder, which may still have to be made. Nothing
/// leads through a folder that is not there: `..` is then the folder that it will be in.
pub fn place_of(file: &Path, folder: &Path) -> PathBuf {
    if folder.exists() {
        return folder.join(file);
    }
    let mut place = folder.to_owned();
    for part in file.components() {
        match part {
            Component::ParentDir if place.file_name().is_some() => _ = place.pop(),
            Component::CurDir => {}
            part => place.push(part),
        }
    }
    place
}

/// Makes the folder of the files, if it is not there.
pub fn make_folder(folder: &Path) -> Result<(), FileError> {
    fs::create_dir_all(folder).map_err(|error| FileError {
        path: folder.to_owned(),
        error,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_beside_a_folder_that_is_still_to_be_made_goes_beside_it() {
        let here = tempfile::tempdir().unwrap();
        let at = |file: &str, folder: &str| place_of(Path::new(file), &here.path().join(folder));
        assert_eq!(at("../m.gsf", "fresh"), here.path().join("m.gsf"));
        assert_eq!(
            at("./m.gsf", "fresh/new"),
            here.path().join("fresh/new/m.gsf")
        );
        assert_eq!(at("../../m.gsf", "fresh/new"), here.path().join("m.gsf"));
        assert_eq!(at("/m.gsf", "fresh"), Path::new("/m.gsf"));
        // A folder that is there may be a link, so the system follows its `..`.
        assert_eq!(at("../m.gsf", ""), here.path().join("../m.gsf"));
        assert_eq!(
            place_of(Path::new("../../../m.gsf"), Path::new("fresh")),
            Path::new("../../m.gsf")
        );
    }
}
