//! Feed `atpg` against Wang et al. 2019, against the fastest law by brute force, and against the
//! residual feed of random surfaces.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::common::{AtpgCase, Case, ast_5, ast_50, joints, oap_213, rate_at, words};
use crate::models::model;
use crate::random::{array, compensator, one_case_in, polynomial, terms};
use proptest::prelude::{any, prop, prop_assert, proptest};
use turnpath_atpg::{AtpgFeed, CubicFit, Residual, explicit_pairs};
use turnpath_core::{Locus, Params, Radial, RadialRange, SpiralLaw, Strategy, SurfaceModel, UM};
use turnpath_nose_radius::{Normal, ZDirection};
use turnpath_surfaces::Conic;

/// A nose of 1 mm fits into polynomials of these terms on parts of 8 mm.
const TERMS: [f64; 5] = [0.1, 0.1, 0.05, 0.005, 0.0008];

/// Relative difference.
fn off(found: f64, expected: f64) -> f64 {
    (found / expected - 1.0).abs()
}

#[test]
fn the_cubic_on_the_saddle_is_the_papers_equation_19() {
    let case = ast_5(ZDirection);
    let table = Residual::Paper.table(case.setup()).unwrap();
    let pairs = explicit_pairs(&table, case.task.range).unwrap();
    assert_eq!(pairs.len(), 99);
    let fit = CubicFit::through(&pairs).unwrap();
    let expected = [-1.14122e-4, 2.62844e-2, -8.77466e-7, -4.94691e-8];
    for (found, expected) in fit.coefficients.iter().zip(expected) {
        assert!(off(*found, expected) < 1e-5, "{found} for {expected}");
    }
    assert!(off(fit.squared_error, 2.08236e-7) < 1e-5, "{fit:?}");
    let turns = fit.reaches(2.5, 97.0).unwrap() - fit.reaches(0.0, 0.0).unwrap();
    assert!((turns - 97.155).abs() < 5e-4, "{turns}");
}

#[test]
fn the_cubic_law_runs_from_end_to_end_in_one_piece() {
    let (out, back) = (ast_5(ZDirection), ast_5(ZDirection).inward());
    let (out, back) = (
        out.plan_law("paper", "cubic").unwrap(),
        back.plan_law("paper", "cubic").unwrap(),
    );
    assert_eq!((out.pieces().len(), out.value(0.0)), (1, 0.0));
    assert!((out.end() - 97.155).abs() < 5e-4);
    assert!((out.value(out.end()) - 2.5).abs() < 1e-13);
    for i in 0..=100 {
        let n = out.end() * f64::from(i) / 100.0;
        assert!((back.value(out.end() - n) - out.value(n)).abs() < 1e-12);
    }
}

#[test]
fn the_feed_at_2_mm_against_the_angle_is_that_of_figure_7() {
    let case = ast_5(Normal);
    let theta: Vec<f64> = (0..3600).map(|i| TAU * f64::from(i) / 3600.0).collect();
    let mut feed = vec![f64::NAN; theta.len()];
    let rho = vec![2.0; theta.len()];
    let residual = case.task.tolerance.residual;
    case.locus
        .residual_feed(residual, Radial::Contact, &theta, &rho, &mut feed)
        .unwrap();
    let (least, most) = feed
        .iter()
        .fold((f64::INFINITY, 0.0f64), |(a, b), f| (f.min(a), f.max(b)));
    assert!((least / UM - 25.25).abs() < 5e-3, "{least}");
    assert!((most / UM - 29.16).abs() < 5e-3, "{most}");
}

/// Both of the paper's real parts: the revolutions that their cutting times give.
#[test]
fn revolutions_of_the_papers_parts() {
    let turns = |case: Case, residual: &str| case.plan_law(residual, "cubic").unwrap().end();
    for residual in ["held", "paper"] {
        let found = turns(ast_50(ZDirection), residual);
        assert!((found - 2740.8).abs() < 0.1, "AST-50, {residual}: {found}");
    }
    let contact = turns(oap_213(Normal), "held");
    assert!((contact - 11684.8).abs() < 0.1, "OAP-213: {contact}");
    let apart = turns(oap_213(ZDirection), "paper");
    assert!((apart - 11686.9).abs() < 0.1, "OAP-213, paper: {apart}");
}

