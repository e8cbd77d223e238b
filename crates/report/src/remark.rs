//! What is allowed but seldom meant: a slip in a unit, a limit that is missing, a cut that takes all
//! night. A remark changes no verdict and no exit status.

use serde::{Deserialize, Serialize};

use crate::unit;

/// The largest residual tolerance without a remark, mm. Turned optics have cusps of some
/// nanometres. A lower threshold would remark on rough cuts, a higher one would miss `um` for `nm`.
const LARGEST_RESIDUAL: f64 = 1e-3;
/// The smallest aperture without a remark, mm. A lower threshold would miss `um` for `mm`, a higher
/// one would remark on lenslets.
const SMALLEST_APERTURE: f64 = 0.1;
/// The largest acceleration of Z without a remark where the machine has no limit for it, mm/s²: g,
/// which few slow tool servos reach. A lower threshold would remark on fast servos.
const LARGEST_Z_ACCELERATION: f64 = 9806.65;
/// The longest cut without a remark, s: eight hours. In a longer one the machine's temperature
/// drifts with that of the day.
const LONGEST_CUT: f64 = 8.0 * 3600.0;
/// The part of the interpolation tolerance that the rounding of positions may take without a
/// remark. Refinement leaves a hundredth of the tolerance to the program, and rounding seldom adds
/// to the largest error with its whole size.
const LARGEST_ROUNDING: f64 = 0.02;

/// One remark, with its numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Remark {
    /// The residual tolerance is that of no optical surface.
    RoughResidual {
        /// The tolerance, mm.
        #[serde(rename = "residual_nm", with = "unit::nm")]
        residual: f64,
    },
    /// The part is smaller than a grain of sand.
    SmallAperture {
        /// The aperture's diameter, mm.
        #[serde(rename = "aperture_mm", with = "unit::mm")]
        aperture: f64,
    },
    /// Z accelerates much, and the recipe has no limit for it.
    FastZ {
        /// The largest acceleration of Z, mm/s².
        #[serde(rename = "acceleration_mm_per_s2", with = "unit::s")]
        acceleration: f64,
    },
    /// The cut takes longer than a working day.
    LongCut {
        /// Time of the cutting section, s.
        #[serde(rename = "cutting_time_s", with = "unit::s")]
        cutting_time: f64,
    },
    /// The decimals of a program take much of the interpolation tolerance.
    CoarseDigits {
        /// Decimals of positions.
        position_decimals: u32,
        /// The most by which they move a position, mm.
        #[serde(rename = "rounding_nm", with = "unit::nm")]
        rounding: f64,
        /// The interpolation tolerance, mm.
        #[serde(rename = "tolerance_nm", with = "unit::nm")]
        tolerance: f64,
    },
    /// Points of a map have no height, and were filled.
    FilledPoints {
        /// Points without a height.
        filled: u64,
        /// All points.
        points: u64,
    },
    /// The path leaves the data that the surface was made from.
    BeyondData {
        /// Whether the place lies on the part, and not on its overrun alone.
        on_part: bool,
        /// How far the place lies beyond the data, mm.
        #[serde(rename = "distance_mm", with = "unit::mm")]
        distance: f64,
        /// The radius of the place, mm.
        #[serde(rename = "radius_mm", with = "unit::mm")]
        radius: f64,
        /// The angle of the place, rad.
        #[serde(rename = "c_deg", with = "unit::deg")]
        c: f64,
        /// How the surface goes on there, in a few words.
        continuation: String,
    },
}

/// What remarks are made on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RemarkSubject {
    /// The aperture's diameter, mm.
    pub aperture: f64,
    /// The residual tolerance, mm.
    pub residual: f64,
    /// The interpolation tolerance, mm.
    pub interpolation: f64,
    /// Time of the cutting section, s.
    pub cutting_time: f64,
    /// The largest acceleration of Z, mm/s², where it is known and the machine has no limit for it.
    pub free_z_acceleration: Option<f64>,
    /// Decimals of a program's positions, where there is a program.
    pub position_decimals: Option<u32>,
}

impl RemarkSubject {
    /// All remarks, in a fixed order.
    pub fn remarks(&self) -> Vec<Remark> {
        let Self {
            aperture,
            residual,
            cutting_time,
            ..
        } = *self;
        let fast = |acceleration: &f64| *acceleration >= LARGEST_Z_ACCELERATION;
        let acceleration = self.free_z_acceleration.filter(fast);
        let remarks = [
            (residual > LARGEST_RESIDUAL).then_some(Remark::RoughResidual { residual }),
            (aperture < SMALLEST_APERTURE).then_some(Remark::SmallAperture { aperture }),
            acceleration.map(|acceleration| Remark::FastZ { acceleration }),
            (cutting_time > LONGEST_CUT).then_some(Remark::LongCut { cutting_time }),
            self.coarse_digits(),
        ];
        remarks.into_iter().flatten().collect()
    }

    fn coarse_digits(&self) -> Option<Remark> {
        let position_decimals = self.position_decimals?;
        let rounding = (0..position_decimals).fold(0.5, |half, _| half / 10.0);
        let tolerance = self.interpolation;
        (rounding > LARGEST_ROUNDING * tolerance).then_some(Remark::CoarseDigits {
            position_decimals,
            rounding,
            tolerance,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const USUAL: RemarkSubject = RemarkSubject {
        aperture: 5.0,
        residual: 1e-4,
        interpolation: 1e-4,
        cutting_time: 600.0,
        free_z_acceleration: Some(1000.0),
        position_decimals: Some(7),
    };

    #[test]
    fn there_is_no_remark_on_a_usual_cut() {
        assert_eq!(USUAL.remarks(), []);
    }

    #[test]
    fn each_implausible_number_has_one_remark() {
        let subject = RemarkSubject {
            residual: 1e-2,
            ..USUAL
        };
        let residual = 1e-2;
        assert_eq!(subject.remarks(), [Remark::RoughResidual { residual }]);
        let subject = RemarkSubject {
            aperture: 1e-2,
            ..USUAL
        };
        let aperture = 1e-2;
        assert_eq!(subject.remarks(), [Remark::SmallAperture { aperture }]);
        let subject = RemarkSubject {
            free_z_acceleration: Some(9806.65),
            ..USUAL
        };
        let acceleration = 9806.65;
        assert_eq!(subject.remarks(), [Remark::FastZ { acceleration }]);
        let subject = RemarkSubject {
            cutting_time: 17.0 * 3600.0,
            ..USUAL
        };
        let cutting_time = 17.0 * 3600.0;
        assert_eq!(subject.remarks(), [Remark::LongCut { cutting_time }]);
    }

    #[test]
    fn a_remark_on_digits_follows_the_tolerance() {
        let digits = |position_decimals, interpolation| {
            let subject = RemarkSubject {
                position_decimals: Some(position_decimals),
                interpolation,
                ..USUAL
            };
            subject.remarks().len()
        };
        assert_eq!(
            [digits(4, 1e-4), digits(5, 1e-4), digits(6, 1e-4)],
            [1, 1, 0]
        );
        assert_eq!([digits(7, 1e-5), digits(7, 1e-6)], [0, 1]);
    }

    #[test]
    fn a_remark_in_a_file_has_its_kind_and_its_numbers_with_units() {
        let remark = Remark::RoughResidual { residual: 1e-2 };
        let text = serde_json::to_string(&remark).unwrap();
        assert_eq!(text, r#"{"kind":"rough_residual","residual_nm":10000.0}"#);
        assert_eq!(serde_json::from_str::<Remark>(&text).unwrap(), remark);
    }
}
