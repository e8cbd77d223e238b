//! Names of new plugins: what a recipe can choose and cargo can build.

use turnpath_core::{Slot, is_strategy_name};
use turnpath_host::Catalogue;

/// Names with which cargo makes no package or Rust no crate: keywords, and what Rust brings along.
const RESERVED: [&str; 58] = [
    "abstract",
    "alloc",
    "as",
    "async",
    "await",
    "become",
    "box",
    "break",
    "const",
    "continue",
    "core",
    "crate",
    "do",
    "dyn",
    "else",
    "enum",
    "extern",
    "false",
    "final",
    "fn",
    "for",
    "gen",
    "if",
    "impl",
    "in",
    "let",
    "loop",
    "macro",
    "match",
    "mod",
    "move",
    "mut",
    "override",
    "priv",
    "proc-macro",
    "pub",
    "ref",
    "return",
    "self",
    "static",
    "std",
    "struct",
    "super",
    "test",
    "trait",
    "true",
    "try",
    "type",
    "typeof",
    "union",
    "unsafe",
    "unsized",
    "use",
    "virtual",
    "where",
    "while",
    "yield",
    "deps",
];
/// How turnpath's own crates begin.
const OWN: &str = "turnpath";

/// Why no plugin can have a name.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NameError {
    /// No recipe and no crate could have it.
    #[error("`{}` is no name for a strategy and its crate", name.escape_debug())]
    NotAName {
        /// The name.
        name: String,
    },
    /// It means something to Rust or to cargo.
    #[error("`{name}` is a name that Rust or cargo uses itself")]
    Reserved {
        /// The name.
        name: String,
    },
    /// It begins as turnpath's own crates do.
    #[error("`{name}` begins like turnpath's own crates")]
    Own {
        /// The name.
        name: String,
    },
    /// A strategy has it.
    #[error("a {} named `{name}` is there already, in {plugin}", slot.noun())]
    Taken {
        /// The name.
        name: String,
        /// The slot of both.
        slot: Slot,
        /// The plugin of the strategy that is there.
        plugin: String,
    },
}

impl NameError {
    /// What would do.
    pub const fn help(&self) -> &'static str {
        match self {
            Self::NotAName { .. } => {
                "a name has lower-case letters, digits and single hyphens, and begins with a letter, \
                 such as my-steps"
            }
            Self::Reserved { .. } | Self::Own { .. } => "choose another name, such as my-steps",
            Self::Taken { .. } => "choose another name; `turnpath list` shows those that are taken",
        }
    }
}

/// Checks a name for a strategy of this slot.
pub fn check(name: &str, slot: Slot, catalogue: &Catalogue) -> Result<(), NameError> {
    let text = name.to_owned();
    let begins = name.starts_with(|c: char| c.is_ascii_lowercase());
    let hyphens = name.ends_with('-') || name.contains("--");
    if !is_strategy_name(name) || !begins || hyphens {
        return Err(NameError::NotAName { name: text });
    }
    if RESERVED.contains(&name) {
        return Err(NameError::Reserved { name: text });
    }
    if name == OWN || name.starts_with(&format!("{OWN}-")) {
        return Err(NameError::Own { name: text });
    }
    match catalogue.find(slot, name) {
        None => Ok(()),
        Some(strategy) => Err(NameError::Taken {
            name: text,
            slot,
            plugin: strategy.plugin().to_string(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(name: &str) -> Option<NameError> {
        check(name, Slot::Sampler, &Catalogue::new()).err()
    }

    #[test]
    fn names_that_a_recipe_and_cargo_take_pass() {
        for name in ["my-steps", "a", "arc2", "lab-7-b"] {
            assert_eq!(refused(name), None, "{name}");
        }
    }

    #[test]
    fn other_names_are_refused_with_their_reason() {
        for name in [
            "", "2d", "-a", "a-", "a--b", "My", "a_b", "a b", "ä", "a/b", "../a",
        ] {
            let error = refused(name);
            assert!(
                matches!(error, Some(NameError::NotAName { .. })),
                "{name}: {error:?}"
            );
        }
        for name in ["match", "test", "core"] {
            let error = refused(name);
            assert!(
                matches!(error, Some(NameError::Reserved { .. })),
                "{name}: {error:?}"
            );
        }
        for name in ["turnpath", "turnpath-plugin"] {
            let error = refused(name);
            assert!(
                matches!(error, Some(NameError::Own { .. })),
                "{name}: {error:?}"
            );
        }
    }
}
