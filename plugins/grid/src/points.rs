//! Heights and slopes of the spline at many points.

use turnpath_plugin::prelude::Gradients;
use turnpath_plugin::registers::Loop;

use crate::basis::GROUP;
use crate::group::{Group, put};
use crate::spline::Spline;

/// The loop that gives points their heights. All slices have one length.
pub struct HeightsAt<'a> {
    /// The spline.
    pub spline: &'a Spline,
    /// x of the points, mm.
    pub x: &'a [f64],
    /// y of the points, mm.
    pub y: &'a [f64],
    /// Their heights, mm.
    pub z: &'a mut [f64],
}

impl Loop for HeightsAt<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { spline, x, y, z } = self;
        let mut group = Group::<1>::new();
        let points = x.chunks(GROUP).zip(y.chunks(GROUP));
        for ((x, y), z) in points.zip(z.chunks_mut(GROUP)) {
            group.take(spline, x, y);
            put(&group.term(0, 0), z);
        }
    }
}

/// The loop that gives points their heights and both slopes. All slices have one length.
pub struct SlopesAt<'a> {
    /// The spline.
    pub spline: &'a Spline,
    /// x of the points, mm.
    pub x: &'a [f64],
    /// y of the points, mm.
    pub y: &'a [f64],
    /// Their heights, mm, and slopes.
    pub out: Gradients<'a>,
}

impl Loop for SlopesAt<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { spline, x, y, out } = self;
        let Gradients { z, zx, zy } = out;
        let mut group = Group::<2>::new();
        let points = x.chunks(GROUP).zip(y.chunks(GROUP));
        let slopes = zx.chunks_mut(GROUP).zip(zy.chunks_mut(GROUP));
        for (((x, y), z), (zx, zy)) in points.zip(z.chunks_mut(GROUP)).zip(slopes) {
            group.take(spline, x, y);
            put(&group.term(0, 0), z);
            put(&group.term(1, 0).map(|slope| slope * spline.per[0]), zx);
            put(&group.term(0, 1).map(|slope| slope * spline.per[1]), zy);
        }
    }
}

#[cfg(test)]
impl Spline {
    /// The height at one place.
    pub fn height(&self, x: f64, y: f64) -> f64 {
        let mut z = [f64::NAN];
        HeightsAt {
            spline: self,
            x: &[x],
            y: &[y],
            z: &mut z,
        }
        .call();
        z[0]
    }

    /// The height and both slopes at one place.
    pub fn gradient(&self, x: f64, y: f64) -> [f64; 3] {
        let [mut z, mut zx, mut zy] = [[f64::NAN]; 3];
        let out = Gradients {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        let (spline, x, y) = (self, &[x], &[y]);
        SlopesAt { spline, x, y, out }.call();
        [z[0], zx[0], zy[0]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::Sheet;

    /// Within the spline, in its margin, beyond it, and nowhere.
    #[test]
    fn any_length_of_batch_gives_what_single_points_give() {
        let heights = Sheet::of_values(12, 9, |u, v| (3.7 * u * u + 5.3 * v + 2.9 * u * v) % 4.0);
        let spline = &Spline::through(heights, [-2.0, 1.0], [0.5, 0.3]);
        let mut x: Vec<f64> = (0..19).map(|i| 0.9 * f64::from(i) - 6.0).collect();
        let mut y: Vec<f64> = x.iter().map(|x| 1.3 - 0.4 * x).collect();
        (x[3], x[7], y[9], y[12]) = (f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300);
        // What is no number may be any of those that are none.
        let bits = |number: f64| (!number.is_nan()).then_some(number.to_bits());
        for length in 0..=x.len() {
            let (x, y) = (&x[..length], &y[..length]);
            let [mut heights, mut z, mut zx, mut zy] = [(); 4].map(|()| vec![0.0; length]);
            HeightsAt {
                spline,
                x,
                y,
                z: &mut heights,
            }
            .call();
            let out = Gradients {
                z: &mut z,
                zx: &mut zx,
                zy: &mut zy,
            };
            SlopesAt { spline, x, y, out }.call();
            for i in 0..length {
                let alone = spline.gradient(x[i], y[i]).map(bits);
                assert_eq!([z[i], zx[i], zy[i]].map(bits), alone, "{length} {i}");
                assert_eq!(bits(heights[i]), alone[0], "{length} {i}");
            }
        }
    }
}
