//! The machine's limits, and what a path makes of them.

use std::collections::BTreeMap;

use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error as _};
use turnpath_core::{Axis, Derivative, Limit, Quantity};

use crate::place::PathPlace;
use crate::unit;
use crate::verdict::within;

/// Where the limits of a machine come from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MachineSource {
    /// The preset that the recipe names.
    pub preset: Option<String>,
    /// Where the preset's figures come from.
    pub source: Option<String>,
    /// Whether the recipe has limits of its own.
    pub own_limits: bool,
}

/// A path against the limits of a machine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MachineReport {
    /// Where the limits come from.
    #[serde(flatten)]
    pub machine: MachineSource,
    /// Each limit with what was measured.
    pub limits: Vec<LimitFigure>,
}

/// A machine before there is a path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MachineLimits {
    /// Where the limits come from.
    #[serde(flatten)]
    pub machine: MachineSource,
    /// The limits.
    pub limits: Vec<LimitFigure>,
    /// Speed of the recipe's spindle, rad/s.
    #[serde(rename = "spindle_rpm", with = "unit::rpm")]
    pub spindle: f64,
}

/// A limit of one axis, and the largest amount that a path has; mm or rad, and s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LimitFigure {
    /// The limit.
    pub limit: Limit,
    /// The largest amount and its place; `None` where it was not measured: straight segments have
    /// no jerk, and before a path there is nothing to measure.
    pub measured: Option<(f64, PathPlace)>,
    /// The largest amount that is certain and its place, where rounding of the path's numbers can make more than a
    /// thousandth of it; `None` where it cannot.
    pub certain: Option<(f64, PathPlace)>,
}

/// The highest speed of the spindle at which the cut holds all limits.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct HighestSpindle {
    /// The speed, rad/s.
    #[serde(rename = "speed_rpm", with = "unit::rpm")]
    pub speed: f64,
    /// The limit that binds.
    #[serde(with = "limit_key")]
    pub bound_by: (Axis, Derivative),
}

impl MachineSource {
    /// The name for a person.
    pub fn name(&self) -> String {
        match &self.preset {
            Some(name) if self.own_limits => format!("{name} and own limits"),
            Some(name) => name.clone(),
            None => "own limits".to_owned(),
        }
    }
}

impl LimitFigure {
    /// A limit of which nothing was measured.
    pub fn unmeasured(limit: Limit) -> Self {
        Self {
            limit,
            measured: None,
            certain: None,
        }
    }

    /// The amount that decides, and its place: what is certain, where that is known.
    pub fn decisive(&self) -> Option<(f64, PathPlace)> {
        self.measured
            .map(|measured| self.certain.unwrap_or(measured))
    }

    /// Whether the limit holds; `None` where nothing was measured.
    pub fn holds(&self) -> Option<bool> {
        self.decisive()
            .map(|(amount, _)| within(amount, self.limit.value))
    }

    /// Whether the limit holds only because rounding can have made what is above it.
    pub fn holds_without_digits(&self) -> bool {
        let is_above = |(amount, _)| !within(amount, self.limit.value);
        self.measured.is_some_and(is_above) && self.holds() == Some(true)
    }
}

/// Whether every limit holds that was measured; `None` where none was.
pub fn all_hold(limits: &[LimitFigure]) -> Option<bool> {
    let mut verdicts = limits.iter().filter_map(LimitFigure::holds).peekable();
    verdicts.peek()?;
    Some(verdicts.all(|holds| holds))
}

/// A limit in a file. Its amounts have their unit in their keys, which depends on the limit.
#[derive(Serialize, Deserialize)]
struct FileLimit {
    limit: String,
    #[serde(flatten)]
    amounts: BTreeMap<String, Option<f64>>,
    at: Option<PathPlace>,
    /// Where the certain amount is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    certain_at: Option<PathPlace>,
    holds: Option<bool>,
}

impl Serialize for LimitFigure {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let (suffix, per) = unit_of(&self.limit);
        let amount = self.measured.map(|(amount, _)| amount);
        let amounts = [("limit", Some(self.limit.value)), ("measured", amount)];
        let certain = self.certain.map(|(amount, _)| ("certain", Some(amount)));
        let entry = |(name, amount): (&str, Option<f64>)| {
            let amount = amount.map(|amount| unit::rounded(amount * per));
            let amount = amount.filter(|amount| amount.is_finite());
            (format!("{name}_{suffix}"), amount)
        };
        FileLimit {
            limit: self.limit.key(),
            amounts: amounts.into_iter().chain(certain).map(entry).collect(),
            at: self.measured.map(|(_, at)| at),
            // Where nothing is certain there is no place.
            certain_at: self
                .certain
                .filter(|(amount, _)| *amount > 0.0)
                .map(|(_, at)| at),
            holds: self.holds(),
        }
        .serialize(to)
    }
}

impl<'de> Deserialize<'de> for LimitFigure {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let limit = FileLimit::deserialize(from)?;
        let (axis, derivative) = limit_key::parse(&limit.limit).map_err(D::Error::custom)?;
        let unvalued = Limit {
            axis,
            derivative,
            value: f64::NAN,
        };
        let (suffix, per) = unit_of(&unvalued);
        let amount = |name: &str| {
            let amount = limit.amounts.get(&format!("{name}_{suffix}"));
            amount.copied().flatten().map(|amount| amount / per)
        };
        let value = amount("limit").unwrap_or(f64::NAN);
        let measured = amount("measured").unwrap_or(f64::NAN);
        Ok(Self {
            limit: Limit { value, ..unvalued },
            measured: limit.at.map(|at| (measured, at)),
            certain: limit
                .amounts
                .contains_key(&format!("certain_{suffix}"))
                .then(|| {
                    (
                        amount("certain").unwrap_or(f64::NAN),
                        limit.certain_at.unwrap_or_default(),
                    )
                }),
        })
    }
}

