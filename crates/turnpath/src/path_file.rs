//! The file that is measured: which kind it is, and how it is read.

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
        self.program.map_or(0.0, |Layout { format, .. }| {
            one_in(format.velocity_decimals) / format.velocity_time()
        })
    }

    /// By how much its numbers lie beside those that were rounded, in the cut and in leads; `None` if it has all
    /// digits of a double.
    pub fn roundings(&self) -> Option<[Rounding; 2]> {
        let Layout { format, .. } = self.program?;
        let digits = self.half_digits();
        let of_straight = format.shape() == SegmentShape::Linear;
        let rounding = |in_lead: bool| {
            let [c, x, z] = format.position_steps(in_lead).map(|steps| steps as f64);
            Rounding {
                position: x.max(z) * digits.position,
                angle: c * digits.angle,
                velocity: if of_straight { 0.0 } else { digits.velocity },
                angular_velocity: if of_straight {
                    0.0
                } else {
                    digits.angular_velocity
                },
                part: format.held_part(),
            }
        };
        Some([rounding(false), rounding(true)])
    }

    /// Half of its last digits; zero if it has all digits of a double.
    pub fn half_digits(&self) -> HalfDigits {
        let Some(Layout { format, .. }) = self.program else {
            return HalfDigits::default();
        };
        let position = 0.5 * one_in(format.position_decimals);
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

/// The last one of so many decimals.
fn one_in(decimals: u32) -> f64 {
    1.0 / 10u64.pow(decimals) as f64
}
