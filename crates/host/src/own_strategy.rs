//! A strategy that the program makes itself: its declaration, its constructor, and what tells it from
//! another of its name.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use turnpath_core::{
    Compensator, FeedStrategy, ParamInfo, Params, Result, Sampler, Slot, SpindleStrategy,
    StrategyError, StrategyInfo, SurfaceModel, VelocitySolver,
};
use turnpath_plugin::{Maker, Offer};

/// What a recipe needs of a surface that stands for a function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceNeed {
    /// Half the side of the square about the surface's own origin in which it is asked, mm.
    pub half_width: f64,
    /// The error along z that does not count beside the recipe's tolerance, mm.
    pub error: f64,
}

/// A surface that the program made for a recipe.
pub struct OwnSurface {
    /// The surface.
    pub model: Box<dyn SurfaceModel>,
    /// Whether its answers have the same bytes on every machine.
    pub byte_exact: bool,
}

/// What tells a strategy of the program from another one of its name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Identity {
    /// The hash of all that its answers depend on, besides its parameters and its plugin.
    Hash(String),
    /// Its answers depend on what has no hash; the text says on what. No record of an ablation is
    /// known to be of this strategy.
    Unknown(String),
}

type MakeSurface = dyn Fn(&Params, SurfaceNeed) -> Result<OwnSurface> + Send + Sync;

/// What a strategy of the program has besides what it offers.
#[derive(Clone, Default)]
pub(crate) struct OwnTraits {
    identity: Option<Identity>,
    surface: Option<Arc<MakeSurface>>,
}

impl fmt::Debug for OwnTraits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("OwnTraits").field(&self.identity).finish()
    }
}

impl OwnTraits {
    pub(crate) fn identity(&self) -> Option<&Identity> {
        self.identity.as_ref()
    }

    /// The surface of an offer for this need, and whether it has the same bytes on every machine.
    pub(crate) fn surface(
        &self,
        offer: &Offer,
        params: &Params,
        need: SurfaceNeed,
    ) -> Result<(Arc<dyn SurfaceModel>, bool)> {
        let Some(make) = self.surface.clone() else {
            return Ok((offer.surface(params)?, true));
        };
        let byte_exact = Arc::new(AtomicBool::new(true));
        let told = Arc::clone(&byte_exact);
        // The surface crosses the boundary alone, so the rest goes beside it.
        let maker = Maker::Surface(Arc::new(move |params| {
            let made = make(params, need)?;
            told.store(made.byte_exact, Ordering::Relaxed);
            Ok(made.model)
        }));
        let model = offer.clone().made_by(maker).surface(params)?;
        Ok((model, byte_exact.load(Ordering::Relaxed)))
    }
}

/// A strategy that the program makes itself: its declaration and its constructor.
#[derive(Debug, Clone)]
pub struct OwnStrategy {
    info: StrategyInfo,
    maker: Maker,
    byte_exact: bool,
    traits: OwnTraits,
}

macro_rules! constructors {
    ($($slot:ident: $variant:ident, $object:ident, $what:literal;)+) => {$(
        #[doc = concat!("A ", $what, " of this name. The host calls `make` with checked values of the parameters.")]
        pub fn $slot(
            name: &'static str,
            make: impl Fn(&Params) -> Result<Box<dyn $object>> + Send + Sync + 'static,
        ) -> Self {
            Self::new(Slot::$variant, name, Maker::$variant(Arc::new(make)))
        }
    )+};
}

impl OwnStrategy {
    constructors! {
        surface: Surface, SurfaceModel, "surface model";
        feed: Feed, FeedStrategy, "feed strategy";
        sampler: Sampler, Sampler, "sampler";
        compensator: Compensator, Compensator, "compensator";
        velocity: Velocity, VelocitySolver, "velocity solver";
        spindle: Spindle, SpindleStrategy, "spindle strategy";
    }

    /// A surface model that is made for what a recipe needs of it.
    pub fn surface_for(
        name: &'static str,
        make: impl Fn(&Params, SurfaceNeed) -> Result<OwnSurface> + Send + Sync + 'static,
    ) -> Self {
        let no_recipe = || StrategyError::failed("is made only for the part of a recipe");
        let mut strategy = Self::surface(name, move |_| Err(no_recipe()));
        strategy.traits.surface = Some(Arc::new(make));
        strategy
    }

    fn new(slot: Slot, name: &'static str, maker: Maker) -> Self {
        let info = StrategyInfo {
            slot,
            name,
            summary: "",
            source: "",
            params: &[],
        };
        Self {
            info,
            maker,
            byte_exact: true,
            traits: OwnTraits::default(),
        }
    }

    /// With one line that says what the strategy does.
    #[must_use]
    pub fn with_summary(mut self, summary: &'static str) -> Self {
        self.info.summary = summary;
        self
    }

    /// With the declarations of its parameters.
    #[must_use]
    pub fn with_params(mut self, params: &'static [ParamInfo]) -> Self {
        self.info.params = params;
        self
    }

    /// With what tells it from another one of its name and its source.
    #[must_use]
    pub fn with_identity(mut self, identity: Identity) -> Self {
        self.traits.identity = Some(identity);
        self
    }

    /// Says that its answers may have other bytes on another machine: it calls sines or sums that
    /// are not the same everywhere. Summaries remark on it.
    #[must_use]
    pub fn differs_between_machines(mut self) -> Self {
        self.byte_exact = false;
        self
    }

    /// Slot and name, `sampler even`, of one whose answers may have other bytes on another machine.
    pub(crate) fn inexact(&self) -> Option<String> {
        let text = || format!("{} {}", self.info.slot, self.info.name);
        (!self.byte_exact).then(text)
    }

    pub(crate) fn into_parts(self) -> (Offer, OwnTraits) {
        (Offer::of_program(self.info, self.maker), self.traits)
    }
}
