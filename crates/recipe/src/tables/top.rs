//! The keys above the first table, and the names of the tables.

use turnpath_core::kind::{Count, Flag, List, Text};
use turnpath_core::{Param, Slot};

use crate::diagnostic::Diagnostic;
use crate::document::{Entry, Node, Table, Value};
use crate::read::{Schema, Section};
use crate::span::Spanned;
use crate::suggest::{did_you_mean, listed, quoted};
use crate::table_info::TableInfo;
use crate::value;

/// The only format so far.
const FORMAT: u64 = 1;

const FORMAT_KEY: Param<Count> = Param::count("format", "the format of the recipe")
    .min(FORMAT)
    .max(FORMAT)
    .example("1");
const NAME: Param<Option<Text>> = Param::text(
    "name",
    "the job's name, also in the output folder's name and in programs; left out: the file's name \
     without its extension",
)
.optional();
const PLUGINS: Param<List> = Param::list(
    "plugins",
    &[],
    "folders and libraries to take strategies from, used only with `--trust-recipe`: native code \
     with your rights",
)
.default(&[]);
const REFINE: Param<Flag> = Param::flag(
    "refine",
    "whether segments whose error exceeds the tolerance are halved until the path as played holds \
     it, in twelve rounds at most, and into none below 0.1 ms; left out in `ablate`: false",
)
.default(true);

/// The keys above the first table.
pub(crate) const TOP: TableInfo = TableInfo {
    name: "",
    summary: "the keys above the first table",
    required: true,
    keys: &[
        FORMAT_KEY.info(),
        NAME.info(),
        PLUGINS.info(),
        REFINE.info(),
    ],
};

/// The values above the first table.
pub(crate) struct Top {
    pub(crate) name: Option<String>,
    pub(crate) plugins: Vec<Spanned<String>>,
    pub(crate) refine: bool,
}

/// Reads the keys above the first table and reports unknown tables.
pub(crate) fn top(section: &mut Section<'_>) -> Top {
    report_unknown(section);
    let params = section.values(&[REFINE.info()]);
    let name = section.text(NAME.name());
    if let Some(empty) = name.as_ref().filter(|name| name.value.trim().is_empty()) {
        let title = "`name` is empty";
        section.report(
            Diagnostic::new(empty.span.clone(), title)
                .with_help("leave it out, or give the job a name"),
        );
    }
    Top {
        name: name.map(|name| name.value),
        plugins: section.texts(PLUGINS.name()).unwrap_or_default(),
        refine: params.find(REFINE).unwrap_or(true),
    }
}

/// Whether a recipe lists plugins, or a key that may be meant so.
pub(crate) fn may_list_plugins(root: &Table) -> bool {
    let key = PLUGINS.name();
    root.get(key).is_some() || root.has_like(key)
}

/// Whether this version reads the recipe's format. Another format is reported.
pub(crate) fn format_is_one(section: &mut Section<'_>) -> bool {
    let key = FORMAT_KEY.name();
    let Some(node) = section.node(key) else {
        section.missing(key, FORMAT_KEY.info().example);
        return true;
    };
    match value::number(key, node) {
        Ok(format) if format == FORMAT as f64 => true,
        Ok(other) => {
            let title = format!("the recipe has format {other}, but this version reads format 1");
            let diagnostic = Diagnostic::new(node.span.clone(), title)
                .with_label("must be 1")
                .with_help("use a version of turnpath that reads this format, or write format = 1");
            section.report(diagnostic);
            false
        }
        Err(diagnostic) => {
            section.report(diagnostic);
            false
        }
    }
}

fn report_unknown(section: &mut Section<'_>) {
    let names = table_names(section.schema);
    for entry in section.table.map_or(&[][..], Table::entries) {
        let is_table = matches!(entry.node.value, Value::Table(_));
        let key = entry.key.as_str();
        if let (true, Value::Array(items)) = (key == Slot::Surface.key(), &entry.node.value) {
            report_wrong_surfaces(section, items);
            continue;
        }
        let diagnostic = match (names.contains(&key), TOP.has(key)) {
            (true, _) if is_table => continue,
            (true, _) => not_a_table(entry),
            (_, true) => continue,
            _ if is_table => unknown_table(entry, &names),
            _ => unknown_key(section, entry, &names),
        };
        section.report(diagnostic);
    }
}

fn table_names(schema: Schema) -> Vec<&'static str> {
    let slots = Slot::ALL.iter().map(|slot| slot.key());
    let fixed = schema.iter().map(|table| table.name);
    let fixed = fixed.filter(|name| !name.contains('.'));
    let is_slot = |name: &&str| Slot::ALL.iter().any(|slot| slot.key() == *name);
    fixed.filter(|name| !is_slot(name)).chain(slots).collect()
}

/// Reports each surface of a list that is not a table.
fn report_wrong_surfaces(section: &mut Section<'_>, items: &[Node]) {
    for item in items {
        if !matches!(item.value, Value::Table(_)) {
            let diagnostic = value::wrong_type(Slot::Surface.key(), item, "a list of tables")
                .with_help("write [[surface]] and its keys below it, once for each surface");
            section.report(diagnostic);
        }
    }
}

fn not_a_table(entry: &Entry) -> Diagnostic {
    let key = &entry.key;
    value::wrong_type(key, &entry.node, "a table")
        .with_help(format!("write the line [{key}], and its keys below it"))
}

fn unknown_table(entry: &Entry, names: &[&str]) -> Diagnostic {
    Diagnostic::new(
        entry.node.span.clone(),
        format!("unknown table {}", quoted(&entry.key)),
    )
    .with_label("unknown table")
    .with_helps(did_you_mean(&entry.key, names))
    .with_help(format!("tables: {}", listed(names)))
}

fn unknown_key(section: &Section<'_>, entry: &Entry, tables: &[&str]) -> Diagnostic {
    let key = entry.key.as_str();
    let elsewhere = || {
        section
            .tables_with(key)
            .map(|tables| format!("`{key}` belongs to {tables}"))
    };
    let keys: Vec<&str> = TOP.names().collect();
    let known: Vec<&str> = keys.iter().chain(tables).copied().collect();
    Diagnostic::new(entry.span.clone(), format!("unknown key {}", quoted(key)))
        .with_label("unknown key")
        .with_helps(did_you_mean(key, &known).or_else(elsewhere))
        .with_help(format!("keys above the first table: {}", listed(&keys)))
}
