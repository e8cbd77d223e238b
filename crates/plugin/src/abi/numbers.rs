//! Tool and task as lists of numbers that may grow.
//!
//! One list of fields serves both directions. A new field is appended: an older side does not read
//! it, and a newer side keeps NaN or no value where an older one gives none.

use abi_stable::StableAbi;
use abi_stable::std_types::RSlice;
use turnpath_core::{
    Direction, Machine, Misfit, Part, RadialRange, StrategyError, Task, Tolerance, Tool,
};

use super::loan::crossing;
use super::reply::{Code, codes};

codes! {
    Misfit { 0 => Misfit::Refuse, 1 => Misfit::CutWhatFits }
    Direction { 0 => Direction::Outward, 1 => Direction::Inward }
}

/// A field that crosses as one number.
trait Field: Sized {
    fn write(self) -> f64;
    /// `None` for a code that this side does not know.
    fn read(number: f64) -> Option<Self>;
}

impl Field for f64 {
    fn write(self) -> f64 {
        self
    }

    fn read(number: f64) -> Option<Self> {
        Some(number)
    }
}

/// NaN is no value.
impl Field for Option<f64> {
    fn write(self) -> f64 {
        self.unwrap_or(f64::NAN)
    }

    fn read(number: f64) -> Option<Self> {
        Some(Some(number).filter(|number| !number.is_nan()))
    }
}

impl<T: Code> Field for T {
    fn write(self) -> f64 {
        self.code() as f64
    }

    fn read(number: f64) -> Option<Self> {
        T::from_code(number as u64)
    }
}

fn unknown(field: &str, number: f64) -> StrategyError {
    StrategyError::failed(format!(
        "the program gives {number} for `{field}`, which this plugin does not know"
    ))
}

/// Lets a struct cross as the list of these fields.
macro_rules! numbers {
    ($type:ident => $abi:ident, $count:literal, $blank:expr, $($($field:ident).+),+ $(,)?) => {
        #[repr(C)]
        #[derive(StableAbi)]
        pub struct $abi<'a>(RSlice<'a, f64>);

        crossing! {
            ['a] &'a $type => $abi<'w>, [f64; $count]:
                |it| [$(it.$($field).+.write()),+],
                |numbers| $abi(numbers.as_slice().into());
            ['a] $abi<'a> => &'w $type, $type:
                |numbers| {
                    let (mut it, mut numbers) = ($blank, numbers.0.iter());
                    $(if let Some(number) = numbers.next() {
                        let field = stringify!($($field).+);
                        it.$($field).+ =
                            Field::read(*number).ok_or_else(|| unknown(field, *number))?;
                    })+
                    it
                },
                |it| it;
        }
    };
}

const NAN: f64 = f64::NAN;
const BLANK_TOOL: Tool = Tool {
    nose_radius: NAN,
    included_angle: None,
    clearance_angle: None,
    misfit: Misfit::Refuse,
};

numbers! {
    Tool => AbiTool, 4, BLANK_TOOL, nose_radius, included_angle, clearance_angle, misfit
}

numbers! {
    Task => AbiTask, 21,
    Task {
        part: Part { aperture_radius: NAN, inner_radius: NAN },
        tool: BLANK_TOOL,
        tolerance: Tolerance { interpolation: NAN, residual: NAN },
        range: RadialRange { inner: NAN, outer: NAN },
        direction: Direction::Inward,
        spindle_speed: NAN,
        machine: Machine::default(),
    },
    part.aperture_radius, part.inner_radius,
    tool.nose_radius, tool.included_angle, tool.clearance_angle, tool.misfit,
    tolerance.interpolation, tolerance.residual,
    range.inner, range.outer, direction, spindle_speed,
    machine.x.velocity, machine.x.acceleration, machine.x.jerk,
    machine.z.velocity, machine.z.acceleration, machine.z.jerk,
    machine.c.velocity, machine.c.acceleration, machine.c.jerk,
}

#[cfg(test)]
mod tests {
    use super::super::loan::Crossing;
    use super::*;
    use turnpath_core::AxisLimits;

    fn task() -> Task {
        let limits = |velocity: f64| AxisLimits {
            velocity: Some(velocity),
            acceleration: None,
            jerk: Some(3.0 * velocity),
        };
        Task {
            part: Part {
                aperture_radius: 4.0,
                inner_radius: 1.0,
            },
            tool: Tool {
                nose_radius: 0.5,
                included_angle: Some(2.0),
                clearance_angle: None,
                misfit: Misfit::CutWhatFits,
            },
            tolerance: Tolerance {
                interpolation: 1e-4,
                residual: 2e-4,
            },
            range: RadialRange {
                inner: 0.9,
                outer: 4.1,
            },
            direction: Direction::Outward,
            spindle_speed: 50.0,
            machine: Machine {
                x: limits(1.0),
                z: limits(2.0),
                c: limits(5.0),
            },
        }
    }

    fn read(numbers: &[f64]) -> Task {
        AbiTask(numbers.into()).lender().unwrap()
    }

    #[test]
    fn a_task_is_the_same_after_both_conversions() {
        assert_eq!(read(&(&task()).lender().unwrap()), task());
    }

    #[test]
    fn a_side_with_more_numbers_and_one_with_fewer_understand_each_other() {
        let numbers = (&task()).lender().unwrap();
        let mut longer = numbers.to_vec();
        longer.push(7.0);
        assert_eq!(read(&longer), task());
        let mut expected = task();
        expected.machine.c.jerk = None;
        assert_eq!(read(&numbers[..20]), expected);
    }

    #[test]
    fn a_code_that_this_side_does_not_know_is_an_error_with_the_fields_name() {
        let numbers = [0.5, f64::NAN, f64::NAN, 9.0];
        let error = AbiTool(numbers.as_slice().into()).lender().unwrap_err();
        assert_eq!(
            error.to_string(),
            "the program gives 9 for `misfit`, which this plugin does not know"
        );
    }
}
