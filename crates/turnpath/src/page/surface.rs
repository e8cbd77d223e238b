//! The wanted surface on a grid, and how it differs from the best sphere or plane.

use turnpath_core::{Part, Result, SurfaceModel};
use turnpath_page::{BestFit, SurfaceSketch};
use turnpath_report::Samples;
use turnpath_verify::BestSphere;
use turnpath_verify::machined::Grid;

/// Cells along each side of the surface.
const CELLS: usize = 160;
/// A sphere that bends less than this over the part, mm, is a plane: a thousandth of what any
/// tolerance asks for.
const FLAT: f64 = 1e-9;

/// The surface on the square around its part. Where it has no height it has no cell.
///
/// # Errors
/// When the surface fails.
pub fn surface_sketch(surface: &dyn SurfaceModel, part: &Part) -> Result<SurfaceSketch> {
    let grid = Grid::cartesian(part, CELLS);
    let cells = (0..CELLS).flat_map(|row| (0..CELLS).map(move |column| (row, column)));
    let (x, y): (Vec<f64>, Vec<f64>) = cells.map(|(row, column)| grid.point(row, column)).unzip();
    let mut heights = vec![f64::NAN; x.len()];
    surface.heights(&x, &y, &mut heights)?;
    let on_part = |x: f64, y: f64| {
        let rho = (x * x + y * y).sqrt();
        (part.inner_radius..=part.aperture_radius).contains(&rho)
    };
    for ((x, y), height) in x.iter().zip(&y).zip(&mut heights) {
        if !on_part(*x, *y) || !height.is_finite() {
            *height = f64::NAN;
        }
    }
    let places = x.iter().zip(&y).zip(&heights);
    let places: Vec<[f64; 3]> = places.map(|((x, y), z)| [*x, *y, *z]).collect();
    let known: Vec<[f64; 3]> = places
        .iter()
        .copied()
        .filter(|place| !place[2].is_nan())
        .collect();
    let best = BestSphere::of(&known);
    let deviation = |[x, y, z]: &[f64; 3]| best.map_or(f64::NAN, |best| z - best.height(*x, *y));
    Ok(SurfaceSketch {
        cells: CELLS,
        half: part.aperture_radius,
        deviations: places.iter().map(deviation).collect(),
        heights: Samples(heights),
        best: best.map(|best| best_fit(&best, part)),
    })
}

fn best_fit(best: &BestSphere, part: &Part) -> BestFit {
    let bends = 0.5 * best.curvature() * part.aperture_radius * part.aperture_radius;
    match bends.abs() < FLAT {
        true => BestFit::Plane,
        false => BestFit::Sphere {
            radius: best.radius(),
        },
    }
}
