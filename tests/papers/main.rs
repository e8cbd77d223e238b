//! Whole runs on the papers' parts, held against the papers' figures.

#[path = "../support/mod.rs"]
mod support;

mod ablation;
mod atpg;
mod ats;
mod fft_adaptive;
mod integrated;
mod minimax;
mod reproduction;
mod velocities;
