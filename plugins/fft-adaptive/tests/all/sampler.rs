//! Sampler `fft-adaptive` against closed forms, and on random paths.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::f64::consts::TAU;
use std::sync::Arc;

use crate::common::{Case, mla_5};
use crate::models::model;
use crate::random::{array, compensating, one_case_in};
use proptest::prelude::{any, prop_assert, prop_assert_eq, proptest};
use turnpath_core::{
    Compensator, DEG, NM, NodeList, ParamValue, Params, Path, Result, Revolutions, Sampler, Scalar,
    SpiralLaw, Strategy, Surface,
};
use turnpath_fft_adaptive::FftAdaptiveSampler;
use turnpath_nose_radius::{Normal, Uncompensated, ZDirection};
use turnpath_surfaces::Astigmatic;

fn sampler(chord: &str, curvature: &str, max_step: f64) -> FftAdaptiveSampler {
    let mut params = Params::new().with("max_step", max_step * DEG);
    params.set("chord", ParamValue::Text(chord.to_owned()));
    params.set("curvature", ParamValue::Text(curvature.to_owned()));
    FftAdaptiveSampler::new(&params).unwrap()
}

fn place(
    sampler: &FftAdaptiveSampler,
    case: &Case,
    law: &SpiralLaw,
    start: f64,
    end: f64,
) -> Result<Vec<f64>> {
    let path = Path {
        task: &case.task,
        locus: &case.locus,
        law,
        spindle: &case.spindle,
    };
    let mut nodes = NodeList::default();
    sampler
        .plan(&path)?
        .place(&path, Revolutions { start, end }, &mut nodes)?;
    Ok(nodes.revolutions().to_vec())
}

/// The law of circles of one radius: it does not move.
fn circles(rho: f64, turns: f64) -> SpiralLaw {
    let mut law = SpiralLaw::new();
    law.push(turns, [rho, 0.0, 0.0, 0.0, 0.0, 0.0]);
    law
}

fn waves(amplitude: f64, count: i32) -> Case {
    struct Waves(f64, i32);
    impl Surface for Waves {
        const IN_WIDE_REGISTERS: bool = false;

        /// A cos(mθ) at every radius, from (x + iy)^m.
        fn sag<S: Scalar>(&self, x: S, y: S) -> S {
            (y.atan2(x) * f64::from(self.1)).cos() * self.0
        }
    }
    let surface = Arc::new(Waves(amplitude, count));
    Case::new(surface, Arc::new(Uncompensated), 10.0, 1.0, 20.0)
}

/// A wave of 30 nm has its 12th harmonic above 20 nm, so no step is longer than 15°. A wave of 15
/// nm has no such harmonic, and the curvature would allow more than 45°.
#[test]
fn waves_as_high_as_the_tolerance_set_the_longest_step() {
    let law = circles(4.0, 3.0);
    let high = place(
        &sampler("full", "start", 45.0),
        &waves(30.0 * NM, 12),
        &law,
        0.0,
        3.0,
    );
    let high = high.unwrap();
    let longest = |nodes: &[f64]| {
        let steps = nodes.windows(2).map(|pair| pair[1] - pair[0]);
        360.0 * steps.fold(0.0, f64::max)
    };
    assert!((longest(&high) - 15.0).abs() < 0.01, "{}", longest(&high));
    let low = place(
        &sampler("full", "start", 45.0),
        &waves(15.0 * NM, 2),
        &law,
        0.0,
        3.0,
    );
    assert!((longest(&low.unwrap()) - 45.0).abs() < 1e-9);
}

/// At the crest of waves of 5 µm, |d²z/dθ²| = m²A. Δθ is sqrt(8e/(m²A)), or half of it.
#[test]
fn at_a_crest_the_step_is_the_chord_of_its_curvature() {
    let case = waves(5e-3, 6);
    let expected = (8.0 * 20.0 * NM / (36.0 * 5e-3)).sqrt() / TAU;
    for (chord, part) in [("full", 1.0), ("half", 0.5)] {
        let nodes = place(
            &sampler(chord, "start", 45.0),
            &case,
            &circles(4.0, 1.0),
            0.0,
            1.0,
        );
        let first = nodes.unwrap()[1];
        assert!((first / (part * expected) - 1.0).abs() < 1e-4, "{first}");
    }
}

