//! What `turnpath-polynomials` does from outside, each subject a module.

mod smoke;
