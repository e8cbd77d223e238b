//! The sum of several surfaces.

use std::sync::Arc;

use turnpath_core::{
    GradientSeries, Gradients, ORDER, Result, Series, SeriesOrders, SurfaceData, SurfaceGap,
    SurfaceModel,
};

use super::rooms::{CURVES, POINTS, ranges, same_lengths};

/// The sum of the heights of several surfaces. It has a value where all of them have one.
pub struct SurfaceSum {
    surfaces: Vec<Arc<dyn SurfaceModel>>,
}

impl SurfaceSum {
    /// The sum of some surfaces; of none it is the plane z = 0.
    pub fn new(surfaces: Vec<Arc<dyn SurfaceModel>>) -> Self {
        Self { surfaces }
    }
}

fn add(sum: &mut [f64], more: &[f64]) {
    for (sum, more) in sum.iter_mut().zip(more) {
        *sum += more;
    }
}

fn add_series(sum: &mut [Series], more: &[Series]) {
    for (sum, more) in sum.iter_mut().zip(more) {
        add(sum, more);
    }
}

impl SurfaceModel for SurfaceSum {
    fn heights(&self, x: &[f64], y: &[f64], z: &mut [f64]) -> Result<()> {
        same_lengths(x.len(), [y.len(), z.len()])?;
        let mut more = [0.0; POINTS];
        for range in ranges(x.len(), POINTS) {
            let (x, y) = (&x[range.clone()], &y[range.clone()]);
            let (z, more) = (&mut z[range.clone()], &mut more[..range.len()]);
            z.fill(0.0);
            for surface in &self.surfaces {
                surface.heights(x, y, more)?;
                add(z, more);
            }
        }
        Ok(())
    }

    fn gradient(&self, x: &[f64], y: &[f64], out: Gradients<'_>) -> Result<()> {
        let Gradients { z, zx, zy } = out;
        same_lengths(x.len(), [y.len(), z.len(), zx.len(), zy.len()])?;
        let mut more = [[0.0; POINTS]; 3];
        for range in ranges(x.len(), POINTS) {
            let count = range.len();
            let (x, y) = (&x[range.clone()], &y[range.clone()]);
            let z = &mut z[range.clone()];
            let (zx, zy) = (&mut zx[range.clone()], &mut zy[range]);
            for slopes in [&mut *z, &mut *zx, &mut *zy] {
                slopes.fill(0.0);
            }
            for surface in &self.surfaces {
                let [more_z, more_zx, more_zy] = &mut more;
                let answer = Gradients {
                    z: &mut more_z[..count],
                    zx: &mut more_zx[..count],
                    zy: &mut more_zy[..count],
                };
                surface.gradient(x, y, answer)?;
                add(z, more_z);
                add(zx, more_zx);
                add(zy, more_zy);
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
        let mut more = [[[0.0; ORDER + 1]; CURVES]; 3];
        for range in ranges(x.len(), CURVES) {
            let count = range.len();
            let (x, y) = (&x[range.clone()], &y[range.clone()]);
            let z = &mut z[range.clone()];
            let (zx, zy) = (&mut zx[range.clone()], &mut zy[range]);
            for slopes in [&mut *z, &mut *zx, &mut *zy] {
                slopes.fill([0.0; ORDER + 1]);
            }
            for surface in &self.surfaces {
                let [more_z, more_zx, more_zy] = &mut more;
                let answer = GradientSeries {
                    z: &mut more_z[..count],
                    zx: &mut more_zx[..count],
                    zy: &mut more_zy[..count],
                };
                surface.series_to(orders, x, y, answer)?;
                add_series(z, more_z);
                add_series(zx, more_zx);
                add_series(zy, more_zy);
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
        let mut more = [[0.0; ORDER + 1]; CURVES];
        for range in ranges(x.len(), CURVES) {
            let (x, y) = (&x[range.clone()], &y[range.clone()]);
            let (z, more) = (&mut z[range.clone()], &mut more[..range.len()]);
            z.fill([0.0; ORDER + 1]);
            for surface in &self.surfaces {
                surface.height_series_to(order, x, y, more)?;
                add_series(z, more);
            }
        }
        Ok(())
    }

    /// That of the surface whose data are farthest away.
    fn beyond_data(&self, x: &[f64], y: &[f64], distance: &mut [f64]) -> Result<()> {
        same_lengths(x.len(), [y.len(), distance.len()])?;
        let mut more = [0.0; POINTS];
        for range in ranges(x.len(), POINTS) {
            let (x, y) = (&x[range.clone()], &y[range.clone()]);
            let (distance, more) = (&mut distance[range.clone()], &mut more[..range.len()]);
            distance.fill(0.0);
            for surface in &self.surfaces {
                surface.beyond_data(x, y, more)?;
                for (most, more) in distance.iter_mut().zip(&*more) {
                    *most = most.max(*more);
                }
            }
        }
        Ok(())
    }

    /// All data together. They go on in the way of the first that has data, and the errors of fits
    /// add up.
    fn data(&self) -> Result<Option<SurfaceData>> {
        let mut sum: Option<SurfaceData> = None;
        for surface in &self.surfaces {
            if let Some(data) = surface.data()? {
                sum = Some(match sum {
                    None => data,
                    Some(sum) => SurfaceData {
                        points: sum.points + data.points,
                        filled: sum.filled + data.filled,
                        fit_error: both(sum.fit_error, data.fit_error),
                        ..sum
                    },
                });
            }
        }
        Ok(sum)
    }

    /// That of the first surface that knows a reason.
    fn gap(&self, x: f64, y: f64) -> Result<Option<SurfaceGap>> {
        for surface in &self.surfaces {
            if let Some(gap) = surface.gap(x, y)? {
                return Ok(Some(gap));
            }
        }
        Ok(None)
    }
}

/// The sum of two errors, as far as there are any.
fn both(one: Option<f64>, other: Option<f64>) -> Option<f64> {
    one.into_iter()
        .chain(other)
        .reduce(|one, other| one + other)
}
