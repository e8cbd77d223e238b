//! The tables that belong to no strategy.

use crate::read::Schema;
use crate::table_info::TableInfo;

use super::{ablation, cutting, machine, output, passes, path, pose, post, servo, work};

/// The tables with fixed keys.
pub(crate) const SCHEMA: Schema = &{
    let mut tables = [work::PART; BEFORE_POSTS.len() + post::TABLES.len() + BEHIND_POSTS.len()];
    let mut k = 0;
    while k < tables.len() {
        let behind = k.saturating_sub(BEFORE_POSTS.len());
        tables[k] = if k < BEFORE_POSTS.len() {
            BEFORE_POSTS[k]
        } else if behind < post::TABLES.len() {
            post::TABLES[behind]
        } else {
            BEHIND_POSTS[behind - post::TABLES.len()]
        };
        k += 1;
    }
    tables
};

const BEFORE_POSTS: [TableInfo; 7] = [
    work::PART,
    pose::POSE,
    work::TOOL,
    cutting::TOLERANCE,
    cutting::SPINDLE,
    path::PATH,
    output::OUTPUT,
];

const BEHIND_POSTS: [TableInfo; 4] = [
    machine::MACHINE,
    servo::SERVO,
    passes::PASSES,
    ablation::ABLATION,
];
