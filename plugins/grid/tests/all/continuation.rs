//! Holes, and places beyond the map.

#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use turnpath_core::{GradientSeries, Gradients, Scalar, Series, SeriesOrders, SurfaceModel};
use turnpath_grid::GridSag;
use turnpath_maps::Map;

/// A paraboloid with a wave on it, mm.
fn wavy(x: f64, y: f64) -> f64 {
    0.01 * (x * x + y * y) + 1e-3 * Scalar::sin(1.1 * x) * Scalar::cos(0.8 * y + 0.3)
}

/// A map of `count` × `count` points over a square of side 10 mm; `height` may be NaN.
fn map(count: usize, height: impl Fn(f64, f64) -> f64) -> Map {
    let pitch = 10.0 / (count - 1) as f64;
    let place = |k: usize| pitch * k as f64 - 5.0;
    let heights = (0..count * count).map(|k| height(place(k % count), place(k / count)));
    Map::new(count, count, pitch, pitch, heights.collect()).unwrap()
}

fn height(surface: &GridSag, x: f64, y: f64) -> f64 {
    let mut z = [0.0];
    surface.heights(&[x], &[y], &mut z).unwrap();
    z[0]
}

/// The largest second derivative along y, at some places along a line.
fn bend(surface: &GridSag, x: f64, y: f64) -> f64 {
    let [mut z, mut zx, mut zy] = [[[0.0; 5]; 1]; 3];
    let (still, moving): (Series, Series) = ([x, 0.0, 0.0, 0.0, 0.0], [y, 1.0, 0.0, 0.0, 0.0]);
    let out = GradientSeries {
        z: &mut z,
        zx: &mut zx,
        zy: &mut zy,
    };
    surface.series(&[still], &[moving], out).unwrap();
    2.0 * z[0][2]
}

#[test]
fn a_dust_grain_is_filled_to_a_part_of_the_wave() {
    let hole = |x: f64, y: f64| (x - 1.0) * (x - 1.0) + (y + 0.5) * (y + 0.5) < 0.16;
    let map = map(101, |x, y| if hole(x, y) { f64::NAN } else { wavy(x, y) });
    let filled = map.heights().len() - map.valid();
    let surface = GridSag::of(map, None).unwrap();
    assert_eq!(surface.data().unwrap().unwrap().filled as usize, filled);
    assert!(filled > 40);
    // Within 0.8 mm a wave of 5.7 mm bends by some micrometres; the plate leaves nanometres.
    for (x, y) in [(1.0, -0.5), (1.2, -0.6), (0.9, -0.25)] {
        let off = (height(&surface, x, y) - wavy(x, y)).abs();
        assert!(off < 8e-6, "{x} {y}: {off}");
    }
}

/// A designed map is exact up to its edge: its own spline counts there, not how it is carried on.
#[test]
fn a_smooth_map_is_exact_up_to_its_edge() {
    for (count, bound) in [(41, 3e-7), (81, 5e-9)] {
        let surface = GridSag::of(map(count, wavy), None).unwrap();
        let pitch = 10.0 / (count - 1) as f64;
        for k in 0..200 {
            let (x, y) = (
                0.05 * f64::from(k) - 4.98,
                5.0 - pitch * (0.1 + f64::from(k % 9) / 4.0),
            );
            for (x, y) in [(x, y), (y, x), (-y, x), (x, -y)] {
                let off = (height(&surface, x, y) - wavy(x, y)).abs();
                assert!(off < bound, "{count}: {x} {y}: {off}");
            }
        }
    }
}

/// Only a disc is measured. Beyond its edge the surface goes on with its slope, and bends no more than
/// within.
#[test]
fn a_disc_goes_on_beyond_its_edge() {
    let disc = |x: f64, y: f64| match x * x + y * y < 16.0 {
        true => wavy(x, y),
        false => f64::NAN,
    };
    let surface = GridSag::of(map(101, disc), None).unwrap();
    let largest = (-40..=40)
        .map(|k| bend(&surface, 0.3, 0.1 * f64::from(k)).abs())
        .fold(0.0, f64::max);
    for k in 0..120 {
        let y = 3.5 + 0.05 * f64::from(k);
        let bend = bend(&surface, 0.3, y).abs();
        assert!(bend < 1.5 * largest, "{y}: {bend} {largest}");
    }
    for (beyond, bound) in [(0.2, 1e-4), (0.5, 4e-4), (1.0, 1.5e-3)] {
        let y = 4.0 + beyond;
        let off = (height(&surface, 0.0, y) - wavy(0.0, y)).abs();
        assert!(off < bound, "{y}: {off}");
    }
}

