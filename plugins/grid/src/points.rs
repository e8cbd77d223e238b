//! Heights and slopes of the spline at many points.
//!
//! Each step goes through a group of points before the next one begins. So the compiler puts the numbers
//! of a point side by side in vector [registers](turnpath_plugin::registers).

use turnpath_plugin::prelude::Gradients;
use turnpath_plugin::registers::Loop;

use crate::basis::{NO_WEIGHTS, derivative};
use crate::spline::{NO_PATCH, Place, Spline, combine, dot};

/// Points of a group. What is kept of them stays in the cache of the first level.
const GROUP: usize = 16;

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
        let mut places = [Place::default(); GROUP];
        let mut patch = NO_PATCH;
        let [mut of_s, mut of_t, mut lines] = [[NO_WEIGHTS; GROUP]; 3];
        let points = x.chunks(GROUP).zip(y.chunks(GROUP));
        for ((x, y), z) in points.zip(z.chunks_mut(GROUP)) {
            let places = spline.places(x, y, &mut places);
            for (of_s, place) in of_s.iter_mut().zip(places) {
                *of_s = derivative::<0>(place.s);
            }
            for (of_t, place) in of_t.iter_mut().zip(places) {
                *of_t = derivative::<0>(place.t);
            }
            for ((line, of_t), place) in lines.iter_mut().zip(&of_t).zip(places) {
                *line = combine(&spline.lines(place, &mut patch), of_t);
            }
            for ((z, line), of_s) in z.iter_mut().zip(&lines).zip(&of_s) {
                *z = dot(line, of_s);
            }
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
        let mut places = [Place::default(); GROUP];
        let mut patch = NO_PATCH;
        // The splines and their rates, and the lines and their rates.
        let [mut of_s, mut of_t, mut lines] = [[[NO_WEIGHTS; 2]; GROUP]; 3];
        let points = x.chunks(GROUP).zip(y.chunks(GROUP));
        let slopes = zx.chunks_mut(GROUP).zip(zy.chunks_mut(GROUP));
        for (((x, y), z), (zx, zy)) in points.zip(z.chunks_mut(GROUP)).zip(slopes) {
            let places = spline.places(x, y, &mut places);
            for (of_s, place) in of_s.iter_mut().zip(places) {
                *of_s = [derivative::<0>(place.s), derivative::<1>(place.s)];
            }
            for (of_t, place) in of_t.iter_mut().zip(places) {
                *of_t = [derivative::<0>(place.t), derivative::<1>(place.t)];
            }
            for ((line, [of_t, rates]), place) in lines.iter_mut().zip(&of_t).zip(places) {
                let at = spline.lines(place, &mut patch);
                *line = [combine(&at, of_t), combine(&at, rates)];
            }
            for ((z, [line, _]), [of_s, _]) in z.iter_mut().zip(&lines).zip(&of_s) {
                *z = dot(line, of_s);
            }
            for ((zx, [line, _]), [_, rates]) in zx.iter_mut().zip(&lines).zip(&of_s) {
                *zx = dot(line, rates) * spline.per[0];
            }
            for ((zy, [_, rates]), [of_s, _]) in zy.iter_mut().zip(&lines).zip(&of_s) {
                *zy = dot(rates, of_s) * spline.per[1];
            }
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
