//! `toolpath.csv`: what the reader takes, the writer writes so that it is read again as the same
//! points.

use turnpath_core::toolpath::PathBlock;
use turnpath_post::{PathReader, PathWriter};

use super::points::{assert_blocks_agree, one_by_one};

const FILE: &str = "toolpath.csv";

/// Words of such files.
pub const WORDS: &[&str] = &[
    "time_s,c_deg,x_mm,z_mm,vc_deg_per_s,vx_mm_per_s,vz_mm_per_s,section\n",
    "0,0,2.5,0,3000,0,0,1\n",
    ",",
    "\n",
    "\r\n",
    "\"",
    "-",
    "1e308",
    "-1e-308",
    "NaN",
    "inf",
    "1e13",
    "360",
    "0",
    "1",
    "2",
    "3",
    "256",
    " ",
    "\u{feff}",
];

/// Reads a tool path's file.
pub fn read(bytes: &[u8]) {
    let new = || PathReader::from_reader(bytes, FILE);
    let Ok(mut reader) = new() else { return };
    let (points, error) = one_by_one(&mut reader);
    assert_blocks_agree(|| new().ok(), &points, error.as_ref());
    // Degrees become radians and degrees again, which may cost the last digit of C. From then on the
    // text stays.
    let first = written(&points);
    let Ok(mut reader) = PathReader::from_reader(first.as_slice(), FILE) else {
        panic!("the writer's own header is refused")
    };
    let (again, _) = one_by_one(&mut reader);
    for ((one, section), (other, of_other)) in points.iter().zip(&again) {
        assert_eq!(section, of_other);
        assert_eq!(
            (one.t, one.x, one.z, one.vx, one.vz),
            (other.t, other.x, other.z, other.vx, other.vz)
        );
        assert!((one.c - other.c).abs() <= 4.0 * f64::EPSILON * one.c.abs());
    }
}

/// The points as the writer of such files writes them.
fn written(points: &[super::points::ReadPoint]) -> Vec<u8> {
    let mut writer = PathWriter::in_memory();
    for (point, section) in points {
        let mut block = PathBlock::default();
        block.push(*point);
        let rows = PathWriter::rows(*section, &block);
        writer.append(&rows).expect("memory takes rows");
    }
    writer.into_bytes()
}
