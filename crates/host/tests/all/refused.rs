//! Files that are not plugins for this program: each has its own message, and none ends the
//! program.

#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{fixtures, with_file, with_sources};
use turnpath_host::{Catalogue, LibraryFile, LoadError, Refusal, sha256_hex};

/// A file with these bytes, in a folder of its own.
fn file_of(bytes: &[u8]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("libplugin.so");
    fs::write(&file, bytes).unwrap();
    (folder, file)
}

fn error_of(file: &Path) -> LoadError {
    match with_file(file) {
        Err(error) => error,
        Ok(catalogue) => panic!("loaded: {:?}", catalogue.plugins()),
    }
}

/// The message with that of its source, without the file's folder.
fn message(error: &LoadError, file: &Path) -> String {
    let folder = fs::canonicalize(file.parent().unwrap()).unwrap();
    let folder = format!("{}/", folder.display());
    assert!(!error.is_io(), "{error}");
    let text = with_sources(error);
    assert!(text.contains(&folder), "{text}");
    text.replace(&folder, "")
}

fn refusal_of(bytes: &[u8]) -> Refusal {
    let (_folder, file) = file_of(bytes);
    match error_of(&file) {
        LoadError::Refused { refusal, .. } => refusal,
        error => panic!("{error}"),
    }
}

#[test]
fn a_text_file() {
    let (_folder, file) = file_of(b"a plugin should be here\n");
    assert_eq!(
        message(&error_of(&file), &file),
        "cannot load the plugin libplugin.so: it is not a dynamic library but a text file"
    );
}

#[test]
fn an_empty_file() {
    let (_folder, file) = file_of(b"");
    assert_eq!(
        message(&error_of(&file), &file),
        "cannot load the plugin libplugin.so: it is not a dynamic library but an empty file"
    );
}

#[test]
fn a_program_instead_of_a_library() {
    let program = fs::read(std::env::current_exe().unwrap()).unwrap();
    // A position-independent program looks like a library, but has no plugin in it.
    assert!(matches!(
        refusal_of(&program),
        Refusal::NotAPlugin | Refusal::NotALibrary(_)
    ));
}

#[test]
fn a_foreign_library() {
    let file = fixtures::library("foreign");
    assert_eq!(
        message(&error_of(&file), &file),
        format!(
            "cannot load the plugin {}: it is not a turnpath plugin: the library has no \
             `turnpath_plugin::export!`",
            fixtures::file_name("foreign")
        )
    );
}

#[test]
fn another_version_of_the_boundary() {
    let file = fixtures::library("other-version");
    assert_eq!(
        message(&error_of(&file), &file),
        format!(
            "cannot load the plugin {}: it is built against turnpath-plugin 0.999.3, but this program has 0.2.1; \
             rebuild the plugin against turnpath-plugin 0.2",
            fixtures::file_name("other-version")
        )
    );
}

#[test]
fn two_with_one_name() {
    let folder = fixtures::plugin_folder(&["twins-a", "twins-b", "constant-arc"]);
    let mut catalogue = Catalogue::new();
    let error = catalogue.add_folder(folder.path()).unwrap_err();
    let (a, b) = (
        fixtures::file_name("twins-a"),
        fixtures::file_name("twins-b"),
    );
    let folder = fs::canonicalize(folder.path()).unwrap();
    assert_eq!(
        error
            .to_string()
            .replace(&format!("{}/", folder.display()), ""),
        format!(
            "two strategies of the slot `sampler` are named `twin`: one of twins-a 0.1.0 ({a}), one of twins-b 0.1.0 ({b})"
        )
    );
    let help = "leave one of the two out, or rename it";
    assert_eq!(error.help(), Some(help));
    assert!(!error.is_io());
}

#[test]
fn names_that_belong_to_the_host_and_names_that_no_recipe_could_choose() {
    let said = |package| {
        let file = fixtures::library(package);
        let mut catalogue = Catalogue::new();
        let error = catalogue.add_file(&file).unwrap_err();
        assert!(!error.is_io() && !error.is_missing());
        assert!(error.help().is_some());
        assert_eq!(error.path(), Some(&*fs::canonicalize(&file).unwrap()));
        assert_eq!(catalogue.plugins().len(), 0);
        let folder = fs::canonicalize(fixtures::folder()).unwrap();
        error
            .to_string()
            .replace(&format!("{}/", folder.display()), "")
    };
    assert_eq!(
        said("host-keys"),
        format!(
            "the sampler `hasty` of host-keys 0.1.0 ({}) declares the parameter `speed`, a key \
             that belongs to the host",
            fixtures::file_name("host-keys")
        )
    );
    assert_eq!(
        said("unusable-name"),
        format!(
            "the sampler `Lab Arc\\n` of unusable-name 0.1.0 ({}) has a name that no recipe could \
             choose",
            fixtures::file_name("unusable-name")
        )
    );
}

