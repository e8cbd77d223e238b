//! Readers on any bytes and on damaged files: a map that keeps its word, or an error.

#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::path::Path;

use proptest::prelude::*;
use turnpath_maps::{Conventions, Format, LEAST_POINTS, Map, length_unit, read};

/// All that a reader may be told, so that it is never stopped by what is missing.
fn conventions(format: Format) -> Conventions {
    let unit = match format {
        Format::CodeV | Format::MetroPro => None,
        _ => length_unit("mm"),
    };
    Conventions {
        format: Some(format),
        xy_unit: length_unit("mm"),
        z_unit: unit,
        pitch_x: Some(0.5),
        pitch_y: Some(0.5),
        ..Conventions::default()
    }
}

fn check(map: &Map) {
    assert!(map.columns() >= LEAST_POINTS && map.rows() >= LEAST_POINTS);
    assert_eq!(map.heights().len(), map.columns() * map.rows());
    assert!(map.valid() > 0 && map.heights().iter().all(|height| !height.is_infinite()));
    assert!(map.pitch_x() > 0.0 && map.pitch_y() > 0.0);
}

fn files() -> Vec<(Format, Vec<u8>)> {
    let folder = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../tests/reference/grids/files"
    );
    let of =
        |format: Format, name: &str| (format, std::fs::read(Path::new(folder).join(name)).unwrap());
    vec![
        of(Format::Zemax, "zemax-mm.DAT"),
        of(Format::CodeV, "code-v.INT"),
        of(Format::Xyz, "points.xyz"),
        of(Format::Gsf, "field.gsf"),
        of(Format::MetroPro, "metropro-2.dat"),
    ]
}

proptest! {
    #[test]
    fn any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        for (_, format) in Format::WORDS {
            if let Ok(map) = read("a", &bytes, &conventions(format)) {
                check(&map);
            }
        }
    }

    /// Bytes that are lost, exchanged, or replaced by such as texts of numbers have.
    #[test]
    fn damaged_files(
        changes in prop::collection::vec((0.0..1.0_f64, prop::sample::select(
            b"0123456789.-+eEN \n\0\xff".to_vec()), 0..3_u8), 1..6),
    ) {
        for (format, mut bytes) in files() {
            for (share, byte, kind) in &changes {
                let at = ((share * bytes.len() as f64) as usize).min(bytes.len() - 1);
                match kind {
                    0 => bytes[at] = *byte,
                    1 => bytes.insert(at, *byte),
                    _ => { bytes.remove(at); }
                }
            }
            if let Ok(map) = read("a", &bytes, &conventions(format)) {
                check(&map);
            }
            let _ = read("a.dat", &bytes, &Conventions::default());
        }
    }
}
