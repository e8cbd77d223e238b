//! How small and how large a map may be.

/// Fewest points along x and along y. A polynomial of degree 5 needs six.
pub const LEAST_POINTS: usize = 6;

/// Most points of a map: 5792 × 5792. A larger limit would let a header ask for more memory than a
/// laboratory's computer has: a map takes 8 bytes a point, and a spline through it five times that.
pub const MOST_POINTS: usize = 1 << 25;
