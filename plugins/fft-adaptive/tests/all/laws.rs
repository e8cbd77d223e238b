//! Feed `fft-adaptive` against the paper's revolutions, against eq. 3 by hand, and against the
//! residual feed of random surfaces.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::common::{Case, ast_5, mla_5};
use crate::models::model;
use crate::random::{array, compensating, one_case_in};
use proptest::prelude::{any, prop, prop_assert, proptest};
use turnpath_core::{Direction, NM, ParamValue, Params, SpiralLaw, Strategy, Surface, angle};
use turnpath_fft_adaptive::FftAdaptiveFeed;
use turnpath_nose_radius::{Uncompensated, ZDirection};
use turnpath_surfaces::Conic;

fn feed(chord: &str, limit_residual: bool, angles: f64, tolerance_nm: f64) -> FftAdaptiveFeed {
    let mut params = Params::new()
        .with("angles", angles)
        .with("tolerance", tolerance_nm * NM);
    params.set("chord", ParamValue::Text(chord.to_owned()));
    params.set("limit_residual", ParamValue::Flag(limit_residual));
    FftAdaptiveFeed::new(&params).unwrap()
}

/// Published are 122 revolutions. Half the chord gives them; the chord as printed gives half as
/// many.
#[test]
fn revolutions_of_the_papers_part_by_half_and_by_full_chords() {
    for angles in [72.0, 144.0, 360.0] {
        for case in [mla_5(Uncompensated), mla_5(Uncompensated).inward()] {
            for (chord, revolutions) in [("half", 122.0), ("full", 61.0)] {
                let law = case.law(&feed(chord, false, angles, 20.0)).unwrap();
                assert_eq!(law.end().ceil(), revolutions, "{chord}, {angles} angles");
            }
        }
    }
}

/// z = 5 µm (cos kx + cos ky), k = 2π·0.4/mm. The section at θ has g_ρρ = −5 µm k² (cos kx cos²θ +
/// cos ky sin²θ). The feed is the least of 2π/θ_i times the chord, at the radius where the
/// revolution starts.
#[test]
fn each_revolution_takes_the_feed_of_equation_3() {
    let law = mla_5(Uncompensated)
        .law(&feed("full", false, 72.0, 20.0))
        .unwrap();
    let (wave, height, e) = (TAU * 0.4, 5e-3, 20.0 * NM);
    let feed = |rho: f64| {
        let steps = (1..=72).map(|i| {
            let theta = TAU * f64::from(i) / 72.0;
            let (sin, cos) = turnpath_core::Scalar::sin_cos(theta);
            let (x, y) = (wave * rho * cos, wave * rho * sin);
            let waves = |v: f64| turnpath_core::Scalar::sin_cos(v);
            let slope = -height * wave * (waves(x).0 * cos + waves(y).0 * sin);
            let second = -height * wave * wave * (waves(x).1 * cos * cos + waves(y).1 * sin * sin);
            let w = (1.0 + slope * slope).sqrt();
            let radius = w * w * w / second.abs();
            TAU / theta * 2.0 * (2.0 * radius * e - e * e).sqrt() / w
        });
        steps.fold(f64::INFINITY, f64::min)
    };
    for piece in law.pieces() {
        let [rho, rate, rest @ ..] = piece.coefficients;
        assert!((rate / feed(rho) - 1.0).abs() < 1e-9, "{rate} at {rho}");
        assert_eq!(rest, [0.0; 4]);
        assert_eq!(piece.start, piece.start.round());
    }
}

/// Zhong et al. compensate no nose. Where the chord alone decides the feed, nothing limits the
/// cusps.
#[test]
fn the_cusps_keep_the_tolerance_with_the_limit_and_not_without_it() {
    let case = mla_5(Uncompensated);
    let over = |limit| {
        let law = case.law(&feed("half", limit, 72.0, 20.0)).unwrap();
        worst(&case, &law, 0.5)
    };
    assert!(over(false) > 2.0);
    assert!((0.95..=1.0).contains(&over(true)));
}

/// The largest distance of neighbouring passes, in residual feeds half way between them.
fn worst(case: &Case, law: &SpiralLaw, offset: f64) -> f64 {
    let places = 3000;
    let ratio = |i: i32| {
        let n = (law.end() - 1.0) * (f64::from(i) + offset) / f64::from(places);
        let (rho, next) = (law.value(n), law.value(n + 1.0));
        (next - rho).abs() / case.residual_feed(angle(n), 0.5 * (rho + next))
    };
    (0..places).map(ratio).fold(0.0, f64::max)
}

