//! The program's figures, held against independent measurements, brute force and closed forms.

#[path = "../support/mod.rs"]
mod support;

mod cut_what_fits;
mod every_chain;
mod form;
mod gouges;
mod large_feeds;
mod leads;
mod machine;
mod machined_surface;
mod pmac;
mod poses;
mod posts;
mod real_nose;
mod recipes;
mod recorded_figures;
mod rims;
mod schedules;
mod servo;
mod spindle;
mod spoiled_paths;
mod spoils;
mod spokes;
mod surface_models;
mod whole_part;
