//! Files that are wrong: the message says where and what.

use turnpath_maps::{Conventions, Format, MapError, length_unit, read};

const MM: Conventions = Conventions {
    format: None,
    xy_unit: Some(1.0),
    z_unit: Some(1.0),
    pitch_x: None,
    pitch_y: None,
    origin: turnpath_maps::Origin::File,
};

fn error(name: &str, bytes: &[u8], conventions: &Conventions) -> String {
    match read(name, bytes, conventions) {
        Ok(map) => panic!("{name} was read: {} × {}", map.columns(), map.rows()),
        Err(MapError { .. }) if bytes.is_empty() && name.is_empty() => String::new(),
        Err(error) => error.to_string(),
    }
}

#[track_caller]
fn says(name: &str, bytes: &[u8], conventions: &Conventions, wanted: &str) {
    let said = error(name, bytes, conventions);
    assert!(said.starts_with(wanted), "{name}: {said}");
}

/// A text of Zemax with one thing changed.
fn sag(header: &str, point: &str, count: usize) -> Vec<u8> {
    let mut text = format!("{header}\n");
    for _ in 1..count {
        text.push_str("0.5 0 0 0 0\n");
    }
    text.push_str(point);
    text.push('\n');
    text.into_bytes()
}

/// A copy that stopped within its last number: `5e-2` has become `5`.
#[test]
fn texts_that_end_within_a_line() {
    let says = |name: &str, text: &str, conventions: &Conventions, line: usize| {
        assert!(
            read(name, format!("{text}\n").as_bytes(), conventions).is_ok(),
            "{name}"
        );
        let wanted = format!("line {line}: the file ends within this line");
        says(name, text.as_bytes(), conventions, &wanted);
    };
    let own = Conventions::default();
    let zemax = format!("6 6 1 1 0 0 0\n{}5", "0.5 0 0 0 0\n".repeat(35));
    says("a.DAT", &zemax, &own, 37);
    let points = (0..36).map(|k| format!("{} {} 0.5", k % 6, k / 6));
    let xyz = points.collect::<Vec<_>>().join("\n");
    says("a.xyz", &xyz, &MM, 36);
    let given = Conventions {
        pitch_x: Some(1.0),
        pitch_y: Some(1.0),
        ..own
    };
    let int = format!(
        "t\nGRD 6 6 SUR WVL 1 SSZ 1 NDA -9999\n{}5",
        "12 ".repeat(35)
    );
    says("a.int", &int, &given, 3);
}

#[test]
fn zemax() {
    const HEADER: &str = "6 6 1 1 0 0 0";
    let own = Conventions::default();
    let says = |bytes: &[u8], wanted: &str| says("a.DAT", bytes, &own, wanted);
    assert!(read("a.DAT", &self::sag(HEADER, "1 0 0 0", 36), &own).is_ok());
    says(b"", "line 1: the file is empty");
    says(b"! nothing\n\n", "line 1: the file is empty");
    says(
        &self::sag("6 6 1 1 4 0 0", "1", 36),
        "line 1: the flag of the units is 4",
    );
    says(
        &self::sag("6 6 1 1 0.5 0 0", "1", 36),
        "line 1: the flag of the units is 0.5",
    );
    says(
        &self::sag("6 6 1 1", "1", 36),
        "line 1: the line has 4 numbers in place of 7",
    );
    says(
        &self::sag("6.5 6 1 1 0 0 0", "1", 36),
        "line 1: `6.5` is no whole number",
    );
    says(
        &self::sag("6 5 1 1 0 0 0", "1", 30),
        "line 1: the grid has 6 × 5 points",
    );
    says(
        &self::sag("6 6 0 1 0 0 0", "1", 36),
        "line 1: the distance of neighbouring points is 0 mm",
    );
    says(
        &self::sag(HEADER, "1 0 0", 35),
        "line 36: the file has 35 points, and its grid has 36",
    );
    says(
        &self::sag(HEADER, "1 0 0 0", 37),
        "line 38: the file goes on after the 36 points",
    );
    says(
        &self::sag(HEADER, "NaN 0 0 0", 36),
        "line 37: `NaN` is no height; a hole has a number and `nodata` 1",
    );
    says(
        &self::sag(HEADER, "1e999 0 0 0", 36),
        "line 37: `1e999` is no finite number",
    );
    says(
        &self::sag(HEADER, "1 0 x 0", 36),
        "line 37: `x` is no number",
    );
    says(
        &self::sag(HEADER, "1 0 0 0 2", 36),
        "line 37: `2` is no flag `nodata`",
    );
    says(
        &self::sag(HEADER, "1 0 0 0 0 0", 36),
        "line 37: the line has 6 numbers",
    );
    // A header that asks for 8 GB ends before any memory is taken.
    says(
        b"1000000 1000 1 1 0 0 0\n1\n",
        "line 1: the grid has 1000000 × 1000 points; a map may have",
    );
    says(
        b"4096 4096 1 1 0 0 0\n1\n",
        "line 1: the file has 1 points, and its grid has 16777216",
    );
    says(
        b"6 18446744073709551615 1 1 0 0 0\n",
        "line 1: the grid has 6 ×",
    );
    says(b"6 6 1 1 0 0 0\n\xff\xfe\n", "line 2: this is not a text");
    let mut holes = self::sag(HEADER, "", 1);
    holes.extend("0 0 0 0 1\n".repeat(36).bytes());
    says(&holes, "no point of the map has a height");
}

