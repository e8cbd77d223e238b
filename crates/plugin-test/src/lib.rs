//! Checks the strategies of a turnpath plugin in one line.
//!
//! ```ignore
//! #[test]
//! fn conforms() {
//!     turnpath_plugin_test::check!();
//! }
//! ```
//!
//! [`check!`] tries every strategy that the crate exports on two small parts, each in a whole chain
//! whose other stages are built in: a saddle from the axis outward, and a ring of a sinusoidal array
//! from the rim inward. The test fails with what is wrong and where, and prints what each strategy
//! came to (`cargo test -- --nocapture` shows it where the test passes).
//!
//! `docs/plugins.md`, "Check a strategy", says what is checked of the strategies of each slot. A
//! [`Promise`] holds a strategy to more.
//!
//! A strategy whose parameters have no defaults gets values from a [`Trial`]:
//!
//! ```ignore
//! turnpath_plugin_test::check!(Trial::of("constant-arc").with(r#"spacing = "0.5 mm""#));
//! ```

mod batches;
mod chain;
mod compensator;
mod conformance;
mod convergence;
mod fault;
mod feed;
mod laws;
mod place;
mod sampler;
mod sections;
mod spindle;
mod surface;
mod trial;
mod trial_part;
mod velocity;
mod whole_path;

pub use conformance::{Conformance, Findings};
pub use fault::{Check, Fault, FaultKind};
pub use place::{AlongPath, OnPart};
pub use trial::{Promise, Trial};

// A plugin that nothing names is dropped by the linker.
use turnpath_constant as _;
use turnpath_integrated as _;
use turnpath_nose_radius as _;
use turnpath_spindle as _;
use turnpath_surfaces as _;
use turnpath_triangle_rotary as _;

/// Checks every strategy that this crate exports, with the defaults of its parameters or with these
/// [`Trial`]s. It belongs into a unit test of the crate that has `export!`.
#[macro_export]
macro_rules! check {
    ($($trial:expr),* $(,)?) => {
        $crate::Conformance::of_crate(env!("CARGO_CRATE_NAME"))
            $(.with($trial))*
            .assert()
    };
}
