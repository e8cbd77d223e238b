//! The list of a library's strategies, in the form that crosses the boundary.
//!
//! Slots cross as words, and what a parameter declares crosses as fields under keys. A new slot, a
//! new kind of parameter and a new thing to declare change no layout.

use abi_stable::StableAbi;
use abi_stable::std_types::{RStr, RVec};
use turnpath_core::{Param, ParamDefault, ParamInfo, ParamKind, Quantity, Slot, StrategyInfo};

use crate::Registration;

/// One strategy. Its texts live as long as the library, which is never unloaded.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiStrategy {
    crate_name: RStr<'static>,
    crate_version: RStr<'static>,
    slot: RStr<'static>,
    name: RStr<'static>,
    summary: RStr<'static>,
    source: RStr<'static>,
    params: RVec<AbiParam>,
}

#[repr(C)]
#[derive(StableAbi)]
pub struct AbiParam {
    name: RStr<'static>,
    help: RStr<'static>,
    fields: RVec<AbiField>,
}

/// What a parameter declares under one key, for example its kind or its least value. The key says
/// which of the other fields have a meaning. A reader leaves out a key that it does not know.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiField {
    key: RStr<'static>,
    number: f64,
    text: RStr<'static>,
    words: RVec<RStr<'static>>,
}

/// The key of a parameter's kind. `text` is a word for it, and a kind that the reader does not know
/// is refused.
const KIND: &str = "kind";
/// The key of a parameter's default. `text` is a word for its kind, or there is no default.
const DEFAULT: &str = "default";

/// The kinds that a word says all of.
const PLAIN_KINDS: [(&str, ParamKind); 5] = [
    ("number", ParamKind::Number),
    ("count", ParamKind::Count),
    ("flag", ParamKind::Flag),
    ("text", ParamKind::Text),
    ("file", ParamKind::File),
];

