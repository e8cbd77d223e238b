//! A surface in the frame of a part that lies on it.

use std::array::from_fn;
use std::sync::Arc;

use turnpath_core::{
    GradientSeries, Gradients, ORDER, Pose, Result, Scalar, Series, StrategyError, SurfaceData,
    SurfaceModel, Taylor,
};

use super::frame::Frame;
use super::rooms::{CURVES, POINTS, ranges, same_lengths};
use super::root::{Guess, Roots, Search};

/// A surface in the frame of a part that lies on it. The part's middle is the origin.
///
/// The height is where the line along the part's z axis meets the surface. Its slopes follow from
/// the surface's by the theorem of implicit functions. Where the line meets no surface, or only
/// below an overhang, the height is NaN.
pub struct PosedSurface {
    surface: Arc<dyn SurfaceModel>,
    frame: Frame,
    guess: Guess,
}

/// Why a surface has no pose.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PoseError {
    /// The surface has no height, or no slope, at the part's middle.
    #[error("the surface has no height at the part's middle")]
    NoMiddle,
    /// The surface is turned so far that it overhangs at the part's middle.
    #[error("turned so far, the surface overhangs at the part's middle")]
    Overhang,
    /// The surface failed.
    #[error(transparent)]
    Strategy(#[from] StrategyError),
}

/// Curves in the surface's own coordinates.
type Curves = [[Series; CURVES]; 3];

const BLANK: Series = [0.0; ORDER + 1];

