//! Which file defines what a path names.

use std::collections::BTreeMap;

use super::crate_files::CrateFiles;

/// Where a path leads to.
#[derive(Clone, Copy)]
enum Target {
    Module(usize),
    /// An item in a file.
    Item(usize),
}

/// The first place where a file takes something of another.
pub struct Import {
    pub path: String,
    pub line: usize,
}

/// Re-exports that lead to each other are followed this far.
const FURTHEST: usize = 16;

/// Every pair of files (from, to) of which the first imports the second.
pub fn imports(files: &CrateFiles) -> BTreeMap<(usize, usize), Import> {
    let mut found = BTreeMap::new();
    for (index, module) in files.modules.iter().enumerate() {
        let mut add = |to: usize, path: String, line: usize| {
            if to != module.file {
                found
                    .entry((module.file, to))
                    .or_insert(Import { path, line });
            }
        };
        for one in &module.uses {
            let path = one.path.join("::");
            match (resolve(files, index, &one.path, 0), &one.name) {
                (Some(Target::Item(to)), name) => {
                    let used = name.as_ref().is_none_or(|name| module.words.contains(name));
                    if used || !one.passed_on {
                        add(to, path, one.line);
                    }
                }
                (Some(Target::Module(from)), None) => {
                    for word in &module.words {
                        if let Some(Target::Item(to)) = lookup(files, from, word, 0) {
                            add(to, format!("{path}::{word}"), one.line);
                        }
                    }
                }
                _ => {}
            }
        }
        for (path, line) in &module.paths {
            if let Some(Target::Item(to)) = resolve(files, index, path, 0) {
                add(to, path.join("::"), *line);
            }
        }
    }
    found
}

/// Follows a path that stands in a module; none if it leads out of the crate.
fn resolve(files: &CrateFiles, from: usize, path: &[String], depth: usize) -> Option<Target> {
    let (first, rest) = path.split_first()?;
    let parent = |module: usize| files.modules[module].parent;
    let start = match first.as_str() {
        "crate" => Target::Module(0),
        "self" => Target::Module(from),
        "super" => Target::Module(parent(from)?),
        name => lookup(files, from, name, depth)?,
    };
    let mut target = start;
    for segment in rest {
        target = match target {
            Target::Item(file) => Target::Item(file),
            Target::Module(module) if segment == "super" => Target::Module(parent(module)?),
            // What a macro defines is not seen: it stands in the module's own file.
            Target::Module(module) => lookup(files, module, segment, depth)
                .unwrap_or(Target::Item(files.modules[module].file)),
        };
    }
    Some(target)
}

/// What a name is in a module.
fn lookup(files: &CrateFiles, module: usize, name: &str, depth: usize) -> Option<Target> {
    if depth > FURTHEST {
        return None;
    }
    let here = &files.modules[module];
    if let Some(child) = here.children.get(name) {
        return Some(Target::Module(*child));
    }
    if here.items.contains(name) {
        return Some(Target::Item(here.file));
    }
    let named = here
        .uses
        .iter()
        .filter(|one| one.name.as_deref() == Some(name));
    // `use surfaces::x` may name a crate like the module that it stands in.
    let mut named = named.filter(|one| one.path.first().is_some_and(|first| first != name));
    if let Some(one) = named.next() {
        return resolve(files, module, &one.path, depth + 1);
    }
    let globs = here.uses.iter().filter(|one| one.name.is_none());
    globs
        .filter_map(|one| resolve(files, module, &one.path, depth + 1))
        .find_map(|target| match target {
            Target::Module(from) if from != module => lookup(files, from, name, depth + 1),
            _ => None,
        })
}
