//! How small and how large a map may be.

/// Fewest points along x and along y. A polynomial of degree 5 needs six.
pub const LEAST_POINTS: usize = 6;

/// Most points of a map: 5792 × 5792. A larger limit would let a header ask for more memory than a
/// laboratory's computer has: a map takes 8 bytes a point, and a spline through it five times that.
pub const MOST_POINTS: usize = 1 << 25;

/// The largest height, and the farthest place from the origin, mm: a thousand kilometres. No part is
/// so large, and the square of such a length is far from the largest number.
pub const LARGEST_LENGTH: f64 = 1e9;

/// The least distance of neighbouring points, mm: a picometre. The fifth power of its inverse is far
/// from the largest number.
pub const LEAST_PITCH: f64 = 1e-9;
