//! How far the part and its overrun leave the data that the surface was made from.

use turnpath_core::{RadialRange, Scalar, SurfaceData, SurfaceModel, even_angles};

use crate::contact::contact_range;
use crate::{Link, LocusLinks, Preparation, Result};

/// Rings of the part that are looked at: what is missing on less than a hundredth of the diameter is
/// filled as well as a grain of dust is.
const RINGS: usize = 50;
/// Angles on a ring.
const ANGLES: usize = 360;
/// A distance from the data below this is rounding of their edge, mm.
pub const ON_DATA: f64 = 1e-9;

/// The place that lies farthest beyond the data.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Farthest {
    /// How far it lies beyond them, mm.
    pub distance: f64,
    /// Its radius on the part, mm.
    pub radius: f64,
    /// Its angle, rad.
    pub angle: f64,
}

/// The data of a surface, and how far the path leaves them.
#[derive(Debug, Clone, PartialEq)]
pub struct DataReach {
    /// The data.
    pub data: SurfaceData,
    /// The farthest place of the part; `None` where the part lies on data.
    pub part: Option<Farthest>,
    /// The farthest place of the overrun, as far as the nose makes contact there; `None` where that
    /// is nowhere farther away than the part is.
    pub overrun: Option<Farthest>,
}

/// How far the path leaves the data that the surface was made from; `None` for formulas.
///
/// # Errors
/// When a strategy fails.
pub fn data_reach(links: &LocusLinks, preparation: &Preparation) -> Result<Option<DataReach>> {
    let surface = &links.surface;
    let data = surface.strategy.data();
    let data = data.map_err(|error| surface.failed("for its data", error))?;
    let Some(data) = data else { return Ok(None) };
    let task = &preparation.task;
    let part = RadialRange {
        inner: task.part.inner_radius,
        outer: task.part.aperture_radius,
    };
    let step = (part.outer - part.inner) / RINGS as f64;
    let rings = (0..=RINGS).map(|ring| part.inner + step * ring as f64);
    let on_part = farthest(surface, rings)?;
    let contact = contact_range(links, &preparation.locus, &task.tool, task.range)?;
    let ends = [contact.inner, contact.outer].into_iter();
    let beyond = ends.filter(|radius| *radius < part.inner || *radius > part.outer);
    let overrun = farthest(surface, beyond)?;
    let least = on_part.map_or(ON_DATA, |place| place.distance + ON_DATA);
    Ok(Some(DataReach {
        data,
        part: on_part,
        overrun: overrun.filter(|place| place.distance > least),
    }))
}

/// The place on some rings that lies farthest beyond the data, if one does.
fn farthest(
    surface: &Link<dyn SurfaceModel>,
    rings: impl Iterator<Item = f64>,
) -> Result<Option<Farthest>> {
    let turn: Vec<(f64, (f64, f64))> = even_angles(ANGLES)
        .map(|angle| (angle, Scalar::sin_cos(angle)))
        .collect();
    let mut most: Option<Farthest> = None;
    let mut distances = vec![0.0; ANGLES];
    for radius in rings {
        let places = turn.iter().map(|(_, (s, c))| (radius * c, radius * s));
        let (x, y): (Vec<f64>, Vec<f64>) = places.unzip();
        let answer = surface.strategy.beyond_data(&x, &y, &mut distances);
        let context = "for the distance from its data";
        answer.map_err(|error| surface.failed(context, error))?;
        for (distance, (angle, _)) in distances.iter().zip(&turn) {
            if *distance > most.map_or(ON_DATA, |most| most.distance) {
                most = Some(Farthest {
                    distance: *distance,
                    radius,
                    angle: *angle,
                });
            }
        }
    }
    Ok(most)
}
