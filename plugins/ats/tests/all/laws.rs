//! Feed `ats` against its own recursion, against cusps by brute force, and against the cost of
//! ATPG.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::sync::Arc;

use crate::common::{Case, ast_5, mla_5};
use crate::models::model;
use crate::random::{array, compensating, one_case_in, polynomial, terms};
use proptest::prelude::{any, prop, proptest};
use turnpath_atpg::AtpgFeed;
use turnpath_ats::AtsFeed;
use turnpath_core::{Direction, ParamValue, Params, Scalar, SpiralLaw, Strategy, Surface, angle};
use turnpath_nose_radius::{Normal, Uncompensated, ZDirection};
use turnpath_surfaces::{Astigmatic, Conic};

/// The margin of the feed below the residual feed, and the largest deviation of its pieces.
const MARGIN: f64 = 1.5e-3;
const STRAY: f64 = 5e-5;
/// A nose of 1 mm fits into polynomials of these terms on parts of 6 mm.
const TERMS: [f64; 5] = [0.1, 0.1, 0.03, 0.003, 0.0005];

fn ats(case: &Case) -> SpiralLaw {
    case.law(&AtsFeed::default()).unwrap()
}

fn outward(case: &Case) -> f64 {
    match case.task.direction {
        Direction::Outward => 1.0,
        Direction::Inward => -1.0,
    }
}

/// Checks that ρ and its first two derivatives are continuous across every knot, and that the path
/// begins and ends where the range requires: every angle has passed the end, and one of them only
/// just.
fn check_shape(case: &Case, law: &SpiralLaw) {
    let (sign, range) = (outward(case), case.task.range);
    let (from, to) = match case.task.direction {
        Direction::Outward => (range.inner, range.outer),
        Direction::Inward => (range.outer, range.inner),
    };
    assert_eq!(law.series(0.0)[..3], [from, 0.0, 0.0]);
    for piece in law.pieces().iter().skip(1) {
        let (before, after) = (law.series_before(piece.start), law.series(piece.start));
        let scale = 1.0 + before[2].abs();
        for (k, allowed) in [(0, 1e-12), (1, 1e-11), (2, 1e-8)] {
            let jump = (before[k] - after[k]).abs();
            assert!(jump <= allowed * scale, "{k} jumps by {jump}");
        }
    }
    let turn = |start: f64| (0..=3000).map(move |i| start + f64::from(i) / 3000.0);
    let ahead = |n: f64| sign * (law.value(n) - to);
    let least = turn(law.end() - 1.0)
        .map(ahead)
        .fold(f64::INFINITY, f64::min);
    assert!(least >= 0.0, "an angle ends {least} mm short");
    for n in turn(0.0).filter(|n| n + 1.0 <= law.end()) {
        let (way, next) = (
            sign * (law.value(n) - from),
            law.value(n + 1.0) - law.value(n),
        );
        assert!(
            way >= 0.0 && way <= 0.4 * next.abs() * (1.0 + 1e-2) + 1e-15,
            "{way} {next}"
        );
    }
    let slowest = ahead(law.end() - 1.0);
    let feed = case.residual_feed(0.0, to);
    assert!(slowest <= 0.2 * feed, "{slowest} mm too far");
}

/// Checks that at random points the cusp to the next pass is within the tolerance, and near it
/// unless the feed is near its cap.
fn check_cusps(case: &Case, law: &SpiralLaw, offset: f64) {
    check_cusps_between(case, law, offset, [2.0, law.end() - 1.0]);
}

/// The same check for passes from one turn to another.
fn check_cusps_between(case: &Case, law: &SpiralLaw, offset: f64, [from, to]: [f64; 2]) {
    let tolerance = case.task.tolerance.residual;
    let cap = 0.1 * case.task.tool.nose_radius;
    let places = 150;
    for i in 0..places {
        let n = from + (to - from) * (f64::from(i) + offset) / f64::from(places);
        let theta = angle(n);
        let (rho, next) = (law.value(n), law.value(n + 1.0));
        let gap = outward(case) * (next - rho);
        let (one, two) = (case.centre(theta, rho), case.centre(theta, next));
        let share = case.cusp(theta, one, two) / tolerance;
        assert!(share <= 1.0, "{share} of the tolerance at {theta}, {rho}");
        assert!(
            share >= 0.98 || gap > 0.4 * cap,
            "{share} of the tolerance at {theta}, {rho}"
        );
    }
}

