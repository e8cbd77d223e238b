//! Remarks on numbers of a recipe, of its path and of its programs: thresholds, and what is compared with them.

use crate::remark::Remark;

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
/// What the rounding of the velocities at both ends moves the middle of a segment by, as a part of the
/// rounding times the segment's time: a cubic has an eighth of the difference of its end velocities.
const VELOCITY_SHARE: f64 = 0.25;

/// The decimals of a program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProgramDigits {
    /// The post that writes it.
    pub post: &'static str,
    /// Decimals of positions, mm.
    pub position_decimals: u32,
    /// Decimals of velocities, mm per [`velocity_time`](Self::velocity_time); `None` where the program
    /// writes no velocities.
    pub velocity_decimals: Option<u32>,
    /// The time that velocities refer to, s.
    pub velocity_time: f64,
    /// C at the end of the path, rad, and the most by which the controller's numbers move it there, rad;
    /// `None` where they hold all digits of a double.
    pub held_c: Option<(f64, f64)>,
    /// Decimals of positions that the controller has on delivery, where it rounds positions to them.
    pub delivered_decimals: Option<u32>,
}

/// What remarks are made on.
#[derive(Debug, Clone, PartialEq)]
pub struct RemarkSubject {
    /// The aperture's diameter, mm.
    pub aperture: f64,
    /// The residual tolerance that the path was made for, mm.
    pub residual: f64,
    /// The interpolation tolerance that the path was made for, mm.
    pub interpolation: f64,
    /// The tolerance of form, mm, which bounds the cusps too.
    pub form: Option<f64>,
    /// Time of the cutting section, s.
    pub cutting_time: f64,
    /// Mean time from one control point to the next, s.
    pub segment_time: f64,
    /// The largest acceleration of Z, mm/s², where it is known and the machine has no limit for it.
    pub free_z_acceleration: Option<f64>,
    /// The steepest slope of the surface along the cut, mm per mm; zero on a part that turns on its axis.
    pub slope_along_cut: f64,
    /// The decimals of each program.
    pub digits: Vec<ProgramDigits>,
}

impl RemarkSubject {
    /// All remarks, in a fixed order.
    pub fn remarks(&self) -> Vec<Remark> {
        let Self {
            aperture,
            residual,
            form,
            cutting_time,
            ..
        } = *self;
        let is_rough = |height: f64| height > LARGEST_RESIDUAL;
        let fast = |acceleration: &f64| *acceleration >= LARGEST_Z_ACCELERATION;
        let acceleration = self.free_z_acceleration.filter(fast);
        let remarks = [
            (is_rough(residual) && form.is_none_or(is_rough))
                .then_some(Remark::RoughResidual { residual }),
            (aperture < SMALLEST_APERTURE).then_some(Remark::SmallAperture { aperture }),
            acceleration.map(|acceleration| Remark::FastZ { acceleration }),
            (cutting_time > LONGEST_CUT).then_some(Remark::LongCut { cutting_time }),
        ];
        let of_program = |digits: &ProgramDigits| {
            [
                self.coarse_digits(digits),
                self.coarse_velocity_digits(digits),
                self.coarse_numbers(digits),
                needs_digits(digits),
            ]
        };
        let of_programs = self.digits.iter().flat_map(of_program);
        remarks.into_iter().chain(of_programs).flatten().collect()
    }

    fn coarse_digits(&self, digits: &ProgramDigits) -> Option<Remark> {
        let position_decimals = digits.position_decimals;
        let rounding = half_digit(position_decimals);
        let tolerance = self.interpolation;
        (rounding > LARGEST_ROUNDING * tolerance).then(|| Remark::CoarseDigits {
            post: digits.post.to_owned(),
            position_decimals,
            rounding,
            tolerance,
        })
    }

    /// A tool at a wrong C is at another place of the part, which is as much higher as the surface rises
    /// on the way to it. No place is farther from the axis than the rim, and none is steeper.
    fn coarse_numbers(&self, digits: &ProgramDigits) -> Option<Remark> {
        let (c, c_rounding) = digits.held_c?;
        let rounding = 0.5 * self.aperture * c_rounding * self.slope_along_cut;
        let tolerance = self.interpolation;
        (rounding > LARGEST_ROUNDING * tolerance).then(|| Remark::CoarseNumbers {
            post: digits.post.to_owned(),
            c,
            c_rounding,
            rounding,
            tolerance,
        })
    }

    fn coarse_velocity_digits(&self, digits: &ProgramDigits) -> Option<Remark> {
        let velocity_time = digits.velocity_time;
        let velocity_decimals = digits.velocity_decimals?;
        let (segment_time, tolerance) = (self.segment_time, self.interpolation);
        let velocity = half_digit(velocity_decimals) / velocity_time;
        let rounding = VELOCITY_SHARE * velocity * segment_time;
        (rounding > LARGEST_ROUNDING * tolerance).then(|| Remark::CoarseVelocityDigits {
            post: digits.post.to_owned(),
            velocity_decimals,
            rounding,
            segment_time,
            tolerance,
        })
    }
}

fn needs_digits(digits: &ProgramDigits) -> Option<Remark> {
    let position_decimals = digits.position_decimals;
    let delivered_decimals = digits.delivered_decimals?;
    (position_decimals > delivered_decimals).then(|| Remark::NeedsDigits {
        post: digits.post.to_owned(),
        position_decimals,
        delivered_decimals,
    })
}