#[test]
fn code_v() {
    let given = Conventions {
        pitch_x: Some(1.0),
        pitch_y: Some(1.0),
        ..Conventions::default()
    };
    let file = |header: &str, numbers: usize| {
        format!("! by hand\ntitle\n{header}\n{}\n", "12 ".repeat(numbers)).into_bytes()
    };
    const HEADER: &str = "GRD 6 6 SUR WVL 0.6328 SSZ 32767 NDA -9999";
    let says = |bytes: &[u8], wanted: &str| says("a.int", bytes, &given, wanted);
    assert!(read("a.int", &file(HEADER, 36), &given).is_ok());
    says(b"", "line 1: the file has no header");
    says(
        &file(HEADER, 35),
        "line 4: the file has 35 points, and its grid has 36",
    );
    says(
        &file(HEADER, 37),
        "line 4: the file goes on after the 36 points",
    );
    says(
        &file("GRD 6 6 WFR WVL 0.6328 SSZ 1", 36),
        "line 3: `WFR` is no surface",
    );
    says(
        &file("GRD 6 6 SUR WVL 0.6328", 36),
        "line 3: the header has no `SSZ`",
    );
    says(
        &file("GRD 6 6 SUR WVL -1 SSZ 1", 36),
        "line 3: `-1` is no number above zero",
    );
    says(
        &file("GRD 6 6 SUR WVL 1 SSZ 1 XSC 2", 36),
        "line 3: the word `XSC` of the header is unknown",
    );
    says(
        &file("GRD 99999 99999 SUR WVL 1 SSZ 1", 36),
        "line 3: the grid has 99999 × 99999 points",
    );
    says(
        &file("GRD 4000 4000 SUR WVL 1 SSZ 1", 36),
        "line 3: the file has 36 points",
    );
    says(
        &file("ZFR 36 SUR WVL 1 SSZ 1", 36),
        "line 3: the file has Zernike coefficients",
    );
    let bytes = file(HEADER, 36);
    self::says(
        "a.int",
        &bytes,
        &Conventions::default(),
        "the file does not say how far",
    );
    let with_unit = Conventions {
        z_unit: Some(1.0),
        ..given
    };
    self::says(
        "a.int",
        &bytes,
        &with_unit,
        "the file itself fixes this unit",
    );
}

#[test]
fn xyz() {
    let grid = |place: &dyn Fn(usize, usize) -> (f64, f64)| -> Vec<u8> {
        let mut text = String::new();
        for i in 0..7 {
            for j in 0..6 {
                let (x, y) = place(i, j);
                text.push_str(&format!("{x} {y} 1.5\n"));
            }
        }
        text.into_bytes()
    };
    let even = |i: usize, j: usize| (0.5 * i as f64, 0.25 * j as f64);
    let says = |bytes: &[u8], wanted: &str| says("a.xyz", bytes, &MM, wanted);
    assert!(read("a.xyz", &grid(&even), &MM).is_ok());
    says(b"", "no point of the map has a height");
    says(b"1 2\n", "line 1: the line has 2 numbers in place of 3");
    says(b"# x\n1 2 3 4\n", "line 2: the line has 4 numbers");
    says(b"1 NaN 3\n", "line 1: `NaN` is no finite number");
    says(b"1 2 inf\n", "line 1: `inf` is no number, nor `NaN`");
    says(b"1 2 three\n", "line 1: `three` is no number");
    // One column is off by a tenth of the pitch.
    let uneven = |i: usize, j: usize| (if i == 3 { 1.55 } else { 0.5 * i as f64 }, 0.25 * j as f64);
    says(
        &grid(&uneven),
        "line 19: the points lie on no regular grid: along x 1.55 lies off its place",
    );
    // Distances that grow.
    let growing = |i: usize, j: usize| ((i * i) as f64 * 0.1, j as f64);
    says(
        &grid(&growing),
        "line 7: the points lie on no regular grid: along x",
    );
    // Turned by a degree.
    let turned = |i: usize, j: usize| (i as f64 - 0.0175 * j as f64, j as f64 + 0.0175 * i as f64);
    says(
        &grid(&turned),
        "line 42: the points lie on no regular grid: along x",
    );
    let mut twice = grid(&even);
    twice.extend(b"0.5 0.5 3\n");
    says(&twice, "line 43: this place has a height already");
    let line = |i: usize, _: usize| (i as f64, 0.0);
    says(
        &grid(&line),
        "line 1: the points lie on no regular grid: along y all points",
    );
    let bytes = grid(&even);
    self::says(
        "a.xyz",
        &bytes,
        &Conventions::default(),
        "the file does not say its unit: give `xy_unit`",
    );
}

