//! Height maps: what a reader takes is a map that keeps its word.

use turnpath_maps::{
    Conventions, Format, LEAST_POINTS, MOST_POINTS, length_unit, read as read_map,
};

/// Words of such files.
pub const WORDS: &[&str] = &[
    "6 6 0.5 0.5 0 0 0\n",
    "0.001 0 0 0 0\n",
    "0 0 0 0 1\n",
    "GRD 6 6 SUR WVL 0.6328 SSZ 32767 NDA -9999\n",
    "WFR",
    "Gwyddion Simple Field 1.0\n",
    "XRes = 6\n",
    "YRes = 6\n",
    "XReal = 0.01\n",
    "XYUnits = m\n",
    "ZUnits = nm\n",
    "0.5, 0.25, 1e-3\n",
    "NaN",
    "inf",
    "-",
    "1e308",
    "99999999999999999999",
    "!",
    "#",
    "\n",
    "\r\n",
    "\0\0\0\0",
];

/// Reads a map in every format, with all that a recipe may say of it, and as it is.
pub fn read(bytes: &[u8]) {
    for (_, format) in Format::WORDS {
        let unit = match format {
            Format::CodeV | Format::MetroPro => None,
            _ => length_unit("mm"),
        };
        check(
            bytes,
            &Conventions {
                format: Some(format),
                xy_unit: length_unit("mm"),
                z_unit: unit,
                pitch_x: Some(0.5),
                pitch_y: Some(0.5),
                ..Conventions::default()
            },
        );
    }
    check(bytes, &Conventions::default());
}

fn check(bytes: &[u8], conventions: &Conventions) {
    let Ok(map) = read_map("map.dat", bytes, conventions) else {
        return;
    };
    let (columns, rows) = (map.columns(), map.rows());
    assert!(columns >= LEAST_POINTS && rows >= LEAST_POINTS);
    assert!(columns * rows <= MOST_POINTS && map.heights().len() == columns * rows);
    assert!(map.valid() > 0 && map.pitch_x() > 0.0 && map.pitch_y() > 0.0);
    // Twice mirrored, it is what it was.
    let mut other = map.clone();
    other.flip_x();
    other.flip_y();
    assert_eq!(
        map.height(0, 0).to_bits(),
        other.height(columns - 1, rows - 1).to_bits()
    );
    other.flip_y();
    other.flip_x();
    let same = |(one, other): (&f64, &f64)| one.to_bits() == other.to_bits();
    assert!(map.heights().iter().zip(other.heights()).all(same));
}
