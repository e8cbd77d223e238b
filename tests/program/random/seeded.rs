//! Random numbers from a seed: the same in every run of the tests, on every system.

/// Splitmix64, whose numbers pass the usual tests and whose state is one number.
#[derive(Debug, Clone)]
pub struct SeededNumbers(u64);

impl SeededNumbers {
    /// The numbers of one case of a test: each case has its own, so that it can be tried alone.
    pub fn of_case(seed: u64, case: u64) -> Self {
        let mut numbers = Self(seed.wrapping_add(case.wrapping_mul(0xD1B5_4A32_D192_ED03)));
        let own = numbers.next();
        Self(own)
    }

    /// The next number.
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    /// A number below `count`; 0 if there is none.
    pub fn below(&mut self, count: usize) -> usize {
        (self.next() % (count.max(1) as u64)) as usize
    }

    /// A number from 0 to 1.
    pub fn share(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number between two.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// A number between two positive ones, of which every doubling is as likely as another.
    pub fn of_any_size(&mut self, low: f64, high: f64) -> f64 {
        let doubled = |size: &f64| Some(2.0 * size).filter(|next| *next < high);
        let sizes: Vec<f64> = std::iter::successors(Some(low), doubled).collect();
        let size = *self.pick(&sizes);
        self.between(size, high.min(2.0 * size))
    }

    /// True in one of so many cases.
    pub fn one_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }

    /// One of these.
    pub fn pick<'a, T>(&mut self, from: &'a [T]) -> &'a T {
        &from[self.below(from.len())]
    }
}
