//! The values of parameters, on their way to a constructor.

use abi_stable::StableAbi;
use abi_stable::std_types::{RString, RVec};
use turnpath_core::{DataFile, ParamValue, Params, Result, StrategyError};

const NUMBER: u32 = 0;
const FLAG: u32 = 1;
const TEXT: u32 = 2;
const ROWS: u32 = 3;
const LIST: u32 = 4;
/// The path, and the bytes.
const FILE: u32 = 5;

/// A parameter's value. Its kind is an open code: it says which of the plain fields hold the value,
/// and a new kind changes no layout.
#[repr(C)]
#[derive(StableAbi, Default)]
pub struct AbiArgument {
    name: RString,
    kind: u32,
    number: f64,
    texts: RVec<RString>,
    rows: RVec<RVec<f64>>,
    bytes: RVec<u8>,
}

impl AbiArgument {
    fn new(name: &str, value: &ParamValue) -> Self {
        let mut argument = Self {
            name: name.into(),
            ..Self::default()
        };
        match value {
            ParamValue::Number(number) => (argument.kind, argument.number) = (NUMBER, *number),
            ParamValue::Flag(flag) => {
                (argument.kind, argument.number) = (FLAG, f64::from(u8::from(*flag)));
            }
            ParamValue::Text(text) => {
                (argument.kind, argument.texts) = (TEXT, vec![text.as_str().into()].into())
            }
            ParamValue::List(texts) => {
                let texts = texts.iter().map(|text| text.as_str().into()).collect();
                (argument.kind, argument.texts) = (LIST, texts);
            }
            ParamValue::File(file) => {
                (argument.kind, argument.bytes) = (FILE, file.bytes.to_vec().into());
                argument.texts.push(file.path.as_str().into());
            }
            ParamValue::Rows(rows) => {
                let rows = rows.iter().map(|row| RVec::from(row.clone())).collect();
                (argument.kind, argument.rows) = (ROWS, rows);
            }
        }
        argument
    }

    fn value(self) -> Result<ParamValue> {
        let mut texts = self.texts.into_iter().map(RString::into_string);
        Ok(match self.kind {
            NUMBER => ParamValue::Number(self.number),
            FLAG => ParamValue::Flag(self.number != 0.0),
            TEXT => ParamValue::Text(texts.next().unwrap_or_default()),
            LIST => ParamValue::List(texts.collect()),
            FILE => ParamValue::File(DataFile {
                path: texts.next().unwrap_or_default(),
                bytes: self.bytes.into_vec().into(),
            }),
            ROWS => ParamValue::Rows(self.rows.into_iter().map(RVec::into_vec).collect()),
            _ => {
                let message = "the plugin does not know values of this kind; build it anew";
                return Err(StrategyError::parameter(self.name.into_string(), message));
            }
        })
    }
}

/// Converts parameters on the host's side.
pub fn arguments(params: &Params) -> RVec<AbiArgument> {
    params
        .iter()
        .map(|(name, value)| AbiArgument::new(name, value))
        .collect()
}

/// Converts parameters on the plugin's side.
pub fn params(arguments: RVec<AbiArgument>) -> Result<Params> {
    let mut params = Params::new();
    for argument in arguments {
        params.set(argument.name.clone().into_string(), argument.value()?);
    }
    Ok(params)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_the_same_after_both_conversions() {
        let mut given = Params::new().with("number", -0.5);
        given.set("flag", ParamValue::Flag(true));
        given.set("text", ParamValue::Text("säge".into()));
        given.set("list", ParamValue::List(vec!["one".into(), "two".into()]));
        let (path, bytes) = ("a/b.csv".into(), vec![0, 255].into());
        given.set("file", ParamValue::File(DataFile { path, bytes }));
        given.set("rows", ParamValue::Rows(vec![vec![1.0, 2.0], vec![]]));
        assert_eq!(params(arguments(&given)), Ok(given));
    }

    #[test]
    fn a_value_of_an_unknown_kind_is_an_error_of_its_parameter() {
        let strange = AbiArgument {
            name: "mask".into(),
            kind: 99,
            ..AbiArgument::default()
        };
        let error = params(vec![strange].into()).unwrap_err();
        assert!(
            error.to_string().starts_with("parameter `mask`: "),
            "{error}"
        );
    }
}
