//! The values of a strategy's parameters, looked up by declaration.

use std::collections::BTreeMap;

use super::declared::Param;
use super::kind::Kind;
use super::value::ParamValue;

/// The values of a strategy's parameters, in inner units.
///
/// ```
/// use turnpath_core::kind::{Angle, Length};
/// use turnpath_core::{Param, Params};
///
/// const SPACING: Param<Length> = Param::length("spacing", "largest arc").positive();
/// const STEP: Param<Option<Angle>> = Param::angle("step", "angle step").optional();
///
/// let params = Params::new().with("spacing", 0.5);
/// assert_eq!(params.get(SPACING), 0.5);
/// assert_eq!(params.get(STEP), None);
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Params(BTreeMap<String, ParamValue>);

impl Params {
    /// A set without values.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets a value. The host and tests use it.
    pub fn set(&mut self, name: impl Into<String>, value: ParamValue) {
        self.0.insert(name.into(), value);
    }

    /// Sets a number, in inner units. Tests and examples use it.
    pub fn with(mut self, name: &str, value: f64) -> Self {
        self.set(name, ParamValue::Number(value));
        self
    }

    /// All values, sorted by name.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &ParamValue)> {
        self.0.iter().map(|(name, value)| (name.as_str(), value))
    }

    /// The value of a declared parameter, of the type that its [kind](crate::kind) says: a quantity
    /// is a number in mm, rad and s. An optional parameter that the recipe leaves out is `None`.
    ///
    /// # Panics
    /// When the strategy does not declare the parameter. That is a mistake of the strategy's author
    /// and shows at the first construction. The boundary turns the panic into an error.
    pub fn get<K: Kind>(&self, param: Param<K>) -> K::Value<'_> {
        self.find(param).unwrap_or_else(|| undeclared(param.name()))
    }

    /// The same; `None` where [`get`](Self::get) would panic.
    pub fn find<K: Kind>(&self, param: Param<K>) -> Option<K::Value<'_>> {
        K::read(self.0.get(param.name()))
    }
}

fn undeclared(name: &str) -> ! {
    panic!("the strategy reads the parameter `{name}`, but does not declare it, or as another kind")
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::DataFile;
    use crate::kind::{
        Choice, ChoiceOr, Coefficients, Count, File, Flag, Length, List, Rows, Text, WordOrNumber,
    };

    const LENGTH: Param<Length> = Param::length("length", "");
    const COUNT: Param<Count> = Param::count("count", "");
    const FLAG: Param<Flag> = Param::flag("flag", "");
    const WORD: Param<Choice> = Param::choice("word", &["one", "two"], "");
    const END: Param<ChoiceOr<Length>> = Param::choice_or_length("end", &["none"], "");
    const TEXT: Param<Text> = Param::text("text", "");
    const LIST: Param<List> = Param::list("list", &[], "");
    const ROWS: Param<Rows> = Param::rows("rows", 2, "");
    const FILE: Param<File> = Param::file("file", "");
    const COEFFICIENTS: Param<Coefficients> = Param::length_coefficients("coefficients", 1, "");

    #[test]
    fn every_kind_has_its_type() {
        let mut params = Params::new().with("length", 0.5).with("count", 36.0);
        params.set("flag", ParamValue::Flag(true));
        params.set("word", ParamValue::Text("two".to_owned()));
        params.set("text", ParamValue::Text("x + y".to_owned()));
        params.set("list", ParamValue::List(vec!["csv".to_owned()]));
        params.set("rows", ParamValue::Rows(vec![vec![1.0, 2.0]]));
        let file = DataFile {
            path: "map.csv".to_owned(),
            bytes: Arc::from(*b"1,2"),
        };
        params.set("file", ParamValue::File(file));
        let length: f64 = params.get(LENGTH);
        let count: u64 = params.get(COUNT);
        let flag: bool = params.get(FLAG);
        let word: &str = params.get(WORD);
        let rows: &[Vec<f64>] = params.get(ROWS);
        assert_eq!((length, count, flag, word), (0.5, 36, true, "two"));
        assert_eq!(rows, [[1.0, 2.0]]);
        params.set("coefficients", ParamValue::Rows(vec![vec![4.0, 0.5]]));
        assert_eq!(params.get(COEFFICIENTS), [[4.0, 0.5]]);
        assert_eq!(params.get(TEXT), "x + y");
        assert_eq!(params.get(LIST), ["csv"]);
        params.set("end", ParamValue::Text("none".to_owned()));
        assert_eq!(params.get(END), WordOrNumber::Word("none"));
        params.set("end", ParamValue::Number(0.5));
        assert_eq!(params.get(END), WordOrNumber::Number(0.5));
        assert_eq!(params.get(FILE).bytes[..], *b"1,2");
        assert!(params.get(FILE.optional()).is_some());
    }

    #[test]
    #[should_panic(expected = "reads the parameter `length`, but does not declare it")]
    fn a_parameter_without_a_value_panics() {
        Params::new().get(LENGTH);
    }

    #[test]
    #[should_panic(expected = "or as another kind")]
    fn an_optional_parameter_of_another_kind_panics() {
        Params::new().with("word", 1.0).get(WORD.optional());
    }
}
