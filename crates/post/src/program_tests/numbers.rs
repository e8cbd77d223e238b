//! Numbers from a seed.

/// Numbers from a seed.
pub(super) struct Numbers(pub(super) u64);

impl Numbers {
    /// SplitMix64.
    pub(super) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Within 0 to 1.
    pub(super) fn part(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number of any size up to `largest`, one in eight of them zero or the largest itself.
    pub(super) fn of_any_size(&mut self, largest: f64) -> f64 {
        let sign = if self.next() & 1 == 0 { 1.0 } else { -1.0 };
        let size = match self.next() % 16 {
            0 => 0.0,
            1 => largest,
            _ => {
                let smaller = 10u64.pow((self.next() % 18) as u32) as f64;
                largest / smaller * self.part()
            }
        };
        sign * size
    }
}
