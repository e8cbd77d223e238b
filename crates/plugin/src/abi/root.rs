//! What a plugin library exports: its catalogue, and a constructor for each slot.

use std::sync::OnceLock;

use abi_stable::StableAbi;
use abi_stable::library::RootModule;
use abi_stable::prefix_type::PrefixTypeTrait;
use abi_stable::sabi_types::VersionStrings;
use abi_stable::std_types::RString;
use turnpath_core::{
    Compensator, FeedStrategy, Params, Result, Sampler, Slot, SpindleStrategy, StrategyError,
    SurfaceModel, VelocitySolver,
};

use super::catalogue::catalogue;
use super::compensator::OwnedCompensator;
use super::feed::OwnedFeed;
use super::params::AbiParams;
use super::reply::{Answer, Returned, answer, result};
use super::sampler::OwnedSampler;
use super::spindle::OwnedSpindle;
use super::surface::OwnedSurface;
use super::velocity::OwnedVelocity;
use crate::{Build, Registration};

/// Which strategy to build, and from which parameters.
#[repr(C)]
#[derive(StableAbi)]
pub struct AbiRequest {
    crate_name: RString,
    name: RString,
    params: AbiParams,
}

impl AbiRequest {
    /// The request for a strategy of a crate.
    pub fn new(crate_name: &str, name: &str, params: &Params) -> Self {
        Self {
            crate_name: crate_name.into(),
            name: name.into(),
            params: params.into(),
        }
    }
}

/// A library's functions: the catalogue, and one constructor for each slot. The constructor of a
/// new slot stands after the last one that every library has, and an older library has none.
#[repr(C)]
#[derive(StableAbi)]
#[sabi(kind(Prefix(prefix_ref = RootRef)))]
pub struct Root {
    pub catalogue: extern "C" fn() -> RString,
    pub surface: extern "C" fn(AbiRequest) -> Answer<OwnedSurface>,
    pub feed: extern "C" fn(AbiRequest) -> Answer<OwnedFeed>,
    pub sampler: extern "C" fn(AbiRequest) -> Answer<OwnedSampler>,
    pub compensator: extern "C" fn(AbiRequest) -> Answer<OwnedCompensator>,
    #[sabi(last_prefix_field)]
    pub velocity: extern "C" fn(AbiRequest) -> Answer<OwnedVelocity>,
    pub spindle: extern "C" fn(AbiRequest) -> Answer<OwnedSpindle>,
}

impl RootModule for RootRef {
    abi_stable::declare_root_module_statics! {RootRef}
    const BASE_NAME: &'static str = "turnpath_plugin";
    const NAME: &'static str = "turnpath_plugin";
    const VERSION_STRINGS: VersionStrings = VersionStrings::new(env!("CARGO_PKG_VERSION"));
}

/// The root of this program or library itself.
pub fn own_root() -> RootRef {
    static ROOT: OnceLock<RootRef> = OnceLock::new();
    *ROOT.get_or_init(|| {
        Root {
            catalogue,
            surface,
            feed,
            sampler,
            compensator,
            velocity,
            spindle,
        }
        .leak_into_prefix()
    })
}

/// Finds the requested strategy and builds it.
fn build<T: Returned>(
    slot: Slot,
    request: AbiRequest,
    with: impl FnOnce(Build, &Params) -> Option<Result<T>>,
) -> Answer<T::Wire> {
    answer(|| {
        let (crate_name, name) = (request.crate_name, request.name);
        let params = request.params.receive()?;
        let matches = |one: &&Registration| {
            one.info.slot == slot && one.info.name == name && one.crate_name == crate_name
        };
        let all = Registration::all();
        let found = all.iter().find(matches);
        let none = || StrategyError::failed(format!("there is no {} `{name}` here", slot.noun()));
        let built = found.and_then(|one| with(one.build, &params));
        built.unwrap_or_else(|| Err(none())).map(T::send)
    })
}

/// What a library may build for the host: a boxed object of one slot.
pub trait Constructed: Returned {
    /// The slot.
    const SLOT: Slot;

    /// The constructor of a library; `None` in one that is older than the slot.
    fn constructor(root: RootRef) -> Option<extern "C" fn(AbiRequest) -> Answer<Self::Wire>>;
}

/// Builds a strategy of a library.
pub fn construct<T: Constructed>(root: RootRef, request: AbiRequest) -> Result<T> {
    match T::constructor(root) {
        Some(constructor) => result(constructor(request)).and_then(T::receive),
        None => {
            let what = T::SLOT.noun();
            Err(StrategyError::failed(format!(
                "this library builds no {what}"
            )))
        }
    }
}

/// The exported constructor of each slot, and the host's way to it.
macro_rules! constructors {
    ($($name:ident: $slot:ident, $object:ident;)*) => {$(
        extern "C" fn $name(request: AbiRequest) -> Answer<<Box<dyn $object> as Returned>::Wire> {
            build(Slot::$slot, request, |build, params| match build {
                Build::$slot(build) => Some(build(params)),
                _ => None,
            })
        }

        impl Constructed for Box<dyn $object> {
            const SLOT: Slot = Slot::$slot;

            fn constructor(
                root: RootRef,
            ) -> Option<extern "C" fn(AbiRequest) -> Answer<Self::Wire>> {
                root.$name().into()
            }
        }
    )*};
}

constructors! {
    surface: Surface, SurfaceModel;
    feed: Feed, FeedStrategy;
    sampler: Sampler, Sampler;
    compensator: Compensator, Compensator;
    velocity: Velocity, VelocitySolver;
    spindle: Spindle, SpindleStrategy;
}