/// Noise of single points is not carried beyond the edge: waves along it die away.
#[test]
fn noise_does_not_grow_beyond_the_edge() {
    let noise = |x: f64, y: f64| {
        let n = Scalar::sin(12.9898 * x + 78.233 * y) * 43758.5453;
        2e-6 * 3.4 * (n - n.floor() - 0.5)
    };
    let rms =
        |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt();
    for half in [5.1, 4.0] {
        let map = map(101, |x, y| match x.abs().max(y.abs()) < half {
            true => noise(x, y),
            false => f64::NAN,
        });
        let surface = GridSag::of(map, None).unwrap();
        for beyond in [0.3, 1.0, 2.0] {
            let y = f64::min(half, 5.0) + beyond;
            let along: Vec<f64> = (-90..=90)
                .map(|k| height(&surface, 0.05 * f64::from(k), y))
                .collect();
            let bends: Vec<f64> = (-90..=90)
                .map(|k| bend(&surface, 0.05 * f64::from(k), y))
                .collect();
            // Inside, a noise of 2 nm at a pitch of 0.1 mm bends by some 1e-3/mm.
            assert!(
                rms(&along) < 40e-6 * beyond.max(0.5),
                "{half} {beyond}: {}",
                rms(&along)
            );
            assert!(rms(&bends) < 1e-3, "{half} {beyond}: {}", rms(&bends));
        }
    }
}

#[test]
fn a_place_beyond_the_cells_knows_how_far_it_is() {
    let disc = |x: f64, y: f64| match x * x + y * y < 16.0 {
        true => 0.0,
        false => f64::NAN,
    };
    let surface = GridSag::of(map(101, disc), None).unwrap();
    let (x, y) = ([0.0, 3.9, 4.5, 0.0, 8.0], [0.0, 0.0, 0.0, -5.5, 0.0]);
    let mut distance = [f64::NAN; 5];
    surface.beyond_data(&x, &y, &mut distance).unwrap();
    for (found, wanted) in distance.into_iter().zip([0.0, 0.0, 0.55, 1.55, 4.05]) {
        // The edge of the disc is one of cells.
        assert!((found - wanted).abs() < 0.101, "{found} {wanted}");
    }
    assert_eq!(distance[..2], [0.0, 0.0]);
}

/// Places on the map, around it, far away, and none.
fn places() -> Vec<(f64, f64)> {
    let near = (0..30).map(|k| (0.7 * f64::from(k) - 9.5, 4.0 - 0.5 * f64::from(k)));
    let far = [(1e300, 0.3), (-1e300, -1e300), (1e18, 2.0), (0.1, 400.0)];
    let none = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    let none = none
        .iter()
        .flat_map(|none| [(*none, 0.4), (0.4, *none), (*none, *none)]);
    near.chain(far).chain(none).collect()
}

