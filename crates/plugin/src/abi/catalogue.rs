//! The list of a library's strategies. It crosses as one JSON text, so that a new slot, a new kind
//! of parameter and a new thing to declare change no layout.

use abi_stable::std_types::RString;
use serde::Deserialize;
use serde_json::Value;
use turnpath_core::{ParamInfo, ParamKind, Slot, StrategyInfo};

use super::text;
use crate::Registration;

/// The strategies of this program or library itself.
pub extern "C" fn catalogue() -> RString {
    text::write(&Registration::all())
}

/// A strategy of a library, on the host's side: a [`Registration`] without its constructor.
#[derive(Debug, Clone, Copy, Deserialize)]
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
    /// Its kind, or the kind of its default.
    pub kind: String,
}

/// Why the list of a library's strategies could not be read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum CatalogueError {
    /// It is no list at all, or a strategy in it lacks a name.
    Damaged,
    /// A strategy has a parameter of an unknown kind.
    UnknownKind(UnknownKind),
}

/// Reads the strategies of those crates that `wanted` names, and leaves out slots that this host does
/// not know. What was read stays for the whole program, as the library does.
///
/// # Errors
/// If the text is no list, or a parameter is of a kind that this host does not know.
pub fn entries(
    catalogue: &str,
    wanted: impl Fn(&str) -> bool,
) -> Result<Vec<CatalogueEntry>, CatalogueError> {
    let all: Vec<Value> = serde_json::from_str(catalogue).map_err(|_| CatalogueError::Damaged)?;
    let all: &'static [Value] = all.leak();
    let is_known = |one: &&Value| Slot::deserialize(&one["info"]["slot"]).is_ok();
    all.iter()
        .filter(|one| one["crate_name"].as_str().is_some_and(&wanted))
        .filter(is_known)
        .map(|one| CatalogueEntry::deserialize(one).map_err(|_| unreadable(&one["info"])))
        .collect()
}

/// Finds what this host does not know in a strategy.
fn unreadable(strategy: &'static Value) -> CatalogueError {
    let words = |value: &Value| value.as_str().map_or_else(|| value.to_string(), Into::into);
    let mut params = strategy["params"].as_array().into_iter().flatten();
    let Some(param) = params.find(|param| ParamInfo::deserialize(*param).is_err()) else {
        return CatalogueError::Damaged;
    };
    let kind = match ParamKind::deserialize(&param["kind"]) {
        Ok(_) => &param["default"],
        Err(_) => &param["kind"],
    };
    CatalogueError::UnknownKind(UnknownKind {
        strategy: words(&strategy["name"]),
        parameter: words(&param["name"]),
        kind: words(kind),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use turnpath_core::{Param, Quantity};

    const PARAMS: &[ParamInfo] = &[
        Param::length("radius", "of \"curvature\"").nonzero().info(),
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

    /// A strategy with these parameters, as it crosses.
    fn strategy(slot: &str, params: &[Value]) -> Value {
        let info = json!({
            "slot": slot, "name": "heavy", "summary": "", "source": "", "params": params,
        });
        json!({ "crate_name": "new_crate", "crate_version": "1.0.0", "info": info })
    }

    fn read(one: &Value) -> Result<Vec<CatalogueEntry>, CatalogueError> {
        entries(&json!([one]).to_string(), |_| true)
    }

    fn params_after_crossing(params: &[Value]) -> Result<&'static [ParamInfo], CatalogueError> {
        read(&strategy("surface", params)).map(|entries| entries[0].info.params)
    }

    #[test]
    fn every_slot_and_every_quantity_cross() {
        for slot in Slot::ALL {
            assert_eq!(serde_json::to_value(slot).unwrap(), slot.key());
            assert_eq!(read(&strategy(slot.key(), &[])).unwrap()[0].info.slot, slot);
        }
        for quantity in Quantity::all() {
            let kind = serde_json::to_value(ParamKind::Quantity(quantity)).unwrap();
            assert_eq!(
                ParamKind::deserialize(kind).unwrap(),
                ParamKind::Quantity(quantity)
            );
        }
    }

    #[test]
    fn a_declaration_is_the_same_after_both_conversions() {
        let params = PARAMS.iter().map(|param| json!(param)).collect::<Vec<_>>();
        assert_eq!(params_after_crossing(&params), Ok(PARAMS));
    }

    #[test]
    fn an_unknown_kind_names_its_parameter() {
        for (key, kind) in [("kind", "mass"), ("default", "computed")] {
            let mut param = json!(PARAMS[0]);
            param[key] = kind.into();
            let unknown = UnknownKind {
                strategy: "heavy".into(),
                parameter: "radius".into(),
                kind: kind.into(),
            };
            let unknown = CatalogueError::UnknownKind(unknown);
            assert_eq!(params_after_crossing(&[param]), Err(unknown));
        }
    }

    #[test]
    fn a_damaged_list_is_an_error() {
        for text in ["", "{}", "[{\"crate_name\": 3"] {
            let error = entries(text, |_| true).unwrap_err();
            assert_eq!(error, CatalogueError::Damaged);
        }
        let mut nameless = strategy("sampler", &[]);
        nameless["info"]["name"] = Value::Null;
        assert_eq!(read(&nameless).unwrap_err(), CatalogueError::Damaged);
    }

    #[test]
    fn a_strategy_of_an_unknown_slot_is_left_out() {
        let mut seventh = strategy("seventh", &[]);
        seventh["info"]["params"] = json!([{ "kind": "mass" }]);
        assert!(read(&seventh).is_ok_and(|entries| entries.is_empty()));
    }

    #[test]
    fn an_unknown_key_is_left_out() {
        let mut param = json!(PARAMS[0]);
        param["colour"] = json!(3.0);
        assert_eq!(params_after_crossing(&[param]), Ok(&PARAMS[..1]));
    }
}
