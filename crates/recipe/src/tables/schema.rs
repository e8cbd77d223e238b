//! The tables that belong to no strategy.

use crate::read::Schema;

use super::{ablation, cutting, machine, output, path, pmac_pvt, pose, servo, work};

/// The tables with fixed keys.
pub(crate) const SCHEMA: Schema = &[
    work::PART,
    pose::POSE,
    work::TOOL,
    cutting::TOLERANCE,
    cutting::SPINDLE,
    path::PATH,
    output::OUTPUT,
    pmac_pvt::PMAC_PVT,
    machine::MACHINE,
    servo::SERVO,
    ablation::ABLATION,
];
