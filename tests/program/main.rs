//! The program as a person calls it: commands, messages, exit statuses and files.

#[path = "../fuzz/src/lib.rs"]
mod fuzz;
#[path = "../support/mod.rs"]
mod support;

mod ablate;
mod bad_plugins;
mod bad_recipes;
mod built_ins;
mod column_files;
mod commands;
mod compressed_programs;
mod controller_commands;
mod damaged_libraries;
mod data_files;
mod depths;
mod drawings;
mod dry_run;
mod ending_plugins;
mod first_mile;
mod frozen_boundary;
mod import;
mod inputs_stay;
mod long_programs;
mod machine_limits;
mod maps;
mod new_plugin;
mod no_surface;
mod own_sampler;
mod packed_ablations;
mod passes;
mod plugins_lock;
mod program_verdicts;
mod queues;
mod random;
mod readme;
mod remarks;
mod results;
mod sag;
mod same_bytes;
mod sizes;
mod straight_lines;
mod sums;
mod telescope_mirror;
mod terminal;
mod too_long;
mod verify;
mod wholeness;