#[test]
fn a_library_with_several_plugins_under_another_name() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("libplugin.so");
    fs::copy(fixtures::library("builds-on"), &file).unwrap();
    assert_eq!(
        message(&error_of(&file), &file),
        "cannot load the plugin libplugin.so: it holds several plugins (builds_on, \
         conics); name the file after the one that you want, libbuilds_on.so"
    );
}

#[test]
fn a_missing_folder_and_a_missing_file() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("plugins");
    let error = Catalogue::new().add_folder(&missing).unwrap_err();
    let expected = format!("there is no plugin folder {}", missing.display());
    assert_eq!((error.to_string(), error.is_io()), (expected, false));

    let error = Catalogue::new().add_file(&missing).unwrap_err();
    let expected = format!("there is no plugin file {}", missing.display());
    assert_eq!((error.to_string(), error.is_io()), (expected, false));

    let error = Catalogue::new().add_file(folder.path()).unwrap_err();
    assert!(matches!(error, LoadError::NoFile { .. }), "{error}");
}

#[test]
fn a_file_as_a_folder() {
    let (_folder, file) = file_of(b"");
    let error = Catalogue::new().add_folder(&file).unwrap_err();
    assert!(matches!(error, LoadError::FileForFolder { .. }), "{error}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_device_is_not_read() {
    let error = Catalogue::new()
        .add_file(Path::new("/dev/zero"))
        .unwrap_err();
    assert!(matches!(error, LoadError::NoFile { .. }), "{error}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_link_to_nowhere_in_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    let link = folder.path().join("libgone.so");
    std::os::unix::fs::symlink(folder.path().join("gone"), &link).unwrap();
    let error = Catalogue::new().add_folder(folder.path()).unwrap_err();
    let expected = format!("there is no plugin file {}", link.display());
    assert_eq!(error.to_string(), expected);
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_that_cannot_be_read_is_no_fault_of_a_plugin() {
    let error = Catalogue::new()
        .add_file(Path::new("/proc/self/mem"))
        .unwrap_err();
    assert!(error.is_io(), "{error}");
    assert!(
        error.to_string().starts_with("cannot read /proc/"),
        "{error}"
    );
}

/// These tests patch 64-bit little-endian ELF headers.
#[cfg(all(
    target_os = "linux",
    target_pointer_width = "64",
    target_endian = "little"
))]
mod elf {
    use super::*;

    const MACHINE: usize = 18;
    const PROGRAM_HEADERS: usize = 32;
    const PROGRAM_HEADER_SIZE: usize = 56;
    const LOADABLE: [u8; 4] = [1, 0, 0, 0];

    fn good() -> Vec<u8> {
        fs::read(fixtures::library("constant-arc")).unwrap()
    }

    fn word(bytes: &[u8], at: usize) -> usize {
        u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize
    }

    /// The offsets of the program headers in a library.
    fn program_headers(bytes: &[u8]) -> Vec<usize> {
        let count = usize::from(u16::from_le_bytes([bytes[56], bytes[57]]));
        let first = word(bytes, PROGRAM_HEADERS);
        (0..count)
            .map(|i| first + i * PROGRAM_HEADER_SIZE)
            .collect()
    }

    #[test]
    fn a_library_cut_short_anywhere() {
        let bytes = good();
        let mut lengths: Vec<usize> = (1..40).map(|i| i * bytes.len() / 40).collect();
        lengths.extend([4, 16, 20, 63, 64, 100, bytes.len() - 1]);
        for header in program_headers(&bytes) {
            if bytes[header..header + 4] == LOADABLE {
                let (offset, size) = (word(&bytes, header + 8), word(&bytes, header + 32));
                lengths.extend([offset + 1, offset + size / 2, offset + size - 1]);
            }
        }
        // With less than the magic number it could be any file.
        lengths.retain(|length| *length >= 4);
        for length in lengths {
            let refusal = refusal_of(&bytes[..length]);
            assert_eq!(refusal, Refusal::Truncated, "at {length}");
        }
    }

    #[test]
    fn a_library_without_section_headers_cut_within_a_segment() {
        let mut bytes = good();
        // Without section headers, only the program headers show that bytes are missing.
        bytes[40..48].fill(0);
        bytes[58..64].fill(0);
        bytes.truncate(bytes.len() / 3);
        assert_eq!(refusal_of(&bytes), Refusal::Truncated);
    }

    #[test]
    fn a_library_for_another_processor() {
        let mut bytes = good();
        bytes[MACHINE] = if bytes[MACHINE] == 183 { 62 } else { 183 };
        let Refusal::WrongMachine { found, ours } = refusal_of(&bytes) else {
            panic!("accepted for this processor");
        };
        assert!(
            ["64-bit ARM", "x86-64"].contains(&found.as_str()),
            "{found}"
        );
        assert!(ours.ends_with(" linux"), "{ours}");
    }

