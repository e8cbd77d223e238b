//! Plain values that cross the boundary, and their conversions in both directions.

use abi_stable::StableAbi;
use abi_stable::std_types::{ROption, RResult, RString, RVec};
use turnpath_core::{
    AxisLimits, DataFile, Direction, Machine, Misfit, ParamValue, Params, Part, Piece,
    PiecewisePolynomial, RadialRange, Result, Slot, StrategyError, Task, Tolerance, Tool,
};

use crate::guard::guarded;

/// The result of a call across the boundary.
pub type Answer<T> = RResult<T, AbiError>;

/// Runs code on its own side of the boundary, so that no panic crosses.
pub fn answer<T>(run: impl FnOnce() -> Result<T>) -> Answer<T> {
    guarded(run).map_err(AbiError::from).into()
}

/// Converts an answer into a result of the core's traits.
pub fn result<T>(answer: Answer<T>) -> Result<T> {
    answer.into_result().map_err(StrategyError::from)
}

#[repr(u8)]
#[derive(StableAbi, Clone, Copy)]
pub enum AbiErrorKind {
    Failed,
    Parameter,
    /// `parameter` holds the key of the slot whose strategy was called.
    Delegate,
    Panicked,
}

#[repr(C)]
#[derive(StableAbi)]
pub struct AbiError {
    kind: AbiErrorKind,
    parameter: RString,
    message: RString,
}

impl From<StrategyError> for AbiError {
    fn from(error: StrategyError) -> Self {
        let (kind, parameter, message) = match error {
            StrategyError::Failed(message) => (AbiErrorKind::Failed, "".into(), message),
            StrategyError::Parameter { name, message } => (AbiErrorKind::Parameter, name, message),
            StrategyError::Delegate { slot, message } => {
                (AbiErrorKind::Delegate, slot.key().into(), message)
            }
            StrategyError::Panicked(message) => (AbiErrorKind::Panicked, "".into(), message),
        };
        let (parameter, message) = (parameter.into_owned().into(), message.into_owned().into());
        Self {
            kind,
            parameter,
            message,
        }
    }
}

impl From<AbiError> for StrategyError {
    fn from(error: AbiError) -> Self {
        let message = error.message.into_string().into();
        let parameter = error.parameter.into_string();
        let slot = || Slot::ALL.into_iter().find(|slot| slot.key() == parameter);
        match error.kind {
            AbiErrorKind::Failed => Self::Failed(message),
            AbiErrorKind::Panicked => Self::Panicked(message),
            AbiErrorKind::Parameter => Self::Parameter {
                name: parameter.into(),
                message,
            },
            AbiErrorKind::Delegate => match slot() {
                Some(slot) => Self::Delegate { slot, message },
                None => Self::Failed(message),
            },
        }
    }
}

#[repr(u8)]
#[derive(StableAbi)]
pub enum AbiValue {
    Number(f64),
    Flag(bool),
    Text(RString),
    List(RVec<RString>),
    Rows(RVec<RVec<f64>>),
    File { path: RString, bytes: RVec<u8> },
}

#[repr(C)]
#[derive(StableAbi)]
pub struct AbiArgument {
    name: RString,
    value: AbiValue,
}

/// Converts parameters on the host's side.
pub fn arguments(params: &Params) -> RVec<AbiArgument> {
    let value = |value: &ParamValue| match value {
        ParamValue::Number(number) => AbiValue::Number(*number),
        ParamValue::Flag(flag) => AbiValue::Flag(*flag),
        ParamValue::Text(text) => AbiValue::Text(text.as_str().into()),
        ParamValue::List(texts) => {
            AbiValue::List(texts.iter().map(|text| text.as_str().into()).collect())
        }
        ParamValue::Rows(rows) => {
            AbiValue::Rows(rows.iter().map(|row| RVec::from(row.clone())).collect())
        }
        ParamValue::File(file) => AbiValue::File {
            path: file.path.as_str().into(),
            bytes: file.bytes.to_vec().into(),
        },
    };
    params
        .iter()
        .map(|(name, v)| AbiArgument {
            name: name.into(),
            value: value(v),
        })
        .collect()
}

/// Converts parameters on the plugin's side.
pub fn params(arguments: RVec<AbiArgument>) -> Params {
    let mut params = Params::new();
    for AbiArgument { name, value } in arguments {
        let value = match value {
            AbiValue::Number(number) => ParamValue::Number(number),
            AbiValue::Flag(flag) => ParamValue::Flag(flag),
            AbiValue::Text(text) => ParamValue::Text(text.into_string()),
            AbiValue::List(texts) => {
                ParamValue::List(texts.into_iter().map(RString::into_string).collect())
            }
            AbiValue::Rows(rows) => {
                ParamValue::Rows(rows.into_iter().map(RVec::into_vec).collect())
            }
            AbiValue::File { path, bytes } => ParamValue::File(DataFile {
                path: path.into_string(),
                bytes: bytes.into_vec().into(),
            }),
        };
        params.set(name.into_string(), value);
    }
    params
}

#[repr(C)]
#[derive(StableAbi, Clone, Copy)]
pub struct AbiTool {
    nose_radius: f64,
    included_angle: ROption<f64>,
    clearance_angle: ROption<f64>,
    cut_what_fits: bool,
}

impl From<&Tool> for AbiTool {
    fn from(tool: &Tool) -> Self {
        Self {
            nose_radius: tool.nose_radius,
            included_angle: tool.included_angle.into(),
            clearance_angle: tool.clearance_angle.into(),
            cut_what_fits: tool.misfit == Misfit::CutWhatFits,
        }
    }
}

