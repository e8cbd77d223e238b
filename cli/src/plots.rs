//! `--map`, `--profile`, `--circle`, `--spectrum`: what is asked for, checked before the work.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use turnpath_core::{DEG, Part, Quantity};
use turnpath_post::{Draft, FileError};
use turnpath_verify::machined::Grid;

use crate::args::{MapGrid, PlotArgs};
use crate::failure::Failure;
use crate::figures::millimetres;

/// The forms of maps, by the ends of their names.
const GSF: &str = "gsf";
const XYZ: &str = "xyz";
/// Places of a circle: every hundredth of a degree.
const CIRCLE_PLACES: usize = 36_000;
/// The spectrum of the axes.
const SPECTRUM: &str = "spectrum.csv";
/// Largest angle of a profile, rad, and what rounding takes.
const WHOLE_TURN: f64 = 360.000_001 * DEG;
/// Digits after the point of angles and radii in the names of files.
const NAME_DIGITS: f64 = 1e6;

/// How a map is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapFormat {
    /// Gwyddion Simple Field.
    Gsf,
    /// Lines of x, y and z.
    Xyz,
}

/// A map that is asked for.
#[derive(Debug)]
pub struct MapWish {
    pub file: PathBuf,
    pub format: MapFormat,
    pub grid: Grid,
}

/// A profile that is asked for.
#[derive(Debug)]
pub struct ProfileWish {
    /// rad.
    pub angle: f64,
    pub file: PathBuf,
    pub spectrum: PathBuf,
}

/// A circle that is asked for.
#[derive(Debug)]
pub struct CircleWish {
    pub grid: Grid,
    pub file: PathBuf,
}

/// All that is asked for.
#[derive(Debug)]
pub struct Wishes {
    pub map: Option<MapWish>,
    pub profiles: Vec<ProfileWish>,
    pub circles: Vec<CircleWish>,
    pub spectrum: Option<PathBuf>,
}

impl Wishes {
    /// What the call asks for; files without a folder of their own go to `folder`.
    ///
    /// # Errors
    /// When the call is wrong, or a file cannot be made.
    pub fn of(args: &PlotArgs, part: &Part, folder: &Path) -> Result<Self, Failure> {
        let map = args.map.as_deref();
        let wishes = Self {
            map: map
                .map(|file| map_wish(args, file, part, folder))
                .transpose()?,
            profiles: each(&args.profile, |text| profile_wish(text, folder))?,
            circles: each(&args.circle, |text| circle_wish(text, part, folder))?,
            spectrum: args.spectrum.then(|| folder.join(SPECTRUM)),
        };
        wishes.names_differ()?;
        for file in wishes.files() {
            can_be_made(file, folder)?;
        }
        Ok(wishes)
    }

    /// Complains where two plots would be one file: names hold no more digits than one can read.
    fn names_differ(&self) -> Result<(), Failure> {
        let mut files: Vec<&Path> = self.files().collect();
        files.sort_unstable();
        let Some(pair) = files.windows(2).find(|pair| pair[0] == pair[1]) else {
            return Ok(());
        };
        let message = format!(
            "two plots would be one file, {}: ask for one of them",
            pair[0].display()
        );
        Err(Failure::call(message))
    }

    /// Whether nothing is asked for.
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

fn each<T>(texts: &[String], wish: impl Fn(&str) -> Result<T, Failure>) -> Result<Vec<T>, Failure> {
    texts.iter().map(|text| wish(text)).collect()
}

fn map_wish(args: &PlotArgs, file: &Path, part: &Part, folder: &Path) -> Result<MapWish, Failure> {
    let ending = file.extension().unwrap_or_default().to_string_lossy();
    let format = match ending.to_ascii_lowercase().as_str() {
        GSF => MapFormat::Gsf,
        XYZ => MapFormat::Xyz,
        _ => {
            let message = format!(
                "--map {}: a map ends in .{GSF} (Gwyddion Simple Field) or .{XYZ} (lines of x, y, z)",
                file.display()
            );
            return Err(Failure::call(message));
        }
    };
    if format == MapFormat::Gsf && args.map_grid == MapGrid::Polar {
        let message = format!("a .{GSF} map has a Cartesian grid; for a polar one choose .{XYZ}");
        return Err(Failure::call(message));
    }
    let count = args.map_size as usize;
    let grid = match args.map_grid {
        MapGrid::Cartesian => Grid::cartesian(part, count),
        MapGrid::Polar => Grid::polar(part, count, count),
    };
    let file = folder.join(file);
    Ok(MapWish { file, format, grid })
}

fn profile_wish(text: &str, folder: &Path) -> Result<ProfileWish, Failure> {
    let angle = read(Quantity::Angle, "--profile", text)?;
    if angle.abs() > WHOLE_TURN {
        let message = format!("--profile {text}: an angle lies between -360 deg and 360 deg");
        return Err(Failure::call(message));
    }
    let name = format!("profile-{}deg", for_name(angle / DEG));
    Ok(ProfileWish {
        angle,
        file: folder.join(format!("{name}.csv")),
        spectrum: folder.join(format!("{name}-spectrum.csv")),
    })
}

fn circle_wish(text: &str, part: &Part, folder: &Path) -> Result<CircleWish, Failure> {
    let radius = read(Quantity::Length, "--circle", text)?;
    let (inner, outer) = (part.inner_radius, part.aperture_radius);
    if radius <= 0.0 || !(inner..=outer).contains(&radius) {
        let reach = match inner > 0.0 {
            true => format!(
                "from {} to {}",
                millimetres(inner, 3),
                millimetres(outer, 3)
            ),
            false => format!("to {}", millimetres(outer, 3)),
        };
        let message = format!("--circle {text}: that is not on the part, which reaches {reach}");
        return Err(Failure::call(message));
    }
    Ok(CircleWish {
        grid: Grid::circle(radius, CIRCLE_PLACES),
        file: folder.join(format!("circle-{}mm.csv", for_name(radius))),
    })
}

fn read(quantity: Quantity, option: &str, text: &str) -> Result<f64, Failure> {
    quantity
        .parse(text)
        .map_err(|error| Failure::call(format!("{option}: {error}")))
}

fn for_name(value: f64) -> f64 {
    (value * NAME_DIGITS).round() / NAME_DIGITS
}

/// Tells before the work what would stop it at its end. The folder of all files may still have to
/// be made; any other must be there.
fn can_be_made(file: &Path, folder: &Path) -> Result<(), FileError> {
    let parent = file.parent().filter(|parent| *parent != Path::new(""));
    let parent = parent.unwrap_or(Path::new("."));
    Draft::can_be(file)?;
    if parent == folder && !parent.exists() {
        return Ok(());
    }
    Draft::begin(file).map(drop)
}

/// Makes the folder of the files, if it is not there.
pub fn make_folder(folder: &Path) -> Result<(), FileError> {
    let failed = |error: io::Error| FileError {
        path: folder.to_owned(),
        error,
    };
    fs::create_dir_all(folder).map_err(failed)
}
