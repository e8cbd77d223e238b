//! Walls: places of the part where the height jumps. No tool follows one.
//!
//! Between two points of a smooth surface the height grows by the mean slope times the way, but for
//! a rest that falls with the cube of the way, and at a crease with the way itself. At a wall the
//! rest stays, however short the way is: halving a stretch between two points closes in on it.

use turnpath_core::{Gradients, Part, Scalar, StrategyError, SurfaceModel, even_angles};

use crate::{Link, PipelineError, Result};

/// Circles about the axis on which walls are looked for, besides the innermost one. A wall that crosses no
/// circle and no radius is not found.
const RINGS: usize = 32;
/// Radii on which walls are looked for.
const ANGLES: usize = 360;
/// Lower jumps are none, mm: a nanometre is below what a tool leaves.
const LOWEST: f64 = 1e-6;
/// How often a stretch is halved: a millimetre down to the rounding of its ends.
const HALVINGS: usize = 36;

/// A point of the surface.
#[derive(Debug, Clone, Copy)]
struct Point {
    x: f64,
    y: f64,
    z: f64,
    zx: f64,
    zy: f64,
}

/// Refuses a surface whose height jumps on the part.
pub fn check_walls(surface: &Link<dyn SurfaceModel>, part: &Part) -> Result<()> {
    let mut stretches = stretches(surface, part)?;
    for _ in 0..HALVINGS {
        if stretches.is_empty() {
            return Ok(());
        }
        let middles: Vec<[f64; 2]> = stretches.iter().map(middle).collect();
        let middles = points(surface, &middles)?;
        for (stretch, middle) in stretches.iter_mut().zip(middles) {
            let [from, to] = *stretch;
            let [first, second] = [[from, middle], [middle, to]];
            *stretch = if jump(&first) > jump(&second) {
                first
            } else {
                second
            };
        }
        stretches.retain(is_suspect);
    }
    let highest = stretches
        .iter()
        .max_by(|one, other| jump(one).total_cmp(&jump(other)));
    highest.map_or(Ok(()), |stretch| Err(refused(stretch)))
}

/// The stretches along the rings and along the radii whose height grows by more or less than their
/// slopes say.
fn stretches(surface: &Link<dyn SurfaceModel>, part: &Part) -> Result<Vec<[Point; 2]>> {
    let turned: Vec<(f64, f64)> = even_angles(ANGLES).map(Scalar::sin_cos).collect();
    let width = part.aperture_radius - part.inner_radius;
    let mut found = Vec::new();
    let mut before: Option<Vec<Point>> = None;
    for number in 0..=RINGS {
        let radius = part.inner_radius + width * number as f64 / RINGS as f64;
        let places: Vec<[f64; 2]> = turned
            .iter()
            .map(|(sin, cos)| [radius * cos, radius * sin])
            .collect();
        let ring = points(surface, &places)?;
        let next = ring.iter().cycle().skip(1);
        found.extend(ring.iter().zip(next).map(|(one, other)| [*one, *other]));
        if let Some(inner) = before {
            found.extend(inner.iter().zip(&ring).map(|(one, other)| [*one, *other]));
        }
        before = Some(ring);
        found.retain(is_suspect);
    }
    Ok(found)
}

fn points(surface: &Link<dyn SurfaceModel>, places: &[[f64; 2]]) -> Result<Vec<Point>> {
    let (x, y): (Vec<f64>, Vec<f64>) = places.iter().map(|[x, y]| (*x, *y)).unzip();
    let [mut z, mut zx, mut zy] = [(); 3].map(|()| vec![f64::NAN; x.len()]);
    let out = Gradients {
        z: &mut z,
        zx: &mut zx,
        zy: &mut zy,
    };
    let answer = surface.strategy.gradient(&x, &y, out);
    answer.map_err(|error| surface.failed("on the part", error))?;
    let slopes = zx.into_iter().zip(zy);
    let heights = z.into_iter().zip(slopes);
    let all = places.iter().zip(heights);
    Ok(all
        .map(|([x, y], (z, (zx, zy)))| Point {
            x: *x,
            y: *y,
            z,
            zx,
            zy,
        })
        .collect())
}

fn middle([from, to]: &[Point; 2]) -> [f64; 2] {
    [0.5 * (from.x + to.x), 0.5 * (from.y + to.y)]
}

/// What the height grows by besides the mean slope, mm. It is −∞ where a height or a slope is
/// missing: that is told elsewhere.
fn jump([from, to]: &[Point; 2]) -> f64 {
    let along_x = 0.5 * (from.zx + to.zx) * (to.x - from.x);
    let along_y = 0.5 * (from.zy + to.zy) * (to.y - from.y);
    let rest = (to.z - from.z - along_x - along_y).abs();
    if rest.is_finite() {
        rest
    } else {
        f64::NEG_INFINITY
    }
}

/// Whether the rest is more than a jump that does not count, and than the rounding of the heights.
fn is_suspect(stretch: &[Point; 2]) -> bool {
    let [from, to] = stretch;
    let rounding = 64.0 * f64::EPSILON * from.z.abs().max(to.z.abs());
    jump(stretch) > LOWEST.max(rounding)
}

fn refused(stretch: &[Point; 2]) -> PipelineError {
    let [x, y] = middle(stretch);
    PipelineError::NoSurface(StrategyError::failed(format!(
        "the height jumps by {:.3e} mm at x = {x:.4} mm, y = {y:.4} mm (part); no tool follows a wall",
        jump(stretch)
    )))
}