/// The hollow at 45° decides. With the contact at a, X = a − R g_ρ/w, and dN = dX/F is sqrt(1 −
/// Rκ)·w/sqrt(8Rε) da, which makes 98.985 revolutions up to X = 2.5 mm. (The explicit pairs have
/// 98.95: each takes the feed of its start, where the feed is larger.)
///
/// Where F falls steadily, a smooth law costs what erosion by h + f_max costs: (h + f_max) times
/// the difference of 1/F, besides the margin.
#[test]
fn on_the_saddle_the_smooth_law_costs_what_erosion_does() {
    let case = ast_5(ZDirection);
    // Turned by half a turn, the saddle is itself.
    let fastest = case.fewest_revolutions(2000, 360, 2);
    assert!((fastest - 98.98498).abs() < 1e-4, "{fastest}");
    let least = |rho: f64| {
        case.residual_feeds(rho, 360)
            .into_iter()
            .fold(f64::INFINITY, f64::min)
    };
    let (centre, rim) = (least(0.0), least(2.5));
    let erosion = (0.05 + centre) * (1.0 / rim - 1.0 / centre);
    let found = case.plan_law("held", "smooth").unwrap().end();
    assert!(
        found > fastest && found < fastest + 1.05 * erosion + 3e-4 * fastest,
        "{found}: {fastest} and {erosion}"
    );
    assert!(found < 1.003 * fastest, "{found}");
}

/// The sharp array has a lens in every 30 feeds. There erosion by f_max itself causes most of the
/// cost.
#[test]
fn on_arrays_the_smooth_law_costs_little_against_the_fastest() {
    let mild = array(5.0 * UM, 0.4, "sum");
    let strong = array(50.0 * UM, 0.4, "product");
    let sharp = array(50.0 * UM, 0.8, "product");
    for (name, surface, nose, allowed) in [
        ("MLA-5", mild, 1.0, 0.003),
        ("strong array", strong, 1.0, 0.02),
        ("sharp array", sharp, 0.5, 0.05),
    ] {
        let case = Case::new(surface, Arc::new(ZDirection), 10.0, nose, 100.0);
        // Turned by half a turn, an array is itself.
        let fastest = case.fewest_revolutions(500, 720, 2);
        let found = case.plan_law("held", "smooth").unwrap().end();
        let cost = found / fastest - 1.0;
        assert!((0.0..allowed).contains(&cost), "{name}: {found}, {cost:.4}");
    }
}

fn with_limit(case: Case, acceleration: f64) -> Case {
    let mut case = case;
    case.task.machine.x.acceleration = Some(acceleration);
    case
}

/// The largest |d²ρ/dt²| on a dense grid, mm/s².
fn acceleration(case: &Case, law: &SpiralLaw) -> f64 {
    let turning = case.task.spindle_speed / TAU;
    let second = |i: u32| -> f64 { 2.0 * law.series(law.end() * f64::from(i) / 20_000.0)[2] };
    let largest = (0..=20_000).fold(0.0, |most: f64, i| most.max(second(i).abs()));
    largest * turning * turning
}

/// MLA-5, and lenses that are ten times as high: F goes up and down with every lens. The limits are
/// parts of the acceleration that the law has without one.
fn assert_gentler(amplitude: f64, inward: bool, limits: &[f64]) {
    let case = || {
        let form = if amplitude < 10.0 * UM {
            "sum"
        } else {
            "product"
        };
        let case = Case::new(
            array(amplitude, 0.4, form),
            Arc::new(ZDirection),
            10.0,
            1.0,
            100.0,
        );
        if inward { case.inward() } else { case }
    };
    let free = case().plan_law("held", "smooth").unwrap();
    let unlimited = acceleration(&case(), &free);
    for part in limits {
        let limited = with_limit(case(), part * unlimited);
        let law = limited.plan_law("held", "smooth").unwrap();
        let found = acceleration(&limited, &law);
        assert!(found <= part * unlimited, "{found} of {part} · {unlimited}");
        assert!(law.end() > free.end());
        if !inward {
            check_law(&limited, &law, 0.3);
        }
    }
}

