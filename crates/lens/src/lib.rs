//! Reader of lens design files: the shape of a surface, its aperture, and the side from which it is
//! cut, out of a Zemax `.zmx`.
//!
//! A file is read in two steps. [`LensText`] turns bytes into text, whatever its encoding, and
//! [`LensText::surface`] takes one surface out of it. Nothing is guessed: a line that could change
//! the surface and is not known is a [`LensProblem`] with its number, and all of them are given at
//! once.
//!
//! A [`DesignSurface`] is seen from the tool: z points to the tool, x to the right and y up, in mm.
//! Where the tool stands on the side of −z of the design, x and z have changed their signs.
//!
//! ```
//! use turnpath_lens::{LensText, Selection, Shape};
//! let text = "MODE SEQ\nUNIT MM X W X CM MR CPMM\nSURF 0\n  TYPE STANDARD\n  DISZ INFINITY\n\
//!             SURF 1\n  TYPE STANDARD\n  CURV -0.002 0 0 0 0\n  CONI -1\n  GLAS MIRROR 0 0\n  \
//!             DISZ -250\n  DIAM 30 1 0 0 1\nSURF 2\n  TYPE STANDARD\n  CURV 0\n";
//! let mirror = LensText::new(text.as_bytes())?.surface(&Selection::default())?;
//! assert_eq!((mirror.number, mirror.aperture.radius), (1, 30.0));
//! let Shape::Radial { base, .. } = mirror.shape else { panic!() };
//! assert_eq!((base.radius, base.conic), (Some(500.0), -1.0));   // positive: concave
//! # Ok::<(), turnpath_lens::LensError>(())
//! ```

mod aperture;
mod base;
mod design;
mod error;
mod keys;
mod medium;
mod numbers;
mod record;
mod shape;
mod shape_reader;
mod side;
mod slots;
mod surface_block;
mod system_lines;
mod text;

pub use aperture::Aperture;
pub use base::Base;
pub use design::{DesignSurface, LensText, Note, Selection};
pub use error::{LensError, LensProblem, ProblemKind};
pub use shape::{Shape, ZernikeList};
pub use side::Side;
