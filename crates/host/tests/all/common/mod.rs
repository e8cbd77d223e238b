//! A small job for strategies to work on, and shorthands for the catalogue.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]
#![allow(dead_code, reason = "each test uses what it needs")]

#[path = "../../../../../tests/support/fixtures.rs"]
pub mod fixtures;

use std::path::Path as FilePath;
use std::sync::Arc;

use turnpath_core::{
    Centres, Compensator, Cut, Direction, Job, Machine, Part, Path, Radial, RadialRange, Result,
    Revolutions, Sampler, Scalar, SpindleLaw, SpiralLaw, Surface, Tolerance, Tool, ToolLocus,
};
use turnpath_host::{Catalogue, LoadError};

/// A catalogue with this one file.
pub fn with_file(file: &FilePath) -> std::result::Result<Catalogue, LoadError> {
    let mut catalogue = Catalogue::new();
    catalogue.add_file(file).map(|()| catalogue)
}

/// A catalogue with one fixture.
pub fn with_fixture(package: &str) -> Catalogue {
    with_file(&fixtures::library(package)).unwrap()
}

/// z = x·y/100, of no crate but this one.
pub struct Saddle;

impl Surface for Saddle {
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
pub fn job() -> Job {
    Job {
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
        spindle: SpindleLaw::constant(50.0),
        machine: Machine::default(),
    }
}

pub fn law() -> SpiralLaw {
    let mut law = SpiralLaw::new();
    law.push(200.0, [2.0, -0.01, 0.0, 0.0, 0.0, 0.0]);
    law
}

/// What the sampler gives for a block of that job.
pub fn nodes(sampler: &dyn Sampler, start: f64, end: f64) -> Result<Vec<f64>> {
    onward(sampler, start, end, &mut Vec::new())
}

/// The same with a state from the block before.
pub fn onward(
    sampler: &dyn Sampler,
    start: f64,
    end: f64,
    state: &mut Vec<f64>,
) -> Result<Vec<f64>> {
    let locus = ToolLocus::new(Arc::new(Saddle), Arc::new(Above), TOOL);
    let (job, law) = (job(), law());
    let path = Path {
        job: &job,
        locus: &locus,
        law: &law,
        prepared: &[],
    };
    let mut nodes = Vec::new();
    sampler.place_onward(&path, Revolutions { start, end }, state, &mut nodes)?;
    Ok(nodes)
}
