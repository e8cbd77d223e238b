//! Programs that are compressed: the same text, and damage that is refused.

use std::io::Read;

use super::{assembled, lines, path_of, plain};
use crate::text_file::file_bytes;
use crate::{Amount, Compression, POSTS, ProgramWriter, ReadError, ReadPath, text_name};

/// Programs of all posts with the names of their files, in one file and in parts where the post has calls.
fn programs() -> Vec<Vec<(String, Vec<u8>)>> {
    let points: Vec<[f64; 6]> = (1..=60)
        .map(|k| [0.003, 9.0, 2.5, f64::from(k % 3), 0.0, 0.0])
        .collect();
    let mut programs = Vec::new();
    for post in POSTS {
        let layout = plain(post);
        let lines = lines(&layout, &path_of(&points), &[]);
        let name = format!("Part.{}", post.extension);
        programs.push(vec![(
            name.clone(),
            assembled(&layout, &lines).into_bytes(),
        )]);
        let mut writer = ProgramWriter::in_memory(layout);
        writer.append(&lines).unwrap();
        let frame = ["OPEN PROG 1 CLEAR\n", "CLOSE\n"];
        let parts = writer.close().assemble_parts(
            frame,
            (&name, super::parts::limits(Amount::Blocks(25), None)),
        );
        programs.extend(parts.ok());
    }
    programs
}

fn decompressed(bytes: &[u8]) -> Vec<u8> {
    zstd::decode_all(bytes).unwrap()
}

/// The same files, each compressed.
fn compressed(files: &[(String, Vec<u8>)]) -> Vec<(String, Vec<u8>)> {
    let compress = |(name, text): &(String, Vec<u8>)| {
        let file = Compression::Zst.file_of(name);
        let bytes = file_bytes(&file, text.clone()).unwrap();
        (file, bytes)
    };
    files.iter().map(compress).collect()
}

/// All points of a program in memory, or the message.
fn points(files: &[(String, Vec<u8>)]) -> Result<Vec<String>, String> {
    let text = text_name(&files[0].0);
    let (_, extension) = text.rsplit_once('.').unwrap();
    let layout = plain(crate::post_of_extension(extension).unwrap());
    let said = |error: ReadError| format!("{error}: {:?}", std::error::Error::source(&error));
    let mut reader = layout.read_files(files.to_vec()).map_err(said)?;
    let mut points = Vec::new();
    while let Some(point) = reader.next_point().map_err(said)? {
        points.push(format!("{point:?}"));
    }
    Ok(points)
}

#[test]
fn a_compressed_program_has_the_text_and_reads_back_as_the_one_that_is_not() {
    let programs = programs();
    assert!(programs.len() > POSTS.len() + 4);
    for files in programs {
        let expected = points(&files).unwrap();
        assert_eq!(expected.len(), 61, "{}", files[0].0);
        let zst = compressed(&files);
        assert_eq!(points(&zst).unwrap(), expected, "{}", files[0].0);
        for ((_, text), (file, bytes)) in files.iter().zip(&zst) {
            assert_eq!(&decompressed(bytes), text, "{file}");
            assert!(bytes.len() < text.len(), "{file}");
        }
    }
}

