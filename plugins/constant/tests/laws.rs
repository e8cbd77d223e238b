//! The constant law: its ends, and the feed that it derives on the saddle AST-5.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

#[path = "../../../tests/support/models.rs"]
mod models;

use std::sync::Arc;

use models::model;
use turnpath_constant::Constant;
use turnpath_core::{
    Compensator, Continuation, Direction, FeedStrategy, Machine, NM, Params, Part, RadialRange,
    Result, Setup, SpiralLaw, Strategy, StrategyError, Task, Tolerance, Tool, ToolLocus, UM,
};
use turnpath_nose_radius::{Normal, Uncompensated, ZDirection};
use turnpath_surfaces::{Astigmatic, Conic};

/// k of z = kρ² sin 2θ, the rim and the nose.
const K: f64 = 0.08;
const RIM: f64 = 2.5;
const NOSE: f64 = 1.0;
const RESIDUAL: f64 = 100.0 * NM;
/// The margin of a derived feed below the smallest feed.
const MARGIN: f64 = 1e-4;

fn task(inner: f64, direction: Direction) -> Task {
    Task {
        part: Part {
            aperture_radius: RIM,
            inner_radius: inner,
        },
        tool: Tool {
            nose_radius: NOSE,
            included_angle: None,
            clearance_angle: None,
            misfit: turnpath_core::Misfit::Refuse,
        },
        tolerance: Tolerance {
            interpolation: RESIDUAL,
            residual: RESIDUAL,
        },
        range: RadialRange { inner, outer: RIM },
        direction,
        spindle_speed: 52.0,
        machine: Machine::default(),
    }
}

fn saddle(compensator: Arc<dyn Compensator>) -> ToolLocus {
    let surface = model::<Astigmatic>(&Params::new().with("k", K));
    ToolLocus::new(surface, compensator, task(0.0, Direction::Inward).tool)
}

fn law(params: &Params, task: &Task, locus: &ToolLocus) -> Result<SpiralLaw> {
    let setup = Setup { task, locus };
    let mut pieces = Vec::new();
    let mut plan = Constant::new(params)?.plan(setup)?;
    assert_eq!(plan.extend(setup, &mut pieces)?, Continuation::End);
    let mut law = SpiralLaw::new();
    for piece in pieces {
        law.push(piece.length, piece.coefficients);
    }
    Ok(law)
}

fn derived_feed(compensator: Arc<dyn Compensator>) -> f64 {
    let task = task(0.0, Direction::Outward);
    law(&Params::new(), &task, &saddle(compensator))
        .unwrap()
        .series(0.0)[1]
}

#[test]
fn a_given_feed_runs_from_one_end_of_the_range_to_the_other() {
    for feed in [10.0 * UM, 7.3 * UM, 1.0 / 3.0] {
        let params = Params::new().with("feed", feed);
        for inner in [0.0, 0.31] {
            let outward = task(inner, Direction::Outward);
            let out = law(&params, &outward, &saddle(Arc::new(ZDirection))).unwrap();
            let inward = task(inner, Direction::Inward);
            let back = law(&params, &inward, &saddle(Arc::new(ZDirection))).unwrap();
            assert_eq!((out.value(0.0), back.value(0.0)), (inner, RIM));
            assert!((out.value(out.end()) - RIM).abs() < 1e-15);
            assert!((back.value(back.end()) - inner).abs() < 1e-15);
            assert!((out.value(1.0) - out.value(0.0) - feed).abs() < 1e-15);
            assert!((back.value(0.0) - back.value(1.0) - feed).abs() < 1e-15);
        }
    }
}

/// The feed is smallest where the section arches most at the rim: sqrt(8Rε/(1 − Rκ))/w = 24.726 µm,
/// which makes 101.11 revolutions.
#[test]
fn the_derived_feed_on_the_saddle_is_the_contact_laws_minimum() {
    let w = (1.0 + 4.0 * K * K * RIM * RIM).sqrt();
    let curvature = -2.0 * K / (w * w * w);
    let closed = (8.0 * NOSE * RESIDUAL / (1.0 - NOSE * curvature)).sqrt() / w;
    assert!((closed / UM - 24.726).abs() < 1e-3);
    for compensator in [
        Arc::new(Normal) as Arc<dyn Compensator>,
        Arc::new(Uncompensated),
    ] {
        let feed = derived_feed(compensator);
        assert!(
            (feed / (closed * (1.0 - MARGIN)) - 1.0).abs() < 1e-12,
            "{feed}"
        );
        assert!((RIM / feed * (1.0 - MARGIN) - 101.11).abs() < 5e-3);
    }
}

/// The feed is smallest in the hollow. The centre at the rim touches further out there, at a with a
/// − R g_ρ(a)/w = 2.5 mm, and the feed is sqrt(8Rε(1 − Rκ))/w.
#[test]
fn the_derived_feed_on_the_saddle_is_the_centre_laws_minimum() {
    let slope = |a: f64| 2.0 * K * a;
    let stretch = |a: f64| (1.0 + slope(a) * slope(a)).sqrt();
    let foot = (0..200).fold(RIM, |a, _| RIM + NOSE * slope(a) / stretch(a));
    let w = stretch(foot);
    let gap = 1.0 - NOSE * 2.0 * K / (w * w * w);
    let closed = (8.0 * NOSE * RESIDUAL * gap).sqrt() / w;
    let feed = derived_feed(Arc::new(ZDirection));
    assert!(
        (feed / (closed * (1.0 - MARGIN)) - 1.0).abs() < 1e-12,
        "{feed} for {closed}"
    );
}

#[test]
fn a_given_feed_of_too_many_revolutions_is_an_error_on_feed() {
    let task = task(0.0, Direction::Inward);
    let locus = saddle(Arc::new(ZDirection));
    let law = |feed| law(&Params::new().with("feed", feed), &task, &locus);
    assert!(law(RIM / 0.99e7).is_ok());
    for feed in [RIM / 1.01e7, 1e-300] {
        let error = law(feed).unwrap_err();
        let on_feed = matches!(&error, StrategyError::Parameter { name, .. } if name == "feed");
        assert!(on_feed, "{error}");
        let said = error.to_string();
        assert!(said.contains("at least 2.5e-4 um/rev"), "{said}");
    }
}

#[test]
fn a_derived_feed_of_too_many_revolutions_is_left_to_the_host() {
    let mut task = task(0.0, Direction::Inward);
    task.tolerance.residual = 1e-18;
    let law = law(&Params::new(), &task, &saddle(Arc::new(ZDirection))).unwrap();
    assert!(law.end() > 2e7, "{}", law.end());
}

#[test]
fn if_the_surface_ends_within_the_range_the_error_names_the_position() {
    let params = Params::new().with("radius", 2.0).with("conic", 0.0);
    let surface = model::<Conic>(&params);
    let task = task(0.0, Direction::Inward);
    let locus = ToolLocus::new(surface, Arc::new(Normal), task.tool);
    let error = law(&Params::new(), &task, &locus).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("no feed can be found at x = 2.0"),
        "{error}"
    );
}
