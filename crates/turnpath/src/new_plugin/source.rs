//! Where a new plugin takes turnpath's crates from.

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use turnpath_host::BOUNDARY_VERSION;

/// The source that a build fixes for the plugins of its users: a text like that of `--crates`.
const OF_BUILD: Option<&str> = option_env!("TURNPATH_CRATES");
/// The repository in which this program was built, where it was built in one.
const OF_CHECKOUT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
/// The word for the registry.
const REGISTRY: &str = "registry";

/// The crates that a plugin depends on, with their folders in the repository.
const PLUGIN: (&str, &str) = ("turnpath-plugin", "crates/plugin");
const PLUGIN_TEST: (&str, &str) = ("turnpath-plugin-test", "crates/plugin-test");

/// Where a new plugin takes turnpath's crates from: a folder, a git repository, or the registry.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum CrateSource {
    /// A copy of turnpath's repository on this machine.
    Checkout(PathBuf),
    /// A git repository.
    Git {
        /// Its address.
        url: String,
        /// The commit, the tag or the branch; that of its head if there is none.
        revision: Option<String>,
    },
    /// The registry of cargo, by version.
    Registry,
}

impl CrateSource {
    /// The source that fits this build: what `TURNPATH_CRATES` said when it was built, else the
    /// repository in which it was built.
    ///
    /// # Errors
    /// When that text is no source, or that repository is not there any more. No registry has the crates
    /// unless somebody has put them there, so it is taken only when it is named.
    pub fn of_this_build() -> Result<Self, SourceError> {
        if let Some(fixed) = OF_BUILD.filter(|text| !text.is_empty()) {
            return fixed.parse();
        }
        let checkout = Path::new(OF_CHECKOUT).canonicalize();
        let checkout = checkout.ok().filter(|folder| is_checkout(folder));
        checkout
            .map(Self::Checkout)
            .ok_or(SourceError::NotInCheckout)
    }

    /// The folder, if the source is one, as an absolute path.
    ///
    /// # Errors
    /// If the crates are not in it.
    pub(super) fn whole(self) -> Result<Self, SourceError> {
        match self {
            Self::Checkout(folder) => match folder.canonicalize() {
                Ok(whole) if is_checkout(&whole) => Ok(Self::Checkout(whole)),
                _ => Err(SourceError::NoCheckout { folder }),
            },
            other => Ok(other),
        }
    }

    /// The versions with which this program's other crates were built, as a file of cargo's; `None` if
    /// the source has none.
    pub(super) fn lock_file(&self) -> Option<PathBuf> {
        match self {
            Self::Checkout(folder) => Some(folder.join("Cargo.lock")),
            Self::Git { .. } | Self::Registry => None,
        }
    }

    /// The line of a manifest for the crate that a plugin depends on.
    pub(super) fn plugin(&self) -> String {
        self.line(PLUGIN, &BOUNDARY_VERSION.to_string())
    }

    /// The line of a manifest for the checks.
    pub(super) fn plugin_test(&self) -> String {
        self.line(PLUGIN_TEST, env!("CARGO_PKG_VERSION"))
    }

    fn line(&self, (name, folder): (&str, &str), version: &str) -> String {
        match self {
            Self::Checkout(root) => {
                let path = root.join(folder).display().to_string();
                // Cargo reads slashes on every system, and `\\?\` paths on none.
                let path = path.trim_start_matches(r"\\?\").replace('\\', "/");
                format!("{name} = {{ path = {} }}", quoted(&path))
            }
            Self::Git { url, revision } => {
                let revision = revision.as_deref();
                let revision = revision.map(|text| format!(", rev = {}", quoted(text)));
                let revision = revision.unwrap_or_default();
                format!("{name} = {{ git = {}{revision} }}", quoted(url))
            }
            Self::Registry => format!("{name} = {}", quoted(version)),
        }
    }
}

/// A text as TOML has it.
fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}

fn is_checkout(folder: &Path) -> bool {
    [PLUGIN, PLUGIN_TEST]
        .iter()
        .all(|(_, path)| folder.join(path).join("Cargo.toml").is_file())
}

/// An address as cargo takes it, which has a scheme: `ssh://git@host/a.git` for `git@host:a.git`.
fn with_scheme(address: &str) -> String {
    match address.split_once(':') {
        Some((host, path)) if !address.contains("://") => format!("ssh://{host}/{path}"),
        _ => address.to_owned(),
    }
}

