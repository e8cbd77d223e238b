//! A whole program is read as the text of its path, or refused.

use std::io::Write;

use super::*;
use crate::{POSTS, ProgramPathInMemory};

/// What happens to the bytes of a file.
type Damage = fn(&mut Vec<u8>);

const STEPS: [[f64; 6]; 4] = [[0.003, 9.0, 2.5, 1.0, -0.2, 5.0]; 4];

fn in_memory(layout: &Layout) -> ProgramPathInMemory {
    let mut writer = ProgramWriter::in_memory(*layout);
    writer
        .append(&lines(layout, &path_of(&STEPS), &[]))
        .unwrap();
    writer.close()
}

/// Whatever modes a header sets, the reader of the path knows nothing of them.
#[test]
fn no_command_of_a_header_changes_how_the_path_is_read() {
    for post in POSTS {
        let layout = plain(post);
        let alone = read_sections(&layout, in_memory(&layout).text()).unwrap();
        for command in [
            "G91",
            "G90",
            "G94",
            "G93",
            "G95",
            "G20",
            "G70",
            "G71",
            "INC",
            "INC(C,X)",
            "ABS",
            "FRAX(X,Z)",
            "TM1",
            "PVT7",
            "DC=IC(3)",
            "VELOCITY OFF",
            "X1 Z2",
            "C5:3 X1:2 Z3:4",
        ] {
            let header = format!("{command}\n{} {command}\n\n", post.comment);
            let whole = in_memory(&layout)
                .assemble([&header, command], "p")
                .unwrap();
            let read = read_sections(&layout, &whole).unwrap();
            assert_eq!(read, alone, "{} {command}", post.name);
        }
    }
}

#[test]
fn a_header_that_hides_the_path_or_a_part_of_it_is_refused_with_its_line() {
    for post in POSTS {
        let layout = plain(post);
        let comment = post.comment;
        for (mark, says) in [
            ("-- cutting --", "a mark of the path stands in the header"),
            ("-- Lead-In --", "a mark of the path stands in the header"),
            ("-- approach --", "a mark of the path stands in the header"),
            ("-- 2 parts --", "a mark of the path stands in the header"),
            (
                "-- end of path: 5 points --",
                "a mark of the path stands in the header",
            ),
            ("-- retreat --", "is out of order"),
            ("the path begins", "the header ends within a line"),
        ] {
            let line = format!("M5\n{comment} {mark}");
            let end = if mark.starts_with("--") { "\n" } else { "" };
            let header = format!("{line}{end}");
            let error = in_memory(&layout).assemble([&header, ""], "p").unwrap_err();
            let said = error.to_string();
            assert!(
                said.contains("p, line 2: ") && said.contains(says),
                "{mark}: {said}"
            );
        }
    }
}

/// A byte that the file has and the text has not, one that it lacks, and another one.
#[test]
fn a_file_with_other_bytes_than_the_measured_text_is_refused() {
    let layout = plain(&POSTS[0]);
    let around = ["OPEN PROG 1 CLEAR\n", "CLOSE\n"];
    let good = in_memory(&layout).assemble(around, "p").unwrap();
    let damages: [(&str, Damage); 4] = [
        ("as it is", |_| {}),
        ("cut off", |bytes| bytes.truncate(bytes.len() - 1)),
        ("longer", |bytes| bytes.push(b'\n')),
        ("another digit", |bytes| {
            let middle = bytes.len() / 2;
            bytes[middle] ^= 1;
        }),
    ];
    for (name, damage) in damages {
        let mut bytes = good.clone();
        damage(&mut bytes);
        let folder = tempfile::tempdir().unwrap();
        let mut file = Draft::begin(folder.path().join("p")).unwrap();
        file.write_all(&bytes).unwrap();
        let whole = crate::WholeProgram {
            file,
            header: around[0].to_owned(),
            text: Some(std::io::Cursor::new(in_memory(&layout).text().to_vec())),
            footer: around[1].to_owned(),
            layout,
        };
        match whole.prove() {
            Ok(_) => assert_eq!(name, "as it is"),
            Err(crate::ReadError::File { error, .. }) => {
                assert!(
                    error.to_string().contains("does not hold the lines"),
                    "{name}: {error}"
                );
                assert_ne!(name, "as it is");
            }
            Err(other) => panic!("{name}: {other}"),
        }
    }
}
