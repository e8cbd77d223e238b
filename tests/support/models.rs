//! Surface models from the crates that compiled them.
//!
//! Where a test makes a model by `Conic::new`, the compiler makes the loops of the formula once more
//! for each width of registers.
#![allow(dead_code, reason = "every test program uses its own part")]
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::sync::Arc;

use turnpath_core::{Params, Result, Slot, Strategy, SurfaceModel};
use turnpath_plugin::{Build, Registration};

/// The model of a type that its crate exports.
pub fn model<T: Strategy>(params: &Params) -> Arc<dyn SurfaceModel> {
    try_model(T::NAME, params).unwrap()
}

/// The model of this name, if the parameters are right.
pub fn try_model(name: &str, params: &Params) -> Result<Arc<dyn SurfaceModel>> {
    let registration = Registration::named(Slot::Surface, name);
    let Some(Build::Surface(build)) = registration.map(|one| one.build) else {
        panic!("no surface `{name}` is linked in")
    };
    build(params).map(Arc::from)
}
