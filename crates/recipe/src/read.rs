//! Reads the keys of one table and collects the messages about them.

use turnpath_core::{ParamDefault, ParamInfo, ParamValue, Params};

use crate::declared::example;
use crate::diagnostic::Diagnostic;
use crate::document::{Entry, Node, Table, Value};
use crate::key_value::{KeyValue, default_of, key_value};
use crate::span::{Span, Spanned};
use crate::suggest::{did_you_mean, is_misspelt, listed, quoted};
use crate::surface_list::heading;
use crate::table_info::TableInfo;
use crate::value;

/// The tables with fixed keys.
pub(crate) type Schema = &'static [TableInfo];

/// One table of the recipe, which may be missing, and the messages so far.
pub(crate) struct Section<'a> {
    /// `tool`; empty for the keys above the first table.
    pub(crate) name: &'a str,
    /// The keys of the table; `None` if the recipe has no such table.
    pub(crate) table: Option<&'a Table>,
    /// The header of the table; the recipe as a whole if there is no header.
    pub(crate) span: Span,
    /// Whether the recipe has an unknown table with nearly this name instead.
    pub(crate) misspelt: bool,
    /// The tables with fixed keys.
    pub(crate) schema: Schema,
    /// The messages so far.
    pub(crate) diagnostics: &'a mut Vec<Diagnostic>,
}

/// A recipe whose tables are read one after the other.
pub(crate) struct Sections<'a> {
    pub(crate) root: &'a Table,
    /// The recipe as a whole.
    pub(crate) whole: &'a Span,
    /// The tables with fixed keys.
    pub(crate) schema: Schema,
    /// The messages so far.
    pub(crate) diagnostics: &'a mut Vec<Diagnostic>,
}

impl Sections<'_> {
    /// The keys above the first table.
    pub(crate) fn top(&mut self) -> Section<'_> {
        let span = self.whole.clone();
        Section {
            name: "",
            table: Some(self.root),
            span,
            misspelt: false,
            schema: self.schema,
            diagnostics: self.diagnostics,
        }
    }

    /// A table by its name, `output` or `output.pmac-pvt`. The recipe need not have it.
    pub(crate) fn open(&mut self, name: &'static str) -> Section<'_> {
        let node = self.root.find(name.split('.'));
        let span = node.map_or(self.whole, |node| &node.span).clone();
        let table = match node.map(|node| &node.value) {
            Some(Value::Table(table)) => Some(table),
            _ => None,
        };
        let misspelt = node.is_none() && self.root.has_like(name);
        Section {
            name,
            table,
            span,
            misspelt,
            schema: self.schema,
            diagnostics: self.diagnostics,
        }
    }
}

impl<'r> Sections<'r> {
    /// A table that is known already, by its path.
    pub(crate) fn open_table<'s>(
        &'s mut self,
        name: &'s str,
        table: &'s Table,
        span: Span,
    ) -> Section<'s>
    where
        'r: 's,
    {
        Section {
            name,
            table: Some(table),
            span,
            misspelt: false,
            schema: self.schema,
            diagnostics: self.diagnostics,
        }
    }
}

