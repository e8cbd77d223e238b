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
use super::reply::{Answer, Returned, answer, result};
use super::request::AbiRequest;
use super::sampler::OwnedSampler;
use super::spindle::OwnedSpindle;
use super::surface::OwnedSurface;
use super::velocity::OwnedVelocity;
use crate::{Build, Maker};

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

/// What a library may build for the host: a boxed object of one slot.
pub trait Constructed: Returned {
    /// The slot.
    const SLOT: Slot;

    /// The constructor of a library; `None` in one that is older than the slot.
    fn constructor(root: RootRef) -> Option<extern "C" fn(AbiRequest) -> Answer<Self::Wire>>;

    /// The registered function that builds it; `None` for one of another slot.
    fn function(build: Build) -> Option<fn(&Params) -> Result<Self>>;

    /// Makes it with a value of the program; `None` for one of another slot.
    fn make(maker: &Maker, params: &Params) -> Option<Result<Self>>;
}

/// Builds a strategy of a library.
pub fn construct<T: Constructed>(root: RootRef, request: AbiRequest) -> Result<T> {
    let slot = T::SLOT.noun();
    let none = || StrategyError::failed(format!("this library builds no {slot}"));
    let constructor = T::constructor(root).ok_or_else(none)?;
    result(constructor(request)).and_then(T::receive)
}

/// Makes a strategy of the program itself. It goes to the other side and back, as one of a library
/// does.
pub fn make<T: Constructed>(maker: &Maker, params: &Params) -> Result<T> {
    let slot = T::SLOT.noun();
    let none = || StrategyError::failed(format!("this program makes no {slot} of this name"));
    let answer = answer(|| {
        let made = T::make(maker, params).ok_or_else(none)?;
        made.map(T::send)
    });
    result(answer).and_then(T::receive)
}

/// Finds the requested strategy here and builds it.
extern "C" fn build<T: Constructed>(request: AbiRequest) -> Answer<T::Wire> {
    answer(|| {
        let build = request.find(T::SLOT, T::function)?;
        build(&request.params()?).map(T::send)
    })
}

/// The exported constructor of each slot, and the host's way to it.
macro_rules! constructors {
    ($($name:ident: $slot:ident, $object:ident;)*) => {
        /// The root of this program or library itself.
        pub fn own_root() -> RootRef {
            static ROOT: OnceLock<RootRef> = OnceLock::new();
            let root = || Root { catalogue, $($name: build::<Box<dyn $object>>),* };
            *ROOT.get_or_init(|| root().leak_into_prefix())
        }

        $(impl Constructed for Box<dyn $object> {
            const SLOT: Slot = Slot::$slot;

            fn constructor(
                root: RootRef,
            ) -> Option<extern "C" fn(AbiRequest) -> Answer<Self::Wire>> {
                root.$name().into()
            }

            fn function(build: Build) -> Option<fn(&Params) -> Result<Self>> {
                match build {
                    Build::$slot(build) => Some(build),
                    _ => None,
                }
            }

            fn make(maker: &Maker, params: &Params) -> Option<Result<Self>> {
                match maker {
                    Maker::$slot(make) => Some(make(params)),
                    _ => None,
                }
            }
        })*
    };
}

constructors! {
    surface: Surface, SurfaceModel;
    feed: Feed, FeedStrategy;
    sampler: Sampler, Sampler;
    compensator: Compensator, Compensator;
    velocity: Velocity, VelocitySolver;
    spindle: Spindle, SpindleStrategy;
}