/// The words for quantities. A kind that is a quantity has its word.
const QUANTITIES: [(&str, Quantity); 12] = [
    ("length", Quantity::Length),
    ("angle", Quantity::Angle),
    ("per length", Quantity::PerLength),
    ("feed", Quantity::Feed),
    ("rotation speed", Quantity::RotationSpeed),
    ("frequency", Quantity::Frequency),
    ("time", Quantity::Time),
    ("velocity", Quantity::Velocity),
    ("acceleration", Quantity::Acceleration),
    ("jerk", Quantity::Jerk),
    ("angular acceleration", Quantity::AngularAcceleration),
    ("angular jerk", Quantity::AngularJerk),
];
/// The word for a value in a table; empty for one that is missing there.
fn word<T: Copy + PartialEq>(table: &[(&'static str, T)], value: T) -> &'static str {
    let found = table.iter().find(|(_, known)| *known == value);
    found.map_or("", |(word, _)| word)
}

/// The value for a word in a table.
fn value<T: Copy>(table: &[(&'static str, T)], word: &str) -> Option<T> {
    let found = table.iter().find(|(known, _)| *known == word);
    found.map(|(_, value)| *value)
}

impl From<&Registration> for AbiStrategy {
    fn from(registration: &Registration) -> Self {
        let info = registration.info;
        Self {
            crate_name: registration.crate_name.into(),
            crate_version: registration.crate_version.into(),
            slot: info.slot.key().into(),
            name: info.name.into(),
            summary: info.summary.into(),
            source: info.source.into(),
            params: info.params.iter().map(AbiParam::from).collect(),
        }
    }
}

impl From<&ParamInfo> for AbiParam {
    fn from(param: &ParamInfo) -> Self {
        let flag = |flag: bool| f64::from(u8::from(flag));
        let mut fields = vec![
            AbiField::kind(param.kind),
            AbiField::number("min", param.min),
            AbiField::number("max", param.max),
            AbiField::number("above_min", flag(param.above_min)),
            AbiField::number("below_max", flag(param.below_max)),
            AbiField::number("nonzero", flag(param.nonzero)),
            AbiField::new("example", param.example, 0.0, &[]),
        ];
        fields.extend(AbiField::default(param.default));
        Self {
            name: param.name.into(),
            help: param.help.into(),
            fields: fields.into(),
        }
    }
}

impl AbiField {
    fn new(key: &'static str, text: &'static str, number: f64, words: &[&'static str]) -> Self {
        Self {
            key: key.into(),
            number,
            text: text.into(),
            words: words.iter().map(|word| RStr::from(*word)).collect(),
        }
    }

    fn number(key: &'static str, number: f64) -> Self {
        Self::new(key, "", number, &[])
    }

    /// The host never frees the list, just as it never unloads the library with its texts.
    fn read_words(&self) -> &'static [&'static str] {
        let words: Vec<&'static str> = self.words.iter().map(RStr::as_str).collect();
        words.leak()
    }

    fn kind(kind: ParamKind) -> Self {
        match kind {
            ParamKind::Quantity(quantity) => Self::new(KIND, word(&QUANTITIES, quantity), 0.0, &[]),
            ParamKind::Choice(words) => Self::new(KIND, "choice", 0.0, words),
            // Words beside a quantity.
            ParamKind::ChoiceOr(words, other) => {
                Self::new(KIND, word(&QUANTITIES, other), 0.0, words)
            }
            ParamKind::List(words) => Self::new(KIND, "list", 0.0, words),
            ParamKind::Rows(columns) => Self::new(KIND, "rows", columns as f64, &[]),
            plain => Self::new(KIND, word(&PLAIN_KINDS, plain), 0.0, &[]),
        }
    }

    fn read_kind(&self) -> Option<ParamKind> {
        match self.text.as_str() {
            "choice" => Some(ParamKind::Choice(self.read_words())),
            "list" => Some(ParamKind::List(self.read_words())),
            "rows" => Some(ParamKind::Rows(self.number as usize)),
            word => value(&PLAIN_KINDS, word).or_else(|| {
                let quantity = value(&QUANTITIES, word)?;
                Some(match self.read_words() {
                    [] => ParamKind::Quantity(quantity),
                    words => ParamKind::ChoiceOr(words, quantity),
                })
            }),
        }
    }

    fn default(default: ParamDefault) -> Option<Self> {
        Some(match default {
            ParamDefault::Required => return None,
            ParamDefault::Absent => Self::new(DEFAULT, "absent", 0.0, &[]),
            ParamDefault::Number(number) => Self::new(DEFAULT, "number", number, &[]),
            ParamDefault::Flag(flag) => Self::new(DEFAULT, "flag", f64::from(u8::from(flag)), &[]),
            ParamDefault::Text(word) => Self::new(DEFAULT, "text", 0.0, &[word]),
            ParamDefault::List(words) => Self::new(DEFAULT, "list", 0.0, words),
        })
    }

    fn read_default(&self) -> Option<ParamDefault> {
        match self.text.as_str() {
            "absent" => Some(ParamDefault::Absent),
            "number" => Some(ParamDefault::Number(self.number)),
            "flag" => Some(ParamDefault::Flag(self.number != 0.0)),
            "text" => Some(ParamDefault::Text(self.words.first()?.as_str())),
            "list" => Some(ParamDefault::List(self.read_words())),
            _ => None,
        }
    }
}

/// A strategy of a library, on the host's side.
#[derive(Debug, Clone, Copy)]
pub struct CatalogueEntry {
    /// The crate that registered the strategy.
    pub crate_name: &'static str,
    /// The crate's version.
    pub crate_version: &'static str,
    /// Name, summary, source and parameters.
    pub info: StrategyInfo,
}

/// A parameter that a newer plugin declares and this host cannot read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownKind {
    /// The strategy's name.
    pub strategy: String,
    /// The parameter's key.
    pub parameter: String,
    /// The word for its kind, or for the kind of its default.
    pub kind: String,
}

impl AbiStrategy {
    /// The name of the crate that registered the strategy.
    pub fn crate_name(&self) -> &'static str {
        self.crate_name.as_str()
    }

    /// The strategy on the host's side; `None` for a slot that this host does not know.
    ///
    /// The host never frees the list of parameters, just as it never unloads the library with their
    /// texts.
    ///
    /// # Errors
    /// If a parameter is of a kind that this host does not know.
    pub fn receive(self) -> Result<Option<CatalogueEntry>, UnknownKind> {
        let mut slots = Slot::ALL.into_iter();
        let Some(slot) = slots.find(|slot| slot.key() == self.slot.as_str()) else {
            return Ok(None);
        };
        let name = self.name.as_str();
        let param = |param: AbiParam| param.receive(name);
        let params: Result<Vec<ParamInfo>, _> = self.params.into_iter().map(param).collect();
        let info = StrategyInfo {
            slot,
            name,
            summary: self.summary.as_str(),
            source: self.source.as_str(),
            params: params?.leak(),
        };
        Ok(Some(CatalogueEntry {
            crate_name: self.crate_name.as_str(),
            crate_version: self.crate_version.as_str(),
            info,
        }))
    }
}

impl AbiParam {
    fn receive(self, strategy: &str) -> Result<ParamInfo, UnknownKind> {
        let unknown = |field: &AbiField| UnknownKind {
            strategy: strategy.to_owned(),
            parameter: self.name.into(),
            kind: field.text.into(),
        };
        // A parameter without a kind is a number, and anything goes.
        let mut param = Param::number(self.name.as_str(), self.help.as_str()).info();
        for field in &self.fields {
            match field.key.as_str() {
                KIND => param.kind = field.read_kind().ok_or_else(|| unknown(field))?,
                DEFAULT => param.default = field.read_default().ok_or_else(|| unknown(field))?,
                "min" => param.min = field.number,
                "max" => param.max = field.number,
                "above_min" => param.above_min = field.number != 0.0,
                "below_max" => param.below_max = field.number != 0.0,
                "example" => param.example = field.text.as_str(),
                "nonzero" => param.nonzero = field.number != 0.0,
                _ => {}
            }
        }
        Ok(param)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PARAMS: &[ParamInfo] = &[
        Param::length("radius", "of curvature").nonzero().info(),
        Param::angle("tilt", "about x").optional().info(),
        Param::number("conic", "constant")
            .default(-1.0)
            .below(2.0)
            .info(),
        Param::count("nodes", "per turn").min(3).info(),
        Param::flag("inside", "the hole").default(true).info(),
        Param::choice("form", &["sum", "product"], "of the waves")
            .default("sum")
            .info(),
        Param::choice_or_length("overrun", &["contact"], "of the path").info(),
        Param::text("title", "of the part")
            .example("a mirror")
            .info(),
        Param::list("axes", &["x", "z"], "that move")
            .default(&["x"])
            .info(),
        Param::rows("terms", 3, "of the polynomial").info(),
        Param::file("map", "of the error").info(),
    ];

    #[test]
    fn every_quantity_crosses() {
        for quantity in Quantity::all() {
            let kind = ParamKind::Quantity(quantity);
            assert_eq!(AbiField::kind(kind).read_kind(), Some(kind));
        }
    }

    #[test]
    fn a_declaration_is_the_same_after_both_conversions() {
        for param in PARAMS {
            assert_eq!(AbiParam::from(param).receive("wavy"), Ok(*param));
        }
    }

    #[test]
    fn an_unknown_kind_names_its_parameter() {
        let unknown = |kind: &str| {
            Err(UnknownKind {
                strategy: "heavy".into(),
                parameter: "radius".into(),
                kind: kind.into(),
            })
        };
        for (key, word) in [(KIND, "mass"), (DEFAULT, "computed")] {
            let mut param = AbiParam::from(&PARAMS[0]);
            param.fields.push(AbiField::new(key, word, 0.0, &[]));
            assert_eq!(param.receive("heavy"), unknown(word));
        }
    }

    #[test]
    fn a_strategy_of_an_unknown_slot_is_left_out() {
        let strategy = |slot: &'static str| AbiStrategy {
            crate_name: "new_crate".into(),
            crate_version: "1.0.0".into(),
            slot: slot.into(),
            name: "wavy".into(),
            summary: "".into(),
            source: "".into(),
            params: RVec::new(),
        };
        assert!(strategy("seventh").receive().is_ok_and(|one| one.is_none()));
        let known = strategy("surface").receive().unwrap().unwrap();
        assert_eq!((known.info.slot, known.info.name), (Slot::Surface, "wavy"));
    }

    #[test]
    fn an_unknown_key_is_left_out() {
        let mut param = AbiParam::from(&PARAMS[0]);
        param.fields.push(AbiField::number("colour", 3.0));
        assert_eq!(param.receive("wavy"), Ok(PARAMS[0]));
    }
}
