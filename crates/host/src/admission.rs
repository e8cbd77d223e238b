//! Who decides about libraries before any of their code runs.

use std::fmt::Debug;

use crate::{LibraryFile, LoadError};

/// Decides whether libraries may be loaded. A [`Catalogue`](crate::Catalogue) asks all of its
/// admissions, in the order in which they were given, before it loads the first of these libraries.
pub trait Admission: Debug + Send + Sync {
    /// Admits the libraries: all of a folder, or a file alone. They have been read and checked, and those that
    /// passed have been copied. None of their code has run for this catalogue.
    ///
    /// # Errors
    /// When one of them must not be loaded. Then none is.
    fn admit(&self, libraries: &[LibraryFile]) -> Result<(), LoadError>;
}
