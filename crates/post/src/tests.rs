//! A written file reads back, and a damaged file is refused with the line of the damage.

use turnpath_core::toolpath::{ControlPoint, PathBlock, Section};
use turnpath_files::Draft;

use crate::{PathReader, PathWriter, ReadPath};

fn path_of(count: usize) -> PathBlock {
    let mut block = PathBlock::default();
    for i in 0..count {
        let k = i as f64;
        block.push(ControlPoint {
            t: k * 0.1 + 1.0 / 3.0,
            c: k * 0.7,
            x: 2.5 - k / 7.0,
            z: 1e-17 * k,
            vc: 7.0,
            vx: -1.0 / 7.0,
            vz: 1e-16,
        });
    }
    block
}

fn written(text: impl Fn(&str) -> String) -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("toolpath.csv");
    let mut writer = PathWriter::begin(Draft::begin(&path).unwrap()).unwrap();
    let rows = PathWriter::rows(Section::Cutting, &path_of(10));
    writer.append(&rows).unwrap();
    writer.whole().complete().unwrap();
    let good = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text(&good)).unwrap();
    (folder, path)
}

fn refusal(text: impl Fn(&str) -> String) -> String {
    let (folder, path) = written(text);
    let read = PathReader::open(&path).and_then(|mut reader| reader.next_block(100).map(|_| ()));
    let error = read.map(|_| ()).unwrap_err();
    let source = std::error::Error::source(&error).map(ToString::to_string);
    let message = format!("{error} {}", source.unwrap_or_default());
    message.replace(&folder.path().display().to_string(), "")
}

fn with_line(text: &str, index: usize, line: &str) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    lines[index] = line;
    lines.join("\n")
}

#[test]
fn doubles_read_back_unchanged() {
    let (_folder, path) = written(str::to_owned);
    let mut reader = PathReader::open(path).unwrap();
    let (section, block) = reader.next_block(100).unwrap().unwrap();
    assert_eq!(section, Section::Cutting);
    let path = path_of(10);
    assert_eq!((&block.t, &block.x, &block.z), (&path.t, &path.x, &path.z));
    assert_eq!((&block.vx, &block.vz), (&path.vx, &path.vz));
    for (read, written) in block.c.iter().zip(&path.c) {
        assert!((read - written).abs() <= f64::EPSILON * written);
    }
    assert!(reader.next_block(100).unwrap().is_none());
}

#[test]
fn blocks_share_the_point_between_them() {
    let (_folder, path) = written(str::to_owned);
    let mut reader = PathReader::open(path).unwrap();
    let mut next = || reader.next_block(4).unwrap().unwrap().1;
    let (first, second) = (next(), next());
    assert_eq!((first.len(), second.len()), (5, 5));
    assert_eq!(first.t[4], second.t[0]);
    assert_eq!(next().len(), 2);
    assert!(reader.next_block(4).unwrap().is_none());
    assert_eq!(reader.read_count().points(), 10);
}

#[test]
fn the_segment_between_lead_and_cut_belongs_to_the_lead() {
    use Section::{Cutting, LeadIn, LeadOut};
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("toolpath.csv");
    let points: Vec<ControlPoint> = path_of(10).points().collect();
    let sections = [
        LeadIn, LeadIn, LeadIn, Cutting, Cutting, Cutting, Cutting, LeadOut, LeadOut, LeadOut,
    ];
    let blocks = |leave_out: &[Section]| {
        let mut writer = PathWriter::begin(Draft::begin(&path).unwrap()).unwrap();
        for (point, section) in points.iter().zip(sections) {
            if leave_out.contains(&section) {
                continue;
            }
            let mut block = PathBlock::default();
            block.push(*point);
            writer.append(&PathWriter::rows(section, &block)).unwrap();
        }
        writer.whole().complete().unwrap();
        let mut reader = PathReader::open(&path).unwrap();
        let mut found = Vec::new();
        while let Some((section, block)) = reader.next_block(3).unwrap() {
            let number = |t: f64| points.iter().position(|point| point.t == t).unwrap();
            let numbers: Vec<usize> = block.t.iter().map(|t| number(*t)).collect();
            found.push((section, numbers));
        }
        found
    };
    let whole = [
        (LeadIn, vec![0, 1, 2, 3]),
        (Cutting, vec![3, 4, 5, 6]),
        (LeadOut, vec![6, 7, 8, 9]),
    ];
    assert_eq!(blocks(&[]), whole);
    assert_eq!(blocks(&[LeadIn]), whole[1..]);
    assert_eq!(blocks(&[LeadOut]), whole[..2]);
    assert_eq!(blocks(&[LeadIn, LeadOut]), whole[1..2]);
    assert_eq!(blocks(&[Cutting, LeadOut]), [(LeadIn, vec![0, 1, 2])]);
}

