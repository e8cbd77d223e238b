//! What `turnpath-host` does from outside, each subject a module.

mod common;

mod loading;
mod misbehaving;
mod refused;
mod same_bits;