/// ℓ(N + 1) = ℓ(N) ± F, with F from the host's own residual feed. The smooth cap takes less than a
/// part in 10⁵ here.
#[test]
fn the_law_is_the_recursion_of_the_hosts_residual_feed() {
    for case in [ast_5(ZDirection), ast_5(Normal).inward(), mla_5(ZDirection)] {
        let law = ats(&case);
        let sign = outward(&case);
        for i in 0..2000 {
            let n = 2.0 + (law.end() - 3.0) * f64::from(i) / 2000.0;
            let (theta, rho) = (angle(n), law.value(n));
            let half = 0.5 * sign * (1.0 - MARGIN) * case.residual_feed(theta, rho);
            let feed = (1.0 - MARGIN) * case.residual_feed(theta, rho + half);
            let gap = sign * (law.value(n + 1.0) - rho);
            assert!((gap / feed - 1.0).abs() < STRAY, "{gap} for {feed} at {n}");
        }
    }
}

/// q over two turns: from rest, by 0.4 of the feed in the first turn, and by all of it from the
/// third on.
#[test]
fn the_first_two_turns_bring_the_feed_in() {
    let case = ast_5(ZDirection);
    let law = ats(&case);
    assert_eq!(law.series(0.0)[..3], [0.0; 3]);
    for i in 0..100 {
        let n = f64::from(i) / 50.0;
        let before = if n < 1.0 { 0.0 } else { law.value(n - 1.0) };
        let u = n - n.floor();
        let rest = u * u * u * u * (1.0 - 0.6 * u);
        let q = if n < 1.0 { rest } else { 0.4 + u - rest };
        let half = 0.5 * (1.0 - MARGIN) * case.residual_feed(angle(n), before);
        let feed = (1.0 - MARGIN) * case.residual_feed(angle(n), before + half);
        assert!((law.value(n) - before - q * feed).abs() <= STRAY * feed);
    }
}

#[test]
fn on_the_papers_parts_the_cusps_hold_in_both_directions() {
    for case in [
        ast_5(ZDirection),
        ast_5(ZDirection).inward(),
        ast_5(Normal),
        mla_5(ZDirection),
        mla_5(ZDirection).inward(),
    ] {
        let law = ats(&case);
        check_shape(&case, &law);
        check_cusps(&case, &law, 0.37);
    }
}

/// The least and the largest ρ of the turn that begins at `start`.
fn spread(law: &SpiralLaw, start: f64) -> (f64, f64) {
    let places = (0..720).map(|i| law.value(start + f64::from(i) / 720.0));
    places.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), rho| {
        (rho.min(a), rho.max(b))
    })
}

/// Angles drift apart on their way, so the two directions differ. Inward, the fast angles cross the
/// axis before the slow ones reach it.
#[test]
fn inward_is_a_law_of_its_own() {
    let (out, back) = (ats(&ast_5(ZDirection)), ats(&ast_5(ZDirection).inward()));
    let (least, most) = spread(&back, 0.0);
    assert!(most - least < 0.03, "the rim, cut inward");
    let (least, most) = spread(&out, out.end() - 1.0);
    assert!(most - least > 0.3, "the rim, cut outward");
    let (least, _) = spread(&back, back.end() - 1.0);
    assert!((-0.6..-0.4).contains(&least), "{least} mm at the centre");
}

