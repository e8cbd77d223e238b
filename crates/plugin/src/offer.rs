//! A strategy that can be made: linked into the program or loaded from a library, alike.

use std::sync::Arc;

use turnpath_core::{
    Compensator, FeedStrategy, Params, Result, Sampler, StrategyInfo, SurfaceModel, VelocitySolver,
};

use crate::abi::catalogue::Listed;
use crate::abi::compensator::IncomingCompensator;
use crate::abi::data::{arguments, result};
use crate::abi::feed::IncomingFeed;
use crate::abi::root::{self, AbiOrder, OpenError, RootRef};
use crate::abi::sampler::IncomingSampler;
use crate::abi::surface::Incoming;
use crate::abi::velocity::IncomingVelocity;

/// A strategy on offer. Linked ones go through the same boundary as loaded ones: one mechanism
/// contains panics, checks slices and makes both answer alike.
#[derive(Clone, Copy)]
pub struct Offer {
    listed: Listed,
    root: RootRef,
}

impl std::fmt::Debug for Offer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Offer").field(&self.listed).finish()
    }
}

impl Offer {
    /// Slot, name, summary, source and parameters.
    pub fn info(&self) -> StrategyInfo {
        self.listed.info
    }

    /// The crate that registered it.
    pub fn crate_name(&self) -> &'static str {
        self.listed.crate_name
    }

    /// That crate's version.
    pub fn crate_version(&self) -> &'static str {
        self.listed.crate_version
    }

    /// Makes the surface model.
    pub fn surface(&self, params: &Params) -> Result<Arc<dyn SurfaceModel>> {
        Ok(Arc::new(Incoming(result(self.root.surface()(
            self.order(params),
        ))?)))
    }

    /// Makes the feed strategy.
    pub fn feed(&self, params: &Params) -> Result<Arc<dyn FeedStrategy>> {
        Ok(Arc::new(IncomingFeed(result(self.root.feed()(
            self.order(params),
        ))?)))
    }

    /// Makes the sampler.
    pub fn sampler(&self, params: &Params) -> Result<Arc<dyn Sampler>> {
        Ok(Arc::new(IncomingSampler::new(result(self
            .root
            .sampler()(
            self.order(params),
        ))?)?))
    }

    /// Makes the compensator.
    pub fn compensator(&self, params: &Params) -> Result<Arc<dyn Compensator>> {
        let made = result(self.root.compensator()(self.order(params)))?;
        Ok(Arc::new(IncomingCompensator::new(made)?))
    }

    /// Makes the velocity solver.
    pub fn velocity(&self, params: &Params) -> Result<Arc<dyn VelocitySolver>> {
        Ok(Arc::new(IncomingVelocity::new(result(self
            .root
            .velocity()(
            self.order(params),
        ))?)?))
    }

    fn order(&self, params: &Params) -> AbiOrder {
        AbiOrder {
            crate_name: self.listed.crate_name.into(),
            name: self.listed.info.name.into(),
            arguments: arguments(params),
        }
    }
}

fn offers(root: RootRef, listed: Vec<Listed>) -> Vec<Offer> {
    listed
        .into_iter()
        .map(|listed| Offer { listed, root })
        .collect()
}

/// The strategies that are linked into this program, sorted by slot and name.
///
/// A plugin crate that nothing names is dropped by the linker: `use turnpath_surfaces as _;`.
pub fn linked() -> Vec<Offer> {
    let root = root::own_root();
    offers(root, root::listed(root))
}

/// The strategies of the library that exports `entry`.
///
/// # Errors
/// When the entry is not one of this boundary version.
///
/// # Safety
/// `entry` is the address of a symbol whose name begins with [`SYMBOL_PREFIX`](root::SYMBOL_PREFIX),
/// in a library that stays loaded for the rest of the program.
#[allow(unsafe_code)] // the boundary: the caller vouches for the library
pub unsafe fn open(entry: *const u8) -> std::result::Result<Vec<Offer>, OpenError> {
    // SAFETY: passed on to the caller.
    let (root, listed) = unsafe { root::open(entry) }?;
    Ok(offers(root, listed))
}
