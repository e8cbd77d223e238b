//! CODE V grid, `.INT`.
//!
//! Lines that begin with `!` are comments. Then come a title, a line of words, and whole numbers in
//! rows: `GRD nx ny SUR WVL w SSZ s NDA n`. A height is number · w / s, w in µm: s is the number
//! that stands for one wave. NDA is the number that stands for no data. The first number is that of
//! the upper left point; numbers go to the right, rows go down.
//!
//! The file does not say how far its points are apart. Only surfaces (`SUR`) are read: wavefronts
//! and filters are no heights.

use crate::conventions::Conventions;
use crate::error::{MapError, MapProblem};
use crate::map::{Map, Size, turn_rows};
use crate::text::{count, length, lines, number, shown, whole_text, words};

/// A wavelength's unit, mm.
const MICROMETRE: f64 = 1e-3;

/// What the line of words says.
#[derive(Default)]
struct Header {
    size: Option<Size>,
    surface: bool,
    wavelength: Option<f64>,
    scale: Option<f64>,
    no_data: Option<f64>,
}

/// Reads a map.
pub fn read(bytes: &[u8], conventions: &Conventions) -> Result<Map, MapError> {
    conventions.no_z_unit()?;
    let text = whole_text(bytes)?;
    let is_comment = |(_, line): &(usize, &str)| line.starts_with('!');
    // The title may be empty.
    let mut all = (1..)
        .zip(text.lines().map(str::trim))
        .skip_while(is_comment);
    let _title = all.next();
    let Some((line, words)) = all.next() else {
        return Err(MapError::header(
            1,
            "the file has no header: GRD nx ny SUR WVL w SSZ s",
        ));
    };
    let header = header(line, words)?;
    let missing = |what: &'static str| MapError::header(line, format!("the header has no {what}"));
    let size = header.size.ok_or_else(|| missing("`GRD nx ny`"))?;
    let wavelength = header.wavelength.ok_or_else(|| missing("`WVL`"))?;
    let scale = header.scale.ok_or_else(|| missing("`SSZ`"))?;
    if !header.surface {
        return Err(missing("`SUR`"));
    }
    let pitch = conventions.pitch([None, None])?;
    let wanted = size.points();
    if bytes.len() / 2 < wanted {
        let found = numbers(text, line).count();
        return Err(MapError::at_line(
            line,
            MapProblem::TooShort { found, wanted },
        ));
    }
    let unit = wavelength / scale * MICROMETRE;
    let mut heights = Vec::with_capacity(wanted);
    let mut last = line;
    for (line, word) in numbers(text, line) {
        last = line;
        if heights.len() == wanted {
            return Err(MapError::at_line(line, MapProblem::TooLong { wanted }));
        }
        let number = number(line, word)?;
        heights.push(match header.no_data == Some(number) {
            true => f64::NAN,
            false => length(line, number * unit)?,
        });
    }
    if heights.len() < wanted {
        let found = heights.len();
        let problem = MapProblem::TooShort { found, wanted };
        return Err(MapError::at_line(last, problem));
    }
    turn_rows(size.columns, &mut heights);
    Ok(Map::around_origin(size, pitch, heights))
}

/// The numbers after the header, each with its line.
fn numbers(text: &str, header: usize) -> impl Iterator<Item = (usize, &str)> {
    let after = lines(text, &[]).skip_while(move |(line, _)| *line <= header);
    after.flat_map(|(line, text)| words(text).map(move |word| (line, word)))
}

fn header(line: usize, text: &str) -> Result<Header, MapError> {
    let mut header = Header::default();
    let mut words = words(text);
    while let Some(word) = words.next() {
        let mut value = || words.next().unwrap_or_default();
        match word.to_ascii_uppercase().as_str() {
            "GRD" => {
                let size = Size::new(count(line, value())?, count(line, value())?);
                header.size = Some(size.map_err(|problem| MapError::at_line(line, problem))?);
            }
            "SUR" => header.surface = true,
            "WVL" => header.wavelength = Some(positive(line, value())?),
            "SSZ" => header.scale = Some(positive(line, value())?),
            "NDA" => header.no_data = Some(number(line, value())?),
            kind @ ("WFR" | "FIL") => {
                let what = format!("`{kind}` is no surface: only `SUR` has heights");
                return Err(MapError::header(line, what));
            }
            "ZFR" | "ZRN" => {
                let what = "the file has Zernike coefficients, not a grid (`GRD`)";
                return Err(MapError::header(line, what));
            }
            _ => {
                let what = format!("the word `{}` of the header is unknown", shown(word));
                return Err(MapError::header(line, what));
            }
        }
    }
    Ok(header)
}

fn positive(line: usize, word: &str) -> Result<f64, MapError> {
    let number = number(line, word)?;
    match number > 0.0 {
        true => Ok(number),
        false => Err(crate::text::no_number(line, word, "number above zero")),
    }
}
