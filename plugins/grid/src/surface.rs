//! The strategy: its parameters, and its batches.

use turnpath_maps::{Conventions, Format, Map, Origin, length_unit};
use turnpath_plugin::prelude::*;
use turnpath_plugin::registers::in_widest;

use crate::bending;
use crate::blocks::{Blocks, block};
use crate::cells::Cells;
use crate::low_pass;
use crate::points::{HeightsAt, SlopesAt};
use crate::sheet::Sheet;
use crate::spline::Spline;
use crate::taylor::{HeightsAlong, SlopesAlong};
use crate::trend::Trend;

/// A surface through the points of a map: a tensor B-spline of degree 5.
///
/// Holes are filled, and points beyond the edges are added, so that the bend changes least. The spline
/// is C⁴ everywhere, also beyond the map, and it has a value everywhere.
#[derive(Debug, Clone)]
pub struct GridSag {
    spline: Spline,
    cells: Cells,
    data: SurfaceData,
}

const FILE: Param<File> = Param::file(
    "file",
    "the map: .DAT, .INT, .xyz, .gsf, or .dat of MetroPro",
);
const FORMAT: Param<Choice> = Param::choice(
    "format",
    &["auto", "zemax", "code-v", "xyz", "gsf", "metropro"],
    "the map's format; auto: as its first bytes or its name say",
)
.default("auto");
const UNITS: &[&str] = &["file", "m", "cm", "mm", "um", "nm", "in"];
const XY_UNIT: Param<Choice> = Param::choice(
    "xy_unit",
    UNITS,
    "unit of x, y and distances in the map; file: as the map says",
)
.default("file");
const Z_UNIT: Param<Choice> = Param::choice(
    "z_unit",
    UNITS,
    "unit of heights in the map; file: as the map says",
)
.default("file");
const PITCH_X: Param<Option<Length>> = Param::length(
    "pitch_x",
    "distance of neighbouring points along x; left out: as the map says",
)
.positive()
.optional();
const PITCH_Y: Param<Option<Length>> = Param::length(
    "pitch_y",
    "distance of neighbouring points along y; left out: `pitch_x`, or as the map says",
)
.positive()
.optional();
const ORIGIN: Param<Choice> = Param::choice(
    "origin",
    &["file", "middle"],
    "where the map's origin lies; file: as the map says, else in its middle",
)
.default("file");
const FLIP_X: Param<Flag> = Param::flag("flip_x", "whether x changes its sign").default(false);
const FLIP_Y: Param<Flag> = Param::flag("flip_y", "whether y changes its sign").default(false);
const SMOOTH: Param<Option<Length>> = Param::length(
    "smooth",
    "cutoff of a Gaussian low-pass: a wave of this length keeps half of its height; left out: the spline goes through all points",
)
.positive()
.optional();

/// The shortest cutoff, in pitches. A shorter one would filter nothing.
const SHORTEST_CUTOFF: f64 = 2.0;

/// Cutoffs in the shorter side of the map, at least. With fewer, a filter leaves a plane.
const CUTOFFS: f64 = 2.0;

/// How the map goes on, for reports.
const CONTINUATION: &str = "C4, with its slope and curvature";

/// Points that carry the map on beyond each edge, at least.
const LEAST_MARGIN: usize = 8;

/// The same, at most. More would take time for places that no tool reaches.
const MOST_MARGIN: usize = 64;

/// The margin's share of the shorter side of the map.
const MARGIN_SHARE: usize = 8;

/// The coefficients of a series.
const ALL: usize = ORDER + 1;

