//! Plugins that misbehave: the caller gets an error or a value that it can check.

#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use crate::common::{Saddle, TOOL, nodes, with_fixture};
use std::sync::Arc;
use turnpath_core::{
    CentreBuffers, CentreSeries, Locus, Nodes, Params, Sampler, Slot, StrategyError, ToolLocus,
    Velocities,
};

fn sampler(package: &str, name: &str) -> Result<Arc<dyn Sampler>, StrategyError> {
    let catalogue = with_fixture(package);
    let strategy = catalogue.find(Slot::Sampler, name).unwrap();
    strategy.offer().sampler(&Params::new())
}

fn panicked<T>(answer: Result<T, StrategyError>) -> String {
    match answer {
        Err(StrategyError::Panicked(message)) => message.into_owned(),
        Err(error) => panic!("not a panic: {error}"),
        Ok(_) => panic!("an answer"),
    }
}

#[test]
fn a_panic_in_the_constructor_is_an_error_that_says_where() {
    let message = panicked(sampler("panics", "panics-in-constructor"));
    assert!(message.starts_with("the table is empty, at "), "{message}");
    assert!(message.contains("lib.rs:"), "{message}");
}

#[test]
fn a_panic_in_a_call_is_an_error_time_and_again() {
    let sampler = sampler("panics", "panics-in-call").unwrap();
    for _ in 0..3 {
        let message = panicked(nodes(sampler.as_ref(), 0.0, 1.0));
        assert!(message.starts_with("index out of bounds"), "{message}");
    }
}

#[test]
fn panics_on_many_threads_at_once_stay_apart() {
    let sampler = sampler("panics", "panics-in-call").unwrap();
    std::thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(|| panicked(nodes(sampler.as_ref(), 0.0, 1.0)));
        }
    });
}

#[test]
fn a_panic_in_drop_goes_no_further() {
    drop(sampler("panics", "panics-in-drop").unwrap());
}

#[test]
fn a_panic_whose_value_panics_when_dropped_is_one_error() {
    let message = panicked(sampler("panics", "panics-twice"));
    assert!(message.starts_with("a value that is not text"), "{message}");
}

#[test]
fn a_parameter_that_was_not_declared_is_an_error_of_its_author() {
    let message = panicked(sampler("constant-arc", "constant-arc"));
    assert!(message.contains("`spacing`"), "{message}");
}

#[test]
fn nodes_that_are_no_numbers_arrive_as_such() {
    let sampler = sampler("nan", "returns-nan").unwrap();
    let nodes = nodes(sampler.as_ref(), 0.0, 1.0).unwrap();
    assert_eq!(nodes.iter().filter(|node| node.is_nan()).count(), 5);
}

#[test]
fn nodes_out_of_order_and_out_of_the_block_arrive_as_such() {
    let of = |name| {
        let sampler = sampler("unordered", name).unwrap();
        nodes(sampler.as_ref(), 1.0, 2.0).unwrap()
    };
    assert!(of("decreasing-nodes").is_sorted_by(|a, b| a > b));
    assert!(of("too-few").is_empty());
    assert!(of("outside-block").iter().any(|node| *node >= 2.0));
}

#[test]
fn a_surface_that_ends_gives_nan_beyond() {
    let catalogue = with_fixture("nan");
    let strategy = catalogue.find(Slot::Surface, "nan-surface").unwrap();
    let surface = strategy.offer().surface(&Params::new()).unwrap();
    let mut z = [0.0; 2];
    surface.heights(&[0.0, 2.0], &[0.0, 0.0], &mut z).unwrap();
    assert_eq!(z[0], 0.0);
    assert!(z[1].is_nan());
}

#[test]
fn velocities_that_are_no_numbers_arrive_as_such() {
    let catalogue = with_fixture("nan");
    let strategy = catalogue.find(Slot::Velocity, "nan-velocity").unwrap();
    let solver = strategy.offer().velocity(&Params::new()).unwrap();
    let at = [0.0, 1.0, 2.0];
    let given = Nodes {
        t: &at,
        c: &at,
        x: &at,
        z: &at,
        c_rate: &at,
        x_rate: &at,
        z_theta: &at,
        z_x: &at,
        at_start: true,
        at_end: true,
    };
    let (mut c, mut x, mut z) = ([0.0; 3], [0.0; 3], [0.0; 3]);
    let out = Velocities {
        c: &mut c,
        x: &mut x,
        z: &mut z,
    };
    solver.solve(given, out).unwrap();
    assert!([c, x, z].as_flattened().iter().all(|v| v.is_nan()));
}

#[test]
fn slices_of_unequal_length_do_not_reach_a_plugin() {
    let catalogue = with_fixture("nan");
    let strategy = catalogue.find(Slot::Surface, "nan-surface").unwrap();
    let surface = strategy.offer().surface(&Params::new()).unwrap();
    let error = surface
        .heights(&[0.0; 2], &[0.0; 2], &mut [0.0])
        .unwrap_err();
    assert!(error.to_string().contains("length"), "{error}");
}

#[test]
fn a_compensator_without_series_gets_the_hosts_fit() {
    let catalogue = with_fixture("plain-compensator");
    let strategy = catalogue.find(Slot::Compensator, "plain-normal").unwrap();
    let compensator = strategy.offer().compensator(&Params::new()).unwrap();
    let locus = ToolLocus::new(Arc::new(Saddle), compensator, TOOL);
    // Along ρ = 1 + t/10, θ = π/2 + t, held against differences of the centre itself.
    let (theta, rho) = (
        [[std::f64::consts::FRAC_PI_2, 1.0, 0.0, 0.0, 0.0]],
        [[1.0, 0.1, 0.0, 0.0, 0.0]],
    );
    let (mut x, mut z) = ([[f64::NAN; 5]], [[f64::NAN; 5]]);
    let out = CentreSeries {
        x: &mut x,
        z: &mut z,
    };
    locus.series(&theta, &rho, out).unwrap();
    let step = 1e-3;
    let mut room = CentreBuffers::default();
    room.resize(3);
    let at = [-step, 0.0, step];
    let along = at.map(|t| (std::f64::consts::FRAC_PI_2 + t, 1.0 + 0.1 * t));
    let (thetas, rhos) = (along.map(|p| p.0), along.map(|p| p.1));
    locus.centre(&thetas, &rhos, room.as_centres()).unwrap();
    for (series, values) in [(x[0], &room.x), (z[0], &room.z)] {
        assert!((series[0] - values[1]).abs() < 1e-12, "{series:?}");
        let slope = (values[2] - values[0]) / (2.0 * step);
        assert!((series[1] - slope).abs() < 1e-7, "{series:?} {slope}");
        let bend = (values[2] - 2.0 * values[1] + values[0]) / (2.0 * step * step);
        assert!((series[2] - bend).abs() < 1e-7, "{series:?} {bend}");
    }
}
