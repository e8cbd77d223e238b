//! `[output]`: the files to write.

use crate::diagnostic::Diagnostic;
use crate::place::Located;
use crate::read::Section;
use crate::suggest::{did_you_mean, listed, quoted};

pub(super) const KEYS: &[&str] = &["posts", "data", "z_reference", "pmac-pvt"];

/// The posts there are. Each may have a table of its name below `[output]`.
const POSTS: &[&str] = &["pmac-pvt"];
const DATA: &[&str] = &["csv"];

/// A data file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DataFormat {
    /// `toolpath.csv`.
    Csv,
}

/// What Z means in a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ZReference {
    /// Z of the tool's tip.
    Tip,
    /// Z of the nose's centre.
    Centre,
}

/// `[output]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    /// The programs to write, by the names of their posts.
    pub posts: Vec<Located<String>>,
    /// The data files to write.
    pub data: Vec<DataFormat>,
    /// What Z means in the programs.
    pub z_reference: ZReference,
}

/// Reads `[output]`.
pub(crate) fn output(section: &mut Section<'_>) -> Output {
    section.only(KEYS);
    let posts = section.texts("posts").unwrap_or_default();
    check_posts(section, &posts);
    let z_reference = match section.word("z_reference", &["tip", "centre"]) {
        Some(word) if word.value == "centre" => ZReference::Centre,
        _ => ZReference::Tip,
    };
    Output {
        posts,
        data: data(section),
        z_reference,
    }
}

fn data(section: &mut Section<'_>) -> Vec<DataFormat> {
    let Some(names) = section.texts("data") else {
        return vec![DataFormat::Csv];
    };
    let unknown = names
        .iter()
        .filter(|name| !DATA.contains(&name.value.as_str()));
    let complaints: Vec<Diagnostic> = unknown
        .map(|name| no_such("data format", name, DATA))
        .collect();
    section.found.extend(complaints);
    if names.is_empty() {
        Vec::new()
    } else {
        vec![DataFormat::Csv]
    }
}

fn no_such(what: &str, name: &Located<String>, known: &[&str]) -> Diagnostic {
    Diagnostic::new(
        name.place.clone(),
        format!("no {what} named {}", quoted(&name.value)),
    )
    .label(format!("unknown {what}"))
    .helps(did_you_mean(&name.value, known))
    .help(format!("known: {}", listed(known)))
}

fn check_posts(section: &mut Section<'_>, posts: &[Located<String>]) {
    for (index, post) in posts.iter().enumerate() {
        if !POSTS.contains(&post.value.as_str()) {
            section.complain(no_such("post", post, POSTS));
        } else if posts[..index].iter().any(|other| other.value == post.value) {
            let title = format!("the post {} stands twice", quoted(&post.value));
            let diagnostic = Diagnostic::new(post.place.clone(), title)
                .label("again")
                .help("each post writes one program: name it once");
            section.complain(diagnostic);
        }
    }
}