/// Why there is no source of crates.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SourceError {
    /// The folder is not turnpath's repository.
    #[error("{} has no crates/plugin and crates/plugin-test of turnpath", folder.display())]
    NoCheckout {
        /// The folder.
        folder: PathBuf,
    },
    /// The repository in which this program was built is not there.
    #[error("the repository in which this turnpath was built is not there any more")]
    NotInCheckout,
    /// An address ends with `#`, and no revision follows.
    #[error("`{address}` names no revision behind its `#`")]
    NoRevision {
        /// The address.
        address: String,
    },
    /// The text is empty.
    #[error("an empty text is no source of crates")]
    Empty,
}

impl FromStr for CrateSource {
    type Err = SourceError;

    /// `registry`; the address of a git repository, such as `https://host/turnpath.git`, with `#` and a
    /// revision behind it or without, or `git@host:turnpath.git`; anything else is a folder.
    fn from_str(text: &str) -> Result<Self, SourceError> {
        let is_address = text.contains("://") || text.starts_with("git@");
        match text {
            "" => Err(SourceError::Empty),
            REGISTRY => Ok(Self::Registry),
            address if is_address => {
                let (url, revision) = match address.split_once('#') {
                    None => (address, None),
                    Some((_, "")) => {
                        let address = address.to_owned();
                        return Err(SourceError::NoRevision { address });
                    }
                    Some((url, revision)) => (url, Some(revision.to_owned())),
                };
                let url = with_scheme(url);
                Ok(Self::Git { url, revision })
            }
            folder => Ok(Self::Checkout(folder.into())),
        }
    }
}

impl fmt::Display for CrateSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Checkout(folder) => write!(f, "{}", folder.display()),
            Self::Git { url, revision } => match revision {
                None => f.write_str(url),
                Some(revision) => write!(f, "{url}#{revision}"),
            },
            Self::Registry => f.write_str(REGISTRY),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_of_source_has_its_text_and_its_line() {
        let cases = [
            (
                "/opt/turn path",
                "turnpath-plugin = { path = \"/opt/turn path/crates/plugin\" }",
            ),
            (
                "https://lab.example/turnpath.git",
                "turnpath-plugin = { git = \"https://lab.example/turnpath.git\" }",
            ),
            (
                "ssh://git@lab.example/t#v0.2.0",
                "turnpath-plugin = { git = \"ssh://git@lab.example/t\", rev = \"v0.2.0\" }",
            ),
        ];
        for (text, line) in cases {
            let source: CrateSource = text.parse().unwrap();
            assert_eq!(
                (source.to_string(), source.plugin()),
                (text.into(), line.into())
            );
        }
    }

    #[test]
    fn the_registry_has_the_versions_of_the_manifests() {
        let version = |manifest: &str| {
            let path = Path::new(OF_CHECKOUT).join(manifest);
            let text = std::fs::read_to_string(path).unwrap();
            let table: toml::Table = text.parse().unwrap();
            table["package"]["version"].as_str().map(str::to_owned)
        };
        let line = CrateSource::Registry.plugin();
        let number = version("crates/plugin/Cargo.toml").unwrap();
        assert_eq!(line, format!("turnpath-plugin = \"{number}\""));
        let text = std::fs::read_to_string(Path::new(OF_CHECKOUT).join("Cargo.toml")).unwrap();
        let workspace: toml::Table = text.parse().unwrap();
        let number = workspace["workspace"]["package"]["version"]
            .as_str()
            .unwrap();
        // It has the workspace's version, so its own manifest names none.
        assert_eq!(
            CrateSource::Registry.plugin_test(),
            format!("turnpath-plugin-test = \"{number}\"")
        );
    }

    #[test]
    fn addresses_without_a_scheme_get_one_and_empty_revisions_are_refused() {
        let source: CrateSource = "git@lab.example:optics/t.git#v1".parse().unwrap();
        assert_eq!(source.to_string(), "ssh://git@lab.example/optics/t.git#v1");
        let empty = "https://lab.example/t.git#".parse::<CrateSource>();
        assert!(matches!(empty, Err(SourceError::NoRevision { .. })));
    }

    #[test]
    fn this_build_was_made_in_a_checkout() {
        let CrateSource::Checkout(folder) = CrateSource::of_this_build().unwrap() else {
            panic!("no folder");
        };
        assert!(folder.is_absolute() && is_checkout(&folder));
        let elsewhere = CrateSource::Checkout(folder.join("docs"));
        assert!(matches!(
            elsewhere.whole(),
            Err(SourceError::NoCheckout { .. })
        ));
    }
}