/// What the keys of a limit's amounts end in, and how many of that unit make one of the model's.
fn unit_of(limit: &Limit) -> (&'static str, f64) {
    match limit.derivative.quantity(limit.axis) {
        Quantity::RotationSpeed => ("deg_per_s", unit::deg::PER),
        Quantity::AngularAcceleration => ("deg_per_s2", unit::deg::PER),
        Quantity::AngularJerk => ("deg_per_s3", unit::deg::PER),
        Quantity::Acceleration => ("mm_per_s2", unit::mm::PER),
        Quantity::Jerk => ("mm_per_s3", unit::mm::PER),
        _ => ("mm_per_s", unit::mm::PER),
    }
}

/// A limit by its key in recipes, such as `x_velocity`.
mod limit_key {
    use super::*;

    pub fn serialize<S: Serializer>(of: &(Axis, Derivative), to: S) -> Result<S::Ok, S::Error> {
        of.1.key(of.0).serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<(Axis, Derivative), D::Error> {
        parse(&String::deserialize(from)?).map_err(D::Error::custom)
    }

    pub fn parse(key: &str) -> Result<(Axis, Derivative), String> {
        let axes = Axis::ALL.into_iter();
        let mut all = axes.flat_map(|axis| Derivative::ALL.map(|derivative| (axis, derivative)));
        all.find(|(axis, derivative)| derivative.key(*axis) == key)
            .ok_or_else(|| format!("`{key}` is no limit of a machine"))
    }
}

#[cfg(test)]
mod tests {
    use turnpath_core::DEG;

    use super::*;

    fn figure(axis: Axis, derivative: Derivative, value: f64, amount: f64) -> LimitFigure {
        let at = PathPlace {
            c: 90.0 * DEG,
            x: 1.25,
        };
        LimitFigure {
            limit: Limit {
                axis,
                derivative,
                value,
            },
            measured: Some((amount, at)),
            certain: None,
        }
    }

    #[test]
    fn a_limit_holds_up_to_a_thousandth_above_it() {
        let of = |amount| figure(Axis::Z, Derivative::Jerk, 100.0, amount).holds();
        assert_eq!((of(100.09), of(100.11)), (Some(true), Some(false)));
        assert_eq!(of(f64::INFINITY), Some(false));
    }

    #[test]
    fn the_keys_of_a_limit_name_its_unit() {
        let jerk = figure(Axis::C, Derivative::Jerk, 2.0 * DEG, DEG);
        let text = serde_json::to_string(&jerk).unwrap();
        let expected = r#"{"limit":"c_jerk","limit_deg_per_s3":2.0,"measured_deg_per_s3":1.0,"at":{"c_deg":90.0,"x_mm":1.25},"holds":true}"#;
        assert_eq!(text, expected);
        let read: LimitFigure = serde_json::from_str(&text).unwrap();
        assert_eq!(serde_json::to_string(&read).unwrap(), text);
        let unmeasured = LimitFigure::unmeasured(jerk.limit);
        let text = serde_json::to_string(&unmeasured).unwrap();
        let read: LimitFigure = serde_json::from_str(&text).unwrap();
        assert_eq!((read.holds(), read.measured), (None, None));
    }

    #[test]
    fn what_is_certain_decides_and_has_its_own_place_in_a_file() {
        let measured = figure(Axis::X, Derivative::Jerk, 60.0, 156.0);
        assert_eq!(measured.holds(), Some(false));
        let at = PathPlace { c: DEG, x: 2.5 };
        let of = |certain: f64| LimitFigure {
            certain: Some((certain, at)),
            ..measured
        };
        let states = [of(52.0), of(80.0)].map(|one| (one.holds(), one.holds_without_digits()));
        assert_eq!(states, [(Some(true), true), (Some(false), false)]);
        assert_eq!(of(80.0).decisive(), Some((80.0, at)));
        let calm = LimitFigure {
            measured: Some((50.0, at)),
            ..of(40.0)
        };
        assert!(!calm.holds_without_digits());
        let text = serde_json::to_string(&of(52.0)).unwrap();
        let expected = r#"{"limit":"x_jerk","certain_mm_per_s3":52.0,"limit_mm_per_s3":60.0,"measured_mm_per_s3":156.0,"at":{"c_deg":90.0,"x_mm":1.25},"certain_at":{"c_deg":1.0,"x_mm":2.5},"holds":true}"#;
        assert_eq!(text, expected);
        let read: LimitFigure = serde_json::from_str(&text).unwrap();
        assert_eq!(serde_json::to_string(&read).unwrap(), text);
        assert_eq!(read, of(52.0));
    }

    #[test]
    fn a_limit_that_does_not_exist_is_refused() {
        let text = r#"{"limit":"y_jerk","at":null,"holds":null}"#;
        let error = serde_json::from_str::<LimitFigure>(text).unwrap_err();
        assert!(
            error.to_string().contains("`y_jerk` is no limit"),
            "{error}"
        );
    }
}
