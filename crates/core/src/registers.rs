//! Vector registers: loops over points, over lanes and over the curves of strips run in the widest that the CPU
//! has.
//!
//! The compiler turns the same loop into other instructions, but neither the operations nor their
//! order change, and no two of them are fused. A loop over lanes does for each lane what the loop one
//! by one does. So the bytes are the same in all registers.
//! `TURNPATH_LANES=base`, `avx2` or `avx512` in the environment asks for no wider ones than these.
//!
//! In a loop over groups of eight numbers the compiler may put eight groups side by side, and not the numbers of a
//! group. A register then holds a number of each group. They are gathered and scattered one by one, and the loop
//! takes up to seven times as long. So formulas without loops and calls go over single numbers, and what makes
//! rows of columns is not inlined into such loops.

pub use pulp::NullaryFnOnce as Loop;

/// Runs a loop, whose `call` must be `#[inline(always)]`.
pub fn in_widest<L: Loop>(one: L) -> L::Output {
    #[cfg(target_arch = "x86_64")]
    return x86::in_widest(one);
    #[cfg(not(target_arch = "x86_64"))]
    return one.call();
}

/// A loop over [lanes](crate::Lanes) that can go without them.
pub trait LaneLoop: Loop {
    /// The same results, with the same bits, from one number after the other, for formulas that the compiler puts
    /// side by side and for CPUs with narrow registers. It must be
    /// `#[inline(always)]`, as the loop over lanes may call it for what does not fill the lanes.
    fn one_by_one(self) -> Self::Output;
}

/// A [`LaneLoop`] that goes from number to number. The compiler puts numbers side by side where it can.
pub struct OneByOne<L>(pub L);

impl<L: LaneLoop> Loop for OneByOne<L> {
    type Output = L::Output;

    #[inline(always)]
    fn call(self) -> L::Output {
        self.0.one_by_one()
    }
}

/// Runs a loop over lanes in the widest registers; its `call` must be `#[inline(always)]`. An x86 CPU
/// with 128 bits alone takes one number after the other. Such CPUs are rare, and lanes for them would
/// take a quarter of the time in which a surface compiles.
pub fn lanes_in_widest<L: LaneLoop>(one: L) -> L::Output {
    #[cfg(target_arch = "x86_64")]
    return x86::lanes_in_widest(one);
    #[cfg(not(target_arch = "x86_64"))]
    return one.call();
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::sync::LazyLock;

    use pulp::x86::{V3, V4};

    use super::{LaneLoop, Loop};

    /// The environment variable that asks for registers.
    const VARIABLE: &str = "TURNPATH_LANES";

    /// Registers by what pulp proves of the CPU.
    #[derive(Debug, Clone, Copy)]
    pub(crate) enum Registers {
        /// 128 bits, which every CPU has.
        Base,
        /// 256 bits.
        Avx2(V3),
        /// 512 bits.
        Avx512(V4),
    }

    static WIDEST: LazyLock<Registers> = LazyLock::new(|| {
        let asked = std::env::var(VARIABLE).unwrap_or_default();
        Registers::within(&asked)
    });

    pub(super) fn in_widest<L: Loop>(one: L) -> L::Output {
        WIDEST.run(one)
    }

    pub(super) fn lanes_in_widest<L: LaneLoop>(one: L) -> L::Output {
        WIDEST.run_lanes(one)
    }

    impl Registers {
        /// The widest registers of the CPU that are no wider than those that are asked for. A word that
        /// asks for none does not count.
        pub(crate) fn within(asked: &str) -> Self {
            let v3 = || V3::try_new().map(Self::Avx2);
            let v4 = || V4::try_new().map(Self::Avx512);
            let found = match asked {
                "base" => None,
                "avx2" => v3(),
                _ => v4().or_else(v3),
            };
            found.unwrap_or(Self::Base)
        }

        pub(crate) fn run<L: Loop>(self, one: L) -> L::Output {
            match self {
                Self::Base => one.call(),
                Self::Avx2(registers) => registers.vectorize(one),
                Self::Avx512(registers) => registers.vectorize(one),
            }
        }

        pub(crate) fn run_lanes<L: LaneLoop>(self, one: L) -> L::Output {
            match self {
                Self::Base => one.one_by_one(),
                Self::Avx2(registers) => registers.vectorize(one),
                Self::Avx512(registers) => registers.vectorize(one),
            }
        }
    }
}

/// Calls a test once for each width of registers that the CPU has.
#[cfg(all(test, target_arch = "x86_64"))]
pub(crate) fn each_width(mut test: impl FnMut(x86::Registers)) {
    for asked in ["base", "avx2", "avx512"] {
        test(x86::Registers::within(asked));
    }
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::Loop;
    use super::x86::Registers;

    /// Products and sums that would differ if they were fused, and a square root.
    struct Formula<'a>(&'a [f64], &'a mut [f64]);

    impl Loop for Formula<'_> {
        type Output = ();

        #[inline(always)]
        fn call(self) {
            let Self(x, z) = self;
            for (z, x) in z.iter_mut().zip(x) {
                *z = (x * x - 0.1 * x + 0.7).sqrt() / (1.0 + x * x);
            }
        }
    }

    #[test]
    fn all_registers_give_the_same_bytes() {
        let x: Vec<f64> = (0..1003).map(|k| 0.137 * f64::from(k) - 40.0).collect();
        let of = |asked: &str| {
            let mut z = vec![0.0; x.len()];
            Registers::within(asked).run(Formula(&x, &mut z));
            z.into_iter().map(f64::to_bits).collect::<Vec<u64>>()
        };
        let base = of("base");
        assert_eq!((&of("avx2"), &of("avx512")), (&base, &base));
    }
}
