//! Tool and task as lists of numbers that may grow.
//!
//! One list of fields serves both directions. A new field is appended: an older side does not read
//! it, and a newer side reads nothing where an older one gives none.

use turnpath_core::{Direction, Machine, Misfit, Part, RadialRange, Task, Tolerance, Tool};

/// A field that crosses as one number.
trait Field {
    fn write(&self) -> f64;
    fn read(&mut self, number: f64);
}

impl Field for f64 {
    fn write(&self) -> f64 {
        *self
    }

    fn read(&mut self, number: f64) {
        *self = number;
    }
}

/// NaN is no value.
impl Field for Option<f64> {
    fn write(&self) -> f64 {
        self.unwrap_or(f64::NAN)
    }

    fn read(&mut self, number: f64) {
        *self = Some(number).filter(|number| !number.is_nan());
    }
}

/// Implements [`Field`] for an enum with a value for the number 1 and one for all others.
macro_rules! either {
    ($($type:ident: $one:ident or $other:ident;)*) => {$(
        impl Field for $type {
            fn write(&self) -> f64 {
                f64::from(u8::from(*self == Self::$one))
            }

            fn read(&mut self, number: f64) {
                *self = if number == 1.0 { Self::$one } else { Self::$other };
            }
        }
    )*};
}

either! {
    Misfit: CutWhatFits or Refuse;
    Direction: Inward or Outward;
}

/// How many numbers a tool has.
pub const TOOL: usize = 4;
/// How many numbers a task has.
pub const TASK: usize = TOOL + 17;

fn tool_fields(tool: &mut Tool) -> [&mut dyn Field; TOOL] {
    [
        &mut tool.nose_radius,
        &mut tool.included_angle,
        &mut tool.clearance_angle,
        &mut tool.misfit,
    ]
}

fn task_fields(task: &mut Task) -> [&mut dyn Field; TASK] {
    let Task {
        part,
        tool,
        tolerance,
        range,
        direction,
        spindle_speed,
        machine,
    } = task;
    let [nose_radius, included_angle, clearance_angle, misfit] = tool_fields(tool);
    let Machine { x, z, c } = machine;
    [
        nose_radius,
        included_angle,
        clearance_angle,
        misfit,
        &mut part.aperture_radius,
        &mut part.inner_radius,
        &mut tolerance.interpolation,
        &mut tolerance.residual,
        &mut range.inner,
        &mut range.outer,
        direction,
        spindle_speed,
        &mut x.velocity,
        &mut x.acceleration,
        &mut x.jerk,
        &mut z.velocity,
        &mut z.acceleration,
        &mut z.jerk,
        &mut c.velocity,
        &mut c.acceleration,
        &mut c.jerk,
    ]
}

const BLANK_TOOL: Tool = Tool {
    nose_radius: f64::NAN,
    included_angle: None,
    clearance_angle: None,
    misfit: Misfit::Refuse,
};

fn blank_task() -> Task {
    let nan = f64::NAN;
    Task {
        part: Part {
            aperture_radius: nan,
            inner_radius: nan,
        },
        tool: BLANK_TOOL,
        tolerance: Tolerance {
            interpolation: nan,
            residual: nan,
        },
        range: RadialRange {
            inner: nan,
            outer: nan,
        },
        direction: Direction::Inward,
        spindle_speed: nan,
        machine: Machine::default(),
    }
}

fn read<const N: usize>(fields: [&mut dyn Field; N], numbers: &[f64]) {
    for (field, number) in fields.into_iter().zip(numbers) {
        field.read(*number);
    }
}

/// The numbers of a tool.
pub fn tool_numbers(tool: &Tool) -> [f64; TOOL] {
    tool_fields(&mut tool.clone()).map(|field| field.write())
}

/// The tool of these numbers.
pub fn read_tool(numbers: &[f64]) -> Tool {
    let mut tool = BLANK_TOOL;
    read(tool_fields(&mut tool), numbers);
    tool
}

/// The numbers of a task.
pub fn task_numbers(task: &Task) -> [f64; TASK] {
    task_fields(&mut task.clone()).map(|field| field.write())
}

/// The task of these numbers.
pub fn read_task(numbers: &[f64]) -> Task {
    let mut task = blank_task();
    read(task_fields(&mut task), numbers);
    task
}

#[cfg(test)]
mod tests {
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

    #[test]
    fn a_task_is_the_same_after_both_conversions() {
        assert_eq!(read_task(&task_numbers(&task())), task());
    }

    #[test]
    fn a_side_with_more_numbers_and_one_with_fewer_understand_each_other() {
        let mut longer = task_numbers(&task()).to_vec();
        longer.push(7.0);
        assert_eq!(read_task(&longer), task());
        let shorter = &longer[..TASK - 1];
        let mut expected = task();
        expected.machine.c.jerk = None;
        assert_eq!(read_task(shorter), expected);
    }
}
