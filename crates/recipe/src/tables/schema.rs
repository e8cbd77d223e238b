//! The keys of the tables that belong to no strategy.

use crate::read::Schema;

use super::{cutting, machine, output, path, pmac_pvt, servo, work};

/// The tables with fixed keys.
pub(crate) const SCHEMA: Schema = &[
    ("part", work::PART_KEYS),
    ("tool", work::TOOL_KEYS),
    ("tolerance", cutting::TOLERANCE_KEYS),
    ("spindle", cutting::SPINDLE_KEYS),
    ("path", path::KEYS),
    ("output", output::KEYS),
    (pmac_pvt::NAME, pmac_pvt::KEYS),
    ("machine", machine::KEYS),
    ("servo", servo::KEYS),
    ("ablation", &["mode"]),
];
