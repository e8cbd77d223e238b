//! What a library's bytes say before any of its code runs: the kind of file, and the plugin entry
//! that it exports.

use object::read::NameOrOrdinal;
use object::{FileKind, Object};
use turnpath_plugin::loading::SYMBOL_PREFIX;

use crate::elf;
use crate::{Refusal, machine};

/// The exported symbol of the plugin in a library, after all checks that can be made without loading
/// the library.
///
/// If the library holds the code of other plugins too, `file_stem` (`libmy_plugin`) decides.
///
/// # Errors
/// When the bytes are not those of a plugin for this program.
pub fn entry_symbol(bytes: &[u8], file_stem: &str) -> Result<String, Refusal> {
    match kind(bytes)? {
        System::Elf => {
            let image = elf::check(bytes)?;
            let symbol = choose(image.exports_with(SYMBOL_PREFIX)?, file_stem)?;
            image.check_entry(&symbol)?;
            Ok(symbol)
        }
        System::Apple | System::Windows => choose(exports(bytes)?, file_stem),
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum System {
    Elf,
    Apple,
    Windows,
}

impl System {
    const OURS: Self = if cfg!(windows) {
        Self::Windows
    } else if cfg!(target_vendor = "apple") {
        Self::Apple
    } else {
        Self::Elf
    };

    const fn noun(self) -> &'static str {
        match self {
            Self::Elf => "Linux or another Unix",
            Self::Apple => "macOS",
            Self::Windows => "Windows",
        }
    }
}

/// The system that the library is for, if that is this program's system.
fn kind(bytes: &[u8]) -> Result<System, Refusal> {
    if bytes.is_empty() {
        return Err(Refusal::NotALibrary("an empty file"));
    }
    let system = match FileKind::parse(bytes) {
        Ok(FileKind::Elf32 | FileKind::Elf64) => System::Elf,
        Ok(FileKind::MachOFat32 | FileKind::MachOFat64) if System::OURS == System::Apple => {
            return Err(Refusal::NotALibrary("one for several processors at once"));
        }
        Ok(FileKind::MachO32 | FileKind::MachO64) => System::Apple,
        Ok(FileKind::MachOFat32 | FileKind::MachOFat64) => System::Apple,
        Ok(FileKind::Pe32 | FileKind::Pe64) => System::Windows,
        Ok(FileKind::Archive) => return Err(Refusal::NotALibrary("a static library")),
        Ok(_) => return Err(Refusal::NotALibrary("an object file")),
        Err(_) if bytes.starts_with(&object::elf::ELFMAG) => return Err(Refusal::Truncated),
        Err(_) if std::str::from_utf8(bytes).is_ok() => {
            return Err(Refusal::NotALibrary("a text file"));
        }
        Err(_) => return Err(Refusal::NotALibrary("a file of another kind")),
    };
    if system == System::OURS {
        return Ok(system);
    }
    Err(Refusal::WrongMachine {
        found: system.noun().to_owned(),
        ours: machine::ours(),
    })
}

/// The plugin entries that a Mach-O or PE library exports.
fn exports(bytes: &[u8]) -> Result<Vec<String>, Refusal> {
    let damaged = |_| Refusal::Damaged("its headers cannot be read");
    let file = object::File::parse(bytes).map_err(damaged)?;
    let mut found = Vec::new();
    for export in file.exports().map_err(damaged)? {
        let export = export.map_err(damaged)?;
        let NameOrOrdinal::Name(name) = export.name() else {
            continue;
        };
        let name = String::from_utf8_lossy(name).into_owned();
        let name = name.strip_prefix('_').unwrap_or(&name);
        if name.starts_with(SYMBOL_PREFIX) {
            found.push(name.to_owned());
        }
    }
    Ok(found)
}

/// The only entry, or among several entries the one with the name of the file.
fn choose(mut symbols: Vec<String>, file_stem: &str) -> Result<String, Refusal> {
    symbols.sort();
    if symbols.len() > 1 {
        let stem = file_stem.strip_prefix("lib").unwrap_or(file_stem);
        let expected = format!("{SYMBOL_PREFIX}{}", stem.replace('-', "_"));
        if symbols.contains(&expected) {
            return Ok(expected);
        }
        let crate_of = |symbol: &String| symbol.replacen(SYMBOL_PREFIX, "", 1);
        return Err(Refusal::SeveralPlugins(
            symbols.iter().map(crate_of).collect(),
        ));
    }
    symbols.pop().ok_or(Refusal::NotAPlugin)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn symbols(crates: &[&str]) -> Vec<String> {
        let symbol = |name: &&str| format!("{SYMBOL_PREFIX}{name}");
        crates.iter().map(symbol).collect()
    }

    #[test]
    fn a_single_entry_is_chosen_whatever_the_name_of_the_file() {
        let symbol = choose(symbols(&["my_plugin"]), "renamed").unwrap();
        assert_eq!(symbol, format!("{SYMBOL_PREFIX}my_plugin"));
    }

    #[test]
    fn among_several_entries_the_files_name_decides() {
        let both = symbols(&["other", "my_plugin"]);
        let symbol = choose(both.clone(), "libmy-plugin").unwrap();
        assert_eq!(symbol, format!("{SYMBOL_PREFIX}my_plugin"));
        let refusal = choose(both, "renamed").unwrap_err();
        let names = ["my_plugin", "other"].map(String::from).to_vec();
        assert_eq!(refusal, Refusal::SeveralPlugins(names));
    }

    #[test]
    fn files_of_other_kinds_are_named() {
        let texts = [
            (&b""[..], "an empty file"),
            (b"hello, this is a text", "a text file"),
            (b"!<arch>\n                        ", "a static library"),
            (&[0xff; 64], "a file of another kind"),
        ];
        for (bytes, what) in texts {
            let refusal = entry_symbol(bytes, "x").unwrap_err();
            assert_eq!(refusal, Refusal::NotALibrary(what));
        }
    }
}
