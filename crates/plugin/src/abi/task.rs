//! What the host lends in few words: the task, the tool, ranges.

use abi_stable::StableAbi;
use abi_stable::std_types::{RSlice, RString};
use turnpath_core::{
    Continuation, Misfit, Radial, RadialRange, Result, Revolutions, StrategyError, Task, Tool,
};

use super::loan::crossing;
use super::reply::Returned;
use super::text;

/// Lets types cross as text, by value, by reference and in answers.
macro_rules! texts {
    ($($core:ident => $abi:ident),+ $(,)?) => {$(
        #[repr(C)]
        #[derive(StableAbi)]
        pub struct $abi(RString);

        crossing! {
            [] $core => $abi, $core: |it| it, |it| $abi(text::write(it));
            [] $abi => $core, $core: |it| text::read(&it.0, stringify!($core))?, |it| it.to_owned();
            ['a] &'a $core => &'w $abi, $abi: |it| $abi(text::write(it)), |it| it;
            ['a] &'a $abi => &'w $core, $core:
                |it| text::read(&it.0, stringify!($core))?, |it| it;
        }

        impl Returned for $core {
            type Wire = RString;

            fn send(self) -> RString {
                text::write(&self)
            }

            fn receive(text: RString) -> Result<Self> {
                text::read(&text, stringify!($core))
            }
        }
    )+};
}

texts! {
    Task => AbiTask,
    Radial => AbiRadial,
    RadialRange => AbiRange,
    Revolutions => AbiBlock,
    Continuation => AbiContinuation,
}

/// A tool, in numbers because every batch of centres needs it: the nose radius, the included and the
/// clearance angle or NaN, and 1 if the tool cuts what fits. More may follow.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiTool<'a>(RSlice<'a, f64>);

crossing! {
    ['a] &'a Tool => AbiTool<'w>, [f64; 4]:
        |tool| [
            tool.nose_radius,
            tool.included_angle.unwrap_or(f64::NAN),
            tool.clearance_angle.unwrap_or(f64::NAN),
            f64::from(tool.misfit == Misfit::CutWhatFits),
        ],
        |numbers| AbiTool(numbers.as_slice().into());
    ['a] AbiTool<'a> => &'w Tool, Tool: |numbers| tool(&numbers.0)?, |tool| tool;
}

fn tool(numbers: &[f64]) -> Result<Tool> {
    let [nose_radius, included, clearance, misfit, ..] = *numbers else {
        return Err(StrategyError::failed(
            "the program gives too few numbers of the tool",
        ));
    };
    let angle = |angle: f64| Some(angle).filter(|angle| !angle.is_nan());
    let misfit = match misfit {
        0.0 => Ok(Misfit::Refuse),
        1.0 => Ok(Misfit::CutWhatFits),
        code => Err(format!("the program gives an unknown `misfit`: {code}")),
    };
    Ok(Tool {
        nose_radius,
        included_angle: angle(included),
        clearance_angle: angle(clearance),
        misfit: misfit.map_err(StrategyError::failed)?,
    })
}

#[cfg(test)]
mod tests {
    use super::super::loan::{Crossing, Lengths};
    use super::*;
    use serde_json::{Value, json};
    use turnpath_core::{AxisLimits, Direction, Machine, Part, Tolerance};

    const TOOL: Tool = Tool {
        nose_radius: 0.5,
        included_angle: Some(2.0),
        clearance_angle: None,
        misfit: Misfit::CutWhatFits,
    };

    fn task() -> Task {
        let limits = |velocity: f64| AxisLimits {
            velocity: Some(velocity),
            acceleration: None,
            jerk: Some(velocity / 3.0),
        };
        Task {
            part: Part {
                aperture_radius: 4.0,
                inner_radius: 0.1 + 0.2,
            },
            tool: TOOL,
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

    fn read_task(text: &Value) -> Result<Task> {
        let (text, lengths) = (AbiTask(text.to_string().into()), &mut Lengths::default());
        <&AbiTask>::lender(&text, lengths)
    }

    fn read_tool(numbers: &[f64]) -> Result<Tool> {
        AbiTool(numbers.into()).lender(&mut Lengths::default())
    }

    #[test]
    fn a_task_is_the_same_after_both_conversions() {
        assert_eq!(read_task(&json!(task())), Ok(task()));
    }

    #[test]
    fn a_task_of_a_newer_program_has_more_to_say() {
        let mut text = json!(task());
        text["coolant"] = json!({ "flow": 3.0 });
        assert_eq!(read_task(&text), Ok(task()));
    }

    #[test]
    fn a_word_that_this_side_does_not_know_is_an_error_with_the_word() {
        let mut text = json!(task());
        text["direction"] = "both-ways".into();
        let error = read_task(&text).unwrap_err().to_string();
        assert!(error.contains("`both-ways`"), "{error}");
    }

    #[test]
    fn a_tool_is_the_same_after_both_conversions() {
        let numbers = (&TOOL).lender(&mut Lengths::default()).unwrap();
        assert_eq!(read_tool(&numbers), Ok(TOOL));
        assert_eq!(read_tool(&[&numbers[..], &[7.0]].concat()), Ok(TOOL));
    }

    #[test]
    fn a_code_that_this_side_does_not_know_is_an_error_with_the_fields_name() {
        let error = read_tool(&[0.5, f64::NAN, f64::NAN, 9.0]).unwrap_err();
        assert!(error.to_string().contains("`misfit`: 9"), "{error}");
    }
}