impl Strategy for GridSag {
    const NAME: &'static str = "grid-sag";
    const SUMMARY: &'static str = "a spline of degree 5 through the heights of a map";
    const SOURCE: &'static str = "C. de Boor, A Practical Guide to Splines; filter: ISO 16610-61";
    const PARAMS: &'static [ParamInfo] = &[
        FILE.info(),
        FORMAT.info(),
        XY_UNIT.info(),
        Z_UNIT.info(),
        PITCH_X.info(),
        PITCH_Y.info(),
        ORIGIN.info(),
        FLIP_X.info(),
        FLIP_Y.info(),
        SMOOTH.info(),
    ];

    fn new(params: &Params) -> Result<Self> {
        let file = params.get(FILE);
        let map = turnpath_maps::read(&file.path, &file.bytes, &conventions(params));
        let mut map = map.map_err(|error| FILE.refused(format!("{}: {error}", file.path)))?;
        if params.get(FLIP_X) {
            map.flip_x();
        }
        if params.get(FLIP_Y) {
            map.flip_y();
        }
        Self::of(map, params.get(SMOOTH))
    }
}

fn conventions(params: &Params) -> Conventions {
    let format = params.get(FORMAT);
    let format = Format::WORDS.iter().find(|(word, _)| *word == format);
    let pitch_x = params.get(PITCH_X);
    Conventions {
        format: format.map(|(_, format)| *format),
        xy_unit: length_unit(params.get(XY_UNIT)),
        z_unit: length_unit(params.get(Z_UNIT)),
        pitch_x,
        pitch_y: params.get(PITCH_Y).or(pitch_x),
        origin: match params.get(ORIGIN) {
            "middle" => Origin::Middle,
            _ => Origin::File,
        },
    }
}

impl GridSag {
    /// The surface of a map. `smooth` is the cutoff of the low-pass, mm.
    ///
    /// # Errors
    /// When the cutoff does not suit the map.
    pub fn of(map: Map, smooth: Option<f64>) -> Result<Self> {
        let cells = Cells::of(&map);
        let (points, valid) = (map.heights().len(), map.valid());
        let data = SurfaceData {
            points: points as u64,
            filled: (points - valid) as u64,
            continuation: CONTINUATION.into(),
            fit_error: None,
        };
        let pitch = [map.pitch_x(), map.pitch_y()];
        let first = [map.x(0), map.y(0)];
        let mut sheet = Sheet {
            columns: map.columns(),
            rows: map.rows(),
            values: map.into_heights(),
        };
        let trend = Trend::of(&sheet);
        let cutoff = smooth.map(|cutoff| checked(cutoff, pitch, &sheet));
        let cutoff = cutoff.transpose()?;
        trend.add_to(&mut sheet, -1.0);
        // Where the first point lies among those of the file, and how far apart points are there.
        let (mut start, mut step) = ([0.0; 2], [1.0; 2]);
        if let Some(cutoff) = cutoff {
            let [wide, high] = pitch.map(|pitch| block(cutoff, pitch));
            start = [
                middle_of_block(sheet.columns, wide),
                middle_of_block(sheet.rows, high),
            ];
            step = [wide as f64, high as f64];
            let blocks = Blocks::of(&sheet, wide, high);
            let cutoff = [0, 1].map(|axis| cutoff / (pitch[axis] * step[axis]));
            sheet = low_pass::filter(&blocks, cutoff);
        }
        let shorter = sheet.columns.min(sheet.rows);
        let margin = (shorter / MARGIN_SHARE).clamp(LEAST_MARGIN, MOST_MARGIN);
        let mut wide = sheet.with_margin(margin);
        bending::fill(&mut wide, pitch[0] * step[0] / (pitch[1] * step[1]));
        let outer = [0, 1].map(|axis| start[axis] - margin as f64 * step[axis]);
        trend.add_at(&mut wide, 1.0, outer, step);
        let first = [0, 1].map(|axis| first[axis] + pitch[axis] * start[axis]);
        let pitch = [0, 1].map(|axis| pitch[axis] * step[axis]);
        let sheet = wide.without_margin(margin);
        let spline = Spline::carried_on(sheet, wide, margin, first, pitch);
        Ok(Self {
            spline,
            cells,
            data,
        })
    }
}

/// How far the middle of the first block lies from the first point, in points.
fn middle_of_block(count: usize, block: usize) -> f64 {
    ((count % block) / 2) as f64 + 0.5 * (block as f64 - 1.0)
}

