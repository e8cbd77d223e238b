//! What a plugin crate registers for each strategy: its description and its constructor.

use serde::Serialize;
use turnpath_core::{
    Compensator, FeedStrategy, Params, Result, Sampler, Slot, SpindleStrategy, Strategy,
    StrategyInfo, Surface, SurfaceModel, VelocitySolver,
};

/// The constructor of a strategy from its parameters, one variant for each slot.
#[derive(Debug, Clone, Copy)]
pub enum Build {
    /// A surface model.
    Surface(fn(&Params) -> Result<Box<dyn SurfaceModel>>),
    /// A feed strategy.
    Feed(fn(&Params) -> Result<Box<dyn FeedStrategy>>),
    /// A sampler.
    Sampler(fn(&Params) -> Result<Box<dyn Sampler>>),
    /// A compensator.
    Compensator(fn(&Params) -> Result<Box<dyn Compensator>>),
    /// A velocity solver.
    Velocity(fn(&Params) -> Result<Box<dyn VelocitySolver>>),
    /// A spindle strategy.
    Spindle(fn(&Params) -> Result<Box<dyn SpindleStrategy>>),
}

/// One strategy of one plugin crate.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Registration {
    /// The crate that registered the strategy. A library may contain the code of other plugins too.
    pub crate_name: &'static str,
    /// The crate's version.
    pub crate_version: &'static str,
    /// Name, summary, source and parameters.
    pub info: StrategyInfo,
    /// The constructor.
    #[serde(skip)]
    pub build: Build,
}

inventory::collect!(Registration);

const fn info<T: Strategy>(slot: Slot) -> StrategyInfo {
    StrategyInfo {
        slot,
        name: T::NAME,
        summary: T::SUMMARY,
        source: T::SOURCE,
        params: T::PARAMS,
    }
}

macro_rules! registrar {
    ($name:ident, $slot:ident, $bound:ident, $object:ident, $what:literal) => {
        #[doc = concat!("Registers a ", $what, "; used by [`export!`](crate::export).")]
        pub const fn $name<T: Strategy + $bound + 'static>(
            crate_name: &'static str,
            crate_version: &'static str,
        ) -> Self {
            fn build<T: Strategy + $bound + 'static>(params: &Params) -> Result<Box<dyn $object>> {
                Ok(Box::new(T::new(params)?))
            }
            let build = Build::$slot(build::<T>);
            Self {
                crate_name,
                crate_version,
                info: info::<T>(Slot::$slot),
                build,
            }
        }
    };
}

impl Registration {
    /// The registrations that are linked in here, in an order that does not depend on the linker.
    pub(crate) fn all() -> Vec<Self> {
        let mut all: Vec<Self> = inventory::iter::<Self>().copied().collect();
        all.sort_by_key(|one| (one.info.slot, one.info.name, one.crate_name));
        all
    }

    /// The registration of this name that is linked in here. Tests make models with it.
    pub fn named(slot: Slot, name: &str) -> Option<Self> {
        Self::all()
            .into_iter()
            .find(|one| one.info.slot == slot && one.info.name == name)
    }

    registrar!(surfaces, Surface, Surface, SurfaceModel, "surface model");
    registrar!(
        surface_models,
        Surface,
        SurfaceModel,
        SurfaceModel,
        "surface model that answers in batches by itself"
    );
    registrar!(feeds, Feed, FeedStrategy, FeedStrategy, "feed strategy");
    registrar!(samplers, Sampler, Sampler, Sampler, "sampler");
    registrar!(
        compensators,
        Compensator,
        Compensator,
        Compensator,
        "compensator"
    );
    registrar!(
        velocities,
        Velocity,
        VelocitySolver,
        VelocitySolver,
        "velocity solver"
    );
    registrar!(
        spindles,
        Spindle,
        SpindleStrategy,
        SpindleStrategy,
        "spindle strategy"
    );
}
