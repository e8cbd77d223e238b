//! What the host asks of a constructor: which strategy, and with which parameters.

use std::collections::BTreeMap;

use abi_stable::StableAbi;
use abi_stable::std_types::{RString, RVec};
use serde::Deserialize;
use serde_json::Value;
use turnpath_core::{ParamValue, Params, Result, Slot, StrategyError};

use super::text;
use crate::{Build, Registration};

/// The crate and the name of a strategy, all values of its parameters as JSON, and beside it the
/// contents of the files among them.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiRequest {
    crate_name: RString,
    name: RString,
    values: RString,
    contents: RVec<RVec<u8>>,
}

impl AbiRequest {
    /// The request for a strategy of a crate.
    pub fn new(crate_name: &str, name: &str, params: &Params) -> Self {
        let values: BTreeMap<_, _> = params.iter().collect();
        let files = params.iter().filter_map(|(_, value)| match value {
            ParamValue::File(file) => Some(file.bytes.to_vec().into()),
            _ => None,
        });
        Self {
            crate_name: crate_name.into(),
            name: name.into(),
            values: text::write(&values),
            contents: files.collect(),
        }
    }

    /// The constructor of the strategy here, which `function` takes out of its registration.
    pub fn find<F>(&self, slot: Slot, function: fn(Build) -> Option<F>) -> Result<F> {
        let (name, noun) = (&self.name, slot.noun());
        let all = Registration::all().into_iter();
        let mut of_name =
            all.filter(|one| *name == one.info.name && self.crate_name == one.crate_name);
        let found = of_name.find_map(|one| function(one.build));
        found.ok_or_else(|| StrategyError::failed(format!("there is no {noun} `{name}` here")))
    }

    /// The values on the plugin's side.
    pub fn params(self) -> Result<Params> {
        let values: BTreeMap<String, Value> = text::read(&self.values, "list of parameters")?;
        let mut contents = self.contents.into_iter();
        let mut params = Params::new();
        for (name, value) in values {
            let Ok(mut value) = ParamValue::deserialize(value) else {
                let message = "the plugin does not know values of this kind; build it anew";
                return Err(StrategyError::parameter(name, message));
            };
            if let ParamValue::File(file) = &mut value {
                file.bytes = contents.next().unwrap_or_default().into_vec().into();
            }
            params.set(name, value);
        }
        Ok(params)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use turnpath_core::DataFile;

    fn request(params: &Params) -> AbiRequest {
        AbiRequest::new("a_crate", "wavy", params)
    }

    #[test]
    fn values_are_the_same_after_both_conversions() {
        let mut given = Params::new().with("number", -0.5);
        given.set("flag", ParamValue::Flag(true));
        given.set("text", ParamValue::Text("säge".into()));
        given.set("list", ParamValue::List(vec!["one".into(), "two".into()]));
        for (name, bytes) in [("file", vec![0, 255]), ("gauge", vec![7])] {
            let (path, bytes) = (format!("a/{name}.csv"), bytes.into());
            given.set(name, ParamValue::File(DataFile { path, bytes }));
        }
        given.set("rows", ParamValue::Rows(vec![vec![1.0, 2.0], vec![]]));
        assert_eq!(request(&given).params(), Ok(given));
    }

    #[test]
    fn every_bit_of_a_number_crosses() {
        let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
        let next = |bits: &mut u64| {
            *bits = bits.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(1);
            f64::from_bits(*bits)
        };
        let numbers = std::iter::repeat_with(|| next(&mut bits)).filter(|n| n.is_finite());
        for number in numbers.take(10_000).chain([-0.0, 0.1, f64::MAX, 5e-324]) {
            let given = Params::new().with("number", number);
            let Ok(params) = request(&given).params() else {
                panic!("{number} does not cross");
            };
            let Some((_, ParamValue::Number(read))) = params.iter().next() else {
                panic!("{number} is no number any more");
            };
            assert_eq!(read.to_bits(), number.to_bits());
        }
    }

    #[test]
    fn a_value_of_an_unknown_kind_is_an_error_of_its_parameter() {
        let mut strange = request(&Params::new());
        strange.values = r#"{ "mask": { "bits": 99 } }"#.into();
        let error = strange.params().unwrap_err();
        assert!(
            error.to_string().starts_with("parameter `mask`: "),
            "{error}"
        );
    }
}