impl PosedSurface {
    /// Poses a surface.
    ///
    /// # Errors
    /// When the surface has no height at the part's middle, overhangs there, or fails.
    pub fn new(surface: Arc<dyn SurfaceModel>, pose: Pose) -> std::result::Result<Self, PoseError> {
        let [mut z, mut zx, mut zy] = [[f64::NAN]; 3];
        let out = Gradients {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        surface.gradient(&[pose.x], &[pose.y], out)?;
        let [height, zx, zy] = [z[0], zx[0], zy[0]];
        if !(height + zx + zy).is_finite() {
            return Err(PoseError::NoMiddle);
        }
        let frame = Frame::new(pose, height, (zx, zy));
        if frame.rates(zx, zy)[2] <= 0.0 {
            return Err(PoseError::Overhang);
        }
        let mut posed = Self {
            surface,
            frame,
            guess: Guess::default(),
        };
        let [along_x, along_y, rate] = posed.frame.rates(zx, zy);
        posed.guess = Guess {
            slope_x: -along_x / rate,
            slope_y: -along_y / rate,
            bends: posed.bends_at_middle()?,
        };
        Ok(posed)
    }

    /// Bends at the part's middle; zero where the surface has no series there.
    fn bends_at_middle(&self) -> Result<[f64; 3]> {
        let (still, moving) = (BLANK, [0.0, 1.0, 0.0, 0.0, 0.0]);
        let [mut z, mut zx, mut zy] = [[BLANK; 2]; 3];
        let out = GradientSeries {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        self.series(&[moving, still], &[still, moving], out)?;
        let bends = [zx[0][1], zx[1][1], zy[1][1]];
        Ok(match bends.iter().all(|bend| bend.is_finite()) {
            true => bends,
            false => [0.0; 3],
        })
    }

    fn find(&self, x: &[f64], y: &[f64], roots: &mut Roots) -> Result<()> {
        let surface = self.surface.as_ref();
        Search::new(surface, &self.frame, &self.guess, (x, y), roots).run()
    }

    /// The heights along at most [`CURVES`] curves, and the curves themselves in the surface's
    /// coordinates.
    ///
    /// Order 0 is the root, order 1 follows from its slopes. A pass over the surface's series then
    /// gives one order more: with all orders of the height below k right and order k left at 0, the
    /// gap's coefficient of order k is −rate times that of the height.
    fn lift(&self, x: &[Series], y: &[Series], z: &mut [Series], own: &mut Curves) -> Result<()> {
        let (mut roots, count) = (Roots::BLANK, x.len());
        let [start_x, start_y] = [x, y].map(|curves| -> [f64; CURVES] {
            from_fn(|i| curves.get(i).map_or(0.0, |curve| curve[0]))
        });
        self.find(&start_x[..count], &start_y[..count], &mut roots)?;
        for (i, z) in z.iter_mut().enumerate() {
            let first = roots.zx[i] * x[i][1] + roots.zy[i] * y[i][1];
            *z = [roots.z[i], first, 0.0, 0.0, 0.0];
            let (x, y, z) = (Taylor(x[i]), Taylor(y[i]), Taylor(*z));
            for (axis, own) in own.iter_mut().enumerate() {
                own[i] = self.frame.coordinate(axis, x, y, z).0;
            }
        }
        let mut below = [BLANK; CURVES];
        let [own_x, own_y, own_z] = own;
        for order in 2..=ORDER {
            let below = &mut below[..count];
            self.surface
                .height_series(&own_x[..count], &own_y[..count], below)?;
            for (i, (z, below)) in z.iter_mut().zip(below).enumerate() {
                let more = (below[order] - own_z[i][order]) / roots.rate[i];
                z[order] = more;
                for (axis, own) in [&mut *own_x, &mut *own_y, &mut *own_z]
                    .into_iter()
                    .enumerate()
                {
                    own[i][order] += self.frame.z_axis[axis] * more;
                }
            }
        }
        Ok(())
    }
}

impl SurfaceModel for PosedSurface {
    fn heights(&self, x: &[f64], y: &[f64], z: &mut [f64]) -> Result<()> {
        same_lengths(x.len(), [y.len(), z.len()])?;
        let mut roots = Roots::BLANK;
        for range in ranges(x.len(), POINTS) {
            self.find(&x[range.clone()], &y[range.clone()], &mut roots)?;
            let count = range.len();
            z[range].copy_from_slice(&roots.z[..count]);
        }
        Ok(())
    }

    fn gradient(&self, x: &[f64], y: &[f64], out: Gradients<'_>) -> Result<()> {
        let Gradients { z, zx, zy } = out;
        same_lengths(x.len(), [y.len(), z.len(), zx.len(), zy.len()])?;
        let mut roots = Roots::BLANK;
        for range in ranges(x.len(), POINTS) {
            self.find(&x[range.clone()], &y[range.clone()], &mut roots)?;
            let count = range.len();
            z[range.clone()].copy_from_slice(&roots.z[..count]);
            zx[range.clone()].copy_from_slice(&roots.zx[..count]);
            zy[range].copy_from_slice(&roots.zy[..count]);
        }
        Ok(())
    }

    /// Once the height is right to the last order, one call of the surface gives slopes that are.
    fn series(&self, x: &[Series], y: &[Series], out: GradientSeries<'_>) -> Result<()> {
        let GradientSeries { z, zx, zy } = out;
        same_lengths(x.len(), [y.len(), z.len(), zx.len(), zy.len()])?;
        let mut own = [[BLANK; CURVES]; 3];
        let mut below = [BLANK; CURVES];
        for range in ranges(x.len(), CURVES) {
            let (x, y) = (&x[range.clone()], &y[range.clone()]);
            self.lift(x, y, &mut z[range.clone()], &mut own)?;
            let count = range.len();
            let (zx, zy) = (&mut zx[range.clone()], &mut zy[range]);
            let answer = GradientSeries {
                z: &mut below[..count],
                zx: &mut *zx,
                zy: &mut *zy,
            };
            self.surface
                .series(&own[0][..count], &own[1][..count], answer)?;
            for (zx, zy) in zx.iter_mut().zip(zy) {
                let [along_x, along_y, rate] = self.frame.rates(Taylor(*zx), Taylor(*zy));
                let over = -rate.recip();
                (*zx, *zy) = ((along_x * over).0, (along_y * over).0);
            }
        }
        Ok(())
    }

    fn height_series(&self, x: &[Series], y: &[Series], z: &mut [Series]) -> Result<()> {
        same_lengths(x.len(), [y.len(), z.len()])?;
        let mut own = [[BLANK; CURVES]; 3];
        for range in ranges(x.len(), CURVES) {
            let (x, y) = (&x[range.clone()], &y[range.clone()]);
            self.lift(x, y, &mut z[range], &mut own)?;
        }
        Ok(())
    }

    fn beyond_data(&self, x: &[f64], y: &[f64], distance: &mut [f64]) -> Result<()> {
        same_lengths(x.len(), [y.len(), distance.len()])?;
        let mut roots = Roots::BLANK;
        let mut own = [[0.0; POINTS]; 2];
        for range in ranges(x.len(), POINTS) {
            let (x, y) = (&x[range.clone()], &y[range.clone()]);
            self.find(x, y, &mut roots)?;
            for (axis, own) in own.iter_mut().enumerate() {
                for (((own, x), y), z) in own.iter_mut().zip(x).zip(y).zip(&roots.z) {
                    *own = self.frame.coordinate(axis, *x, *y, *z);
                }
            }
            let count = range.len();
            let distance = &mut distance[range];
            self.surface
                .beyond_data(&own[0][..count], &own[1][..count], distance)?;
        }
        Ok(())
    }

    fn data(&self) -> Result<Option<SurfaceData>> {
        self.surface.data()
    }
}
