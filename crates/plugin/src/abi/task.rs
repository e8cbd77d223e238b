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
