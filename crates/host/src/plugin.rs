//! Plugins, and the strategies that they register.

use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

use turnpath_core::{Params, Result, StrategyInfo, SurfaceModel, printable_line};
use turnpath_plugin::Offer;
use turnpath_plugin::calls::Callee;

use crate::own_strategy::{Identity, OwnTraits, SurfaceNeed};
use crate::source_hash::{HashError, SourceHash};

/// A crate that registers strategies, or a part of the program that makes its own. A crate is linked
/// into the program or loaded from a file.
#[derive(Debug, Clone)]
pub struct Plugin {
    /// The package's name, `turnpath-surfaces`.
    pub name: String,
    /// The package's version.
    pub version: String,
    /// The absolute path of the library that was loaded; `None` for what is no library.
    pub file: Option<PathBuf>,
    /// The hash of the bytes that were loaded, or of the source that the program names; `None` for a
    /// linked crate.
    pub hash: Option<SourceHash>,
    /// Where the source of the program's own strategies is, for messages; `None` for a crate.
    pub source: Option<String>,
    /// The program's own strategies, `sampler even`, whose answers may have other bytes on another
    /// machine.
    pub inexact: Vec<String>,
}

impl Plugin {
    /// The SHA-256 of the bytes that were loaded, or of the source that the program names, in lower-case
    /// hexadecimal; `None` for a linked crate.
    ///
    /// # Errors
    /// When the copy of the library cannot be read.
    pub fn sha256(&self) -> std::result::Result<Option<&str>, HashError> {
        self.hash.as_ref().map(SourceHash::hex).transpose()
    }
}

impl fmt::Display for Plugin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} ", self.name, self.version)?;
        match (&self.file, &self.source) {
            (Some(file), _) => write!(f, "({})", file.display()),
            (None, Some(source)) => write!(f, "({source})"),
            (None, None) => f.write_str("(built in)"),
        }
    }
}

/// A strategy in the catalogue: its declaration, its constructor and its plugin.
#[derive(Debug, Clone)]
pub struct Strategy {
    offer: Offer,
    plugin: Arc<Plugin>,
    own: OwnTraits,
}

impl Strategy {
    /// Calls of the strategy are marked with its name, so that one that ends the process can be named.
    pub(crate) fn new(offer: Offer, plugin: Arc<Plugin>, own: OwnTraits) -> Self {
        let info = offer.info();
        let text = format!("the {} `{}` of {plugin}", info.slot.noun(), info.name);
        // What the program brings is as little known as a library.
        let is_foreign = plugin.file.is_some() || plugin.source.is_some();
        let callee = Callee::new(printable_line(&text).into_owned(), is_foreign);
        let offer = offer.named(callee);
        Self { offer, plugin, own }
    }

    /// Slot, name, summary, source and parameters.
    pub fn info(&self) -> StrategyInfo {
        self.offer.info()
    }

    /// The constructor.
    pub fn offer(&self) -> &Offer {
        &self.offer
    }

    /// The plugin that registered it.
    pub fn plugin(&self) -> &Arc<Plugin> {
        &self.plugin
    }

    /// What tells a strategy of the program from another one of its name and its source; `None` for a
    /// strategy of a crate, which its plugin stands for.
    pub fn identity(&self) -> Option<&Identity> {
        self.own.identity()
    }

    /// Makes the surface model for what a recipe needs of it. Gives it, and whether its answers have
    /// the same bytes on every machine as far as that depends on its parameters.
    ///
    /// # Errors
    /// When the constructor refuses the parameters or fails.
    pub fn surface(
        &self,
        params: &Params,
        need: SurfaceNeed,
    ) -> Result<(Arc<dyn SurfaceModel>, bool)> {
        self.own.surface(&self.offer, params, need)
    }
}
