//! A surface that is scaled, moved, turned and lifted.

use std::array::from_fn;
use std::sync::Arc;

use turnpath_core::{
    GradientSeries, Gradients, ORDER, Placement, Result, Scalar, Series, SeriesOrders, SurfaceData,
    SurfaceGap, SurfaceModel,
};

use super::rooms::{CURVES, POINTS, ranges, same_lengths};

/// A surface in its place: scale · f(R(−clocking)(r − decentre)) + piston.
pub struct PlacedSurface {
    surface: Arc<dyn SurfaceModel>,
    placement: Placement,
    /// Sine and cosine of the clocking.
    sin: f64,
    cos: f64,
}

impl PlacedSurface {
    /// Puts a surface in its place.
    pub fn new(surface: Arc<dyn SurfaceModel>, placement: Placement) -> Self {
        let (sin, cos) = Scalar::sin_cos(placement.clocking);
        Self {
            surface,
            placement,
            sin,
            cos,
        }
    }

    /// The place in the surface's own coordinates.
    fn own_points(&self, x: &[f64], y: &[f64], own: &mut [[f64; POINTS]; 2]) {
        let [own_x, own_y] = own;
        for (((u, v), x), y) in own_x.iter_mut().zip(own_y).zip(x).zip(y) {
            let (x, y) = (x - self.placement.decentre_x, y - self.placement.decentre_y);
            (*u, *v) = (self.cos * x + self.sin * y, self.cos * y - self.sin * x);
        }
    }

    fn own_curves(&self, x: &[Series], y: &[Series], own: &mut [[Series; CURVES]; 2]) {
        let [own_x, own_y] = own;
        for (((u, v), x), y) in own_x.iter_mut().zip(own_y).zip(x).zip(y) {
            let (mut x, mut y) = (*x, *y);
            x[0] -= self.placement.decentre_x;
            y[0] -= self.placement.decentre_y;
            *u = from_fn(|k| self.cos * x[k] + self.sin * y[k]);
            *v = from_fn(|k| self.cos * y[k] - self.sin * x[k]);
        }
    }

    fn height(&self, own: f64) -> f64 {
        self.placement.scale * own + self.placement.piston
    }

    /// The slopes along x and y from those in the surface's own coordinates.
    fn slopes(&self, along_u: f64, along_v: f64) -> (f64, f64) {
        let scale = self.placement.scale;
        (
            scale * (self.cos * along_u - self.sin * along_v),
            scale * (self.sin * along_u + self.cos * along_v),
        )
    }

    fn lift(&self, heights: &mut [Series]) {
        for z in heights {
            *z = z.map(|c| self.placement.scale * c);
            z[0] += self.placement.piston;
        }
    }
}

impl SurfaceModel for PlacedSurface {
    fn heights(&self, x: &[f64], y: &[f64], z: &mut [f64]) -> Result<()> {
        same_lengths(x.len(), [y.len(), z.len()])?;
        let mut own = [[0.0; POINTS]; 2];
        for range in ranges(x.len(), POINTS) {
            let (z, count) = (&mut z[range.clone()], range.len());
            self.own_points(&x[range.clone()], &y[range], &mut own);
            self.surface
                .heights(&own[0][..count], &own[1][..count], z)?;
            for z in z {
                *z = self.height(*z);
            }
        }
        Ok(())
    }

    fn gradient(&self, x: &[f64], y: &[f64], out: Gradients<'_>) -> Result<()> {
        let Gradients { z, zx, zy } = out;
        same_lengths(x.len(), [y.len(), z.len(), zx.len(), zy.len()])?;
        let mut own = [[0.0; POINTS]; 2];
        for range in ranges(x.len(), POINTS) {
            let count = range.len();
            self.own_points(&x[range.clone()], &y[range.clone()], &mut own);
            let z = &mut z[range.clone()];
            let (zx, zy) = (&mut zx[range.clone()], &mut zy[range]);
            let answer = Gradients {
                z: &mut *z,
                zx: &mut *zx,
                zy: &mut *zy,
            };
            self.surface
                .gradient(&own[0][..count], &own[1][..count], answer)?;
            for ((z, zx), zy) in z.iter_mut().zip(zx).zip(zy) {
                *z = self.height(*z);
                (*zx, *zy) = self.slopes(*zx, *zy);
            }
        }
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
        let GradientSeries { z, zx, zy } = out;
        same_lengths(x.len(), [y.len(), z.len(), zx.len(), zy.len()])?;
        let mut own = [[[0.0; ORDER + 1]; CURVES]; 2];
        for range in ranges(x.len(), CURVES) {
            let count = range.len();
            self.own_curves(&x[range.clone()], &y[range.clone()], &mut own);
            let z = &mut z[range.clone()];
            let (zx, zy) = (&mut zx[range.clone()], &mut zy[range]);
            let answer = GradientSeries {
                z: &mut *z,
                zx: &mut *zx,
                zy: &mut *zy,
            };
            self.surface
                .series_to(orders, &own[0][..count], &own[1][..count], answer)?;
            self.lift(z);
            for (zx, zy) in zx.iter_mut().zip(zy) {
                for (zx, zy) in zx.iter_mut().zip(zy) {
                    (*zx, *zy) = self.slopes(*zx, *zy);
                }
            }
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
        same_lengths(x.len(), [y.len(), z.len()])?;
        let mut own = [[[0.0; ORDER + 1]; CURVES]; 2];
        for range in ranges(x.len(), CURVES) {
            let (z, count) = (&mut z[range.clone()], range.len());
            self.own_curves(&x[range.clone()], &y[range], &mut own);
            self.surface
                .height_series_to(order, &own[0][..count], &own[1][..count], z)?;
            self.lift(z);
        }
        Ok(())
    }

    fn beyond_data(&self, x: &[f64], y: &[f64], distance: &mut [f64]) -> Result<()> {
        same_lengths(x.len(), [y.len(), distance.len()])?;
        let mut own = [[0.0; POINTS]; 2];
        for range in ranges(x.len(), POINTS) {
            let (distance, count) = (&mut distance[range.clone()], range.len());
            self.own_points(&x[range.clone()], &y[range], &mut own);
            self.surface
                .beyond_data(&own[0][..count], &own[1][..count], distance)?;
        }
        Ok(())
    }

    fn data(&self) -> Result<Option<SurfaceData>> {
        let data = self.surface.data()?;
        let scale = self.placement.scale.abs();
        Ok(data.map(|data| SurfaceData {
            fit_error: data.fit_error.map(|error| error * scale),
            ..data
        }))
    }

    fn gap(&self, x: f64, y: f64) -> Result<Option<SurfaceGap>> {
        let mut own = [[0.0; POINTS]; 2];
        self.own_points(&[x], &[y], &mut own);
        self.surface.gap(own[0][0], own[1][0])
    }
}
