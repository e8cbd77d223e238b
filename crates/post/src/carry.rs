//! Stretches of a path as a program carries them: the half of writing that all dialects share.

use turnpath_core::toolpath::{ControlPoint, PathBlock, Section, SectionBlock};

use crate::digit_columns::{DigitColumns, MOST_POINTS};
use crate::digits::{Digits, Place, steps_of, turn};
use crate::program_error::ProgramError;
use crate::program_format::ProgramFormat;
use crate::trail::{Move, Trail};

/// Gives the first point and the segments of a stretch in their order, long segments divided; returns
/// the number of their points.
pub(crate) fn carry(
    format: &ProgramFormat,
    stretch: &SectionBlock<'_>,
    write: &mut impl FnMut(Move<'_>),
) -> Result<usize, ProgramError> {
    let mut trail = Trail::new(stretch.points.shape);
    let in_lead = stretch.section != Section::Cutting;
    // The section before a cut is the lead-in, and that before a lead-out is the cut.
    let before_in_lead = in_lead != stretch.opens_section;
    for point in stretch.before {
        trail.go_to(format, (point, before_in_lead), None, &mut |_| {})?;
    }
    let mut count = 0;
    let mut write = |step: Move<'_>| {
        count += step.points();
        write(step);
    };
    let points = stretch.points;
    let mut columns = DigitColumns::new(format, points);
    for first in (0..points.len()).step_by(MOST_POINTS) {
        let range = first..points.len().min(first + MOST_POINTS);
        let columns = columns.as_mut();
        let known = columns.and_then(|columns| columns.find(format, points, range.clone()));
        let segments = known.and_then(|known| trail.segments_to(format, (known, range.len())));
        if let Some(segments) = segments {
            write(Move::Segments(&segments));
            trail.went_along(&segments, points.get(range.end - 1), in_lead);
            continue;
        }
        for (index, point) in range.filter_map(|number| points.get(number)).enumerate() {
            let digits = known.and_then(|columns| columns.at(index));
            trail.go_to(format, (&point, in_lead), digits, &mut write)?;
        }
    }
    Ok(count)
}

/// Points of a program.
#[derive(Debug, Clone, Default)]
pub struct CarriedPoints {
    /// The points.
    pub points: PathBlock,
    /// How many of them, at the beginning, belong to the section before: those between the last point of
    /// a lead-in and the first point of the cut.
    pub of_section_before: usize,
}

/// The points of a stretch as a program carries them: on the controller's steps of time, in the
/// program's digits, C unwrapped, long segments divided.
pub(crate) fn carried(
    format: &ProgramFormat,
    stretch: &SectionBlock<'_>,
) -> Result<CarriedPoints, ProgramError> {
    let mut carried = CarriedPoints {
        points: PathBlock {
            shape: format.shape(),
            ..PathBlock::default()
        },
        of_section_before: 0,
    };
    let mut is_before = leads_into_cut(stretch);
    carry(format, stretch, &mut |step| {
        is_before &= !step.reaches_point();
        carried.of_section_before += usize::from(is_before);
        let points = &mut carried.points;
        match step {
            Move::Start(digits) => points.push(digits.point(format)),
            Move::Segment { segment, .. } => points.push(segment.to.point(format)),
            Move::Segments(segments) => {
                let each = segments.segments();
                each.for_each(|segment| points.push(segment.to.point(format)));
            }
        }
    })?;
    Ok(carried)
}

/// Whether a stretch begins with the way from a lead-in to the cut, which belongs to the lead-in.
pub(crate) fn leads_into_cut(stretch: &SectionBlock<'_>) -> bool {
    stretch.opens_section && stretch.section == Section::Cutting
}

/// Whole turns of C that a program leaves out because it begins within 0 to 360 deg, rad.
pub(crate) fn turns_left_out(
    format: &ProgramFormat,
    first: &ControlPoint,
) -> Result<f64, ProgramError> {
    let place = Place {
        arrival: *first,
        segment: None,
        in_lead: false,
        grid: [0; 3],
    };
    let digits = Digits::at(format, &place, steps_of(format, first))?;
    let left_out = match format.c_wrapped {
        true => digits.position[0].div_euclid(turn(format)),
        false => 0,
    };
    Ok(format.c_sign() * std::f64::consts::TAU * left_out as f64)
}
