//! Where a strategy comes from.

use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

use turnpath_core::StrategyInfo;
use turnpath_plugin::Offer;

/// A plugin: a crate that registered strategies, linked in or loaded from a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Plugin {
    /// The package's name, `turnpath-surfaces`.
    pub name: String,
    /// The package's version.
    pub version: String,
    /// The library that it was loaded from, as an absolute path; `None` for one linked in.
    pub file: Option<PathBuf>,
    /// SHA-256 of the bytes that were loaded, in lower-case hexadecimal; `None` for one linked in.
    pub sha256: Option<String>,
}

impl fmt::Display for Plugin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} ", self.name, self.version)?;
        match &self.file {
            Some(file) => write!(f, "({})", file.display()),
            None => f.write_str("(built in)"),
        }
    }
}

/// A strategy in the catalogue: what it is, how it is made, and whose it is.
#[derive(Debug, Clone)]
pub struct Strategy {
    offer: Offer,
    plugin: Arc<Plugin>,
}

impl Strategy {
    pub(crate) fn new(offer: Offer, plugin: Arc<Plugin>) -> Self {
        Self { offer, plugin }
    }

    /// Slot, name, summary, source and parameters.
    pub fn info(&self) -> StrategyInfo {
        self.offer.info()
    }

    /// How it is made.
    pub fn offer(&self) -> &Offer {
        &self.offer
    }

    /// The plugin that registered it.
    pub fn plugin(&self) -> &Arc<Plugin> {
        &self.plugin
    }
}
