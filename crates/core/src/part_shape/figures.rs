//! Height, slope and principal curvatures of a surface at places.

use crate::surface::GradientSeries;
use crate::{
    ORDER, Result, Scalar, Series, SeriesOrders, StrategyError, SurfaceModel, sines_and_cosines,
};

/// The figures of a place: −z, z, the angle of the steepest slope, and the principal curvatures at [`HOLLOW`] and
/// at [`DOMED`].
pub type Figures = [f64; 5];

/// The number of the more hollow principal curvature among the figures.
pub const HOLLOW: usize = 3;
/// The number of the more domed one, which has the other sign.
pub const DOMED: usize = 4;

/// A height, its slopes and their first derivatives: what a curvature needs.
const CURVATURE: SeriesOrders = SeriesOrders {
    heights: 1,
    slopes: 1,
};

/// Places that go through a surface together: their series stay in the first two caches.
const TOGETHER: usize = 128;

/// The memory of a measurement: some places, straight lines through them, and the answers of a surface.
#[derive(Default)]
pub struct FigureRoom {
    places: Vec<(f64, f64)>,
    /// x and y of the lines, which run along x first, and then along y.
    x: Vec<Series>,
    y: Vec<Series>,
    z: Vec<Series>,
    /// z_x and z_y along x.
    of_x: [Vec<Series>; 2],
    /// z_x and z_y along y.
    of_y: [Vec<Series>; 2],
}

impl FigureRoom {
    /// The figures of the surface at each (θ, ρ).
    ///
    /// # Errors
    /// If the surface has no height, slope or curvature there.
    pub fn measure(
        &mut self,
        surface: &dyn SurfaceModel,
        theta: &[f64],
        rho: &[f64],
        out: &mut [Figures],
    ) -> Result<()> {
        let places = theta.chunks(TOGETHER).zip(rho.chunks(TOGETHER));
        for ((theta, rho), out) in places.zip(out.chunks_mut(TOGETHER)) {
            self.take_places(theta, rho);
            self.ask(surface)?;
            self.put_figures(out)?;
        }
        Ok(())
    }

    fn take_places(&mut self, theta: &[f64], rho: &[f64]) {
        let [mut sines, mut cosines] = [[0.0; TOGETHER]; 2];
        let (sines, cosines) = (&mut sines[..theta.len()], &mut cosines[..theta.len()]);
        sines_and_cosines(theta, sines, cosines);
        let rays = sines.iter().zip(&*cosines).zip(rho);
        self.places.clear();
        (self.places).extend(rays.map(|((sine, cosine), rho)| (rho * cosine, rho * sine)));
        let lines = [&mut self.x, &mut self.y, &mut self.z].into_iter();
        for series in lines.chain(&mut self.of_x).chain(&mut self.of_y) {
            series.resize(self.places.len(), [0.0; ORDER + 1]);
        }
    }

    /// Asks the surface for what all figures need.
    fn ask(&mut self, surface: &dyn SurfaceModel) -> Result<()> {
        for ([rate_x, rate_y], [zx, zy]) in
            [([1.0, 0.0], &mut self.of_x), ([0.0, 1.0], &mut self.of_y)]
        {
            let lines = self.x.iter_mut().zip(&mut self.y);
            for ((x, y), place) in lines.zip(&self.places) {
                (x[0], x[1]) = (place.0, rate_x);
                (y[0], y[1]) = (place.1, rate_y);
            }
            let z = &mut self.z;
            surface.series_to(CURVATURE, &self.x, &self.y, GradientSeries { z, zx, zy })?;
        }
        Ok(())
    }

    fn put_figures(&self, out: &mut [Figures]) -> Result<()> {
        for (i, out) in out.iter_mut().enumerate() {
            let [slope_x, slope_y] = [self.of_x[0][i], self.of_x[1][i]];
            let bends = [slope_x[1], slope_y[1], self.of_y[1][i][1]];
            let [most, least] = principal([slope_x[0], slope_y[0]], bends);
            let steepest = Scalar::atan(Scalar::hypot(slope_x[0], slope_y[0]));
            let height = self.z[i][0];
            *out = [-height, height, steepest, most, -least];
            if out.iter().any(|value| !value.is_finite()) {
                return Err(no_height(self.places[i]));
            }
        }
        Ok(())
    }
}

/// The principal curvatures, the larger one first, from the slopes z_x, z_y and from z_xx, z_xy, z_yy.
///
/// In the frame of the steepest slope p = |∇z| the shape has the curvatures z_uu/w³ along it and
/// z_vv/w across, and z_uv/w² between them, with w² = 1 + p².
fn principal([zx, zy]: [f64; 2], [xx, xy, yy]: [f64; 3]) -> [f64; 2] {
    let steep = Scalar::hypot(zx, zy);
    let (cos, sin) = match steep > 0.0 {
        true => (zx / steep, zy / steep),
        false => (1.0, 0.0),
    };
    let w = Scalar::sqrt(1.0 + steep * steep);
    let along = (xx * cos * cos + 2.0 * xy * cos * sin + yy * sin * sin) / (w * w * w);
    let across = (xx * sin * sin - 2.0 * xy * cos * sin + yy * cos * cos) / w;
    let between = ((yy - xx) * cos * sin + xy * (cos * cos - sin * sin)) / (w * w);
    let (mean, half) = (0.5 * (along + across), 0.5 * (along - across));
    let off = Scalar::hypot(half, between);
    [mean + off, mean - off]
}

fn no_height((x, y): (f64, f64)) -> StrategyError {
    StrategyError::failed(format!(
        "the surface has no height, slope or curvature at x = {x:.4} mm, y = {y:.4} mm; choose a \
         smaller aperture"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_surface::Waves;

    /// One room for all counts, so that numbers of earlier places would show.
    #[test]
    fn figures_of_any_number_of_places_are_those_of_single_places() {
        let mut room = FigureRoom::default();
        for count in [3 * TOGETHER + 7, TOGETHER + 1, TOGETHER, TOGETHER - 1, 1, 0] {
            let theta: Vec<f64> = (0..count).map(|i| 0.1 * i as f64).collect();
            let rho: Vec<f64> = (0..count).map(|i| 2.0 - 0.004 * i as f64).collect();
            let mut all = vec![Figures::default(); count];
            room.measure(&Waves, &theta, &rho, &mut all).unwrap();
            for ((theta, rho), figures) in theta.iter().zip(&rho).zip(&all) {
                let mut alone = [Figures::default()];
                let mut fresh = FigureRoom::default();
                fresh
                    .measure(&Waves, &[*theta], &[*rho], &mut alone)
                    .unwrap();
                assert_eq!(*figures, alone[0], "{count}: {theta} {rho}");
            }
        }
    }
}