/// Checks that the law runs from end to end of the range, with one piece for each revolution and
/// each turn beyond the last.
fn check_shape(case: &Case, law: &SpiralLaw) {
    let range = case.task.range;
    let (from, to, sign) = match case.task.direction {
        Direction::Outward => (range.inner, range.outer, 1.0),
        Direction::Inward => (range.outer, range.inner, -1.0),
    };
    assert_eq!(law.value(0.0), from);
    assert!((law.value(law.end()) - to).abs() < 1e-12);
    assert_eq!(law.pieces().len(), law.end().ceil() as usize);
    for pair in law.pieces().windows(2) {
        let (end, start) = (law.series_before(pair[1].start), law.series(pair[1].start));
        assert!((end[0] - start[0]).abs() < 1e-12);
    }
    for i in 0..2000 {
        let n = (law.end() - 1.0) * f64::from(i) / 2000.0;
        assert!(n < 0.0 || sign * (law.value(n + 1.0) - law.value(n)) > 0.0);
    }
}

#[test]
fn on_a_flat_the_nose_alone_decides_or_a_tenth_of_the_range() {
    struct Flat;
    impl Surface for Flat {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: turnpath_core::Scalar>(&self, _: S, _: S) -> S {
            S::constant(0.0)
        }
    }
    let case = Case::new(Arc::new(Flat), Arc::new(ZDirection), 10.0, 1.0, 100.0);
    let law = case.law(&feed("half", true, 72.0, 20.0)).unwrap();
    let residual_feed = (8.0 * 100.0 * NM).sqrt();
    assert!(
        (law.end() * residual_feed / 5.0 - 1.0).abs() < 1e-3,
        "{}",
        law.end()
    );
    let law = case.law(&feed("half", false, 72.0, 20.0)).unwrap();
    assert!((law.end() - 10.0).abs() < 1e-9, "{}", law.end());
}

/// On a flat the feed is a tenth of the range. For many ranges ten of these, added up, stop a rounding
/// short of the end or go beyond it: what is left is no revolution of its own.
#[test]
fn a_feed_that_divides_the_range_leaves_no_revolution_of_roundings() {
    struct Flat;
    impl Surface for Flat {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: turnpath_core::Scalar>(&self, _: S, _: S) -> S {
            S::constant(0.0)
        }
    }
    for i in 0..200 {
        let aperture = 0.3 + 0.011 * f64::from(i);
        let case = || {
            let (surface, compensator) = (Arc::new(Flat), Arc::new(Uncompensated));
            Case::new(surface, compensator, aperture, 1.0, 100.0)
        };
        for case in [case(), case().inward()] {
            let law = case.law(&feed("half", false, 72.0, 20.0)).unwrap();
            check_shape(&case, &law);
            assert_eq!(law.pieces().len(), 10, "aperture {aperture} mm");
        }
    }
}

#[test]
fn a_part_without_surface_or_without_width_is_an_error() {
    let params = Params::new().with("radius", 2.0).with("conic", 0.0);
    let sphere = model::<Conic>(&params);
    let beyond = Case::new(sphere, Arc::new(Uncompensated), 5.0, 1.0, 100.0);
    let error = beyond.law(&feed("half", false, 72.0, 20.0)).unwrap_err();
    assert!(
        error.to_string().contains("no curvature at x = "),
        "{error}"
    );
    let nothing = ast_5(ZDirection).with_hole(2.5);
    let error = nothing.law(&feed("half", true, 72.0, 20.0)).unwrap_err();
    assert!(error.to_string().contains("nothing to cut"), "{error}");
}

proptest! {
    #![proptest_config(one_case_in(8))]

    #[test]
    fn on_arrays_the_law_goes_from_end_to_end_and_keeps_the_residual(
        amplitude in 0.001..0.01f64,
        frequency in 0.1..0.6f64,
        which in any::<bool>(),
        inward in any::<bool>(),
        half in any::<bool>(),
        hole in prop::option::of(0.1..2.0f64),
        tolerance in 5.0..500.0f64,
        offset in 0.0..1.0f64,
    ) {
        let surface = array(amplitude, frequency, "product");
        let mut case = Case::new(surface, compensating(which), 6.0, 0.5, 100.0);
        case = case.with_hole(hole.unwrap_or(0.0));
        if inward {
            case = case.inward();
        }
        let chord = if half { "half" } else { "full" };
        let law = case.law(&feed(chord, true, 72.0, tolerance)).unwrap();
        check_shape(&case, &law);
        let worst = worst(&case, &law, offset);
        prop_assert!(worst <= 1.0, "{}", worst);
    }
}
