//! Strategies that the program makes itself, as values: closures, and what another language gives.

use turnpath_plugin::Offer;

use crate::own_strategy::{OwnStrategy, OwnTraits};
use crate::{Plugin, SourceHash};

/// Strategies of the program's own under the name of one plugin.
///
/// [`Catalogue::with_own`](crate::Catalogue::with_own) takes it. The strategies cross the same
/// boundary as those of libraries, and the host checks their answers in the same way.
#[derive(Debug, Clone)]
pub struct OwnPlugin {
    plugin: Plugin,
    strategies: Vec<OwnStrategy>,
}

impl OwnPlugin {
    /// A plugin of this name and version, without strategies.
    pub fn new(name: impl Into<String>, version: impl Into<String>) -> Self {
        let plugin = Plugin {
            name: name.into(),
            version: version.into(),
            file: None,
            hash: None,
            source: Some("of this program".to_owned()),
            inexact: Vec::new(),
        };
        Self {
            plugin,
            strategies: Vec::new(),
        }
    }

    /// With its source: where it is, for messages, and the SHA-256 of its bytes in lower-case
    /// hexadecimal. Summaries have both, and the hash is a part of the keys of ablations, with the
    /// [identities](crate::Identity) of the strategies that a run uses.
    #[must_use]
    pub fn with_source(mut self, place: impl Into<String>, sha256: impl Into<String>) -> Self {
        self.plugin.source = Some(place.into());
        self.plugin.hash = Some(SourceHash::known(sha256));
        self
    }

    /// With one more strategy.
    #[must_use]
    pub fn with(mut self, strategy: OwnStrategy) -> Self {
        self.plugin.inexact.extend(strategy.inexact());
        self.strategies.push(strategy);
        self
    }

    pub(crate) fn into_parts(self) -> (Plugin, Vec<(Offer, OwnTraits)>) {
        let strategies = self.strategies.into_iter();
        (
            self.plugin,
            strategies.map(OwnStrategy::into_parts).collect(),
        )
    }
}
