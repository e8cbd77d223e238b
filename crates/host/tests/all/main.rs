//! What `turnpath-host` does from outside, each subject a module.

mod common;

mod loading;
mod misbehaving;
mod own_plugin;
mod refused;
mod same_bits;
