//! Radial profiles: height and slope of the surface along rays from the spindle axis.

use turnpath_core::{Gradients, Result, SurfaceModel, sines_and_cosines};

/// Radial profiles at a set of angles, in batches.
pub(crate) struct Profiles<'a> {
    surface: &'a dyn SurfaceModel,
    sine: Vec<f64>,
    cosine: Vec<f64>,
    x: Vec<f64>,
    y: Vec<f64>,
    zx: Vec<f64>,
    zy: Vec<f64>,
    /// g at the points of the last call.
    pub height: Vec<f64>,
    /// g_ρ at these points.
    pub slope: Vec<f64>,
}

impl<'a> Profiles<'a> {
    /// The profiles at these angles, rad.
    pub fn new(surface: &'a dyn SurfaceModel, theta: &[f64]) -> Self {
        let (mut sine, mut cosine) = (vec![0.0; theta.len()], vec![0.0; theta.len()]);
        sines_and_cosines(theta, &mut sine, &mut cosine);
        let empty = Vec::new;
        let (x, y, zx, zy) = (empty(), empty(), empty(), empty());
        Self {
            surface,
            sine,
            cosine,
            x,
            y,
            zx,
            zy,
            height: empty(),
            slope: empty(),
        }
    }

    /// Sine and cosine of an angle.
    pub fn turned(&self, index: usize) -> (f64, f64) {
        (self.sine[index], self.cosine[index])
    }

    /// Computes height and slope at one radius for each angle.
    pub fn at_all(&mut self, rho: &[f64]) -> Result<()> {
        self.at(rho.iter().copied().enumerate())
    }

    /// Computes height and slope at points (index of the angle, radius).
    pub fn at(&mut self, points: impl Iterator<Item = (usize, f64)> + Clone) -> Result<()> {
        self.x.clear();
        self.y.clear();
        for (index, rho) in points.clone() {
            let (s, c) = self.turned(index);
            self.x.push(rho * c);
            self.y.push(rho * s);
        }
        let count = self.x.len();
        for column in [
            &mut self.height,
            &mut self.slope,
            &mut self.zx,
            &mut self.zy,
        ] {
            column.resize(count, 0.0);
        }
        let out = Gradients {
            z: &mut self.height,
            zx: &mut self.zx,
            zy: &mut self.zy,
        };
        self.surface.gradient(&self.x, &self.y, out)?;
        for (i, (index, _)) in points.enumerate() {
            let (s, c) = self.turned(index);
            self.slope[i] = self.zx[i] * c + self.zy[i] * s;
        }
        Ok(())
    }
}
