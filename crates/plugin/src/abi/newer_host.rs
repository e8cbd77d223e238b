//! A library of today's boundary under a host whose boundary has grown.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};

use abi_stable::StableAbi;
use abi_stable::abi_stability::abi_checking::{
    CheckingGlobals, check_layout_compatibility, check_layout_compatibility_with_globals,
};
use abi_stable::library::RawLibrary;
use turnpath_core::{Continuation, Params, Revolutions};

use super::entry::root_if_not_newer;
use super::layout;
use super::reply::{Returned, result};
use super::request::AbiRequest;
use super::root::RootRef;
use newer::Sampler;

/// A root with one more function, `seventh`, of this type.
macro_rules! grown_root {
    ($seventh:ty) => {
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
            pub seventh: $seventh,
        }
    };
}

/// The boundary of one day: one more slot, and one more property and method of samplers.
#[allow(dead_code, reason = "a test needs a part of it")]
mod newer {
    use abi_stable::StableAbi;
    use abi_stable::std_types::RString;
    use turnpath_core::{Continuation, Path, Result, Revolutions, SamplerPlan};

    use super::super::compensator::OwnedCompensator;
    use super::super::declaration::prelude::*;
    use super::super::feed::OwnedFeed;
    use super::super::reply::Answer;
    use super::super::request::AbiRequest;
    use super::super::spindle::OwnedSpindle;
    use super::super::surface::OwnedSurface;
    use super::super::velocity::OwnedVelocity;

    pub trait Sampler: Send + Sync {
        fn needs_exact_rates(&self) -> bool;
        fn is_quiet(&self) -> bool;
        fn plan(&self, path: &Path<'_>) -> Result<Box<dyn SamplerPlan>>;
        fn continues(&self, block: Revolutions) -> Result<Continuation>;
    }

    declare! {
        Sampler: Deref AsPtr, Send Sync => AbiSampler, AbiSampler_TO, IncomingSampler<'b>;
        properties { needs_exact_rates: bool = false, is_quiet: bool = true }
        methods {
            fn plan(&self, path[&]: Path<'_>) -> Result<Box<dyn SamplerPlan>>;
        }
        later {
            fn continues(&self, block: Revolutions) -> Result<Continuation> = Ok(Continuation::End);
        }
        owned by OwnedSampler
    }

    grown_root!(extern "C" fn(AbiRequest) -> Answer<OwnedSurface>);

    /// Another boundary of that day, whose new slot has another type.
    pub mod otherwise {
        use super::*;

        grown_root!(extern "C" fn() -> RString);
    }
}

/// A boundary that has changed what it had.
#[allow(dead_code, reason = "only its layout counts")]
mod other {
    use abi_stable::StableAbi;
    use abi_stable::std_types::RVec;

    #[repr(C)]
    #[derive(StableAbi)]
    #[sabi(kind(Prefix(prefix_ref = RootRef)))]
    pub struct Root {
        #[sabi(last_prefix_field)]
        pub catalogue: extern "C" fn() -> RVec<f64>,
    }
}

/// The root of the plugin in docs/plugins.md. `cargo test` builds it as an example; with `--lib` it does
/// not.
fn root_of_a_library() -> newer::RootRef {
    let program = std::env::current_exe().unwrap();
    let examples = program.ancestors().nth(2).unwrap().join("examples");
    let library = examples.join(format!("{DLL_PREFIX}constant_arc{DLL_SUFFIX}"));
    let library = RawLibrary::load_at(&library).unwrap();
    let symbol = b"turnpath_plugin_root__constant_arc\0";
    // SAFETY: the symbol is a static, so its address may be taken as a pointer of any type.
    let entry = unsafe { library.get::<*const u8>(symbol) }.map(|symbol| *symbol);
    let entry = entry.unwrap();
    std::mem::forget(library);
    // SAFETY: the symbol has the prefix, and the library stays loaded.
    unsafe { root_if_not_newer(entry) }.unwrap().unwrap().1
}

#[test]
fn an_older_library_loads_and_what_it_lacks_has_its_default() {
    let root = root_of_a_library();
    assert!(root.spindle().is_some() && root.seventh().is_none());
    let params = Params::new().with("spacing", 0.1).with("at_least", 36.0);
    let request = AbiRequest::new("constant_arc", "constant-arc", &params);
    let sampler = result(root.sampler()(request)).and_then(Box::<dyn Sampler>::receive);
    let sampler = sampler.unwrap();
    assert!(sampler.is_quiet() && !sampler.needs_exact_rates());
    let block = Revolutions {
        start: 0.0,
        end: 1.0,
    };
    assert_eq!(sampler.continues(block), Ok(Continuation::End));
}

#[test]
fn newer_libraries_load_under_this_host_if_they_fit_each_other() {
    let (newer, otherwise) = (newer::RootRef::LAYOUT, newer::otherwise::RootRef::LAYOUT);
    for library in [newer, otherwise] {
        assert!(!layout::is_not_newer::<RootRef>(library));
    }
    // Each of them fits this host alone.
    let alone = CheckingGlobals::new();
    let otherwise_alone =
        check_layout_compatibility_with_globals(RootRef::LAYOUT, otherwise, &alone);
    assert!(otherwise_alone.is_ok());
    assert_eq!(layout::check_newer::<RootRef>(newer), Ok(()));
    assert!(layout::check_newer::<RootRef>(otherwise).is_err());
    assert_eq!(layout::check_newer::<RootRef>(newer), Ok(()));
}

#[test]
fn a_library_of_the_same_age_is_not_newer() {
    assert!(layout::is_not_newer::<RootRef>(RootRef::LAYOUT));
}

#[test]
fn abi_stable_alone_would_refuse_an_older_library() {
    let (newer, ours) = (newer::RootRef::LAYOUT, RootRef::LAYOUT);
    assert!(check_layout_compatibility(newer, ours).is_err());
    assert!(check_layout_compatibility(ours, newer).is_ok());
}

#[test]
fn a_library_whose_functions_have_changed_is_refused() {
    let text = layout::check_newer::<RootRef>(other::RootRef::LAYOUT).unwrap_err();
    assert!(text.contains("RString"), "{text}");
}