/// Half a unit of the last of so many decimals.
fn half_digit(decimals: u32) -> f64 {
    (0..decimals).fold(0.5, |half, _| half / 10.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const USUAL: RemarkSubject = RemarkSubject {
        aperture: 5.0,
        residual: 1e-4,
        interpolation: 1e-4,
        form: None,
        cutting_time: 600.0,
        segment_time: 0.01,
        free_z_acceleration: Some(1000.0),
        slope_along_cut: 1.0,
        digits: Vec::new(),
    };
    const DIGITS: ProgramDigits = ProgramDigits {
        post: "a-post",
        position_decimals: 7,
        velocity_decimals: Some(7),
        velocity_time: 1.0,
        held_c: None,
        delivered_decimals: None,
    };

    #[test]
    fn there_is_no_remark_on_a_usual_cut() {
        let subject = RemarkSubject {
            digits: vec![DIGITS; 2],
            ..USUAL
        };
        assert_eq!(subject.remarks(), []);
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
                digits: vec![ProgramDigits {
                    position_decimals,
                    ..DIGITS
                }],
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

    /// Velocities at both ends of a cubic that are off by δ, one up and one down, move its middle by
    /// δh/4.
    #[test]
    fn a_remark_on_the_digits_of_velocities_follows_the_time_of_a_segment() {
        let rounding = |velocity_decimals, velocity_time, segment_time| {
            let digits = ProgramDigits {
                velocity_decimals: Some(velocity_decimals),
                velocity_time,
                ..DIGITS
            };
            let subject = RemarkSubject {
                digits: vec![digits],
                segment_time,
                ..USUAL
            };
            match subject.remarks().as_slice() {
                [] => None,
                [Remark::CoarseVelocityDigits { rounding, .. }] => Some(*rounding),
                other => panic!("{other:?}"),
            }
        };
        // A fiftieth of the tolerance is 2e-6 mm.
        assert_eq!(rounding(3, 1.0, 0.01), None);
        assert_eq!(rounding(3, 1.0, 0.1), Some(0.25 * 0.5e-3 * 0.1));
        assert_eq!(rounding(2, 1.0, 0.01), Some(0.25 * 0.5e-2 * 0.01));
        assert_eq!(rounding(2, 60.0, 0.01), None);
        assert_eq!(rounding(7, 1.0, 4.0), None);
    }

    /// Each program has its own, with its post's name; one without velocities has none on them.
    #[test]
    fn each_program_has_remarks_of_its_own() {
        let coarse = |post, velocity_decimals| ProgramDigits {
            post,
            position_decimals: 5,
            velocity_decimals,
            ..DIGITS
        };
        let held = ProgramDigits {
            post: "held",
            held_c: Some((6e4, 1e-6)),
            delivered_decimals: Some(3),
            ..DIGITS
        };
        let subject = RemarkSubject {
            digits: vec![coarse("one", Some(0)), DIGITS, coarse("two", None), held],
            ..USUAL
        };
        let found = subject.remarks();
        let said: Vec<&str> = found
            .iter()
            .map(|remark| match remark {
                Remark::CoarseDigits { post, .. }
                | Remark::CoarseVelocityDigits { post, .. }
                | Remark::NeedsDigits { post, .. } => post.as_str(),
                // 1e-6 rad at 2.5 mm.
                Remark::CoarseNumbers { post, rounding, .. }
                    if (rounding - 2.5e-6).abs() < 1e-15 =>
                {
                    post
                }
                other => panic!("{other:?}"),
            })
            .collect();
        assert_eq!(said, ["one", "one", "two", "held", "held"]);
    }

    /// The same C on a flat part moves nothing, and on a slope of a tenth a tenth.
    #[test]
    fn a_remark_on_c_follows_the_slope_along_the_cut() {
        let rounding = |slope_along_cut| {
            let held = ProgramDigits {
                held_c: Some((6e4, 1e-5)),
                ..DIGITS
            };
            let subject = RemarkSubject {
                slope_along_cut,
                digits: vec![held],
                ..USUAL
            };
            match subject.remarks().as_slice() {
                [] => None,
                [Remark::CoarseNumbers { rounding, .. }] => Some(*rounding),
                other => panic!("{other:?}"),
            }
        };
        assert_eq!(rounding(0.0), None);
        // A fiftieth of the tolerance is 2e-6 mm.
        assert_eq!(rounding(0.079), None);
        let tenth = rounding(0.1).unwrap();
        assert!((tenth - 2.5e-6).abs() < 1e-15, "{tenth}");
    }

    /// The path of a form may be made for a larger residual than the form, where the recipe's own feed
    /// decides. What the form allows is then all that the cusps may have.
    #[test]
    fn a_residual_is_not_rough_below_a_form_that_is_not() {
        let remarks = |form| {
            let subject = RemarkSubject {
                residual: 2e-3,
                form,
                ..USUAL
            };
            subject.remarks().len()
        };
        assert_eq!(
            [remarks(None), remarks(Some(3e-3)), remarks(Some(2e-4))],
            [1, 1, 0]
        );
    }
}