impl From<AbiTool> for Tool {
    fn from(tool: AbiTool) -> Self {
        Self {
            nose_radius: tool.nose_radius,
            included_angle: tool.included_angle.into(),
            clearance_angle: tool.clearance_angle.into(),
            misfit: if tool.cut_what_fits {
                Misfit::CutWhatFits
            } else {
                Misfit::Refuse
            },
        }
    }
}

#[repr(C)]
#[derive(StableAbi, Clone, Copy)]
pub struct AbiRange {
    inner: f64,
    outer: f64,
}

impl From<RadialRange> for AbiRange {
    fn from(range: RadialRange) -> Self {
        Self {
            inner: range.inner,
            outer: range.outer,
        }
    }
}

impl From<AbiRange> for RadialRange {
    fn from(range: AbiRange) -> Self {
        Self {
            inner: range.inner,
            outer: range.outer,
        }
    }
}

#[repr(C)]
#[derive(StableAbi, Clone, Copy)]
pub struct AbiPiece {
    start: f64,
    coefficients: [f64; 6],
}

#[repr(C)]
#[derive(StableAbi)]
pub struct AbiLaw {
    pieces: RVec<AbiPiece>,
    end: f64,
}

impl From<&PiecewisePolynomial> for AbiLaw {
    fn from(law: &PiecewisePolynomial) -> Self {
        let piece = |p: &Piece| AbiPiece {
            start: p.start,
            coefficients: p.coefficients,
        };
        Self {
            pieces: law.pieces().iter().map(piece).collect(),
            end: law.end(),
        }
    }
}

impl From<&AbiLaw> for PiecewisePolynomial {
    fn from(law: &AbiLaw) -> Self {
        let piece = |p: &AbiPiece| Piece {
            start: p.start,
            coefficients: p.coefficients,
        };
        Self::from_pieces(law.pieces.iter().map(piece).collect(), law.end)
    }
}

#[repr(C)]
#[derive(StableAbi, Clone, Copy)]
pub struct AbiAxisLimits {
    velocity: ROption<f64>,
    acceleration: ROption<f64>,
    jerk: ROption<f64>,
}

impl From<AxisLimits> for AbiAxisLimits {
    fn from(limits: AxisLimits) -> Self {
        Self {
            velocity: limits.velocity.into(),
            acceleration: limits.acceleration.into(),
            jerk: limits.jerk.into(),
        }
    }
}

impl From<AbiAxisLimits> for AxisLimits {
    fn from(limits: AbiAxisLimits) -> Self {
        Self {
            velocity: limits.velocity.into(),
            acceleration: limits.acceleration.into(),
            jerk: limits.jerk.into(),
        }
    }
}

#[repr(C)]
#[derive(StableAbi, Clone, Copy)]
pub struct AbiMachine {
    x: AbiAxisLimits,
    z: AbiAxisLimits,
    c: AbiAxisLimits,
}

impl From<Machine> for AbiMachine {
    fn from(machine: Machine) -> Self {
        Self {
            x: machine.x.into(),
            z: machine.z.into(),
            c: machine.c.into(),
        }
    }
}

impl From<AbiMachine> for Machine {
    fn from(machine: AbiMachine) -> Self {
        Self {
            x: machine.x.into(),
            z: machine.z.into(),
            c: machine.c.into(),
        }
    }
}

#[repr(C)]
#[derive(StableAbi)]
pub struct AbiTask {
    aperture_radius: f64,
    inner_radius: f64,
    tool: AbiTool,
    interpolation: f64,
    residual: f64,
    range: AbiRange,
    inward: bool,
    spindle_speed: f64,
    machine: AbiMachine,
}

impl From<&Task> for AbiTask {
    fn from(task: &Task) -> Self {
        Self {
            aperture_radius: task.part.aperture_radius,
            inner_radius: task.part.inner_radius,
            tool: (&task.tool).into(),
            interpolation: task.tolerance.interpolation,
            residual: task.tolerance.residual,
            range: task.range.into(),
            inward: task.direction == Direction::Inward,
            spindle_speed: task.spindle_speed,
            machine: task.machine.into(),
        }
    }
}

impl From<&AbiTask> for Task {
    fn from(task: &AbiTask) -> Self {
        let part = Part {
            aperture_radius: task.aperture_radius,
            inner_radius: task.inner_radius,
        };
        Self {
            part,
            tool: task.tool.into(),
            tolerance: Tolerance {
                interpolation: task.interpolation,
                residual: task.residual,
            },
            range: task.range.into(),
            direction: if task.inward {
                Direction::Inward
            } else {
                Direction::Outward
            },
            spindle_speed: task.spindle_speed,
            machine: task.machine.into(),
        }
    }
}

/// Checks that all slices of a call have one length. A plugin may rely on it, so the host must
/// check it.
pub fn same_length(lengths: &[usize]) -> Result<()> {
    match lengths.split_first() {
        Some((first, rest)) if rest.iter().any(|length| length != first) => Err(
            StrategyError::failed("the slices of a call differ in length"),
        ),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_task_is_the_same_after_both_conversions() {
        let limits = |velocity: f64| AxisLimits {
            velocity: Some(velocity),
            acceleration: None,
            jerk: Some(3.0 * velocity),
        };
        let task = Task {
            part: Part {
                aperture_radius: 4.0,
                inner_radius: 1.0,
            },
            tool: Tool {
                nose_radius: 0.5,
                included_angle: Some(2.0),
                clearance_angle: None,
                misfit: Misfit::Refuse,
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
        };
        assert_eq!(Task::from(&AbiTask::from(&task)), task);
    }
}
