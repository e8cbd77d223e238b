//! Strategies on offer: the host builds linked and loaded strategies in the same way.

use std::sync::Arc;

use turnpath_core::{
    Compensator, FeedStrategy, Params, Result, Sampler, SpindleStrategy, StrategyInfo,
    SurfaceModel, VelocitySolver,
};

use crate::abi::catalogue::CatalogueEntry;
use crate::abi::compensator::IncomingCompensator;
use crate::abi::data::{arguments, result};
use crate::abi::feed::IncomingFeed;
use crate::abi::root::{self, AbiRequest, OpenError, RootRef};
use crate::abi::sampler::IncomingSampler;
use crate::abi::spindle::IncomingSpindle;
use crate::abi::surface::IncomingSurface;
use crate::abi::velocity::IncomingVelocity;

/// A strategy that the host can build. Linked strategies cross the same boundary as loaded ones, so
/// that one mechanism contains panics and checks slices, and both give the same answers.
#[derive(Clone, Copy)]
pub struct Offer {
    entry: CatalogueEntry,
    root: RootRef,
}

impl std::fmt::Debug for Offer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Offer").field(&self.entry).finish()
    }
}

impl Offer {
    /// Slot, name, summary, source and parameters.
    pub fn info(&self) -> StrategyInfo {
        self.entry.info
    }

    /// The crate that registered the strategy.
    pub fn crate_name(&self) -> &'static str {
        self.entry.crate_name
    }

    /// The version of that crate.
    pub fn crate_version(&self) -> &'static str {
        self.entry.crate_version
    }

    /// Builds the surface model.
    pub fn surface(&self, params: &Params) -> Result<Arc<dyn SurfaceModel>> {
        Ok(Arc::new(IncomingSurface(result(self.root.surface()(
            self.request(params),
        ))?)))
    }

    /// Builds the feed strategy.
    pub fn feed(&self, params: &Params) -> Result<Arc<dyn FeedStrategy>> {
        Ok(Arc::new(IncomingFeed(result(self.root.feed()(
            self.request(params),
        ))?)))
    }

    /// Builds the sampler.
    pub fn sampler(&self, params: &Params) -> Result<Arc<dyn Sampler>> {
        Ok(Arc::new(IncomingSampler::new(result(self
            .root
            .sampler()(
            self.request(params),
        ))?)?))
    }

    /// Builds the compensator.
    pub fn compensator(&self, params: &Params) -> Result<Arc<dyn Compensator>> {
        let made = result(self.root.compensator()(self.request(params)))?;
        Ok(Arc::new(IncomingCompensator::new(made)?))
    }

    /// Builds the velocity solver.
    pub fn velocity(&self, params: &Params) -> Result<Arc<dyn VelocitySolver>> {
        Ok(Arc::new(IncomingVelocity::new(result(self
            .root
            .velocity()(
            self.request(params),
        ))?)?))
    }

    /// Builds the spindle strategy.
    pub fn spindle(&self, params: &Params) -> Result<Arc<dyn SpindleStrategy>> {
        let made = result(self.root.spindle()(self.request(params)))?;
        Ok(Arc::new(IncomingSpindle::new(made)?))
    }

    fn request(&self, params: &Params) -> AbiRequest {
        AbiRequest {
            crate_name: self.entry.crate_name.into(),
            name: self.entry.info.name.into(),
            arguments: arguments(params),
        }
    }
}

fn offers(root: RootRef, entries: Vec<CatalogueEntry>) -> Vec<Offer> {
    entries
        .into_iter()
        .map(|entry| Offer { entry, root })
        .collect()
}

/// The strategies that are linked into this program, sorted by slot and name.
///
/// The linker drops a plugin crate that no code names. `use turnpath_surfaces as _;` keeps it.
pub fn linked() -> Vec<Offer> {
    let root = root::own_root();
    offers(root, root::catalogue_entries(root))
}

/// The strategies of the library that exports `entry`.
///
/// # Errors
/// If the entry does not belong to this version of the boundary.
///
/// # Safety
/// `entry` is the address of a symbol whose name begins with [`SYMBOL_PREFIX`](root::SYMBOL_PREFIX),
/// in a library that stays loaded for the rest of the program.
#[allow(unsafe_code)] // the boundary: the caller guarantees the properties of the library
pub unsafe fn open(entry: *const u8) -> std::result::Result<Vec<Offer>, OpenError> {
    // SAFETY: the caller makes the same promise.
    let (root, entries) = unsafe { root::open(entry) }?;
    Ok(offers(root, entries))
}
