//! The files and modules of one crate, from its root on.

use std::path::{Path, PathBuf};

use super::module::{Declaration, Module, read};
use super::tokens::{Token, tokens};

/// A crate's files and its modules; the first module is the root.
#[derive(Default)]
pub struct CrateFiles {
    pub paths: Vec<PathBuf>,
    pub modules: Vec<Module>,
}

/// Where the modules lie that a module declares.
#[derive(Clone)]
struct Folder {
    /// Where `mod name;` looks for the file.
    children: PathBuf,
    /// Where `#[path]` begins.
    attributes: PathBuf,
}

impl CrateFiles {
    /// Reads the root and every file that a `mod` names.
    pub fn read(root: &Path, read: &dyn Fn(&Path) -> Option<String>) -> Self {
        let mut files = Self::default();
        let text = read(root).unwrap_or_else(|| panic!("{}: no such file", root.display()));
        let folder = root.parent().unwrap_or(Path::new("")).to_owned();
        let folder = Folder {
            children: folder.clone(),
            attributes: folder,
        };
        files.paths.push(root.to_owned());
        files.add(None, 0, &tokens(&text), &folder, read);
        files
    }

    /// Adds a module and those that it declares; gives its index.
    fn add(
        &mut self,
        parent: Option<usize>,
        file: usize,
        body: &[Token],
        folder: &Folder,
        read_file: &dyn Fn(&Path) -> Option<String>,
    ) -> usize {
        let mut module = Module {
            file,
            parent,
            ..Module::default()
        };
        let (declared, macros) = read(body, &mut module);
        let index = self.modules.len();
        self.modules.push(module);
        self.modules[0].items.extend(macros);
        for child in declared {
            let name = child.name.clone();
            let added = match &child.body {
                Some(body) => {
                    let inside = Folder {
                        children: folder.children.join(&name),
                        attributes: folder.children.join(&name),
                    };
                    Some(self.add(Some(index), file, body, &inside, read_file))
                }
                None => self.add_file(index, &child, folder, read_file),
            };
            let added = added.map(|added| (name, added));
            self.modules[index].children.extend(added);
        }
        index
    }

    /// Adds the module of a file. A file that is not there is left to the compiler.
    fn add_file(
        &mut self,
        parent: usize,
        child: &Declaration,
        folder: &Folder,
        read_file: &dyn Fn(&Path) -> Option<String>,
    ) -> Option<usize> {
        let name = &child.name;
        let candidates = match &child.path {
            Some(path) => vec![folder.attributes.join(path)],
            None => vec![
                folder.children.join(format!("{name}.rs")),
                folder.children.join(name).join("mod.rs"),
            ],
        };
        let found = candidates.into_iter().find_map(|path| {
            let text = read_file(&path)?;
            Some((path, text))
        });
        let (path, text) = found?;
        let own = path.parent().unwrap_or(Path::new("")).to_owned();
        let is_folder = child.path.is_some() || path.file_name().is_some_and(|f| f == "mod.rs");
        let inside = Folder {
            children: if is_folder {
                own.clone()
            } else {
                own.join(name)
            },
            attributes: own,
        };
        let file = self.paths.len();
        self.paths.push(path);
        Some(self.add(Some(parent), file, &tokens(&text), &inside, read_file))
    }
}
