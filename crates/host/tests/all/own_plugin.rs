//! Strategies that the program makes itself cross the boundary as those of libraries do.

#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use turnpath_core::{
    Param, ParamInfo, Params, Scalar, Slot, StrategyError, Surface, SurfaceModel, kind::Length,
};
use turnpath_host::{Catalogue, LoadError, OwnPlugin, OwnStrategy};

const HEIGHT: Param<Length> = Param::length("height", "of the plane");
const PARAMS: &[ParamInfo] = &[HEIGHT.info()];
const PISTON: &[ParamInfo] = &[Param::length("piston", "").info()];

/// z = slope·x + height.
struct Plane {
    slope: f64,
    height: f64,
}

impl Surface for Plane {
    fn sag<S: Scalar>(&self, x: S, _: S) -> S {
        assert!(self.height >= 0.0, "no height below zero");
        x * self.slope + self.height
    }
}

/// A plane whose slope the program holds.
fn plane(slope: f64) -> OwnStrategy {
    let make = move |params: &Params| -> Result<Box<dyn SurfaceModel>, StrategyError> {
        let height = params.get(HEIGHT);
        Ok(Box::new(Plane { slope, height }))
    };
    OwnStrategy::surface("plane", make)
        .with_summary("a plane")
        .with_params(PARAMS)
}

fn lab() -> OwnPlugin {
    OwnPlugin::new("lab", "0.3.1").with_source("lab.py", "ab".repeat(32))
}

#[test]
fn a_strategy_of_the_program_is_found_made_and_asked() {
    let catalogue = Catalogue::new().with_own(lab().with(plane(0.5))).unwrap();
    let found = catalogue.find(Slot::Surface, "plane").unwrap();
    assert_eq!(
        (found.info().summary, found.info().params),
        ("a plane", PARAMS)
    );
    assert_eq!(found.plugin().to_string(), "lab 0.3.1 (lab.py)");
    assert_eq!(found.plugin().sha256.as_ref().map(String::len), Some(64));
    let params = Params::new().with("height", 2.0);
    let surface = found.offer().surface(&params).unwrap();
    let mut z = [0.0; 2];
    surface.heights(&[1.0, 4.0], &[0.0; 2], &mut z).unwrap();
    assert_eq!(z, [2.5, 4.0]);
    let other_slot = found.offer().sampler(&params).map(|_| ());
    assert!(
        other_slot
            .unwrap_err()
            .to_string()
            .contains("makes no sampler")
    );
}

#[test]
fn its_panics_are_errors_when_it_is_made_and_when_it_is_asked() {
    let catalogue = Catalogue::new().with_own(lab().with(plane(0.5))).unwrap();
    let offer = catalogue.find(Slot::Surface, "plane").unwrap().offer();
    let not_made = offer.surface(&Params::new()).map(|_| ()).unwrap_err();
    assert!(
        not_made
            .to_string()
            .contains("reads the parameter `height`"),
        "{not_made}"
    );
    let surface = offer.surface(&Params::new().with("height", -1.0)).unwrap();
    let asked = surface.heights(&[1.0], &[0.0], &mut [0.0]).unwrap_err();
    assert!(matches!(asked, StrategyError::Panicked(_)), "{asked}");
    assert!(
        asked.to_string().contains("no height below zero"),
        "{asked}"
    );
}

#[test]
fn a_name_twice_and_a_key_of_the_host_are_refused_and_leave_nothing() {
    let mut catalogue = Catalogue::new();
    let twice = catalogue.add_own(lab().with(plane(0.5)).with(plane(0.6)));
    assert!(
        matches!(twice, Err(LoadError::TwoOfOneName { .. })),
        "{twice:?}"
    );
    let host_key = catalogue.add_own(lab().with(plane(0.5).with_params(PISTON)));
    assert!(
        matches!(host_key, Err(LoadError::HostKey { .. })),
        "{host_key:?}"
    );
    assert_eq!(
        (catalogue.strategies().count(), catalogue.plugins().len()),
        (0, 0)
    );
}

#[test]
fn a_strategy_that_differs_between_machines_says_so() {
    let own = lab().with(plane(0.5).differs_between_machines());
    let catalogue = Catalogue::new().with_own(own).unwrap();
    assert_eq!(catalogue.plugins()[0].inexact, ["surface plane"]);
}
