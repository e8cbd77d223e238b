//! Replies on their way back: answers, errors, and what a strategy says of itself.

use abi_stable::std_types::{RResult, RString};
use serde::Deserialize;
use serde_json::Value;
use turnpath_core::{Result, StrategyError};

use super::text;
use crate::guard::guarded;

/// The result of a call across the boundary. An error crosses as text.
pub type Answer<T> = RResult<T, RString>;

/// Runs code on its own side of the boundary, so that no panic crosses.
pub fn answer<T>(run: impl FnOnce() -> Result<T>) -> Answer<T> {
    guarded(run).map_err(|error| text::write(&error)).into()
}

/// Converts an answer into a result of the core's traits. An error of a kind that this side does not
/// know counts as a failure.
pub fn result<T>(answer: Answer<T>) -> Result<T> {
    answer.into_result().map_err(|error| {
        let known = serde_json::from_str(&error);
        known.unwrap_or_else(|_| StrategyError::failed(error.into_string()))
    })
}

/// A value of the core that an answer holds.
pub trait Returned: Sized {
    /// Its form between both sides.
    type Wire;

    /// Converts it for the way back.
    fn send(self) -> Self::Wire;

    /// Converts it on arrival.
    fn receive(wire: Self::Wire) -> Result<Self>;
}

impl Returned for () {
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

impl<T: Returned> Reply for Result<T> {
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
        Ok(self.transpose()?.is_some())
    }

    fn receive(result: Result<bool>) -> Self {
        result.map(|given| given.then_some(())).transpose()
    }
}

/// One property of a strategy. An older plugin does not give those that were added later, and these
/// have a default.
pub fn property<T: for<'v> Deserialize<'v>>(
    properties: &Value,
    name: &str,
    default: Option<T>,
) -> Result<T> {
    let message = match properties.get(name) {
        Some(value) => match T::deserialize(value) {
            Ok(value) => return Ok(value),
            Err(_) => format!("the plugin's `{name}` is {value}, which this program does not know"),
        },
        None => match default {
            Some(value) => return Ok(value),
            None => format!("the plugin does not say what its `{name}` is"),
        },
    };
    Err(StrategyError::failed(message))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use turnpath_core::Slot;

    #[test]
    fn errors_are_the_same_after_both_conversions() {
        let errors = [
            StrategyError::failed("too steep"),
            StrategyError::parameter("radius", "too small"),
            StrategyError::Delegate {
                slot: Slot::Surface,
                entry: 2,
                message: "no value".into(),
            },
            StrategyError::Panicked("at lib.rs:3".into()),
        ];
        for error in errors {
            assert_eq!(result::<()>(answer(|| Err(error.clone()))), Err(error));
        }
    }

    #[test]
    fn an_error_that_an_older_plugin_handed_on_is_that_of_the_first_strategy() {
        let text = r#"{"delegate":{"slot":"surface","message":"no value"}}"#;
        let answer: Answer<()> = RResult::RErr(text.into());
        let delegate = StrategyError::Delegate {
            slot: Slot::Surface,
            entry: 0,
            message: "no value".into(),
        };
        assert_eq!(result(answer), Err(delegate));
    }

    #[test]
    fn an_error_of_an_unknown_kind_is_a_failure() {
        let text = r#"{"timeout":"after 3 s"}"#;
        let answer: Answer<()> = RResult::RErr(text.into());
        assert_eq!(result(answer), Err(StrategyError::failed(text)));
    }

    #[test]
    fn a_property_has_its_default_or_an_error_with_its_name() {
        let quiet = |given, default| property::<bool>(&given, "quiet", default);
        assert_eq!(quiet(json!({ "quiet": true }), Some(false)), Ok(true));
        assert_eq!(quiet(json!({}), Some(true)), Ok(true));
        let text = |answer: Result<bool>| answer.unwrap_err().to_string();
        assert_eq!(
            text(quiet(json!({}), None)),
            "the plugin does not say what its `quiet` is"
        );
        assert_eq!(
            text(quiet(json!({ "quiet": "very" }), Some(true))),
            "the plugin's `quiet` is \"very\", which this program does not know"
        );
    }
}
