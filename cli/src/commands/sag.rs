//! `turnpath sag`: the surface on a grid, and against a map.

use std::io::{BufWriter, ErrorKind};
use std::path::Path;

use turnpath::report::text;
use turnpath::{
    Catalogue, Error, LARGEST_MAP_LENGTH, LEAST_MAP_PITCH, MapFormat, MapSource, Recipe,
    compare_with_map, length_unit, write_sag, write_sag_to,
};
use turnpath_core::Quantity;

use super::output::{is_standard, refuse_output};
use super::setup;
use crate::args::{Format, SagArgs};
use crate::failure::Failure;
use crate::message::note;
use crate::print::{Output, print_report};
use crate::{Outcome, Status};

/// Writes the recipe's surface on a grid over the square around the aperture, or compares a map with
/// it.
pub fn sag(args: &SagArgs, catalogue: Catalogue) -> Outcome {
    let against = args.against.as_deref().map(|file| source(args, file));
    let against = against.transpose()?;
    if against.is_some() {
        refuse_output(args.output.as_deref(), "-o")?;
    }
    let (recipe, catalogue) = setup::recipe(&args.recipe, catalogue)?;
    if let Some(source) = against {
        let report = compare_with_map(&recipe, &catalogue, &source, args.output.as_deref())?;
        print_report(
            Some(args.format.unwrap_or(Format::Human)),
            &report,
            text::map_comparison,
        )?;
        return Ok(Status::Holds);
    }
    match (args.grid, args.output.as_deref()) {
        (Some(count), Some(output)) => write(&recipe, &catalogue, count as usize, output),
        // The arguments require both where there is no map.
        _ => Err(Failure::Call("give --grid and -o, or --against".to_owned())),
    }
}

fn write(recipe: &Recipe, catalogue: &Catalogue, count: usize, output: &Path) -> Outcome {
    if !is_standard(output) {
        let missing = write_sag(recipe, catalogue, count, output)?;
        note_missing(missing, count);
        return Ok(Status::Holds);
    }
    let mut writer = BufWriter::new(Output);
    match write_sag_to(recipe, catalogue, count, &mut writer, output) {
        // A reader that has gone, such as `head`, is no failure.
        Err(Error::File(error)) if error.error.kind() == ErrorKind::BrokenPipe => {}
        Err(Error::File(error)) => return Err(Failure::Output(error.error)),
        answer => note_missing(answer?, count),
    }
    Ok(Status::Holds)
}

/// Says on standard error how many points of a grid have no height, if some have none.
fn note_missing(missing: usize, count: usize) {
    let all = count * count;
    match missing {
        0 => {}
        1 => note(&format!(
            "1 of {all} points has no height: it lies beyond the part"
        )),
        some => note(&format!(
            "{some} of {all} points have no height: they lie beyond the part"
        )),
    }
}

/// The map that the arguments name.
fn source(args: &SagArgs, file: &Path) -> Result<MapSource, Failure> {
    let map = &args.map;
    let pitch = map.pitch.as_deref().map(|text| {
        let refused = |why: String| Failure::Call(format!("--pitch: {why}"));
        let parsed = Quantity::Length.parse(text);
        match parsed.map_err(|error| refused(error.to_string()))? {
            pitch if (LEAST_MAP_PITCH..=LARGEST_MAP_LENGTH).contains(&pitch) => Ok(pitch),
            _ => Err(refused(format!(
                "the distance of neighbouring points lies between {LEAST_MAP_PITCH:e} mm and \
                 {LARGEST_MAP_LENGTH:e} mm"
            ))),
        }
    });
    let format = map.map_format.as_deref().and_then(MapFormat::of_word);
    Ok(MapSource {
        file: file.to_owned(),
        format,
        xy_unit: unit("--xy-unit", map.xy_unit.as_deref())?,
        z_unit: unit("--z-unit", map.z_unit.as_deref())?,
        pitch: pitch.transpose()?,
        flip_x: map.flip_x,
    })
}

fn unit(option: &str, name: Option<&str>) -> Result<Option<f64>, Failure> {
    let found = name.map(|name| {
        length_unit(name).ok_or_else(|| {
            Failure::Call(format!(
                "{option}: the unit `{name}` is unknown: m, cm, mm, um, nm and in are known"
            ))
        })
    });
    found.transpose()
}
