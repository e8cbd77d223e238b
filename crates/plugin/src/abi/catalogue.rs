//! The list of a library's strategies, in the form that crosses the boundary.

use abi_stable::StableAbi;
use abi_stable::std_types::{RStr, RVec};
use turnpath_core::{ParamDefault, ParamInfo, ParamKind, Quantity, Slot, StrategyInfo};

use crate::Registration;

/// One strategy. Its texts live as long as the library, which is never unloaded.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiStrategy {
    crate_name: RStr<'static>,
    crate_version: RStr<'static>,
    slot: u8,
    name: RStr<'static>,
    summary: RStr<'static>,
    source: RStr<'static>,
    params: RVec<AbiParam>,
}

#[repr(u8)]
#[derive(StableAbi)]
pub enum AbiKind {
    /// The index in [`QUANTITIES`].
    Quantity(u8),
    Number,
    Count,
    Flag,
    Choice(RVec<RStr<'static>>),
    /// Words, and the index of the quantity.
    ChoiceOr(RVec<RStr<'static>>, u8),
    Text,
    List(RVec<RStr<'static>>),
    Rows(u64),
    File,
}

/// The quantities in an order that never changes: a new one is added at the end.
const QUANTITIES: [Quantity; 12] = [
    Quantity::Length,
    Quantity::Angle,
    Quantity::PerLength,
    Quantity::Feed,
    Quantity::RotationSpeed,
    Quantity::Time,
    Quantity::Velocity,
    Quantity::Acceleration,
    Quantity::Jerk,
    Quantity::AngularAcceleration,
    Quantity::AngularJerk,
    Quantity::Frequency,
];

#[repr(u8)]
#[derive(StableAbi)]
pub enum AbiDefault {
    Required,
    Absent,
    Number(f64),
    Flag(bool),
    Text(RStr<'static>),
    List(RVec<RStr<'static>>),
}

#[repr(C)]
#[derive(StableAbi)]
pub struct AbiParam {
    name: RStr<'static>,
    help: RStr<'static>,
    kind: AbiKind,
    default: AbiDefault,
    min: f64,
    max: f64,
    above_min: bool,
    below_max: bool,
    nonzero: bool,
    example: RStr<'static>,
}

impl From<&Registration> for AbiStrategy {
    fn from(registration: &Registration) -> Self {
        let Registration {
            crate_name,
            crate_version,
            info,
            ..
        } = *registration;
        Self {
            crate_name: crate_name.into(),
            crate_version: crate_version.into(),
            slot: info.slot as u8,
            name: info.name.into(),
            summary: info.summary.into(),
            source: info.source.into(),
            params: info.params.iter().map(AbiParam::from).collect(),
        }
    }
}

impl From<&ParamInfo> for AbiParam {
    fn from(param: &ParamInfo) -> Self {
        Self {
            name: param.name.into(),
            help: param.help.into(),
            kind: param.kind.into(),
            default: param.default.into(),
            min: param.min,
            max: param.max,
            above_min: param.above_min,
            below_max: param.below_max,
            nonzero: param.nonzero,
            example: param.example.into(),
        }
    }
}

impl From<ParamKind> for AbiKind {
    fn from(kind: ParamKind) -> Self {
        match kind {
            ParamKind::Quantity(quantity) => Self::Quantity(code(quantity)),
            ParamKind::Number => Self::Number,
            ParamKind::Count => Self::Count,
            ParamKind::Flag => Self::Flag,
            ParamKind::Choice(words) => Self::Choice(lent(words)),
            ParamKind::ChoiceOr(words, quantity) => Self::ChoiceOr(lent(words), code(quantity)),
            ParamKind::Text => Self::Text,
            ParamKind::List(words) => Self::List(lent(words)),
            ParamKind::Rows(columns) => Self::Rows(columns as u64),
            ParamKind::File => Self::File,
        }
    }
}

fn lent(words: &[&'static str]) -> RVec<RStr<'static>> {
    words.iter().map(|word| RStr::from(*word)).collect()
}

/// The host never frees the list, just as it never unloads the library with its texts.
fn received(words: RVec<RStr<'static>>) -> &'static [&'static str] {
    let words: Vec<&'static str> = words.iter().map(|word| word.as_str()).collect();
    words.leak()
}

fn quantity(code: u8) -> Option<Quantity> {
    QUANTITIES.get(usize::from(code)).copied()
}

fn code(quantity: Quantity) -> u8 {
    let known = (0..).zip(QUANTITIES).find(|(_, known)| *known == quantity);
    known.map_or(u8::MAX, |(code, _)| code)
}

impl From<ParamDefault> for AbiDefault {
    fn from(default: ParamDefault) -> Self {
        match default {
            ParamDefault::Required => Self::Required,
            ParamDefault::Absent => Self::Absent,
            ParamDefault::Number(value) => Self::Number(value),
            ParamDefault::Flag(value) => Self::Flag(value),
            ParamDefault::Text(word) => Self::Text(word.into()),
            ParamDefault::List(words) => Self::List(lent(words)),
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

impl AbiStrategy {
    /// The strategy on the host's side; `None` for a slot or a kind of parameter that this host does
    /// not know.
    ///
    /// The host never frees the list of parameters, just as it never unloads the library with their
    /// texts.
    pub fn receive(self) -> Option<CatalogueEntry> {
        let slot = Slot::ALL
            .into_iter()
            .find(|slot| *slot as u8 == self.slot)?;
        let params: Option<Vec<ParamInfo>> =
            self.params.into_iter().map(AbiParam::receive).collect();
        let info = StrategyInfo {
            slot,
            name: self.name.as_str(),
            summary: self.summary.as_str(),
            source: self.source.as_str(),
            params: params?.leak(),
        };
        let (crate_name, crate_version) = (self.crate_name.as_str(), self.crate_version.as_str());
        Some(CatalogueEntry {
            crate_name,
            crate_version,
            info,
        })
    }
}

impl AbiParam {
    fn receive(self) -> Option<ParamInfo> {
        Some(ParamInfo {
            name: self.name.as_str(),
            help: self.help.as_str(),
            kind: self.kind.receive()?,
            default: self.default.receive(),
            min: self.min,
            max: self.max,
            above_min: self.above_min,
            below_max: self.below_max,
            nonzero: self.nonzero,
            example: self.example.as_str(),
        })
    }
}

impl AbiKind {
    fn receive(self) -> Option<ParamKind> {
        Some(match self {
            Self::Quantity(code) => ParamKind::Quantity(quantity(code)?),
            Self::Number => ParamKind::Number,
            Self::Count => ParamKind::Count,
            Self::Flag => ParamKind::Flag,
            Self::Choice(words) => ParamKind::Choice(received(words)),
            Self::ChoiceOr(words, code) => ParamKind::ChoiceOr(received(words), quantity(code)?),
            Self::Text => ParamKind::Text,
            Self::List(words) => ParamKind::List(received(words)),
            Self::Rows(columns) => ParamKind::Rows(usize::try_from(columns).unwrap_or(usize::MAX)),
            Self::File => ParamKind::File,
        })
    }
}

impl AbiDefault {
    fn receive(self) -> ParamDefault {
        match self {
            Self::Required => ParamDefault::Required,
            Self::Absent => ParamDefault::Absent,
            Self::Number(value) => ParamDefault::Number(value),
            Self::Flag(value) => ParamDefault::Flag(value),
            Self::Text(word) => ParamDefault::Text(word.as_str()),
            Self::List(words) => ParamDefault::List(received(words)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_quantity_crosses() {
        for quantity in Quantity::all() {
            let kind = ParamKind::Quantity(quantity);
            assert_eq!(AbiKind::from(kind).receive(), Some(kind));
        }
        assert_eq!(AbiKind::Quantity(u8::MAX).receive(), None);
    }
}