fn gsf(header: &str, floats: usize) -> Vec<u8> {
    let mut bytes = format!("Gwyddion Simple Field 1.0\n{header}").into_bytes();
    let padding = 4 - bytes.len() % 4;
    bytes.extend(std::iter::repeat_n(0, padding));
    for _ in 0..floats {
        bytes.extend(1.5_f32.to_le_bytes());
    }
    bytes
}

#[test]
fn gwyddion() {
    const HEADER: &str =
        "XRes = 6\nYRes = 6\nXReal = 0.01\nYReal = 0.01\nXYUnits = m\nZUnits = m\n";
    let own = Conventions::default();
    let says = |bytes: &[u8], wanted: &str| says("a.gsf", bytes, &own, wanted);
    assert!(read("a.gsf", &gsf(HEADER, 36), &own).is_ok());
    says(b"XRes = 6\n", "line 1: the file does not begin with");
    says(
        b"Gwyddion Simple Field 1.0\nXRes = 6",
        "line 1: no NUL ends the header",
    );
    says(
        &gsf(HEADER, 35),
        "byte 236: the file has 35 points, and its grid has 36",
    );
    says(
        &gsf(HEADER, 37),
        "byte 240: the file goes on after the 36 points",
    );
    says(&gsf("XRes = 6\n", 36), "line 1: the header has no YRes");
    says(
        &gsf("XRes = six\nYRes = 6\n", 36),
        "line 2: `six` is no whole number",
    );
    says(&gsf("no key\n", 36), "line 2: `no key` is no `key = value`");
    says(
        &gsf(&HEADER.replace("ZUnits = m", "ZUnits = V"), 36),
        "line 7: the unit `V` is unknown",
    );
    says(
        &gsf(&HEADER.replace("ZUnits = m\n", ""), 36),
        "the file does not say its unit: give `z_unit`",
    );
    says(
        &gsf(&HEADER.replace("0.01", "-1"), 36),
        "line 4: the distance of neighbouring points is -166.667 mm",
    );
    says(
        &gsf(&HEADER.replace("= 6", "= 100000"), 36),
        "line 2: the grid has 100000 × 100000 points; a map may have",
    );
    let given = Conventions {
        z_unit: length_unit("um"),
        ..own
    };
    assert!(
        read(
            "a.gsf",
            &gsf(&HEADER.replace("ZUnits = m", "ZUnits = V"), 36),
            &given
        )
        .is_ok()
    );
}

