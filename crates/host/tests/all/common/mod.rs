//! A small task for strategies, and shorthands for the catalogue.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]
#![allow(dead_code, reason = "each test uses what it needs")]

#[path = "../../../../../tests/support/fixtures.rs"]
pub mod fixtures;

use std::path::Path as FilePath;
use std::sync::Arc;

use turnpath_core::{
    Centres, Compensator, Cut, Direction, Machine, NodeList, Part, Path, Radial, RadialRange,
    Result, Revolutions, Sampler, Scalar, SpindleLaw, SpiralLaw, Surface, Task, Tolerance, Tool,
    ToolLocus,
};
use turnpath_host::{Catalogue, LoadError};

/// A catalogue with this one file.
pub fn with_file(file: &FilePath) -> std::result::Result<Catalogue, LoadError> {
    Catalogue::new().with_file(file)
}

/// The text of an error and of its sources, as the program prints it.
pub fn with_sources(error: &dyn std::error::Error) -> String {
    match error.source() {
        Some(source) => format!("{error}: {}", with_sources(source)),
        None => error.to_string(),
    }
}

/// A catalogue with one fixture.
pub fn with_fixture(package: &str) -> Catalogue {
    with_file(&fixtures::library(package)).unwrap()
}

/// z = x·y/100, a surface of this test alone.
pub struct Saddle;

impl Surface for Saddle {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        x * y * 0.01
    }
}

/// The nose radius above the surface.
pub struct Above;

impl Compensator for Above {
    fn radial(&self) -> Radial {
        Radial::Centre
    }

    fn centre(&self, cut: Cut<'_>, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()> {
        let along = |part: fn(f64) -> f64| -> Vec<f64> {
            theta.iter().zip(rho).map(|(t, r)| r * part(*t)).collect()
        };
        cut.surface
            .heights(&along(libm::cos), &along(libm::sin), out.z)?;
        out.z.iter_mut().for_each(|z| *z += cut.tool.nose_radius);
        out.x.copy_from_slice(rho);
        out.foot.copy_from_slice(rho);
        Ok(())
    }
}

pub const TOOL: Tool = Tool {
    nose_radius: 0.5,
    included_angle: None,
    clearance_angle: None,
    misfit: turnpath_core::Misfit::Refuse,
};

/// From 2 mm inwards, 10 µm a revolution.
pub fn task() -> Task {
    Task {
        part: Part {
            aperture_radius: 2.0,
            inner_radius: 0.0,
        },
        tool: TOOL,
        tolerance: Tolerance {
            interpolation: 1e-4,
            residual: 1e-4,
        },
        range: RadialRange {
            inner: 0.0,
            outer: 2.0,
        },
        direction: Direction::Inward,
        spindle_speed: 50.0,
        machine: Machine::default(),
    }
}

pub fn law() -> SpiralLaw {
    let mut law = SpiralLaw::new();
    law.push(200.0, [2.0, -0.01, 0.0, 0.0, 0.0, 0.0]);
    law
}

/// The nodes that the sampler places in a block of that task.
pub fn nodes(sampler: &dyn Sampler, start: f64, end: f64) -> Result<Vec<f64>> {
    place_more(sampler, start, end, &mut Vec::new())
}

/// Calls a function with the path of that task.
pub fn with_path<T>(call: impl FnOnce(&Path<'_>) -> T) -> T {
    let locus = ToolLocus::new(Arc::new(Saddle), Arc::new(Above), TOOL);
    call(&Path {
        task: &task(),
        locus: &locus,
        law: &law(),
        spindle: &SpindleLaw::constant(50.0),
    })
}

/// The same with the state that the block before left.
pub fn place_more(
    sampler: &dyn Sampler,
    start: f64,
    end: f64,
    state: &mut Vec<f64>,
) -> Result<Vec<f64>> {
    let mut nodes = NodeList::default();
    with_path(|path| {
        let plan = sampler.plan(path)?;
        plan.place_sequential(path, Revolutions { start, end }, state, &mut nodes)
    })?;
    Ok(nodes.revolutions().to_vec())
}