#[test]
fn within_a_machines_limit_the_law_is_gentler_and_still_below_the_residual_feed() {
    assert_gentler(5.0 * UM, false, &[0.7]);
    assert_gentler(50.0 * UM, false, &[0.1]);
    assert_gentler(50.0 * UM, true, &[0.3]);
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_within_many_limits_the_law_is_gentler_and_still_below_the_residual_feed() {
    for (amplitude, inward) in [(5.0 * UM, false), (50.0 * UM, false), (50.0 * UM, true)] {
        assert_gentler(amplitude, inward, &[0.7, 0.3, 0.1]);
    }
}

#[test]
fn a_limit_that_the_law_already_keeps_changes_no_bit_and_one_that_no_law_keeps_ends_the_search() {
    for case in [ast_5, |compensator| ast_5(compensator).inward()] {
        let free = case(ZDirection).plan_law("held", "smooth").unwrap();
        let wide = with_limit(case(ZDirection), 1e6);
        assert_eq!(wide.plan_law("held", "smooth").unwrap(), free);
    }
    let impossible = with_limit(ast_5(ZDirection), 1e-12);
    check(&impossible, 0.5);
    let cubic = ast_5(ZDirection).plan_law("held", "cubic").unwrap();
    assert_eq!(impossible.plan_law("held", "cubic").unwrap(), cubic);
}

/// Checks everything that the case's smooth law promises, on a dense grid.
fn check(case: &Case, offset: f64) {
    check_law(case, &case.plan_law("held", "smooth").unwrap(), offset);
}

fn check_law(case: &Case, law: &SpiralLaw, offset: f64) {
    let RadialRange { inner, outer } = case.task.range;
    assert_eq!(law.value(0.0), inner);
    assert!((law.value(law.end()) - outer).abs() < 1e-13 * (1.0 + outer));
    for n in joints(law) {
        let (before, after) = (law.series_before(n), law.series(n));
        for (k, allowed) in [(0, 1e-13), (1, 1e-12), (2, 1e-11)] {
            let jump = (before[k] - after[k]).abs();
            assert!(
                jump <= allowed * (1.0 + outer),
                "order {k} jumps by {jump} at {n}"
            );
        }
    }
    for i in 0..400 {
        let (rho, rate) = rate_at(law, law.end() * (f64::from(i) + offset) / 400.0);
        let limit = case
            .residual_feeds(rho, 211)
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        assert!(
            rate > 0.0 && rate <= limit,
            "{rate} over {limit} at ρ = {rho}"
        );
    }
}

proptest! {
    #![proptest_config(one_case_in(8))]

    #[test]
    fn on_polynomials_the_law_never_exceeds_the_residual_feed(
        terms in terms(TERMS),
        which in any::<u8>(),
        hole in prop::option::of(0.1..3.0f64),
        offset in 0.0..1.0f64,
    ) {
        let case = Case::new(polynomial(terms), compensator(which), 8.0, 1.0, 50.0);
        check(&case.with_hole(hole.unwrap_or(0.0)), offset);
    }

    #[test]
    fn on_arrays_the_law_never_exceeds_the_residual_feed(
        amplitude in 0.001..0.02f64,
        frequency in 0.1..1.0f64,
        which in any::<u8>(),
        offset in 0.0..1.0f64,
    ) {
        let surface = array(amplitude, frequency, "product");
        check(&Case::new(surface, compensator(which), 6.0, 0.4, 50.0), offset);
    }

    #[test]
    fn inward_is_the_outward_law_reversed(terms in terms(TERMS), which in any::<u8>()) {
        let case = Case::new(polynomial(terms), compensator(which), 8.0, 1.0, 50.0);
        let out = case.plan_law("held", "smooth").unwrap();
        let back = case.inward().plan_law("held", "smooth").unwrap();
        prop_assert!((out.end() - back.end()).abs() < 1e-9);
        for i in 0..=500 {
            let n = out.end() * f64::from(i) / 500.0;
            prop_assert!((back.value(out.end() - n) - out.value(n)).abs() < 1e-11);
        }
        prop_assert!(back.value(0.0) == 4.0 && back.value(back.end()).abs() < 1e-13);
    }
}

/// Where the nose does not fit, the feed is capped and the interference check reports it. Where
/// there is no surface, or nothing to cut, the feed is an error.
#[test]
fn a_part_without_a_feed_is_an_error_and_never_endless() {
    let sphere = |radius: f64| -> Arc<dyn SurfaceModel> {
        let params = Params::new().with("radius", radius).with("conic", 0.0);
        model::<Conic>(&params)
    };
    for fit in ["smooth", "cubic"] {
        for residual in ["held", "paper"] {
            let beyond = Case::new(sphere(2.0), Arc::new(Normal), 5.0, 1.0, 100.0);
            let error = beyond.plan_law(residual, fit).unwrap_err();
            assert!(
                error.to_string().contains("no feed can be found"),
                "{error}"
            );
            let nothing = Case::new(sphere(9.0), Arc::new(Normal), 5.0, 1.0, 100.0);
            let error = nothing.with_hole(2.5).plan_law(residual, fit).unwrap_err();
            assert!(error.to_string().contains("nothing to cut"), "{error}");
        }
    }
}

/// A part of an array with its aperture and hole in mm.
fn assert_law_of_less_than_a_revolution(aperture: f64, hole: f64) {
    let surface = array(1e-4, 1.0, "sum");
    let case = Case::new(surface, Arc::new(ZDirection), aperture, 1.0, 100.0);
    let case = case.with_hole(hole);
    let law = case.plan_law("held", "smooth").unwrap();
    assert!(law.end() > 0.0 && law.end() < 2.0);
    assert_eq!(law.value(0.0), hole);
    assert!((law.value(law.end()) - 0.5 * aperture).abs() < 1e-13);
    let error = case.plan_law("held", "cubic").unwrap_err();
    assert!(error.to_string().contains("too few for a cubic"), "{error}");
}

#[test]
fn tiny_parts_have_laws_of_less_than_a_revolution() {
    for (aperture, hole) in [(1e-6, 0.0), (1e-3, 0.49e-3), (0.05, 0.0)] {
        assert_law_of_less_than_a_revolution(aperture, hole);
    }
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_tiny_parts_with_and_without_a_hole_have_laws_of_less_than_a_revolution() {
    for aperture in [1e-6, 1e-3, 0.05] {
        for hole in [0.0, 0.49 * aperture] {
            assert_law_of_less_than_a_revolution(aperture, hole);
        }
    }
}

#[test]
fn thin_rings_far_out_have_a_law() {
    let case = ast_50(ZDirection).with_hole(24.99);
    let law = case.plan_law("held", "smooth").unwrap();
    assert!(off(law.end(), 0.01 / case.residual_feeds(25.0, 1)[0]) < 0.01);
}

#[test]
fn a_law_may_start_beyond_the_axis() {
    let mut case = ast_5(ZDirection);
    case.task.range.inner = -0.1;
    check(&case, 0.5);
    let beyond = case.plan_law("held", "smooth").unwrap().end();
    let turns = ast_5(ZDirection).plan_law("held", "smooth").unwrap().end();
    let least = case
        .residual_feeds(0.0, 360)
        .into_iter()
        .fold(f64::INFINITY, f64::min);
    assert!(off(beyond - turns, 0.1 / least) < 0.005);
}

#[test]
fn words_choose_the_law() {
    let feed =
        |residual, fit| AtpgFeed::new(&words(&[("residual", residual), ("fit", fit)])).unwrap();
    assert_ne!(feed("held", "smooth"), feed("paper", "smooth"));
    assert_ne!(feed("held", "smooth"), feed("held", "cubic"));
}
