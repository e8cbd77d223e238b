//! `turnpath sag`: the surface on a grid, and against a map.

use std::io::{BufWriter, ErrorKind};
use std::path::Path;

use turnpath::report::text;
use turnpath::{
    Catalogue, Error, LARGEST_MAP_LENGTH, LEAST_MAP_PITCH, MapFormat, MapSource, Recipe, SagGaps,
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
        let gaps = write_sag(recipe, catalogue, count, output)?;
        note_gaps(&gaps, count);
        return Ok(Status::Holds);
    }
    let mut writer = BufWriter::new(Output);
    match write_sag_to(recipe, catalogue, count, &mut writer, output) {
        // A reader that has gone, such as `head`, is no failure.
        Err(Error::File(error)) if error.error.kind() == ErrorKind::BrokenPipe => {}
        Err(Error::File(error)) => return Err(Failure::Output(error.error)),
        answer => note_gaps(&answer?, count),
    }
    Ok(Status::Holds)
}

/// Says on standard error how many points of a grid have no height, and how many lie beyond the data of the
/// surface, if some do.
fn note_gaps(gaps: &SagGaps, count: usize) {
    let all = count * count;
    if gaps.beyond_data > 0 {
        let lie = if gaps.beyond_data == 1 {
            "point lies"
        } else {
            "points lie"
        };
        note(&format!(
            "of the part, {} {lie} beyond the data of the surface, by up to {:.3e} mm: there it goes on by itself",
            gaps.beyond_data, gaps.farthest
        ));
    }
    match gaps.missing {
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