impl<'a> Section<'a> {
    /// The value under a key, if the recipe has the key.
    pub(crate) fn node(&self, key: &str) -> Option<&'a Node> {
        self.table?.get(key).map(|entry| &entry.node)
    }

    /// The span of the value under a key, else of the table.
    pub(crate) fn nearest_span(&self, key: &str) -> Span {
        self.node(key).map_or(&self.span, |node| &node.span).clone()
    }

    /// Whether the recipe has a value of another kind under the table's name. Another message
    /// reports that value.
    pub(crate) fn is_something_else(&self) -> bool {
        self.table.is_none() && !self.span.is_whole()
    }

    /// Reports a value of another kind under the name of a table within a table.
    pub(crate) fn report_unless_table(&mut self) {
        if self.is_something_else() {
            let title = format!("`{}` must be a table", self.name);
            let diagnostic = Diagnostic::new(self.span.clone(), title).with_help(format!(
                "write the line [{}], and its keys below it",
                self.name
            ));
            self.report(diagnostic);
        }
    }

    /// Adds a message.
    pub(crate) fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    fn ok_or_report<T>(&mut self, result: Result<T, Diagnostic>) -> Option<T> {
        result.map_err(|diagnostic| self.report(diagnostic)).ok()
    }

    fn at<T>(
        &mut self,
        key: &str,
        read: impl FnOnce(&'a Node) -> Result<T, Diagnostic>,
    ) -> Option<Spanned<T>> {
        let node = self.node(key)?;
        let value = self.ok_or_report(read(node))?;
        Some(Spanned {
            value,
            span: node.span.clone(),
        })
    }

    /// The values of a table's declared keys. Unknown keys, wrong values and missing keys are
    /// reported. A key that the recipe leaves out has its default.
    pub(crate) fn bind(&mut self, info: &TableInfo) -> Params {
        self.bind_but(info, &[])
    }

    /// The same without some keys, which the table reads itself.
    pub(crate) fn bind_but(&mut self, info: &TableInfo, own: &[&str]) -> Params {
        self.report_unknown_keys(info);
        let keys = info.keys.iter();
        self.values(keys.filter(|key| !own.contains(&key.name)))
    }

    /// The values of some keys.
    pub(crate) fn values<'k>(&mut self, keys: impl IntoIterator<Item = &'k ParamInfo>) -> Params {
        let mut params = Params::new();
        for key in keys {
            if let Some(value) = self.value(key) {
                params.set(key.name, value);
            }
        }
        params
    }

    fn value(&mut self, key: &ParamInfo) -> Option<ParamValue> {
        let Some(node) = self.node(key.name) else {
            if key.default == ParamDefault::Required {
                self.require(key);
            }
            return default_of(key);
        };
        match self.ok_or_report(key_value(key, node))? {
            KeyValue::Value(value) => Some(value),
            KeyValue::File(path) => Some(ParamValue::Text(path.value)),
        }
    }

    /// Reports a key that the table lacks, unless the table has a misspelling of it, which has a
    /// message of its own.
    pub(crate) fn require(&mut self, key: &ParamInfo) {
        let has_like = |table: &Table| table.get(key.name).is_some() || table.has_like(key.name);
        if !self.table.is_none_or(has_like) {
            self.missing(key.name, &example(key));
        }
    }

    /// A string; `None` if the key is missing or its value is wrong.
    pub(crate) fn text(&mut self, key: &str) -> Option<Spanned<String>> {
        self.at(key, |node| value::text(key, node).map(str::to_owned))
    }

    /// The items of a list that are strings. Each other item is reported.
    pub(crate) fn texts(&mut self, key: &str) -> Option<Vec<Spanned<String>>> {
        let nodes = self.at(key, |node| value::items(key, node))?.value;
        let item = |node: &Node| {
            let value = self.ok_or_report(value::text(key, node))?.to_owned();
            Some(Spanned {
                value,
                span: node.span.clone(),
            })
        };
        Some(nodes.iter().filter_map(item).collect())
    }

    /// Reports a missing key; `example` is a value as the recipe would have it.
    pub(crate) fn missing(&mut self, key: &str, example: &str) {
        let (title, to) = if self.name.is_empty() {
            (format!("the recipe lacks `{key}`"), String::new())
        } else {
            (
                format!("{} lacks `{key}`", heading(self.name)),
                format!(" to {}", heading(self.name)),
            )
        };
        let mut diagnostic = Diagnostic::new(self.span.clone(), title)
            .with_help(format!("add{to} a line such as: {key} = {example}"));
        if !self.name.is_empty() {
            diagnostic = diagnostic.with_label(format!("`{key}` must be given"));
        }
        self.report(diagnostic);
    }

    /// Whether the recipe has the table. A table that it must have is reported.
    pub(crate) fn is_there(&mut self, info: &TableInfo) -> bool {
        let there = self.table.is_some();
        let required = |key: &&ParamInfo| key.default == ParamDefault::Required;
        let first = info.keys.iter().find(required).or(info.keys.first());
        if let (false, true, Some(first)) = (there, info.required, first) {
            self.missing_table(&format!("{} = {}", first.name, example(first)));
        }
        there
    }

    /// Reports a missing table; `example` is a line that the table could have.
    pub(crate) fn missing_table(&mut self, example: &str) {
        if self.is_something_else() || self.misspelt {
            return;
        }
        let title = format!("the recipe lacks the table [{}]", self.name);
        let help = format!(
            "add the line [{}] and below it, for example: {example}",
            self.name
        );
        let diagnostic = Diagnostic::new(self.span.clone(), title).with_help(help);
        self.report(diagnostic);
    }

    /// Reports each key that is neither a key of the table nor a table within it.
    pub(crate) fn report_unknown_keys(&mut self, info: &TableInfo) {
        let known = known_keys(self.schema, info);
        let entries = self.table.map_or(&[][..], Table::entries);
        let unknown = entries
            .iter()
            .filter(|entry| !known.contains(&entry.key.as_str()));
        for entry in unknown {
            let diagnostic = self.unknown_key(entry, &known);
            self.report(diagnostic);
        }
    }

    /// Reports each key that looks like a misspelling of `key`, if the table lacks `key` itself.
    pub(crate) fn report_misspelling(&mut self, key: &str, info: &TableInfo) {
        let known = known_keys(self.schema, info);
        let entries = match self.table {
            Some(table) if table.get(key).is_none() => table.entries(),
            _ => &[],
        };
        for entry in entries.iter().filter(|entry| is_misspelt(&entry.key, key)) {
            let diagnostic = self.unknown_key(entry, &known);
            self.report(diagnostic);
        }
    }

    fn unknown_key(&self, entry: &Entry, known: &[&str]) -> Diagnostic {
        let key = entry.key.as_str();
        let title = format!("[{}] has no key {}", self.name, quoted(key));
        let elsewhere = || {
            self.tables_with(key)
                .map(|tables| format!("`{key}` belongs to {tables}"))
        };
        Diagnostic::new(entry.span.clone(), title)
            .with_label("unknown key")
            .with_helps(did_you_mean(key, known).or_else(elsewhere))
            .with_help(format!("keys of [{}]: {}", self.name, listed(known)))
    }

    /// The tables that have such a key: "[part]", or "[part] or [path]".
    pub(crate) fn tables_with(&self, key: &str) -> Option<String> {
        let with_key = self.schema.iter().filter(|table| table.has(key));
        let names: Vec<String> = with_key.map(|table| format!("[{}]", table.name)).collect();
        (!names.is_empty()).then(|| names.join(" or "))
    }
}

/// The keys of a table, and the tables within it.
pub(crate) fn known_keys(schema: Schema, info: &TableInfo) -> Vec<&'static str> {
    let within = |table: &'static TableInfo| {
        let rest = table.name.strip_prefix(info.name)?;
        rest.strip_prefix('.')
    };
    info.names()
        .chain(schema.iter().filter_map(within))
        .collect()
}
