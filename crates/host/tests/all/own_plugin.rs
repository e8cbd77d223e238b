//! Strategies that the program makes itself cross the boundary as those of libraries do.

#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use turnpath_core::{
    Param, ParamInfo, Params, Scalar, Slot, StrategyError, Surface, SurfaceModel, kind::Length,
};
use turnpath_host::{
    Catalogue, Identity, LoadError, OwnPlugin, OwnStrategy, OwnSurface, SurfaceNeed,
};

const HEIGHT: Param<Length> = Param::length("height", "of the plane");
const PARAMS: &[ParamInfo] = &[HEIGHT.info()];
const PISTON: &[ParamInfo] = &[Param::length("piston", "").info()];

/// z = slope·x + height.
struct Plane {
    slope: f64,
    height: f64,
}

impl Surface for Plane {
    const IN_WIDE_REGISTERS: bool = false;

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
    assert_eq!(found.plugin().sha256().unwrap().map(str::len), Some(64));
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
    let twice = twice.unwrap_err();
    assert!(matches!(twice, LoadError::TwoOfOneName { .. }), "{twice:?}");
    let said = "two strategies of the slot `surface` are named `plane`: one of ";
    assert!(twice.to_string().starts_with(said), "{twice}");
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

/// A plane at the height of the need, so that the need shows.
fn needed(params: &Params, need: SurfaceNeed) -> Result<OwnSurface, StrategyError> {
    let height = params.get(HEIGHT);
    let (slope, byte_exact) = (need.error, height == 0.0);
    let height = height + need.half_width;
    let model = Box::new(Plane { slope, height });
    Ok(OwnSurface { model, byte_exact })
}

#[test]
fn a_surface_is_made_for_each_need_and_says_whether_its_bytes_may_differ() {
    let own = OwnStrategy::surface_for("needed", needed).with_params(PARAMS);
    let catalogue = Catalogue::new().with_own(lab().with(own)).unwrap();
    let found = catalogue.find(Slot::Surface, "needed").unwrap();
    let made = |height: f64, half_width: f64| {
        let params = Params::new().with("height", height);
        let need = SurfaceNeed {
            half_width,
            error: 0.5,
        };
        let (surface, byte_exact) = found.surface(&params, need).unwrap();
        let mut z = [0.0];
        surface.heights(&[2.0], &[0.0], &mut z).unwrap();
        (z[0], byte_exact)
    };
    assert_eq!(made(0.0, 3.0), (4.0, true));
    assert_eq!(made(1.0, 3.0), (5.0, false));
    assert_eq!(made(0.0, 7.0), (8.0, true));
    let params = Params::new().with("height", 0.0);
    let without = found.offer().surface(&params).map(|_| ()).unwrap_err();
    assert!(
        without.to_string().contains("for the part of a recipe"),
        "{without}"
    );
}

#[test]
fn a_surface_without_needs_is_made_as_it_is() {
    let catalogue = Catalogue::new().with_own(lab().with(plane(0.5))).unwrap();
    let found = catalogue.find(Slot::Surface, "plane").unwrap();
    let need = SurfaceNeed {
        half_width: 1.0,
        error: 1.0,
    };
    let params = Params::new().with("height", 2.0);
    let (surface, byte_exact) = found.surface(&params, need).unwrap();
    let mut z = [0.0];
    surface.heights(&[4.0], &[0.0], &mut z).unwrap();
    assert_eq!((z[0], byte_exact), (4.0, true));
}

#[test]
fn an_identity_is_that_of_one_strategy() {
    let known = plane(0.5).with_identity(Identity::Hash("c0ffee".to_owned()));
    let own = lab().with(known);
    let catalogue = Catalogue::linked().unwrap().with_own(own).unwrap();
    let found = catalogue.find(Slot::Surface, "plane").unwrap();
    assert_eq!(found.identity(), Some(&Identity::Hash("c0ffee".to_owned())));
    let others = catalogue.strategies();
    let mut others = others.filter(|one| one.info().name != "plane");
    assert!(others.all(|one| one.identity().is_none()));
}
