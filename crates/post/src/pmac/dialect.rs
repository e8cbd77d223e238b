//! The controllers of the family.

/// Which controller of the family reads the lines.
#[derive(Debug)]
pub(crate) enum PmacDialect {
    /// Turbo PMAC: capital letters, and `CLEAR` empties a program.
    Turbo,
    /// Power PMAC: small letters, and `open prog` empties a program.
    Power,
}
