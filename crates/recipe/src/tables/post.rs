//! `[output.NAME]` of a post: the layout of its programs. The post declares the keys.

use turnpath_core::Params;
use turnpath_post::{C_SIGN, FOOTER_KEY, HEADER_KEY, POSTS, Post};

use crate::declared::example;
use crate::diagnostic::Diagnostic;
use crate::read::Section;
use crate::span::Spanned;
use crate::table_info::TableInfo;

/// The declared tables of all posts.
pub(super) const TABLES: [TableInfo; POSTS.len()] = {
    let mut tables = [table(&POSTS[0]); POSTS.len()];
    let mut k = 1;
    while k < tables.len() {
        tables[k] = table(&POSTS[k]);
        k += 1;
    }
    tables
};

/// The declared table of a post.
const fn table(post: &Post) -> TableInfo {
    TableInfo {
        name: post.table,
        summary: post.summary,
        required: false,
        keys: post.keys,
    }
}

/// A post's table, with defaults for the keys that the recipe leaves out.
#[derive(Debug, Clone, PartialEq)]
pub struct PostSettings {
    /// The post's name.
    pub post: &'static str,
    /// The values of the table but the templates.
    pub params: Params,
    /// The template of the program's header; `None` for the post's own.
    pub header: Option<Spanned<String>>,
    /// The template of the program's footer; `None` for the post's own.
    pub footer: Option<Spanned<String>>,
}

/// Reads a post's table. A post that `is_asked` for a program needs the keys that have no default, with
/// or without a table.
pub(crate) fn post_settings(
    post: &'static Post,
    section: &mut Section<'_>,
    is_asked: bool,
) -> PostSettings {
    // Templates keep their places, since the post reads them later.
    let templates = [HEADER_KEY.name(), FOOTER_KEY.name()];
    let params = section.bind_but(&table(post), &templates);
    section.report_unless_table();
    check_c_sign(section, &params);
    if let (true, None, Some(key)) = (is_asked, section.table, post.undecided(&params)) {
        section.missing_table(&format!("{} = {}", key.name, example(key)));
    }
    PostSettings {
        post: post.name,
        params,
        header: section.text(HEADER_KEY.name()),
        footer: section.text(FOOTER_KEY.name()),
    }
}

fn check_c_sign(section: &mut Section<'_>, params: &Params) {
    if params.find(C_SIGN).is_some_and(|sign| sign.abs() != 1.0) {
        let span = section.nearest_span(C_SIGN.name());
        let diagnostic = Diagnostic::new(span, "`c_sign` must be 1 or -1")
            .with_label("neither 1 nor -1")
            .with_help("the path's C grows; -1 makes the program's C decrease");
        section.report(diagnostic);
    }
}
