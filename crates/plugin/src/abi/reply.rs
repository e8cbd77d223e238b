//! Replies on their way back: answers, errors, and what a strategy says of itself.

use abi_stable::StableAbi;
use abi_stable::std_types::{RResult, RString};
use turnpath_core::{Result, Slot, StrategyError};

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

/// A value of the core that an answer holds.
pub trait Value: Sized {
    /// Its form between both sides.
    type Wire;

    /// Converts it for the way back.
    fn send(self) -> Self::Wire;

    /// Converts it on arrival.
    fn receive(wire: Self::Wire) -> Result<Self>;
}

impl Value for () {
    type Wire = ();

    fn send(self) {}

    fn receive((): ()) -> Result<Self> {
        Ok(())
    }
}

/// What a method of the core's traits returns.
pub trait Reply: Sized {
    /// The form of its value between both sides.
    type Wire;

    /// Converts it for the way back.
    fn send(self) -> Result<Self::Wire>;

    /// Converts it on arrival.
    fn receive(result: Result<Self::Wire>) -> Self;
}

/// Calls the other side and converts its answer.
pub fn receive<R: Reply>(call: impl FnOnce() -> Result<R::Wire>) -> R {
    R::receive(call())
}

impl<T: Value> Reply for Result<T> {
    type Wire = T::Wire;

    fn send(self) -> Result<T::Wire> {
        self.map(T::send)
    }

    fn receive(result: Result<T::Wire>) -> Self {
        result.and_then(T::receive)
    }
}

/// `None` crosses as false.
impl Reply for Option<Result<()>> {
    type Wire = bool;

    fn send(self) -> Result<bool> {
        self.map_or(Ok(false), |done| done.map(|()| true))
    }

    fn receive(result: Result<bool>) -> Self {
        match result {
            Ok(true) => Some(Ok(())),
            Ok(false) => None,
            Err(error) => Some(Err(error)),
        }
    }
}

/// What a strategy says of itself, as an open code: a new one changes no layout.
pub trait Code: Sized {
    /// The code.
    fn code(self) -> u64;

    /// The meaning of a code; `None` for one that this side does not know.
    fn from_code(code: u64) -> Option<Self>;
}

/// Implements [`Code`] for an enum.
macro_rules! codes {
    ($($type:ty { $($code:literal => $value:expr),+ $(,)? })*) => {$(
        impl $crate::abi::reply::Code for $type {
            fn code(self) -> u64 {
                let known = [$(($code, $value)),+];
                known.into_iter().find(|(_, one)| *one == self).map_or(u64::MAX, |(code, _)| code)
            }

            fn from_code(code: u64) -> Option<Self> {
                let known = [$(($code, $value)),+];
                known.into_iter().find(|(one, _)| *one == code).map(|(_, value)| value)
            }
        }
    )*};
}
pub(crate) use codes;

codes! {
    bool { 0 => false, 1 => true }
}

/// One property out of the codes of a strategy. An older plugin does not give those that were added
/// later, and these have a default.
pub fn property<T: Code>(code: Option<u64>, name: &str, default: Option<T>) -> Result<T> {
    let message = match code {
        Some(code) => match T::from_code(code) {
            Some(value) => return Ok(value),
            None => format!("the plugin's `{name}` is {code}, which this program does not know"),
        },
        None => match default {
            Some(value) => return Ok(value),
            None => format!("the plugin does not say what its `{name}` is"),
        },
    };
    Err(StrategyError::failed(message))
}

const FAILED: u32 = 0;
const PARAMETER: u32 = 1;
/// `parameter` holds the key of the slot whose strategy was called.
const DELEGATE: u32 = 2;
const PANICKED: u32 = 3;

/// An error. A kind that this side does not know counts as a failure.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiError {
    kind: u32,
    parameter: RString,
    message: RString,
}

impl From<StrategyError> for AbiError {
    fn from(error: StrategyError) -> Self {
        let (kind, parameter, message) = match error {
            StrategyError::Failed(message) => (FAILED, "".into(), message),
            StrategyError::Parameter { name, message } => (PARAMETER, name, message),
            StrategyError::Delegate { slot, message } => (DELEGATE, slot.key().into(), message),
            StrategyError::Panicked(message) => (PANICKED, "".into(), message),
        };
        Self {
            kind,
            parameter: parameter.into_owned().into(),
            message: message.into_owned().into(),
        }
    }
}

impl From<AbiError> for StrategyError {
    fn from(error: AbiError) -> Self {
        let message = error.message.into_string().into();
        let parameter = error.parameter.into_string();
        match (error.kind, Slot::ALL.iter().find(|s| s.key() == parameter)) {
            (PARAMETER, _) => Self::Parameter {
                name: parameter.into(),
                message,
            },
            (DELEGATE, Some(slot)) => Self::Delegate {
                slot: *slot,
                message,
            },
            (PANICKED, _) => Self::Panicked(message),
            _ => Self::Failed(message),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_the_same_after_both_conversions() {
        let errors = [
            StrategyError::failed("too steep"),
            StrategyError::parameter("radius", "too small"),
            StrategyError::Delegate {
                slot: Slot::Surface,
                message: "no value".into(),
            },
            StrategyError::Panicked("at lib.rs:3".into()),
        ];
        for error in errors {
            assert_eq!(StrategyError::from(AbiError::from(error.clone())), error);
        }
    }

    #[test]
    fn an_error_of_an_unknown_kind_is_a_failure() {
        let mut error = AbiError::from(StrategyError::Panicked("out of time".into()));
        error.kind = 99;
        assert_eq!(
            StrategyError::from(error),
            StrategyError::failed("out of time")
        );
    }

    #[test]
    fn a_property_has_its_default_or_an_error_with_its_name() {
        let quiet = |code, default| property::<bool>(code, "quiet", default);
        assert_eq!(quiet(Some(1), Some(false)), Ok(true));
        assert_eq!(quiet(None, Some(true)), Ok(true));
        let text = |answer: Result<bool>| answer.unwrap_err().to_string();
        assert_eq!(
            text(quiet(None, None)),
            "the plugin does not say what its `quiet` is"
        );
        assert_eq!(
            text(quiet(Some(7), Some(true))),
            "the plugin's `quiet` is 7, which this program does not know"
        );
    }
}
