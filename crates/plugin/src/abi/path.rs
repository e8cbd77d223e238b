//! The path across the boundary.

use abi_stable::StableAbi;
use turnpath_core::{Path, Setup, SpindleLaw, SpiralLaw};

use super::data::AbiLaw;
use super::feed::{AbiSetup, lend_setup};

/// Task, locus and laws, lent for the duration of a call.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiPath<'a> {
    setup: AbiSetup<'a>,
    law: AbiLaw,
    time: AbiLaw,
}

/// Lends a path for the duration of `call`.
pub fn lend_path<T>(path: &Path<'_>, call: impl FnOnce(AbiPath<'_>) -> T) -> T {
    let setup = Setup {
        task: path.task,
        locus: path.locus,
    };
    lend_setup(setup, |setup| {
        call(AbiPath {
            setup,
            law: path.law.into(),
            time: path.spindle.as_time().into(),
        })
    })
}

impl AbiPath<'_> {
    /// Converts the path to that of the core, for the duration of `call`.
    pub fn receive<T>(self, call: impl FnOnce(&Path<'_>) -> T) -> T {
        let law = SpiralLaw::from(&self.law);
        let spindle = SpindleLaw::from_time((&self.time).into());
        self.setup.receive(|Setup { task, locus }| {
            call(&Path {
                task,
                locus,
                law: &law,
                spindle: &spindle,
            })
        })
    }
}