fn checked(cutoff: f64, pitch: [f64; 2], sheet: &Sheet) -> Result<f64> {
    let least = SHORTEST_CUTOFF * pitch[0].max(pitch[1]);
    let sides = [
        pitch[0] * sheet.columns as f64,
        pitch[1] * sheet.rows as f64,
    ];
    let most = sides[0].min(sides[1]) / CUTOFFS;
    if (least..=most).contains(&cutoff) {
        return Ok(cutoff);
    }
    Err(SMOOTH.refused(format!(
        "for this map the cutoff lies between {least:.4} mm, two distances of points, and \
         {most:.4} mm, half of its shorter side"
    )))
}

impl SurfaceModel for GridSag {
    fn heights(&self, x: &[f64], y: &[f64], z: &mut [f64]) -> Result<()> {
        same_lengths(x.len(), &[y.len(), z.len()])?;
        let spline = &self.spline;
        in_widest(HeightsAt { spline, x, y, z });
        Ok(())
    }

    fn gradient(&self, x: &[f64], y: &[f64], out: Gradients<'_>) -> Result<()> {
        let Gradients { z, zx, zy } = &out;
        same_lengths(x.len(), &[y.len(), z.len(), zx.len(), zy.len()])?;
        let spline = &self.spline;
        in_widest(SlopesAt { spline, x, y, out });
        Ok(())
    }

    fn series(&self, x: &[Series], y: &[Series], out: GradientSeries<'_>) -> Result<()> {
        self.series_to(SeriesOrders::ALL, x, y, out)
    }

    fn series_to(
        &self,
        orders: SeriesOrders,
        x: &[Series],
        y: &[Series],
        out: GradientSeries<'_>,
    ) -> Result<()> {
        let GradientSeries { z, zx, zy } = &out;
        same_lengths(x.len(), &[y.len(), z.len(), zx.len(), zy.len()])?;
        let spline = &self.spline;
        match (orders.heights, orders.slopes) {
            (0..=1, 0..=1) => in_widest(SlopesAlong::<2, 2, 3> { spline, x, y, out }),
            (0..=2, 0..=2) => in_widest(SlopesAlong::<3, 3, 4> { spline, x, y, out }),
            (_, 0..=2) => in_widest(SlopesAlong::<ALL, 3, ALL> { spline, x, y, out }),
            _ => in_widest(SlopesAlong::<ALL, ALL, { ALL + 1 }> { spline, x, y, out }),
        }
        Ok(())
    }

    fn height_series(&self, x: &[Series], y: &[Series], z: &mut [Series]) -> Result<()> {
        self.height_series_to(ORDER, x, y, z)
    }

    fn height_series_to(
        &self,
        order: usize,
        x: &[Series],
        y: &[Series],
        z: &mut [Series],
    ) -> Result<()> {
        same_lengths(x.len(), &[y.len(), z.len()])?;
        let spline = &self.spline;
        match order {
            0..=2 => in_widest(HeightsAlong::<3> { spline, x, y, z }),
            _ => in_widest(HeightsAlong::<ALL> { spline, x, y, z }),
        }
        Ok(())
    }

    fn beyond_data(&self, x: &[f64], y: &[f64], distance: &mut [f64]) -> Result<()> {
        same_lengths(x.len(), &[y.len(), distance.len()])?;
        for ((distance, x), y) in distance.iter_mut().zip(x).zip(y) {
            *distance = self.cells.distance(*x, *y);
        }
        Ok(())
    }

    fn data(&self) -> Result<Option<SurfaceData>> {
        Ok(Some(self.data.clone()))
    }
}

fn same_lengths(points: usize, others: &[usize]) -> Result<()> {
    match others.iter().find(|length| **length != points) {
        None => Ok(()),
        Some(length) => Err(StrategyError::failed(format!(
            "a batch of {points} points came with a slice of length {length}"
        ))),
    }
}
