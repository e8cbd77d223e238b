//! The list of a library's strategies, in the form that crosses the boundary.
//!
//! Slots, kinds of parameters and kinds of defaults cross as words, with plain fields beside them.
//! A new one changes no layout.

use abi_stable::StableAbi;
use abi_stable::std_types::{RStr, RVec};
use turnpath_core::{Param, ParamDefault, ParamKind, Slot, StrategyInfo};

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

/// One parameter. The words for its kind and for that of its default say which of the fields after
/// them have a meaning.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiParam {
    name: RStr<'static>,
    help: RStr<'static>,
    kind: RStr<'static>,
    words: RVec<RStr<'static>>,
    columns: u64,
    default: RStr<'static>,
    default_number: f64,
    default_text: RStr<'static>,
    min: f64,
    max: f64,
    above_min: bool,
    nonzero: bool,
}

/// The kinds without words or columns.
const PLAIN_KINDS: [(&str, ParamKind); 7] = [
    ("length", ParamKind::Length),
    ("angle", ParamKind::Angle),
    ("per length", ParamKind::PerLength),
    ("feed", ParamKind::Feed),
    ("number", ParamKind::Number),
    ("count", ParamKind::Count),
    ("flag", ParamKind::Flag),
];
const CHOICE: &str = "choice";
const ROWS: &str = "rows";

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

impl From<&Param> for AbiParam {
    fn from(param: &Param) -> Self {
        let plain = PLAIN_KINDS.iter().find(|(_, kind)| *kind == param.kind);
        let (kind, words, columns): (_, &[&str], _) = match param.kind {
            ParamKind::Choice(words) => (CHOICE, words, 0),
            ParamKind::Rows(columns) => (ROWS, &[], columns as u64),
            _ => (plain.map_or("", |(word, _)| word), &[], 0),
        };
        let (default, number, text) = match param.default {
            ParamDefault::Required => ("required", f64::NAN, ""),
            ParamDefault::Absent => ("absent", f64::NAN, ""),
            ParamDefault::Number(number) => ("number", number, ""),
            ParamDefault::Flag(flag) => ("flag", f64::from(u8::from(flag)), ""),
            ParamDefault::Text(word) => ("text", f64::NAN, word),
        };
        Self {
            name: param.name.into(),
            help: param.help.into(),
            kind: kind.into(),
            words: words.iter().map(|word| RStr::from(*word)).collect(),
            columns,
            default: default.into(),
            default_number: number,
            default_text: text.into(),
            min: param.min,
            max: param.max,
            above_min: param.above_min,
            nonzero: param.nonzero,
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
        let params: Result<Vec<Param>, _> = self.params.into_iter().map(param).collect();
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
    fn receive(self, strategy: &str) -> Result<Param, UnknownKind> {
        let unknown = |kind: RStr<'static>| UnknownKind {
            strategy: strategy.to_owned(),
            parameter: self.name.into(),
            kind: kind.into(),
        };
        Ok(Param {
            name: self.name.as_str(),
            help: self.help.as_str(),
            kind: self.kind().ok_or_else(|| unknown(self.kind))?,
            default: self.default().ok_or_else(|| unknown(self.default))?,
            min: self.min,
            max: self.max,
            above_min: self.above_min,
            nonzero: self.nonzero,
        })
    }

    fn kind(&self) -> Option<ParamKind> {
        let words = || self.words.iter().map(RStr::as_str).collect::<Vec<_>>();
        match self.kind.as_str() {
            CHOICE => Some(ParamKind::Choice(words().leak())),
            ROWS => usize::try_from(self.columns).ok().map(ParamKind::Rows),
            plain => {
                let mut kinds = PLAIN_KINDS.into_iter();
                kinds.find(|(word, _)| *word == plain).map(|(_, kind)| kind)
            }
        }
    }

    fn default(&self) -> Option<ParamDefault> {
        Some(match self.default.as_str() {
            "required" => ParamDefault::Required,
            "absent" => ParamDefault::Absent,
            "number" => ParamDefault::Number(self.default_number),
            "flag" => ParamDefault::Flag(self.default_number != 0.0),
            "text" => ParamDefault::Text(self.default_text.as_str()),
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PARAMS: &[Param] = &[
        Param::length("radius", "of curvature").nonzero(),
        Param::angle("tilt", "about x").optional(),
        Param::per_length("frequency", "of the waves"),
        Param::feed("feed", "per revolution"),
        Param::number("conic", "constant").default(-1.0).max(2.0),
        Param::count("nodes", "per turn").min(3.0),
        Param::flag("inside", "the hole").default_flag(true),
        Param::choice("form", &["sum", "product"], "of the waves").default_choice("sum"),
        Param::rows("terms", 3, "of the polynomial"),
    ];

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
        let mut param = AbiParam::from(&PARAMS[0]);
        param.kind = "mass".into();
        assert_eq!(param.receive("heavy"), unknown("mass"));
        let mut param = AbiParam::from(&PARAMS[0]);
        param.default = "computed".into();
        assert_eq!(param.receive("heavy"), unknown("computed"));
    }
}
