//! The task and the tool, which the host lends to strategies.

use abi_stable::StableAbi;
use abi_stable::std_types::{RSlice, RString};
use turnpath_core::{Misfit, Result, StrategyError, Task, Tool};

use super::loan::crossing;
use super::text;

/// A task, as text.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiTask(RString);

crossing! {
    ['a] &'a Task => &'w AbiTask, AbiTask: |task| AbiTask(text::write(task)), |task| task;
    ['a] &'a AbiTask => &'w Task, Task: |task| text::read(&task.0, "task")?, |task| task;
}

/// A tool, in numbers because every batch of centres needs it: the nose radius, the included and the
/// clearance angle or NaN, and 1 if the tool cuts what fits. More may follow.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiTool<'a>(RSlice<'a, f64>);

crossing! {
    ['a] &'a Tool => AbiTool<'w>, [f64; 4]: |tool| numbers(tool),
        |numbers| AbiTool(numbers.as_slice().into());
    ['a] AbiTool<'a> => &'w Tool, Tool: |numbers| tool(numbers.0.as_slice())?, |tool| tool;
}

fn numbers(tool: &Tool) -> [f64; 4] {
    let angle = |angle: Option<f64>| angle.unwrap_or(f64::NAN);
    let cuts_what_fits = tool.misfit == Misfit::CutWhatFits;
    [
        tool.nose_radius,
        angle(tool.included_angle),
        angle(tool.clearance_angle),
        f64::from(u8::from(cuts_what_fits)),
    ]
}

fn tool(numbers: &[f64]) -> Result<Tool> {
    let angle = |angle: f64| Some(angle).filter(|angle| !angle.is_nan());
    let [nose_radius, included_angle, clearance_angle, misfit, ..] = *numbers else {
        return Err(StrategyError::failed("the tool lacks numbers"));
    };
    let misfit = match misfit {
        0.0 => Misfit::Refuse,
        1.0 => Misfit::CutWhatFits,
        code => {
            let message = format!("the program gives an unknown `misfit`: {code}");
            return Err(StrategyError::failed(message));
        }
    };
    Ok(Tool {
        nose_radius,
        included_angle: angle(included_angle),
        clearance_angle: angle(clearance_angle),
        misfit,
    })
}