/// The law is the outward law of the mirror image, run backwards over whole turns. It is C² at all
/// joins, ends at rest on the axis and never goes beyond it, and its cusps keep the tolerance.
#[test]
fn backwards_it_closes_at_the_axis() {
    let mut words = Params::new();
    words.set("inward", ParamValue::Text("backwards".to_owned()));
    let feed = AtsFeed::new(&words).unwrap();
    let mirrored = model::<Astigmatic>(&Params::new().with("k", -0.08));
    for (case, mirrored) in [
        (
            ast_5(ZDirection),
            Case::new(mirrored, Arc::new(ZDirection), 5.0, 1.0, 100.0),
        ),
        (mla_5(ZDirection), mla_5(ZDirection)),
    ] {
        let out = ats(&mirrored);
        assert_eq!(case.law(&feed).unwrap().end(), ats(&case).end(), "outward");
        let case = case.inward();
        let law = case.law(&feed).unwrap();
        assert!((law.end() - out.end().ceil()).abs() < 1e-10);
        for i in 0..=5000 {
            let n = out.end() * f64::from(i) / 5000.0;
            let off = (law.value(law.end() - n) - out.value(n)).abs();
            assert!(off < 1e-10, "{off} at {n}");
        }
        let end = law.series_before(law.end());
        assert!(end[..3].iter().all(|k| k.abs() < 1e-15), "{end:?}");
        let least = (0..=200_000).map(|i| law.value(law.end() * f64::from(i) / 2e5));
        assert!(least.fold(f64::INFINITY, f64::min) > -1e-15);
        for piece in law.pieces().iter().skip(1) {
            let (before, after) = (law.series_before(piece.start), law.series(piece.start));
            for (k, allowed) in [(0, 1e-12), (1, 1e-10), (2, 1e-7)] {
                let jump = (before[k] - after[k]).abs();
                assert!(jump <= allowed * (1.0 + before[2].abs()), "{k}: {jump}");
            }
        }
        check_cusps_between(&case, &law, 0.37, [0.0, law.end() - 3.0]);
    }
}

/// RMS of ρ'' over the law, mm.
fn bend(law: &SpiralLaw) -> f64 {
    let places = 200_000;
    let squared = (0..places).map(|i| {
        let second = 2.0 * law.series(law.end() * f64::from(i) / f64::from(places))[2];
        second * second
    });
    (squared.sum::<f64>() / f64::from(places)).sqrt()
}

/// X = ρ here, so its acceleration is ρ''(ω/2π)². The measured values are 7.8e5 and 9.2e5 times
/// those of ATPG on AST-5 (outward, inward), and 3.3e5 and 6.7e5 times on MLA-5.
#[test]
fn x_accelerates_hundreds_of_thousands_of_times_as_much_as_with_atpg() {
    let mut words = Params::new();
    for (name, word) in [("residual", "held"), ("fit", "smooth")] {
        words.set(name, ParamValue::Text(word.to_owned()));
    }
    let atpg = AtpgFeed::new(&words).unwrap();
    for case in [
        ast_5(ZDirection),
        ast_5(ZDirection).inward(),
        mla_5(ZDirection),
        mla_5(ZDirection).inward(),
    ] {
        let ratio = bend(&ats(&case)) / bend(&case.law(&atpg).unwrap());
        assert!((2e5..2e6).contains(&ratio), "{ratio}");
    }
}

/// Within a turn the rate swings between −3 and +3 mm/rev near AST-5's rim.
#[test]
fn near_the_rim_of_the_saddle_the_rate_swings_by_3_mm_a_turn() {
    let law = ats(&ast_5(ZDirection));
    let rates = (0..720).map(|i| law.rate(law.end() - 2.0 + f64::from(i) / 720.0));
    let (least, most) = rates.fold((0.0f64, 0.0f64), |(a, b), r| (a.min(r), b.max(r)));
    assert!(
        (-3.5..-2.5).contains(&least) && (2.5..3.5).contains(&most),
        "{least} {most}"
    );
}

