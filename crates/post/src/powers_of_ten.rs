//! The powers of ten that numbers of 64 bits are divided by.

/// The number of powers that 64 bits hold.
const COUNT: usize = 20;

/// The powers of ten, from 1 on.
pub(crate) const POWERS_OF_TEN: [u64; COUNT] = {
    let mut powers = [1; COUNT];
    let mut k = 1;
    while k < powers.len() {
        powers[k] = 10 * powers[k - 1];
        k += 1;
    }
    powers
};
