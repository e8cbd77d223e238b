//! The only crate that a turnpath plugin depends on: the prelude, the parameters and [`export!`].
//!
//! A strategy is an ordinary type that implements [`Strategy`](prelude::Strategy) and the trait of
//! its slot:
//!
//! ```
//! use turnpath_plugin::prelude::*;
//!
//! const NODES: Param<Count> = Param::count("nodes", "nodes a revolution").min(3);
//!
//! /// The same number of nodes on every revolution.
//! #[derive(Clone)]
//! struct Even(f64);
//!
//! impl Strategy for Even {
//!     const NAME: &'static str = "even";
//!     const SUMMARY: &'static str = "the same number of nodes on every revolution";
//!     const PARAMS: &'static [ParamInfo] = &[NODES.info()];
//!     fn new(p: &Params) -> Result<Self> {
//!         Ok(Self(p.get(NODES) as f64))
//!     }
//! }
//!
//! impl SamplerPlan for Even {
//!     fn place(&self, _: &Path<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()> {
//!         nodes.extend(block.turns().flat_map(|turn| turn.subdivide(self.0)));
//!         Ok(())
//!     }
//! }
//!
//! turnpath_plugin::export!(samplers: [Even]);
//! # fn main() {}
//! ```
//!
//! With `crate-type = ["cdylib"]` this crate is a plugin. With `"rlib"` in addition, the same crate
//! links into a program. The version of `turnpath-plugin` is the number of the boundary: a program
//! loads plugins whose number has the same first two parts, older ones and newer ones.

mod abi;
#[doc(hidden)]
pub mod calls;
mod guard;
mod head;
mod maker;
mod offer;
mod panic_safe_box;
mod registration;

// For the host, and for the expansion of `export!`.
#[doc(hidden)]
pub use maker::{Make, Maker};
#[doc(hidden)]
pub use offer::{Offer, linked};
#[doc(hidden)]
pub use registration::{Build, Registration};

// For samplers and feeds that a lab writes, and for loops over many points or curves. The
// documentation has a sentence on each.
pub use turnpath_core::{hermite, law_limits, locus, registers, ring, strip};

/// Everything that a strategy's author needs.
pub mod prelude {
    pub use std::f64::consts::{PI, TAU};
    pub use turnpath_core::extreme;
    pub use turnpath_core::interference::{self, Interference};
    pub use turnpath_core::kind::*;
    pub use turnpath_core::toolpath::SegmentShape;
    pub use turnpath_core::{
        AxisLimits, CentreBuffers, CentreSeries, Centres, Compensator, Conicoid, Continuation, Cut,
        DEG, DataFile, Dependence, Direction, Dual, FeedPiece, FeedPlan, FeedStrategy,
        GradientSeries, Gradients, LARGEST_OFFSET, Lanes, Locus, Machine, Mask, Misfit, NM,
        NamedConstant, NodeList, NodeOffset, Nodes, ORDER, Pace, Param, ParamInfo, Params, Part,
        Path, Piece, PiecewisePolynomial, Radial, RadialRange, Rates, Result, Revolutions, Sampler,
        SamplerPlan, Scalar, Series, SeriesOrders, Setup, SpindleAsk, SpindleLaw, SpindleStrategy,
        SpiralLaw, Strategy, StrategyError, Surface, SurfaceData, SurfaceGap, SurfaceModel, Task,
        Taylor, Tolerance, Tool, Turn, UM, Velocities, VelocitySolver, angle, per_radian, quintic,
        sines_and_cosines,
    };
}

/// For the host: functions that open a library's plugin.
#[doc(hidden)]
pub mod loading {
    pub use crate::abi::catalogue::UnknownKind;
    pub use crate::abi::entry::inspect;
    pub use crate::head::{BOUNDARY_VERSION, BoundaryVersion, OpenError, SYMBOL_PREFIX};
    pub use crate::offer::{open_if_not_newer, open_newer};
}

/// For the macros: the items that their expansion names.
#[doc(hidden)]
pub mod macros {
    pub use crate::abi::entry::{PluginEntry, plugin_entry};
    pub use inventory;
}

/// Registers strategies with the program that the crate is linked into, and with the host that
/// loads it as a library.
///
/// ```text
/// turnpath_plugin::export!(feeds: [MyFeed], samplers: [MySampler, MyOther]);
/// ```
///
/// A surface that is a formula goes under `surfaces`. One that answers in batches by itself, because
/// it looks into a table, implements [`SurfaceModel`](prelude::SurfaceModel) and goes under
/// `surface_models`.
///
/// The slots are `surfaces`, `feeds`, `samplers`, `compensators`, `velocities` and `spindles`. Use the macro
/// once in a crate. A plugin must unwind on panic. `panic = "abort"` in its profile would end the
/// whole program, so the macro refuses it.
#[macro_export]
macro_rules! export {
    ($($slot:ident : [$($strategy:ty),+ $(,)?]),+ $(,)?) => {
        $($(
            $crate::macros::inventory::submit! {
                $crate::Registration::$slot::<$strategy>(
                    env!("CARGO_CRATE_NAME"),
                    env!("CARGO_PKG_VERSION"),
                )
            }
        )+)+

        const _: () = {
            #[cfg(panic = "abort")]
            compile_error!(
                "a turnpath plugin must unwind on panic: remove `panic = \"abort\"` from its profile"
            );

            #[unsafe(export_name = concat!("turnpath_plugin_root__", env!("CARGO_CRATE_NAME")))]
            pub static TURNPATH_PLUGIN: $crate::macros::PluginEntry =
                $crate::macros::plugin_entry(env!("CARGO_CRATE_NAME"));
        };
    };
}