/// A paraboloid is flat along every circle, so the printed rule takes its largest steps. Along the
/// spiral d²z/dθ² is 2cρ'², and the curvature of the step itself includes it.
#[test]
fn as_printed_the_curve_is_the_circle_through_the_start() {
    struct Bowl;
    impl Surface for Bowl {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, y: S) -> S {
            (x.squared() + y.squared()) * 0.1
        }
    }
    let case = Case::new(Arc::new(Bowl), Arc::new(Uncompensated), 10.0, 1.0, 20.0);
    let mut law = SpiralLaw::new();
    law.push(1.0, [2.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
    let count = |curvature: &str| {
        let nodes = place(&sampler("full", curvature, 45.0), &case, &law, 0.0, 1.0);
        nodes.unwrap().len()
    };
    assert_eq!(count("start"), 8);
    // Δθ² = 8e/(2cρ'²), 10.2°.
    assert_eq!(count("step"), 36);
}

/// With the largest curvature on the step, the sagitta of every segment, straight in θ, stays
/// within the tolerance. With the curvature at the start alone it is many times that.
#[test]
fn the_steps_own_curvature_keeps_the_chord_within_the_tolerance() {
    let case = mla_5(Uncompensated);
    let mut case = case;
    case.task.tolerance.interpolation = 20.0 * NM;
    let law = circles(4.3, 1.0);
    let worst = |curvature: &str| {
        let mut nodes = place(&sampler("full", curvature, 45.0), &case, &law, 0.0, 1.0).unwrap();
        nodes.push(1.0);
        let height = |n: f64| {
            let (sin, cos) = Scalar::sin_cos(TAU * n);
            let mut z = [f64::NAN];
            let surface = &case.surface;
            surface.heights(&[4.3 * cos], &[4.3 * sin], &mut z).unwrap();
            z[0]
        };
        let mut worst: f64 = 0.0;
        for pair in nodes.windows(2) {
            let (from, to) = (height(pair[0]), height(pair[1]));
            for i in 1..32 {
                let s = f64::from(i) / 32.0;
                let played = from + s * (to - from);
                worst = worst.max((played - height(pair[0] + s * (pair[1] - pair[0]))).abs());
            }
        }
        worst / NM
    };
    assert!((19.0..=20.05).contains(&worst("step")), "{}", worst("step"));
    assert!(worst("start") > 100.0, "{}", worst("start"));
}

/// A turn of z = kρ² sin 2θ has ∮ dθ/Δθ = sqrt(kρ²/2e)·∮ sqrt|sin 2θ| dθ points, which is 4.7926
/// times the root. The look ahead takes two or three more at each of the four inflections. The
/// harmonics have no effect, since the second allows 90°. So ten times the tolerance takes a third
/// of the points, where eq. 10 would take 0.56 of them.
#[test]
fn points_of_a_turn_are_those_of_straight_chords() {
    let k = 3.84e-4;
    let surface = model::<Astigmatic>(&Params::new().with("k", k));
    for (rho, tolerance) in [(20.0, 10.0), (20.0, 100.0), (5.0, 10.0)] {
        let case = Case::new(
            surface.clone(),
            Arc::new(Uncompensated),
            50.0,
            1.0,
            tolerance,
        );
        let nodes = place(
            &sampler("full", "step", 45.0),
            &case,
            &circles(rho, 1.0),
            0.0,
            1.0,
        );
        let expected = 4.7926 * (k * rho * rho / (2.0 * tolerance * NM)).sqrt();
        let more = nodes.unwrap().len() as f64 - expected;
        assert!((0.0..12.0).contains(&more), "{more} more than {expected}");
    }
}

#[test]
fn an_edge_is_an_error_that_names_the_position() {
    struct Roof;
    impl Surface for Roof {
        const IN_WIDE_REGISTERS: bool = false;

        fn sag<S: Scalar>(&self, x: S, _: S) -> S {
            (x.squared() + 1e-22).sqrt()
        }
    }
    let case = Case::new(Arc::new(Roof), Arc::new(Uncompensated), 10.0, 1.0, 1e-3);
    let error = place(
        &sampler("full", "step", 45.0),
        &case,
        &circles(4.0, 1.0),
        0.0,
        1.0,
    );
    let error = error.unwrap_err().to_string();
    assert!(error.contains("ρ = 4.0000 mm"), "{error}");
}

/// The path goes through the axis, where arcs have no length.
#[test]
fn the_axis_itself_is_not_an_obstacle() {
    let params = Params::new().with("k", 0.08);
    let surface = model::<Astigmatic>(&params);
    for compensator in [
        Arc::new(ZDirection) as Arc<dyn Compensator>,
        Arc::new(Normal),
    ] {
        let case = Case::new(surface.clone(), compensator, 5.0, 1.0, 100.0);
        let mut law = SpiralLaw::new();
        law.push(3.0, [0.0, 0.025, 0.0, 0.0, 0.0, 0.0]);
        law.push(3.0, [0.075, 0.0, 0.0, 0.0, 0.0, 0.0]);
        for (start, end) in [(0.0, 3.0), (3.0, 6.0)] {
            let nodes = place(&sampler("full", "step", 45.0), &case, &law, start, end).unwrap();
            assert!((24..500).contains(&nodes.len()), "{}", nodes.len());
        }
        let still = place(
            &sampler("full", "step", 45.0),
            &case,
            &circles(0.0, 1.0),
            0.0,
            1.0,
        );
        assert_eq!(still.unwrap().len(), 8);
    }
}

proptest! {
    #![proptest_config(one_case_in(8))]

    #[test]
    fn nodes_increase_begin_every_turn_and_do_not_depend_on_blocks(
        amplitude in 0.001..0.01f64,
        frequency in 0.1..0.6f64,
        tolerance in 5.0..500.0f64,
        feed in 0.005..0.05f64,
        turns in 1.0..9.0f64,
        which in any::<bool>(),
        curvature in any::<bool>(),
        max_step in 5.0..90.0f64,
    ) {
        let surface = array(amplitude, frequency, "product");
        let case = Case::new(surface, compensating(which), 6.0, 0.5, tolerance);
        let mut law = SpiralLaw::new();
        law.push(turns, [2.5, -feed, 0.0, 0.0, 0.0, 0.0]);
        let curvature = if curvature { "step" } else { "start" };
        let sampler = sampler("full", curvature, max_step);
        let whole = place(&sampler, &case, &law, 0.0, turns).unwrap();
        let mut parts = place(&sampler, &case, &law, 0.0, 1.0).unwrap();
        parts.extend(place(&sampler, &case, &law, 1.0, turns).unwrap());
        prop_assert_eq!(&whole, &parts);
        for turn in 0..turns.ceil() as usize {
            prop_assert!(whole.contains(&(turn as f64)));
        }
        for pair in whole.windows(2) {
            let step = 360.0 * (pair[1] - pair[0]);
            prop_assert!(step > 0.0 && step <= max_step * (1.0 + 2e-3), "{}", step);
        }
        prop_assert!(whole[whole.len() - 1] < turns);
    }
}