/// A roof whose ridge is some 10 nm wide. Its curvature there is thousands of times that of the
/// nose.
#[test]
fn an_edge_is_an_error_that_names_the_radius_and_a_way_out() {
    struct Roof;
    impl Surface for Roof {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, _: S) -> S {
            (x.squared() + 1e-10).sqrt() * -0.05
        }
    }
    let case = Case::new(Arc::new(Roof), Arc::new(Uncompensated), 4.0, 1.0, 100.0);
    let error = case
        .with_hole(1.0)
        .law(&AtsFeed::default())
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("ρ = 1.000 mm") && error.contains("`atpg`"),
        "{error}"
    );
}

#[test]
fn nothing_to_cut_is_an_error() {
    let error = ast_5(ZDirection)
        .with_hole(2.5)
        .law(&AtsFeed::default())
        .unwrap_err();
    assert!(error.to_string().contains("nothing to cut"), "{error}");
}

#[test]
fn thin_rings_have_a_law_of_a_few_turns() {
    for direction in [Direction::Outward, Direction::Inward] {
        let mut case = ast_5(ZDirection).with_hole(2.4999);
        case.task.direction = direction;
        let law = ats(&case);
        check_shape(&case, &law);
        assert!(law.end() < 3.0, "{}", law.end());
    }
}

fn check(mut case: Case, inward: bool, offset: f64) {
    if inward {
        case = case.inward();
    }
    let law = ats(&case);
    check_shape(&case, &law);
    check_cusps(&case, &law, offset);
}

/// On a part of rotational symmetry no angle is slower than another. The rate follows the radius
/// alone and never pauses.
#[test]
fn on_a_sphere_the_law_is_as_even_as_one_of_the_radius() {
    let params = Params::new().with("radius", 60.0).with("conic", 0.0);
    let surface = model::<Conic>(&params);
    for direction in [Direction::Outward, Direction::Inward] {
        let mut case = Case::new(surface.clone(), Arc::new(ZDirection), 20.0, 1.0, 100.0);
        case.task.direction = direction;
        let law = ats(&case);
        check_shape(&case, &law);
        for i in 0..500 {
            let n = 2.0 + (law.end() - 2.0) * f64::from(i) / 500.0;
            let feed = case.residual_feed(0.0, law.value(n));
            let share = law.rate(n).abs() / feed;
            assert!((share - 1.0 + MARGIN).abs() < 1e-4, "{share} at {n}");
        }
    }
}

proptest! {
    #![proptest_config(one_case_in(8))]

    #[test]
    fn on_polynomials_the_law_is_smooth_covers_the_range_and_holds(
        terms in terms(TERMS),
        which in any::<bool>(),
        inward in any::<bool>(),
        hole in prop::option::of(0.1..2.0f64),
        tolerance in 10.0..500.0f64,
        offset in 0.0..1.0f64,
    ) {
        let case = Case::new(polynomial(terms), compensating(which), 6.0, 1.0, tolerance);
        check(case.with_hole(hole.unwrap_or(0.0)), inward, offset);
    }

    #[test]
    fn on_arrays_the_law_is_smooth_covers_the_range_and_holds(
        amplitude in 0.001..0.008f64,
        frequency in 0.1..0.5f64,
        which in any::<bool>(),
        inward in any::<bool>(),
        offset in 0.0..1.0f64,
    ) {
        let surface = array(amplitude, frequency, "product");
        check(Case::new(surface, compensating(which), 6.0, 0.8, 100.0), inward, offset);
    }
}

/// On slopes of 75 degrees feeds differ by far more than the part is wide.
#[test]
fn a_law_whose_fast_angles_leave_the_part_is_refused_with_what_helps() {
    for direction in [Direction::Outward, Direction::Inward] {
        let surface = model::<Astigmatic>(&Params::new().with("k", 1.25));
        let mut case = Case::new(surface, Arc::new(ZDirection), 3.0, 0.3, 5000.0);
        case.task.direction = direction;
        let refused = case.law(&AtsFeed::default()).unwrap_err().to_string();
        assert!(refused.contains("`atpg`"), "{refused}");
    }
}
