//! The series of the spline along curves.
//!
//! The caller chooses how many coefficients are made. A term of order k begins with tᵏ, so that terms of higher
//! orders add nothing to the coefficients that are asked for. The curves of a group go side by side, and each
//! step goes through a group before the next one begins.

use turnpath_plugin::prelude::{GradientSeries, Series};
use turnpath_plugin::registers::Loop;

use crate::basis::{GROUP, Numbers};
use crate::group::Group;
use crate::spline::Spline;

/// The series of the curves, order by order.
type Orders<const K: usize> = [Numbers; K];

/// The loop that gives curves `K` coefficients of their heights. All slices have one length.
pub struct HeightsAlong<'a, const K: usize> {
    /// The spline.
    pub spline: &'a Spline,
    /// x(t) of the curves, mm.
    pub x: &'a [Series],
    /// y(t) of the curves, mm.
    pub y: &'a [Series],
    /// Their heights, mm.
    pub z: &'a mut [Series],
}

impl<const K: usize> Loop for HeightsAlong<'_, K> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { spline, x, y, z } = self;
        let [per_x, per_y] = spline.per;
        let mut group = Curves::<K, K>::new();
        let curves = x.chunks(GROUP).zip(y.chunks(GROUP));
        for ((x, y), z) in curves.zip(z.chunks_mut(GROUP)) {
            group.take_terms(spline, x, y);
            group.of_x = powers(x, per_x);
            group.of_y = powers(y, per_y);
            let mut height = [[0.0; GROUP]; K];
            for b in 0..K {
                for a in 0..K - b {
                    let product = group.product(a, b);
                    add(&mut height, &group.terms[b][a], &product, a + b);
                }
            }
            put(&height, z);
        }
    }
}

/// The loop that gives curves `K` coefficients of their heights, and `S` of both slopes, `S` ≤ `K`. This takes
/// `N` orders of derivatives: `K` or `S` + 1, whichever is more. All slices have one length.
pub struct SlopesAlong<'a, const K: usize, const S: usize, const N: usize> {
    /// The spline.
    pub spline: &'a Spline,
    /// x(t) of the curves, mm.
    pub x: &'a [Series],
    /// y(t) of the curves, mm.
    pub y: &'a [Series],
    /// Their heights, mm, and slopes.
    pub out: GradientSeries<'a>,
}

impl<const K: usize, const S: usize, const N: usize> Loop for SlopesAlong<'_, K, S, N> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        const { assert!(S <= K && K <= N && S < N) }
        let Self { spline, x, y, out } = self;
        let GradientSeries { z, zx, zy } = out;
        let [per_x, per_y] = spline.per;
        let mut group = Curves::<K, N>::new();
        let curves = x.chunks(GROUP).zip(y.chunks(GROUP));
        let slopes = zx.chunks_mut(GROUP).zip(zy.chunks_mut(GROUP));
        for (((x, y), z), (zx, zy)) in curves.zip(z.chunks_mut(GROUP)).zip(slopes) {
            group.take_terms(spline, x, y);
            group.of_x = powers(x, per_x);
            group.of_y = powers(y, per_y);
            let mut height = [[0.0; GROUP]; K];
            let [mut slope_x, mut slope_y] = [[[0.0; GROUP]; S]; 2];
            for b in 0..K {
                for a in 0..K - b {
                    let product = group.product(a, b);
                    add(&mut height, &group.terms[b][a], &product, a + b);
                    if a + b < S {
                        let along_x =
                            group.terms[b][a + 1].map(|term| term * (a + 1) as f64 * per_x);
                        let along_y =
                            group.terms[b + 1][a].map(|term| term * (b + 1) as f64 * per_y);
                        add(&mut slope_x, &along_x, &product, a + b);
                        add(&mut slope_y, &along_y, &product, a + b);
                    }
                }
            }
            put(&height, z);
            put(&slope_x, zx);
            put(&slope_y, zy);
        }
    }
}

/// The curves of a group, and what is known of them.
struct Curves<const K: usize, const N: usize> {
    /// The spline where curves begin.
    starts: Group<N>,
    /// The derivatives of the spline where curves begin, over their factorials: `terms[b][a]` is that of
    /// order a along x and b along y, in cells.
    terms: [[Numbers; N]; N],
    /// The powers of what each coordinate moves from its start.
    of_x: [Orders<K>; K],
    of_y: [Orders<K>; K],
}