#[test]
fn a_writer_compresses_by_the_name_of_the_file_with_the_same_text_in_parts_and_in_one() {
    let layout = plain(crate::post_named("beckhoff-g93").unwrap());
    let points: Vec<[f64; 6]> = (1..=60).map(|_| [0.003, 9.0, 2.5, 0.1, 0.0, 0.0]).collect();
    let lines = lines(&layout, &path_of(&points), &[]);
    let parts = |file: &str| {
        let mut writer = ProgramWriter::in_memory(layout);
        writer.append(&lines).unwrap();
        let most = Amount::Blocks(25);
        writer
            .close()
            .assemble_parts(["", ""], (file, super::parts::limits(most, None)))
            .unwrap()
    };
    let (text, zst) = (parts("part.cnc"), parts("part.cnc.zst"));
    assert!(text.len() > 3);
    for ((name, text), (file, bytes)) in text.iter().zip(&zst) {
        assert_eq!(file, &format!("{name}.zst"));
        assert_eq!(&decompressed(bytes), text, "{file}");
        // In a folder the text comes in other pieces.
        assert_eq!(bytes, &file_bytes(file, text.clone()).unwrap(), "{file}");
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("part.cnc.zst");
    let draft = turnpath_files::Draft::begin(&path).unwrap();
    let mut writer = ProgramWriter::begin(draft, layout).unwrap();
    writer.append(&lines).unwrap();
    let whole = writer.close().unwrap().assemble(["", ""]).unwrap();
    whole.prove().unwrap().complete().unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let mut reader = layout.open(&path).unwrap();
    let mut found = 0;
    while reader.next_point().unwrap().is_some() {
        found += 1;
    }
    assert_eq!(found, 61);
    let text = String::from_utf8(decompressed(&bytes)).unwrap();
    assert!(text.contains("-- end of path: 61 points --"));
}

/// A changed byte or a file that is cut short is refused with the file's name. Some bits of a frame mean
/// nothing to its text: one of its header, the memory that it asks for, and codes of which several give the
/// same text. Then the points are the same.
#[test]
fn a_damaged_file_is_refused_and_never_read_as_another_path() {
    for files in programs().into_iter().step_by(4) {
        let zst = compressed(&files);
        let expected = points(&zst).unwrap();
        for (k, (file, bytes)) in zst.iter().enumerate() {
            let damaged = |bytes: Vec<u8>| {
                let mut damaged = zst.clone();
                damaged[k].1 = bytes;
                damaged
            };
            let mut accepted = 0;
            for place in 0..bytes.len() {
                let mut changed = bytes.clone();
                changed[place] ^= 1 << (place % 8);
                match points(&damaged(changed)) {
                    Ok(points) => {
                        assert_eq!(points, expected, "{file} {place}");
                        accepted += 1;
                    }
                    Err(said) => assert!(said.contains(file.as_str()), "{said}"),
                }
                let cut = points(&damaged(bytes[..place].to_vec()));
                assert!(cut.unwrap_err().contains(file.as_str()), "{file} {place}");
            }
            assert!(accepted * 20 < bytes.len(), "{file}: {accepted}");
        }
    }
}

/// Without its sum a changed byte may give another text of the same form.
#[test]
fn a_frame_without_a_sum_and_a_second_frame_are_refused() {
    let files = &programs()[0];
    let zst = compressed(files);
    let with = |bytes: Vec<u8>| {
        let mut others = zst.clone();
        others[0].1 = bytes;
        points(&others)
    };
    let encode = |text: &[u8], sum: bool| {
        let mut encoder = zstd::Encoder::new(Vec::new(), 3).unwrap();
        encoder.include_checksum(sum).unwrap();
        std::io::Write::write_all(&mut encoder, text).unwrap();
        encoder.finish().unwrap()
    };
    let text = &files[0].1;
    assert_eq!(with(encode(text, true)), points(&zst));
    let said = with(encode(text, false)).unwrap_err();
    assert!(
        said.contains(&zst[0].0) && said.contains("no sum of its contents"),
        "{said}"
    );
    // One whose flag was changed.
    let mut changed = zst[0].1.clone();
    changed[4] &= !4;
    assert!(with(changed).is_err());
    let more = [encode(text, true), encode(b"M30\n", false)].concat();
    let said = with(more).unwrap_err();
    assert!(said.contains("behind the text"), "{said}");
    let skipped = [
        &[0x53, 0x2A, 0x4D, 0x18, 0, 0, 0, 0][..],
        &encode(text, false),
    ]
    .concat();
    assert!(with(skipped).unwrap_err().contains("no sum"));
}

#[test]
fn text_that_is_no_program_ends_early_however_much_of_it_there_is() {
    const FRAME: usize = 1 << 26;
    // This file has 64 GiB and a few bytes.
    let frame = file_bytes("lines.zst", vec![b'\n'; FRAME]).unwrap();
    let mut file = Vec::new();
    for _ in 0..=1 << 10 {
        file.extend_from_slice(&frame);
    }
    assert!(file.len() < 1 << 24, "{}", file.len());
    let said = points(&[("part.pmc.zst".to_owned(), file)]).unwrap_err();
    assert!(said.contains("no point of a path in 8 MiB"), "{said}");
    // A line without an end.
    let frame = file_bytes("line.zst", vec![b'C'; FRAME]).unwrap();
    let said = points(&[("part.pmc.zst".to_owned(), frame)]).unwrap_err();
    assert!(said.contains("longer than any line"), "{said}");
}

/// A frame may ask its reader to hold as much of the text as it says.
#[test]
fn a_frame_that_asks_for_a_gigabyte_of_memory_is_refused() {
    let mut encoder = zstd::Encoder::new(Vec::new(), 3).unwrap();
    encoder.include_checksum(true).unwrap();
    encoder.window_log(30).unwrap();
    std::io::copy(&mut std::io::repeat(b'\n').take(1 << 21), &mut encoder).unwrap();
    let file = encoder.finish().unwrap();
    let said = points(&[("part.pmc.zst".to_owned(), file)]).unwrap_err();
    assert!(
        said.contains("part.pmc.zst") && said.contains("memory"),
        "{said}"
    );
}
