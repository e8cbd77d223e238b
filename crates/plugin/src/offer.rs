//! Strategies on offer: the host builds linked and loaded strategies in the same way.

use std::sync::Arc;

use turnpath_core::{
    Compensator, FeedStrategy, Params, Result, Sampler, SpindleStrategy, StrategyInfo,
    SurfaceModel, VelocitySolver,
};

use crate::abi::catalogue::CatalogueEntry;
use crate::abi::entry;
use crate::abi::request::AbiRequest;
use crate::abi::root::{self, Constructed, RootRef};
use crate::calls::Callee;
use crate::guard::guarded;
use crate::head::OpenError;
use crate::maker::Maker;

/// A strategy that the host can build. Linked strategies, and those that the program makes itself,
/// cross the same boundary as loaded ones, so that one mechanism contains panics and checks slices,
/// and all give the same answers.
#[derive(Clone)]
pub struct Offer {
    entry: CatalogueEntry,
    constructor: Constructor,
    callee: Option<&'static Callee>,
}

/// What builds a strategy.
#[derive(Clone)]
enum Constructor {
    /// A function that the crate of the entry registered.
    Registered(RootRef),
    /// A value of the program.
    Program(Maker),
}

impl std::fmt::Debug for Offer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Offer").field(&self.entry).finish()
    }
}

impl Offer {
    /// The offer of a strategy that the program makes itself. The slot of `info` is that of the
    /// maker.
    pub fn of_program(info: StrategyInfo, maker: Maker) -> Self {
        let slot = maker.slot();
        Self {
            entry: CatalogueEntry {
                crate_name: "",
                crate_version: "",
                info: StrategyInfo { slot, ..info },
            },
            constructor: Constructor::Program(maker),
            callee: None,
        }
    }

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

    /// The offer with the name under which its calls are marked.
    pub fn named(self, callee: &'static Callee) -> Self {
        let callee = Some(callee);
        Self { callee, ..self }
    }

    /// The offer with another constructor, a value of the program.
    #[must_use]
    pub fn made_by(self, maker: Maker) -> Self {
        let constructor = Constructor::Program(maker);
        Self {
            constructor,
            ..self
        }
    }

    /// Builds the surface model.
    pub fn surface(&self, params: &Params) -> Result<Arc<dyn SurfaceModel>> {
        self.build(params)
    }

    /// Builds the feed strategy.
    pub fn feed(&self, params: &Params) -> Result<Arc<dyn FeedStrategy>> {
        self.build(params)
    }

    /// Builds the sampler.
    pub fn sampler(&self, params: &Params) -> Result<Arc<dyn Sampler>> {
        self.build(params)
    }

    /// Builds the compensator.
    pub fn compensator(&self, params: &Params) -> Result<Arc<dyn Compensator>> {
        self.build(params)
    }

    /// Builds the velocity solver.
    pub fn velocity(&self, params: &Params) -> Result<Arc<dyn VelocitySolver>> {
        self.build(params)
    }

    /// Builds the spindle strategy.
    pub fn spindle(&self, params: &Params) -> Result<Arc<dyn SpindleStrategy>> {
        self.build(params)
    }

    fn build<T: ?Sized>(&self, params: &Params) -> Result<Arc<T>>
    where
        Box<T>: Constructed,
    {
        let CatalogueEntry {
            crate_name, info, ..
        } = self.entry;
        let _mark = self.callee.map(Callee::enter);
        let made = match &self.constructor {
            Constructor::Registered(root) => {
                let request = AbiRequest::new(crate_name, info.name, params);
                root::construct::<Box<T>>(*root, request)
            }
            Constructor::Program(maker) => root::make::<Box<T>>(maker, params),
        };
        made.map(Arc::from)
    }
}

fn offers(root: RootRef, entries: Vec<CatalogueEntry>) -> Vec<Offer> {
    entries
        .into_iter()
        .map(|entry| Offer {
            entry,
            constructor: Constructor::Registered(root),
            callee: None,
        })
        .collect()
}

/// The strategies that are linked into this program, sorted by slot and name.
///
/// The linker drops a plugin crate that no code names. `use turnpath_surfaces as _;` keeps it.
pub fn linked() -> Vec<Offer> {
    let (root, entries) = entry::own();
    offers(root, entries)
}

/// The strategies of the library that exports `entry`, if it has nothing that this program lacks, and
/// fits it; else `None`. Several libraries may be opened in this way at the same time.
///
/// # Errors
/// If the entry does not belong to this version of the boundary.
///
/// # Safety
/// `entry` is the address of a symbol whose name begins with
/// [`SYMBOL_PREFIX`](crate::head::SYMBOL_PREFIX), in a library that stays loaded for the rest of the
/// program.
#[allow(unsafe_code)] // the boundary: the caller guarantees the properties of the library
pub unsafe fn open_if_not_newer(
    entry: *const u8,
) -> std::result::Result<Option<Vec<Offer>>, OpenError> {
    let opened = without_panics(|| {
        // SAFETY: the caller makes the same promise.
        unsafe { entry::open_if_not_newer(entry) }
    });
    Ok(opened?.map(|(root, entries)| offers(root, entries)))
}

/// The strategies of a newer library. One such library is opened after the other.
///
/// # Errors
/// If the entry does not belong to this version of the boundary, or does not fit this program or a
/// newer library that was opened before.
///
/// # Safety
/// That of [`open_if_not_newer`].
#[allow(unsafe_code)] // the boundary: the caller guarantees the properties of the library
pub unsafe fn open_newer(entry: *const u8) -> std::result::Result<Vec<Offer>, OpenError> {
    let (root, entries) = without_panics(|| {
        // SAFETY: the caller makes the same promise.
        unsafe { entry::open_newer(entry) }
    })?;
    Ok(offers(root, entries))
}

/// The comparison of layouts panics where a description refers to what is not in it.
fn without_panics<T>(
    open: impl FnOnce() -> std::result::Result<T, OpenError>,
) -> std::result::Result<T, OpenError> {
    guarded(|| Ok(open())).unwrap_or(Err(OpenError::Damaged))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_of_the_comparison_is_a_damaged_library_and_an_error_stays_as_it_is() {
        let damaged = without_panics(|| -> std::result::Result<(), OpenError> {
            panic!("a description that refers to what is not there")
        });
        assert!(matches!(damaged, Err(OpenError::Damaged)), "{damaged:?}");
        let layout = without_panics(|| -> std::result::Result<(), OpenError> {
            Err(OpenError::Layout("differs".to_owned()))
        });
        assert!(matches!(layout, Err(OpenError::Layout(text)) if text == "differs"));
    }
}
