//! The low-pass, as a stated filter.

#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::f64::consts::{LN_2, TAU};

use turnpath_core::{Scalar, SurfaceModel};
use turnpath_grid::GridSag;
use turnpath_maps::Map;

const COUNT: usize = 201;
const PITCH: f64 = 0.05;

fn map(mut height: impl FnMut(f64, f64) -> f64) -> Map {
    let place = |k: usize| PITCH * k as f64 - 5.0;
    let heights = (0..COUNT * COUNT).map(|k| height(place(k % COUNT), place(k / COUNT)));
    Map::new(COUNT, COUNT, PITCH, PITCH, heights.collect()).unwrap()
}

fn height(surface: &GridSag, x: f64, y: f64) -> f64 {
    let mut z = [0.0];
    surface.heights(&[x], &[y], &mut z).unwrap();
    z[0]
}

/// With a cutoff of 0.4 mm the filter works on all points, with one of 1.5 mm on blocks.
#[test]
fn a_wave_passes_as_the_cutoff_says() {
    for cutoff in [0.4, 1.5] {
        for length in [0.5 * cutoff, cutoff, 3.0 * cutoff] {
            let wave = |x: f64, _: f64| 1e-3 * Scalar::cos(TAU * x / length);
            let surface = GridSag::of(map(wave), Some(cutoff)).unwrap();
            let found = height(&surface, 0.0, 0.1) / 1e-3;
            let share: f64 = cutoff / length;
            let wanted = Scalar::exp(-LN_2 * share * share);
            // Blocks take up to a hundredth more.
            let bound = if cutoff > 1.0 { 0.012 } else { 2e-3 };
            assert!(
                (found - wanted).abs() < bound,
                "{cutoff} {length}: {found} {wanted}"
            );
        }
    }
}

#[test]
fn a_paraboloid_stays_and_noise_goes() {
    let paraboloid = |x: f64, y: f64| 0.01 * (x * x + 2.0 * y * y) - 0.003 * x * y;
    let noise = |x: f64, y: f64| {
        let n = Scalar::sin(12.9898 * x + 78.233 * y) * 43758.5453;
        // RMS 2 nm.
        2e-6 * 12_f64.sqrt() * (n - n.floor() - 0.5)
    };
    let surface = GridSag::of(map(|x, y| paraboloid(x, y) + noise(x, y)), Some(0.6)).unwrap();
    let (mut square, mut count) = (0.0_f64, 0.0);
    for i in -45..=45 {
        for j in -45..=45 {
            let (x, y) = (0.1 * f64::from(i) + 0.013, 0.1 * f64::from(j) - 0.021);
            let off = height(&surface, x, y) - paraboloid(x, y);
            square += off * off;
            count += 1.0;
        }
    }
    let rms = (square / count).sqrt();
    // A Gaussian of cutoff L over a pitch p leaves √(0.66)·p/L of white noise: 0.14 nm here.
    assert!(rms < 0.3e-6, "{rms}");
}

/// At three points in ten, at random, a filter on blocks keeps of a wave what the cutoff says.
#[test]
fn a_map_with_few_points_is_filtered_as_the_cutoff_says() {
    let wave = |x: f64, y: f64| Scalar::cos(TAU * x / 6.0) * Scalar::cos(TAU * y / 6.0);
    let mut state = 1_u64;
    let sparse = |x: f64, y: f64| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        match state >> 32 < u64::from(u32::MAX) * 3 / 10 {
            true => 1e-3 * wave(x, y),
            false => f64::NAN,
        }
    };
    let map = map(sparse);
    let share = map.valid() as f64 / (COUNT * COUNT) as f64;
    assert!((0.28..0.32).contains(&share), "{share}");
    let surface = GridSag::of(map, Some(2.4)).unwrap();
    // Two waves of 6 mm, one along each axis.
    let kept = Scalar::exp(-2.0 * LN_2 * 0.16);
    for (x, y) in [(0.0, 0.0), (1.5, 0.0), (-1.0, 0.7), (0.0, 2.0)] {
        let found = height(&surface, x, y) / 1e-3;
        let wanted = kept * wave(x, y);
        assert!((found - wanted).abs() < 0.01, "{x} {y}: {found} {wanted}");
    }
}

/// Up to the edge and beside holes a slope is followed.
#[test]
fn edges_are_not_flattened() {
    let slope = |x: f64, y: f64| 1e-3 * Scalar::sin(0.4 * x + 0.2 * y);
    let disc = |x: f64, y: f64| match x * x + y * y < 20.0 {
        true => slope(x, y),
        false => f64::NAN,
    };
    let surface = GridSag::of(map(disc), Some(0.5)).unwrap();
    for k in 0..60 {
        let (sin, cos) = Scalar::sin_cos(TAU * f64::from(k) / 60.0);
        let (x, y) = (4.4 * cos, 4.4 * sin);
        let off = (height(&surface, x, y) - slope(x, y)).abs();
        assert!(off < 4e-6, "{k}: {off}");
    }
}