impl<const K: usize, const N: usize> Curves<K, N> {
    #[inline(always)]
    fn new() -> Self {
        Self {
            starts: Group::new(),
            terms: [[[0.0; GROUP]; N]; N],
            of_x: [[[0.0; GROUP]; K]; K],
            of_y: [[[0.0; GROUP]; K]; K],
        }
    }

    /// Takes the terms where curves begin.
    #[inline(always)]
    fn take_terms(&mut self, spline: &Spline, x: &[Series], y: &[Series]) {
        let [mut of_x, mut of_y] = [[0.0; GROUP]; 2];
        let starts = of_x.iter_mut().zip(&mut of_y).zip(x.iter().zip(y));
        for ((of_x, of_y), (x, y)) in starts {
            (*of_x, *of_y) = (x[0], y[0]);
        }
        let count = x.len().min(GROUP);
        self.starts.take_places(spline, &of_x, &of_y, count);
        for b in 0..N {
            for a in 0..N - b {
                self.terms[b][a] = self.starts.term(a, b);
            }
        }
    }

    /// The products of powers that begin with tᵃ and tᵇ.
    #[inline(always)]
    fn product(&self, a: usize, b: usize) -> Orders<K> {
        product(&self.of_x[a], &self.of_y[b], a, b)
    }
}

/// The powers of what a coordinate moves from its start, in cells. The power of order k begins with
/// tᵏ.
#[inline(always)]
fn powers<const K: usize>(curves: &[Series], over: f64) -> [Orders<K>; K] {
    let mut step = [[0.0; GROUP]; K];
    for (i, curve) in curves.iter().enumerate().take(GROUP) {
        for (step, c) in step.iter_mut().zip(curve).skip(1) {
            step[i] = c * over;
        }
    }
    let mut powers = [[[0.0; GROUP]; K]; K];
    powers[0][0] = [1.0; GROUP];
    for order in 1..K {
        powers[order] = product(&powers[order - 1], &step, order - 1, 1);
    }
    powers
}

/// The products of two series that begin with tᵃ and tᵇ.
#[inline(always)]
fn product<const K: usize>(one: &Orders<K>, other: &Orders<K>, a: usize, b: usize) -> Orders<K> {
    let last = K - 1;
    let mut product = [[0.0; GROUP]; K];
    for i in a..=last {
        for j in b..=last - i.min(last) {
            for (k, sum) in product[i + j].iter_mut().enumerate() {
                *sum += one[i][k] * other[j][k];
            }
        }
    }
    product
}

/// Adds the multiples of a product, which begins with the order `first`.
#[inline(always)]
fn add<const K: usize, const L: usize>(
    sum: &mut Orders<L>,
    factors: &Numbers,
    product: &Orders<K>,
    first: usize,
) {
    for (sum, product) in sum.iter_mut().zip(product).skip(first) {
        for ((sum, factor), product) in sum.iter_mut().zip(factors).zip(product) {
            *sum += factor * product;
        }
    }
}

/// Puts the numbers of the curves into their series. What was not asked for is zero. It is not compiled into loops
/// for wide registers, as the places of a [`Group`] are not transposed there.
#[inline(never)]
fn put<const K: usize>(orders: &Orders<K>, curves: &mut [Series]) {
    for (i, curve) in curves.iter_mut().enumerate().take(GROUP) {
        for (order, coefficient) in curve.iter_mut().enumerate() {
            *coefficient = orders.get(order).map_or(0.0, |numbers| numbers[i]);
        }
    }
}

#[cfg(test)]
impl Spline {
    /// The series of the height and of both slopes along one curve.
    pub fn series<const K: usize, const S: usize, const N: usize>(
        &self,
        x: &Series,
        y: &Series,
    ) -> [Series; 3] {
        let [mut z, mut zx, mut zy] = [[[f64::NAN; 5]]; 3];
        let out = GradientSeries {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        let (spline, x, y) = (self, &[*x], &[*y]);
        SlopesAlong::<K, S, N> { spline, x, y, out }.call();
        [z[0], zx[0], zy[0]]
    }

    /// The series of the height along one curve.
    pub fn height_series<const K: usize>(&self, x: &Series, y: &Series) -> Series {
        let mut z = [[f64::NAN; 5]];
        HeightsAlong::<K> {
            spline: self,
            x: &[*x],
            y: &[*y],
            z: &mut z,
        }
        .call();
        z[0]
    }
}
