//! The lens array: equal conicoids on a square or a hexagonal lattice.

use turnpath_plugin::prelude::*;

/// A conicoid about each point of a lattice. Above each (x, y) the one of the nearest lattice point
/// counts.
///
/// One lattice point is the origin. The next ones lie one pitch away: in a square array along x and
/// along y, in a hexagonal array along x and at 60° to it. Lenses meet in seams, where the slope
/// jumps: in ridges if they are concave, in valleys if they are convex. The array goes on beyond the
/// aperture, so it has a height everywhere.
#[derive(Debug, Clone, PartialEq)]
pub struct LensletArray {
    lens: Conicoid,
    layout: Layout,
    pitch: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Layout {
    Square,
    Hexagonal,
}

const LAYOUT: Param<Choice> = Param::choice(
    "layout",
    &["square", "hexagonal"],
    "the lattice of the lenses' centres",
);
const PITCH: Param<Length> =
    Param::length("pitch", "from a lens's centre to the next ones").positive();
const RADIUS: Param<Length> = Param::length(
    "radius",
    "radius of curvature of a lens at its vertex; positive: concave",
)
.nonzero();

/// Rows of a hexagonal lattice lie this many pitches apart: sqrt(3)/2.
const ROW: f64 = 0.866_025_403_784_438_6;

impl Strategy for LensletArray {
    const NAME: &'static str = "lenslet-array";
    const SUMMARY: &'static str = "equal spheres or conicoids on a square or a hexagonal lattice";
    const SOURCE: &'static str = "a conicoid about the nearest point of a lattice; Zemax Lenslet \
        Array has the square one";
    const PARAMS: &'static [ParamInfo] = &[
        LAYOUT.info(),
        PITCH.info(),
        RADIUS.info(),
        Conicoid::CONIC.info(),
    ];

    fn new(params: &Params) -> Result<Self> {
        let (layout, farthest) = match params.get(LAYOUT) {
            "hexagonal" => (Layout::Hexagonal, 1.0 / 3.0),
            _ => (Layout::Square, 0.5),
        };
        let pitch = params.get(PITCH);
        let lens = Conicoid::new(Some(params.get(RADIUS)), params.get(Conicoid::CONIC));
        let lens = lens.ok_or_else(|| RADIUS.refused(Conicoid::TOO_SMALL))?;
        // The square of the distance of a cell's corner from its centre.
        if !lens.reaches(farthest * pitch * pitch) {
            return Err(PITCH.refused("the lenses do not reach the corners of their cells"));
        }
        Ok(Self {
            lens,
            layout,
            pitch,
        })
    }
}

impl Surface for LensletArray {
    #[inline(always)]
    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        let square = match self.layout {
            Layout::Square => from_lattice(x, y, self.pitch, self.pitch),
            Layout::Hexagonal => {
                // Every second row, and the rows between them.
                let (along_x, along_y) = (self.pitch, 2.0 * ROW * self.pitch);
                let between = (x - 0.5 * along_x, y - 0.5 * along_y);
                from_lattice(x, y, along_x, along_y)
                    .min(from_lattice(between.0, between.1, along_x, along_y))
            }
        };
        self.lens.sag(square)
    }
}

/// The squared distance from the nearest point of a rectangular lattice.
#[inline(always)]
fn from_lattice<S: Scalar>(x: S, y: S, along_x: f64, along_y: f64) -> S {
    from_nearest(x, along_x).squared() + from_nearest(y, along_y).squared()
}

/// The distance from the nearest multiple of a spacing.
#[inline(always)]
fn from_nearest<S: Scalar>(x: S, spacing: f64) -> S {
    x - (x / spacing + 0.5).floor() * spacing
}