/// Heights and slopes of a batch of any length are those of its places alone. At a place that is no number
/// there are none.
#[test]
fn heights_and_slopes_of_a_batch_of_any_length_are_those_of_single_places() {
    let surface = GridSag::of(map(40, wavy), None).unwrap();
    let places = places();
    for length in [0, 1, 7, 8, 9, 16, 17, 33, places.len()] {
        // From the end on, so that each place comes into batches of several lengths.
        let batch: Vec<(f64, f64)> = places.iter().rev().take(length).copied().collect();
        let (x, y): (Vec<f64>, Vec<f64>) = batch.iter().copied().unzip();
        let [mut z, mut zx, mut zy, mut heights] = [(); 4].map(|()| vec![0.0; length]);
        let out = Gradients {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        surface.gradient(&x, &y, out).unwrap();
        surface.heights(&x, &y, &mut heights).unwrap();
        for i in 0..length {
            let ([mut z_alone], [mut zx_alone], [mut zy_alone]) = ([0.0], [0.0], [0.0]);
            let out = Gradients {
                z: std::slice::from_mut(&mut z_alone),
                zx: std::slice::from_mut(&mut zx_alone),
                zy: std::slice::from_mut(&mut zy_alone),
            };
            surface.gradient(&x[i..=i], &y[i..=i], out).unwrap();
            let found = [z[i], zx[i], zy[i], heights[i]];
            let alone = [z_alone, zx_alone, zy_alone, height(&surface, x[i], y[i])];
            match x[i].is_finite() && y[i].is_finite() {
                true => assert_eq!(
                    found.map(f64::to_bits),
                    alone.map(f64::to_bits),
                    "{:?}",
                    batch[i]
                ),
                false => assert!(
                    found.iter().chain(&alone).all(|n| n.is_nan()),
                    "{:?}",
                    batch[i]
                ),
            }
        }
    }
}

/// The same for series through each order.
#[test]
fn series_of_a_batch_of_any_length_are_those_of_single_curves() {
    let surface = GridSag::of(map(40, wavy), None).unwrap();
    let places = places();
    let curve = |at: f64| [at, 0.8, -0.3, 0.05, 0.02];
    let bits = |series: &Series, to: usize| -> Vec<u64> {
        series[..=to].iter().map(|c| c.to_bits()).collect()
    };
    for length in [0, 1, 7, 8, 9, 16, 17, 33, places.len()] {
        let batch: Vec<(f64, f64)> = places.iter().rev().take(length).copied().collect();
        let (x, y): (Vec<f64>, Vec<f64>) = batch.iter().copied().unzip();
        let (along_x, along_y): (Vec<Series>, Vec<Series>) =
            batch.iter().map(|(x, y)| (curve(*x), curve(*y))).unzip();
        for to in [1, 2, 4] {
            let orders = SeriesOrders {
                heights: to,
                slopes: to,
            };
            let [mut z, mut zx, mut zy, mut heights] = [(); 4].map(|()| vec![[0.0; 5]; length]);
            let out = GradientSeries {
                z: &mut z,
                zx: &mut zx,
                zy: &mut zy,
            };
            surface.series_to(orders, &along_x, &along_y, out).unwrap();
            surface
                .height_series_to(to, &along_x, &along_y, &mut heights)
                .unwrap();
            for i in 0..length {
                let [mut z_alone, mut zx_alone, mut zy_alone] = [[[0.0; 5]]; 3];
                let out = GradientSeries {
                    z: &mut z_alone,
                    zx: &mut zx_alone,
                    zy: &mut zy_alone,
                };
                surface
                    .series(&along_x[i..=i], &along_y[i..=i], out)
                    .unwrap();
                let alone = [z_alone[0], zx_alone[0], zy_alone[0], z_alone[0]];
                for (found, alone) in [z[i], zx[i], zy[i], heights[i]].iter().zip(&alone) {
                    match x[i].is_finite() && y[i].is_finite() {
                        true => assert_eq!(bits(found, to), bits(alone, to), "{:?} {to}", batch[i]),
                        false => assert!(
                            found[..=to].iter().all(|c| c.is_nan()),
                            "{:?} {to}",
                            batch[i]
                        ),
                    }
                }
            }
        }
    }
}

/// The smallest maps, with holes.
#[test]
fn maps_of_six_points_on_a_side_have_a_surface() {
    for (columns, rows) in [(6, 6), (6, 40), (40, 6)] {
        let mut heights: Vec<f64> = (0..columns * rows).map(|k| 1e-3 * (k % 7) as f64).collect();
        (heights[8], heights[15]) = (f64::NAN, f64::NAN);
        let surface =
            GridSag::of(Map::new(columns, rows, 0.1, 0.1, heights).unwrap(), None).unwrap();
        for (x, y) in [(0.0, 0.0), (0.2, -0.2), (5.0, 3.0)] {
            assert!(
                height(&surface, x, y).is_finite(),
                "{columns} {rows}: {x} {y}"
            );
        }
    }
}

/// An ordinary batch and one point at a time.
#[test]
fn a_batch_gives_what_single_points_give() {
    let surface = GridSag::of(map(40, wavy), None).unwrap();
    let x: Vec<f64> = (0..37).map(|k| 0.31 * f64::from(k) - 5.5).collect();
    let y: Vec<f64> = x.iter().map(|x| 1.5 - x).collect();
    let mut z = vec![0.0; x.len()];
    surface.heights(&x, &y, &mut z).unwrap();
    for ((x, y), z) in x.iter().zip(&y).zip(&z) {
        assert_eq!(height(&surface, *x, *y).to_bits(), z.to_bits());
    }
    assert!(surface.heights(&x, &y[1..], &mut z).is_err());
}