    #[test]
    fn a_library_of_another_word_length_or_byte_order() {
        for (offset, other) in [(4, 1), (5, 2)] {
            let mut bytes = good();
            bytes[offset] = other;
            let refusal = refusal_of(&bytes);
            assert!(matches!(refusal, Refusal::WrongMachine { .. }), "{refusal}");
        }
    }

    #[test]
    fn a_library_for_another_system() {
        let mut windows = vec![0; 1024];
        windows[..2].copy_from_slice(b"MZ");
        windows[0x3c] = 0x80;
        windows[0x80..0x84].copy_from_slice(b"PE\0\0");
        windows[0x80 + 24..0x80 + 26].copy_from_slice(&0x20b_u16.to_le_bytes());
        let Refusal::WrongMachine { found, .. } = refusal_of(&windows) else {
            panic!("accepted for this system");
        };
        assert_eq!(found, "Windows");
    }

    #[test]
    fn a_library_whose_headers_point_anywhere() {
        let bytes = good();
        let mut refused = 0;
        for header in program_headers(&bytes) {
            for field in [8, 16, 32, 40] {
                for value in [u64::MAX, 1 << 63, bytes.len() as u64 + 1] {
                    let mut broken = bytes.clone();
                    broken[header + field..header + field + 8]
                        .copy_from_slice(&value.to_le_bytes());
                    let (_folder, file) = file_of(&broken);
                    refused += u32::from(with_file(&file).is_err());
                }
            }
        }
        assert!(refused > 20, "{refused}");
    }

    #[test]
    fn a_library_that_needs_another_that_is_not_there() {
        let mut bytes = good();
        let needed = b"\0libc.so.6\0";
        let offset = bytes.windows(needed.len()).position(|w| w == needed);
        bytes[offset.unwrap() + 4] = b'q';
        let (_folder, file) = file_of(&bytes);
        let message = message(&error_of(&file), &file);
        let expected = "cannot load the plugin libplugin.so: the system's loader refuses it: libq.so.6: \
                        cannot open shared object file: No such file or directory";
        assert_eq!(message, expected);
    }

    /// An unfinished copy has the right length and blocks of zeros.
    #[test]
    fn a_library_with_a_hole_in_its_code() {
        let mut bytes = good();
        let code = |header: &usize| bytes[*header..header + 5] == [1, 0, 0, 0, 5];
        let header = program_headers(&bytes).into_iter().find(code).unwrap();
        let middle = word(&bytes, header + 8) + word(&bytes, header + 32) / 2;
        let hole = middle.next_multiple_of(4096);
        bytes[hole..hole + 4096].fill(0);
        assert_eq!(
            refusal_of(&bytes).to_string(),
            "the file is damaged (a part of it is empty); copy or build it again"
        );
    }

    #[test]
    fn a_library_that_ends_in_zeros() {
        let bytes = good();
        for part in 1..40 {
            let mut broken = bytes.clone();
            broken[part * bytes.len() / 40..].fill(0);
            refusal_of(&broken);
        }
    }
}

/// The code of `unusable-name` can be loaded; the program refuses its name. `zzz` is no library at all.
#[test]
fn of_two_libraries_that_are_refused_the_first_is_named() {
    let folder = fixtures::plugin_folder(&["unusable-name"]);
    fs::write(folder.path().join("zzz.so"), "no library").unwrap();
    let error = Catalogue::new().with_folder(folder.path()).unwrap_err();
    assert!(matches!(error, LoadError::UnusableName { .. }), "{error}");
}

/// They are read through memory that they share. Those of a large folder are hashed as they are read,
/// the copies of others later.
#[test]
fn each_library_of_a_folder_has_the_hash_of_its_own_bytes() {
    for refused in [20u8, 70] {
        let folder = fixtures::plugin_folder(&["conics", "nan", "constant-arc"]);
        let bytes = |i: u8| vec![i; 40_000 / (1 + usize::from(i))];
        for i in 0..refused {
            fs::write(folder.path().join(format!("z{i:02}.so")), bytes(i)).unwrap();
        }
        let libraries = LibraryFile::read_folder(folder.path()).unwrap();
        assert_eq!(libraries.len(), usize::from(refused) + 3);
        // Debug shows a hash that is known, and calculates none.
        let shown = libraries.iter().map(|library| format!("{library:?}"));
        let later = shown.filter(|shown| shown.contains("SourceHash(None)"));
        assert_eq!(later.count(), if refused > 64 { 0 } else { 3 });
        for library in &libraries {
            let bytes = fs::read(library.path()).unwrap();
            let path = library.path().display();
            assert_eq!(library.sha256().unwrap(), sha256_hex(&bytes), "{path}");
        }
        let loadable = libraries
            .iter()
            .filter(|library| library.loadable().is_some());
        assert_eq!(loadable.count(), 3);
    }
}