#[test]
fn damaged_files_are_refused_with_their_line() {
    assert!(
        refusal(|text| text.replace("time_s", "time")).contains("line 1: this is not the header")
    );
    let short = refusal(|text| with_line(text, 3, "1,2,3"));
    assert!(
        short.contains("line 4: there are 3 values, not 8"),
        "{short}"
    );
    let one = refusal(|text| with_line(text, 3, "1"));
    assert!(one.contains("line 4: there is 1 value, not 8"), "{one}");
    let word = refusal(|text| with_line(text, 3, "1,two,3,4,5,6,7,1"));
    assert!(
        word.contains("line 4: c_deg: invalid float literal"),
        "{word}"
    );
    let nan = refusal(|text| with_line(text, 3, "0.6,100,3,NaN,5,6,7,1"));
    assert!(nan.contains("line 4: z_mm is not a finite number"), "{nan}");
    let vast = refusal(|text| with_line(text, 1, "0,-1e308,3,4,5,6,7,1"));
    assert!(vast.contains("line 2: C = -1e308 deg is more"), "{vast}");
    let late = refusal(|text| with_line(text, 1, "1e14,2,3,4,5,6,7,1"));
    assert!(late.contains("line 2: time_s is 1e14 s"), "{late}");
    let quoted = refusal(|text| with_line(text, 3, "0.6,\"100,3,4,5,6,7,1"));
    assert!(quoted.contains("line 4: c_deg: "), "{quoted}");
    let endless = refusal(|text| text.to_owned() + &"0".repeat(200_000));
    assert!(endless.contains("a line is longer than any"), "{endless}");
    let section = refusal(|text| with_line(text, 3, "1,2,3,4,5,6,7,9"));
    assert!(section.contains("line 4: the section must be"), "{section}");
    let back = refusal(|text| with_line(text, 5, "0.1,2,3,4,5,6,7,1"));
    assert!(back.contains("line 6: the time"), "{back}");
    let turned = refusal(|text| with_line(text, 10, "100,2000,3,4,5,6,7,1"));
    assert!(turned.contains("line 11: C turns by"), "{turned}");
    // A double could not distinguish parts of such a turn.
    let turning = refusal(|text| with_line(text, 1, "0.0,1e14,3,4,5,6,7,1"));
    assert!(
        turning.contains("line 2: C = 1e14 deg is more than"),
        "{turning}"
    );
    let far = refusal(|text| with_line(text, 10, "1e12,1e12,3,4,5,6,7,1"));
    assert!(far.contains("line 11: C turns by 99999999"), "{far}");
}

#[test]
fn a_path_in_memory_has_the_bytes_of_its_file_and_reads_back() {
    let (_folder, path) = written(str::to_owned);
    let mut writer = PathWriter::in_memory();
    let rows = PathWriter::rows(Section::Cutting, &path_of(10));
    writer.append(&rows).unwrap();
    let bytes = writer.into_bytes();
    assert_eq!(bytes, std::fs::read(&path).unwrap());

    let mut memory = PathReader::from_reader(bytes.as_slice(), "memory").unwrap();
    let mut file = PathReader::open(path).unwrap();
    assert_eq!(
        memory.next_block(100).unwrap(),
        file.next_block(100).unwrap()
    );
}

#[test]
fn errors_have_their_causes_as_sources() {
    use std::error::Error;
    let error = PathReader::open("no/such/toolpath.csv")
        .map(|_| ())
        .unwrap_err();
    assert_eq!(error.to_string(), "cannot read no/such/toolpath.csv");
    assert!(error.source().is_some());
}
