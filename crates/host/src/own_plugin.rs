//! Strategies that the program makes itself, as values: closures, and what another language gives.

use std::sync::Arc;

use turnpath_core::{
    Compensator, FeedStrategy, ParamInfo, Params, Result, Sampler, Slot, SpindleStrategy,
    StrategyInfo, SurfaceModel, VelocitySolver,
};
use turnpath_plugin::{Maker, Offer};

use crate::Plugin;

/// Strategies of the program's own under the name of one plugin.
///
/// [`Catalogue::with_own`](crate::Catalogue::with_own) takes it. The strategies cross the same
/// boundary as those of libraries, and the host checks their answers in the same way.
#[derive(Debug, Clone)]
pub struct OwnPlugin {
    plugin: Plugin,
    offers: Vec<Offer>,
}

impl OwnPlugin {
    /// A plugin of this name and version, without strategies.
    pub fn new(name: impl Into<String>, version: impl Into<String>) -> Self {
        let plugin = Plugin {
            name: name.into(),
            version: version.into(),
            file: None,
            sha256: None,
            source: Some("of this program".to_owned()),
            inexact: Vec::new(),
        };
        Self {
            plugin,
            offers: Vec::new(),
        }
    }

    /// With its source: where it is, for messages, and the SHA-256 of its bytes in lower-case
    /// hexadecimal. Summaries have both, and the hash is a part of the keys of ablations.
    #[must_use]
    pub fn with_source(mut self, place: impl Into<String>, sha256: impl Into<String>) -> Self {
        self.plugin.source = Some(place.into());
        self.plugin.sha256 = Some(sha256.into());
        self
    }

    /// With one more strategy.
    #[must_use]
    pub fn with(mut self, strategy: OwnStrategy) -> Self {
        let info = strategy.info;
        if !strategy.byte_exact {
            let text = format!("{} {}", info.slot, info.name);
            self.plugin.inexact.push(text);
        }
        self.offers.push(Offer::of_program(info, strategy.maker));
        self
    }

    pub(crate) fn into_parts(self) -> (Plugin, Vec<Offer>) {
        (self.plugin, self.offers)
    }
}

/// A strategy that the program makes itself: its declaration and its constructor.
#[derive(Debug, Clone)]
pub struct OwnStrategy {
    info: StrategyInfo,
    maker: Maker,
    byte_exact: bool,
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

    /// Says that its answers may have other bytes on another machine: it calls sines or sums that
    /// are not the same everywhere. Summaries remark on it.
    #[must_use]
    pub fn differs_between_machines(mut self) -> Self {
        self.byte_exact = false;
        self
    }
}
