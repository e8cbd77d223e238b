//! Forbes' polynomials: Q^con of strong aspheres, Q^bfs of mild ones, and Q2D of freeforms.

mod best_fit_sphere;
mod q2d;
mod q2d_basis;
mod qbfs;
mod qbfs_basis;
mod qcon;
mod round_terms;

pub use self::q2d::ForbesQ2d;
pub use self::qbfs::ForbesQbfs;
pub use self::qcon::ForbesQcon;