#[test]
fn metropro() {
    let file = |change: &dyn Fn(&mut Vec<u8>)| {
        let mut bytes = vec![0; 834 + 36 * 4];
        let mut put = |at: usize, with: &[u8]| bytes[at..at + with.len()].copy_from_slice(with);
        put(0, &[0x88, 0x1b, 0x03, 0x6f]);
        put(6, &834_u32.to_be_bytes());
        put(68, &[0, 6, 0, 6]);
        for (at, factor) in [(164, 0.5), (168, 632.8e-9), (176, 1.0), (184, 1e-4)] {
            put(at, &f32::to_be_bytes(factor));
        }
        change(&mut bytes);
        bytes
    };
    let own = Conventions::default();
    let says = |bytes: &[u8], wanted: &str| says("a.dat", bytes, &own, wanted);
    assert!(read("a.dat", &file(&|_| ()), &own).is_ok());
    says(
        &file(&|bytes| bytes.truncate(100)),
        "byte 100: the file ends within its header",
    );
    says(
        &file(&|bytes| bytes.truncate(900)),
        "byte 900: the file has 16 points, and its grid has 36",
    );
    says(
        &file(&|bytes| bytes.push(0)),
        "byte 978: the file goes on after the 36 points",
    );
    says(
        &file(&|bytes| bytes[219] = 7),
        "byte 218: a phase resolution of 7 is unknown",
    );
    says(
        &file(&|bytes| bytes[168..172].fill(0)),
        "byte 168: a wavelength of 0 gives no heights",
    );
    says(
        &file(&|bytes| bytes[184..188].fill(0)),
        "the file does not say how far its points are apart",
    );
    says(
        &file(&|bytes| bytes[68..72].fill(0xff)),
        "byte 68: the grid has 65535 × 65535 points",
    );
    says(
        &file(&|bytes| bytes[6..10].fill(0xff)),
        "byte 978: the file has 0 points",
    );
    says(
        &file(&|bytes| bytes[9] = 0),
        "byte 6: a header of 768 bytes is too short",
    );
}

/// Lengths that no part has would become infinite in a spline.
#[test]
fn lengths_that_no_part_has() {
    let own = Conventions::default();
    let zemax = |header: &str, point: &str| {
        let mut file = self::sag(header, "1", 20);
        file.extend(format!("{point}\n").bytes());
        file.extend("0 0 0 0 0\n".repeat(15).bytes());
        file
    };
    const HEADER: &str = "6 6 1 1 0 0 0";
    assert!(read("a.DAT", &zemax(HEADER, "1"), &own).is_ok());
    let says = |name: &str, bytes: &[u8], wanted: &str| self::says(name, bytes, &own, wanted);
    says(
        "a.DAT",
        &zemax(HEADER, "-1e308"),
        "line 22: a length of -1e308 mm",
    );
    // A thousand kilometres in metres.
    let metres = zemax("6 6 1e-3 1e-3 3 0 0", "1.1e6");
    says("a.DAT", &metres, "line 22: a length of 1.1e9 mm");
    says(
        "a.DAT",
        &zemax("6 6 1 1 0 0 1e300", "1"),
        "line 1: a length of 1e300 mm",
    );
    let tiny = zemax("6 6 1e-300 1 0 0 0", "1");
    says(
        "a.DAT",
        &tiny,
        "line 1: the distance of neighbouring points is 1e-300 mm",
    );
    let header = "XRes = 6\nYRes = 6\nXReal = 1\nYReal = 1\nXYUnits = m\nZUnits = m\n";
    let offset = format!("{header}YOffset = 1e12\n");
    says("a.gsf", &gsf(&offset, 36), "line 8: a length of 1e15 mm");
    let mut field = gsf(header, 36);
    let at = field.len() - 4 * 30;
    field[at..at + 4].copy_from_slice(&1e30_f32.to_le_bytes());
    says("a.gsf", &field, &format!("byte {at}: a length of 1e33 mm"));
    let numbers = "1 2 3 4 5 6\n".repeat(6);
    let code_v = format!("title\nGRD 6 6 SUR WVL 1e300 SSZ 1\n{numbers}");
    let given = Conventions {
        pitch_x: Some(1.0),
        pitch_y: Some(1.0),
        ..own
    };
    self::says(
        "a.int",
        code_v.as_bytes(),
        &given,
        "line 3: a length of 1e297 mm",
    );
    self::says(
        "a.xyz",
        b"1 2 3\n1 1e10 3\n",
        &MM,
        "line 2: a length of 1e10 mm",
    );
    self::says("a.xyz", b"1 2 -1e10\n", &MM, "line 1: a length of -1e10 mm");
}

#[test]
fn a_file_of_an_unknown_format() {
    says("map", b"1 2 3", &MM, "the format is unknown: give `format`");
    says("map.png", b"\x89PNG", &MM, "the format is unknown");
    let given = Conventions {
        format: Some(Format::Gsf),
        ..MM
    };
    says(
        "map.png",
        b"\x89PNG",
        &given,
        "line 1: the file does not begin with",
    );
    // Binary rubbish under each name.
    let rubbish: Vec<u8> = (0..4000_u32)
        .map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8)
        .collect();
    for name in ["a.DAT", "a.int", "a.xyz", "a.gsf"] {
        let own = Conventions { z_unit: None, ..MM };
        let conventions = if name == "a.int" { own } else { MM };
        let said = error(name, &rubbish, &conventions);
        assert!(said.starts_with("line 1: "), "{name}: {said}");
    }
}
