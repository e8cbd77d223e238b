//! `[output]`: the files to write.

use turnpath_core::Param;
use turnpath_core::kind::{Choice, Length, List, Velocity};
use turnpath_post::{APPROACH_FEED, APPROACH_HEIGHT, ColumnFormat, Compression, POST_NAMES};

use crate::diagnostic::Diagnostic;
use crate::read::Section;
use crate::span::Spanned;
use crate::suggest::{did_you_mean, listed, quoted};
use crate::table_info::TableInfo;

const CSV: &str = "csv";
const DATA: &[&str] = &[CSV, "parquet", "npz"];
const CENTRE: &str = "centre";
const ZST: &str = "zst";

const POSTS_KEY: Param<List> =
    Param::list("posts", POST_NAMES, "the programs to write, each once").default(&[]);
const DATA_KEY: Param<List> = Param::list(
    "data",
    DATA,
    "the data files to write, as `toolpath.csv`, `toolpath.parquet`, `toolpath.npz`",
)
.default(&[CSV]);
const Z_REFERENCE: Param<Choice> = Param::choice(
    "z_reference",
    &["tip", CENTRE],
    "what Z is in programs: the tip of the tool, or the centre of the nose",
)
.default("tip");

const COMPRESS: Param<Choice> = Param::choice(
    "compress",
    &["none", ZST],
    "how the files of programs are compressed: not at all, or by Zstandard as `.zst`",
)
.default("none");

/// Seconds of a minute.
const MINUTE: f64 = 60.0;
/// The largest height of an approach, mm: no lathe for optics has a longer travel of Z.
const REACH: f64 = 1e3;
const APPROACH_HEIGHT_KEY: Param<Length> = Param::length(
    "approach_height",
    "how far above the highest place of the path X and C move before and after it",
)
.positive()
.max(REACH)
.default(APPROACH_HEIGHT)
.example("5 mm");
const APPROACH_FEED_KEY: Param<Velocity> = Param::velocity(
    "approach_feed",
    "how fast Z goes down to the first point of the path",
)
.positive()
.default(APPROACH_FEED / MINUTE)
.example("60 mm/min");

pub(super) const OUTPUT: TableInfo = TableInfo {
    name: "output",
    summary: "the files to write",
    required: false,
    keys: &[
        POSTS_KEY.info(),
        DATA_KEY.info(),
        Z_REFERENCE.info(),
        COMPRESS.info(),
        APPROACH_HEIGHT_KEY.info(),
        APPROACH_FEED_KEY.info(),
    ],
};

/// A data file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DataFormat {
    /// `toolpath.csv`.
    Csv,
    /// `toolpath.parquet` or `toolpath.npz`.
    Columns(ColumnFormat),
}

/// The point of the tool whose Z a program gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ZReference {
    /// The tip of the tool.
    Tip,
    /// The centre of the nose.
    Centre,
}

/// `[output]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    /// The posts that write programs, by their names.
    pub posts: Vec<Spanned<String>>,
    /// The data files to write.
    pub data: Vec<DataFormat>,
    /// The point of the tool whose Z the programs give.
    pub z_reference: ZReference,
    /// How the files of programs are compressed.
    pub compression: Compression,
    /// How far above the highest place of the path X and C move before and after it, mm.
    pub approach_height: f64,
    /// How fast Z goes down to the first point of the path, mm/s.
    pub approach_feed: f64,
}

/// Reads `[output]`.
pub(crate) fn output(section: &mut Section<'_>) -> Output {
    // The items of the lists have messages of their own.
    let params = section.bind_but(&OUTPUT, &[POSTS_KEY.name(), DATA_KEY.name()]);
    let posts = section.texts(POSTS_KEY.name()).unwrap_or_default();
    check_posts(section, &posts);
    let z_reference = match params.find(Z_REFERENCE) {
        Some(CENTRE) => ZReference::Centre,
        _ => ZReference::Tip,
    };
    let compression = match params.find(COMPRESS) {
        Some(ZST) => Compression::Zst,
        _ => Compression::None,
    };
    Output {
        posts,
        data: data(section),
        z_reference,
        compression,
        approach_height: params.find(APPROACH_HEIGHT_KEY).unwrap_or(APPROACH_HEIGHT),
        approach_feed: params
            .find(APPROACH_FEED_KEY)
            .unwrap_or(APPROACH_FEED / MINUTE),
    }
}

fn data(section: &mut Section<'_>) -> Vec<DataFormat> {
    let Some(names) = section.texts(DATA_KEY.name()) else {
        return vec![DataFormat::Csv];
    };
    let unknown = names
        .iter()
        .filter(|name| !DATA.contains(&name.value.as_str()));
    let messages: Vec<Diagnostic> = unknown
        .map(|name| unknown_name("data format", name, DATA))
        .collect();
    section.diagnostics.extend(messages);
    let format = |name: &Spanned<String>| match name.value.as_str() {
        CSV => Some(DataFormat::Csv),
        "parquet" => Some(DataFormat::Columns(ColumnFormat::Parquet)),
        "npz" => Some(DataFormat::Columns(ColumnFormat::Npz)),
        _ => None,
    };
    let mut formats: Vec<DataFormat> = Vec::new();
    for format in names.iter().filter_map(format) {
        if !formats.contains(&format) {
            formats.push(format);
        }
    }
    formats
}

fn unknown_name(what: &str, name: &Spanned<String>, known: &[&str]) -> Diagnostic {
    Diagnostic::new(
        name.span.clone(),
        format!("no {what} named {}", quoted(&name.value)),
    )
    .with_label(format!("unknown {what}"))
    .with_helps(did_you_mean(&name.value, known))
    .with_help(format!("known: {}", listed(known)))
}

fn check_posts(section: &mut Section<'_>, posts: &[Spanned<String>]) {
    for (index, post) in posts.iter().enumerate() {
        if !POST_NAMES.contains(&post.value.as_str()) {
            section.report(unknown_name("post", post, POST_NAMES));
        } else if posts[..index].iter().any(|other| other.value == post.value) {
            let title = format!("the post {} is named twice", quoted(&post.value));
            let diagnostic = Diagnostic::new(post.span.clone(), title)
                .with_label("named again here")
                .with_help("each post writes one program: name it once");
            section.report(diagnostic);
        }
    }
}
