//! The file that is measured: which kind it is, and how it is read.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use turnpath_core::DEG;
use turnpath_core::toolpath::{ControlPoint, Section, SegmentShape};
use turnpath_post::{Layout, PathReader, ReadError, ReadPath, post_of_extension, text_name};
use turnpath_recipe::Recipe;
use turnpath_verify::{HalfDigits, Rounding};

use crate::error::Error;
use crate::posts::{layout, refuse_undecided};

/// A file of a tool path, which can be read more than once.
#[derive(Debug, Clone)]
pub struct SourceFile {
    /// Where it is.
    pub path: PathBuf,
    /// How it is laid out, if it is a program; a table otherwise.
    pub program: Option<Layout>,
}

impl SourceFile {
    /// The file at `path`. What its name ends with says whether it is a program.
    ///
    /// # Errors
    /// When it is a program, and the recipe lacks a key that says what the words of its post mean.
    pub fn new(path: &Path, recipe: &Recipe, compensates_nose: bool) -> Result<Self, Error> {
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        let extension = text_name(&file).rsplit_once('.').map(|(_, end)| end);
        let post = extension.and_then(post_of_extension);
        if let Some(post) = post {
            refuse_undecided(recipe, post)?;
        }
        Ok(Self {
            path: path.to_owned(),
            program: post.map(|post| layout(recipe, post, compensates_nose)),
        })
    }

    /// Opens the file at its beginning.
    pub fn open(&self) -> Result<Box<dyn ReadPath + Send + Sync>, ReadError> {
        Ok(match self.program {
            Some(layout) => Box::new(layout.open(&self.path)?),
            None => Box::new(PathReader::open(&self.path)?),
        })
    }

    /// The first row; `None` if there is none.
    pub fn first_row(&self) -> Result<Option<(ControlPoint, Section)>, ReadError> {
        self.open()?.next_point()
    }

    /// What is played between its rows: `own` is what the recipe's path plays.
    pub fn shape(&self, own: SegmentShape) -> SegmentShape {
        self.program.map_or(own, |layout| layout.format.shape())
    }

    /// Whether it says how far it is from point to point.
    pub fn has_distances(&self) -> bool {
        self.program.is_some_and(|layout| layout.format.incremental)
    }

    /// The last digit of its velocities, mm/s or deg/s; zero if it has all digits of a double.
    pub fn velocity_digit(&self) -> f64 {
        self.program
            .map_or(0.0, |Layout { format, .. }| format.velocity_digit())
    }

    /// By how much its numbers lie beside those that were rounded, in the cut and in leads.
    pub fn roundings(&self) -> [Rounding; 2] {
        let Some(Layout { format, .. }) = self.program else {
            return [Rounding::default(); 2];
        };
        let digit = format.position_digit();
        let rounding = |in_lead: bool| {
            let [c, x, z] = format.position_rounding(in_lead);
            Rounding {
                digits: HalfDigits {
                    position: x * digit,
                    angle: c * digit * DEG,
                    time: 0.0,
                    ..self.half_digits()
                },
                lift: (z - x) * digit,
                last_digit: Some(digit),
                part: format.held_part().unwrap_or(0.0),
                largest_angle: if format.c_wrapped { TAU } else { f64::INFINITY },
                z_above: format.z_above,
            }
        };
        [rounding(false), rounding(true)]
    }

    /// Half of its last digits; zero if it has all digits of a double.
    pub fn half_digits(&self) -> HalfDigits {
        let Some(Layout { format, .. }) = self.program else {
            return HalfDigits::default();
        };
        let position = 0.5 * format.position_digit();
        // A program of straight lines has no velocities to compare.
        let velocity = match format.shape() {
            SegmentShape::Cubic => 0.5 * self.velocity_digit(),
            SegmentShape::Linear => f64::INFINITY,
        };
        HalfDigits {
            time: 0.5 / format.steps_per_s as f64,
            position,
            angle: position * DEG,
            velocity,
            angular_velocity: velocity * DEG,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RECIPE: &str = include_str!("../../../docs/recipes/astigmatic-5mm.toml");

    /// The roundings of a program in the cut and in leads, with these settings of Turbo PMAC or LinuxCNC.
    fn roundings(file: &str, sets: &[&str]) -> [Rounding; 2] {
        let sets: Vec<String> = sets.iter().map(ToString::to_string).collect();
        let recipe = Recipe::parse(RECIPE, "recipe.toml", &sets).unwrap();
        let file = SourceFile::new(Path::new(file), &recipe, true).unwrap();
        file.roundings()
    }

    #[track_caller]
    fn assert_near(found: f64, wanted: f64) {
        assert!((found / wanted - 1.0).abs() <= 1e-12, "{found} {wanted}");
    }

    #[test]
    fn numbers_of_turbo_pmac_have_half_a_digit_and_35_bits() {
        let [cut, leads] = roundings("a.pmc", &[]);
        assert_eq!(cut, leads);
        assert_near(cut.digits.position, 0.5e-7);
        assert_near(cut.digits.angle, 0.5e-7 * DEG);
        assert_near(cut.digits.velocity, 0.5e-7);
        assert_near(cut.digits.angular_velocity, 0.5e-7 * DEG);
        assert_near(cut.part, 2.91038304567337e-11);
        assert_eq!((cut.largest_angle, cut.z_above), (f64::INFINITY, 1.0));
        // Per minute, velocities have a decimal less than positions.
        let [cut, _] = roundings(
            "a.pmc",
            &[
                "output.pmac-pvt.position_decimals=5",
                "output.pmac-pvt.velocity_per=min",
                "output.pmac-pvt.c_wrap=0-360",
            ],
        );
        assert_near(cut.digits.position, 0.5e-5);
        assert_near(cut.digits.velocity, 0.5e-4 / 60.0);
        assert_near(cut.digits.angular_velocity, 0.5e-4 / 60.0 * DEG);
        assert_eq!(cut.largest_angle, TAU);
        let [cut, _] = roundings("a.pmc", &["output.pmac-pvt.positioning=incremental"]);
        assert_eq!(cut.part, 0.0);
    }

    /// In the cut X and Z are multiples of two digits. In leads they are of as many as the slowest motion needs, and
    /// Z may have been lifted by two of those steps.
    #[test]
    fn numbers_of_linuxcnc_have_half_a_step() {
        let file = "a.ngc";
        let [cut, leads] = roundings(file, &[]);
        assert_near(cut.digits.position, 1e-7);
        assert_near(cut.digits.angle, 0.5e-7 * DEG);
        assert_eq!(cut.part, 0.0);
        let recipe = Recipe::parse(RECIPE, "recipe.toml", &[]).unwrap();
        let format = SourceFile::new(Path::new(file), &recipe, true).unwrap();
        let slowest = format
            .program
            .unwrap()
            .format
            .chords
            .unwrap()
            .slowest
            .unwrap();
        let step = 1e-7 * slowest.lead_steps[2] as f64;
        assert!(step > 1e-6, "{step}");
        assert_near(leads.digits.position, 0.5 * step);
        assert_near(leads.lift, 2.0 * step);
    }

    #[test]
    fn a_table_has_all_digits() {
        let recipe = Recipe::parse(RECIPE, "recipe.toml", &[]).unwrap();
        let table = SourceFile::new(Path::new("toolpath.csv"), &recipe, true).unwrap();
        assert_eq!(table.roundings(), [Rounding::default(); 2]);
    }
}
