//! `toolpath.parquet` and `toolpath.npz`: read by the crates of these formats, and held against
//! `toolpath.csv`, number by number.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs::File;
use std::io::Read;

use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use zip::ZipArchive;

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, changed};

/// The saddle with leads, and with these data files.
fn bench(data: &str) -> Bench {
    let recipe = changed(SADDLE, "lead = false", "lead = true");
    Bench::with(&format!("{recipe}\n[output]\ndata = [{data}]\n"))
}

/// The names of the table's columns, and its columns.
fn table(bench: &Bench) -> (Vec<String>, Vec<Vec<f64>>) {
    let text = bench.read("out/toolpath.csv");
    let mut lines = text.lines();
    let names: Vec<String> = lines
        .next()
        .unwrap()
        .split(',')
        .map(str::to_owned)
        .collect();
    let mut columns = vec![Vec::new(); names.len()];
    for line in lines {
        for (column, number) in columns.iter_mut().zip(line.split(',')) {
            column.push(number.parse().unwrap());
        }
    }
    (names, columns)
}

/// The array of an archive with this name, as numpy reads it.
fn array(archive: &mut ZipArchive<File>, name: &str) -> Vec<f64> {
    let mut bytes = Vec::new();
    let mut entry = archive.by_name(&format!("{name}.npy")).unwrap();
    entry.read_to_end(&mut bytes).unwrap();
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
    let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let (header, numbers) = bytes[10..].split_at(length);
    let header = String::from_utf8(header.to_vec()).unwrap();
    let is_section = name == "section";
    let kind = if is_section { "|u1" } else { "<f8" };
    let numbers: Vec<f64> = match is_section {
        true => numbers.iter().map(|byte| f64::from(*byte)).collect(),
        false => {
            let (chunks, rest) = numbers.as_chunks::<8>();
            assert!(rest.is_empty());
            chunks
                .iter()
                .map(|bytes| f64::from_le_bytes(*bytes))
                .collect()
        }
    };
    let says = format!(
        "{{'descr': '{kind}', 'fortran_order': False, 'shape': ({},), }}",
        numbers.len()
    );
    assert_eq!(header.trim_end(), says);
    numbers
}

#[test]
fn an_archive_of_arrays_has_the_columns_of_the_table() {
    let bench = bench("\"csv\", \"npz\"");
    bench.line("run recipe.toml -o out").ends(0);
    let (names, columns) = table(&bench);
    let mut archive = ZipArchive::new(File::open(bench.path("out/toolpath.npz")).unwrap()).unwrap();
    assert_eq!(archive.len(), names.len());
    for (name, column) in names.iter().zip(&columns) {
        assert_eq!(&array(&mut archive, name), column, "{name}");
    }
}

#[test]
fn a_parquet_file_has_the_columns_of_the_table_and_their_units() {
    let bench = bench("\"csv\", \"parquet\"");
    bench.line("run recipe.toml -o out").ends(0);
    let (names, columns) = table(&bench);
    let file = File::open(bench.path("out/toolpath.parquet")).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let mut found = vec![Vec::new(); names.len()];
    for row in reader.get_row_iter(None).unwrap() {
        for (k, (name, field)) in row.unwrap().get_column_iter().enumerate() {
            assert_eq!(name, &names[k]);
            found[k].push(match field {
                Field::Double(number) => *number,
                Field::UByte(section) => f64::from(*section),
                other => panic!("{name}: {other:?}"),
            });
        }
    }
    assert_eq!(found, columns);
    let metadata = reader.metadata().file_metadata();
    let pairs = metadata.key_value_metadata().unwrap();
    for (name, unit) in [("time_s", "s"), ("c_deg", "deg"), ("vx_mm_per_s", "mm/s")] {
        let key = format!("unit of {name}");
        let pair = pairs.iter().find(|pair| pair.key == key).unwrap();
        assert_eq!(pair.value.as_deref(), Some(unit));
    }
}

#[test]
fn files_of_columns_need_no_table_and_have_the_same_bytes_whatever_the_threads() {
    let bench = bench("\"parquet\", \"npz\"");
    bench.line("run recipe.toml -o out --threads 1").ends(0);
    bench.line("run recipe.toml -o again --threads 3").ends(0);
    let files = bench.files();
    assert!(
        !files.iter().any(|file| file.ends_with(".csv")),
        "{files:?}"
    );
    let summary = bench.read("out/summary.json");
    for file in ["toolpath.parquet", "toolpath.npz"] {
        assert!(
            summary.contains(&format!("\"file\": \"{file}\"")),
            "{summary}"
        );
        let read = |folder: &str| std::fs::read(bench.path(format!("{folder}/{file}"))).unwrap();
        assert!(read("out") == read("again"), "{file}");
    }
}

#[test]
fn an_unknown_format_is_underlined_with_the_known_ones() {
    let said = bench("\"parket\"").line("run recipe.toml -o out").ends(2);
    for known in ["no data format named `parket`", "`parquet`", "npz"] {
        assert!(said.stderr.contains(known), "{said}");
    }
}
