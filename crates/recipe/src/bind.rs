//! Checks the parameters that a recipe gives a strategy against the strategy's declarations.

use turnpath_core::{ParamDefault, ParamInfo, Params, Slot, StrategyInfo};

use crate::choice::Choice;
use crate::declared::example;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::Entry;
use crate::key_value::{KeyValue, default_of, key_value};
use crate::recipe::Recipe;
use crate::span::Spanned;
use crate::suggest::{did_you_mean, is_misspelt, listed, quoted};
use crate::surface_list::heading;
use crate::tables::slot_keys;

/// The parameters of a strategy, checked against its declarations. Files are named but not read.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Binding {
    /// The values of all parameters but files. A parameter that the recipe leaves out has its
    /// default, or is absent if it is optional.
    pub params: Params,
    /// The files that the recipe names.
    pub files: Vec<NamedFile>,
}

/// A file that a recipe names as a parameter of a strategy.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedFile {
    /// The parameter.
    pub param: &'static str,
    /// The path, relative to the recipe, and its place.
    pub path: Spanned<String>,
}

impl Recipe {
    /// The parameters of the strategy chosen for a slot, checked against its declarations.
    pub fn bind(&self, slot: Slot, info: &StrategyInfo) -> Result<Binding, Diagnostics> {
        self.choice(slot).bind(info)
    }

    /// The message that no strategy of the chosen name is known.
    pub fn unknown_strategy(&self, slot: Slot, known: &[&str]) -> Diagnostic {
        self.choice(slot).unknown(known)
    }
}

impl Choice {
    /// The parameters, checked against the declarations of the strategy.
    pub fn bind(&self, info: &StrategyInfo) -> Result<Binding, Diagnostics> {
        let mut diagnostics: Vec<Diagnostic> = self
            .params
            .iter()
            .filter_map(|entry| self.unknown_param(entry, info))
            .collect();
        let mut binding = Binding::default();
        for param in info.params {
            match self.value_of(param, info) {
                Ok(Some(KeyValue::Value(value))) => binding.params.set(param.name, value),
                Ok(Some(KeyValue::File(path))) => {
                    let param = param.name;
                    binding.files.push(NamedFile { param, path });
                }
                Ok(None) => {}
                Err(diagnostic) => diagnostics.push(diagnostic),
            }
        }
        Diagnostics::unless_any(Some(binding), diagnostics)
    }

    /// The message that no strategy of this name is known.
    pub fn unknown(&self, known: &[&str]) -> Diagnostic {
        let noun = self.slot.noun();
        let mut sorted = known.to_vec();
        sorted.sort_unstable();
        let title = format!("no {noun} named {}", quoted(self.name()));
        let diagnostic = Diagnostic::new(self.name.span.clone(), title)
            .with_label(format!("unknown {noun}"))
            .with_helps(did_you_mean(self.name(), &sorted));
        if sorted.is_empty() {
            diagnostic.with_help(format!("no {noun} was found at all; give --plugin-dir DIR"))
        } else {
            diagnostic.with_help(format!("known: {}", listed(&sorted)))
        }
    }

    fn unknown_param(&self, entry: &Entry, info: &StrategyInfo) -> Option<Diagnostic> {
        if info.params.iter().any(|param| param.name == entry.key) {
            return None;
        }
        let names: Vec<&str> = info.params.iter().map(|param| param.name).collect();
        let of_host = slot_keys(self.slot).iter().map(|key| key.name);
        let known: Vec<&str> = names.iter().copied().chain(of_host).collect();
        let noun = self.slot.noun();
        let title = format!(
            "the {noun} `{}` has no parameter {}",
            info.name,
            quoted(&entry.key)
        );
        let list = if names.is_empty() {
            format!("`{}` has no parameters", info.name)
        } else {
            format!("parameters of `{}`: {}", info.name, listed(&names))
        };
        let diagnostic = Diagnostic::new(entry.span.clone(), title)
            .with_label("unknown parameter")
            .with_helps(did_you_mean(&entry.key, &known))
            .with_help(list);
        Some(diagnostic.with_helps(self.help_for_left_over(entry)))
    }

    /// Help for a key of the file that belongs to the strategy before a `--set` of `use`.
    fn help_for_left_over(&self, entry: &Entry) -> Option<String> {
        let chosen_later = self.name.span.source().rank > entry.span.source().rank;
        chosen_later.then(|| {
            format!(
                "`--set {path}.use` keeps the table's other keys; to replace the whole table: \
                 --set '{path}={{ use = \"{name}\" }}'",
                path = self.path,
                name = self.name()
            )
        })
    }

    /// Whether an unknown key looks like a misspelling of this parameter. That key has its own
    /// message.
    fn misspells(&self, param: &ParamInfo, info: &StrategyInfo) -> bool {
        let declared = |key: &str| info.params.iter().any(|other| other.name == key);
        let mut unknown = self.params.iter().filter(|entry| !declared(&entry.key));
        unknown.any(|entry| is_misspelt(&entry.key, param.name))
    }

    fn value_of(
        &self,
        param: &ParamInfo,
        info: &StrategyInfo,
    ) -> Result<Option<KeyValue>, Diagnostic> {
        match self.param(param.name) {
            Some(entry) => key_value(param, &entry.node).map(Some),
            None if param.default != ParamDefault::Required => {
                Ok(default_of(param).map(KeyValue::Value))
            }
            None if self.misspells(param, info) => Ok(None),
            None => Err(self.missing(param)),
        }
    }

    fn missing(&self, param: &ParamInfo) -> Diagnostic {
        let title = format!(
            "the {} `{}` needs `{}`",
            self.slot.noun(),
            self.name(),
            param.name
        );
        let missing = match param.help.trim() {
            "" => format!("`{}` is missing", param.name),
            help => format!("`{}` is missing: {help}", param.name),
        };
        Diagnostic::new(self.name.span.clone(), title)
            .with_label(missing)
            .with_help(format!(
                "add to {} a line such as: {} = {}",
                heading(&self.path),
                param.name,
                example(param)
            ))
    }
}
