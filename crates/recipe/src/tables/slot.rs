//! The keys of the host in a strategy's table.

use turnpath_core::{ParamInfo, Slot};

use super::cutting::SPINDLE;
use super::strategy::USE;
use super::surface;

/// The keys that the host itself reads from a slot's table. All of them are among
/// [`HOST_KEYS`](turnpath_core::HOST_KEYS), so that no strategy has a parameter of that name.
pub fn slot_keys(slot: Slot) -> &'static [ParamInfo] {
    match slot {
        Slot::Spindle => SPINDLE.keys,
        Slot::Surface => surface::KEYS,
        Slot::Feed | Slot::Sampler | Slot::Compensator | Slot::Velocity => const { &[USE.info()] },
    }
}

#[cfg(test)]
mod tests {
    use turnpath_core::HOST_KEYS;

    use super::*;

    #[test]
    fn every_key_is_kept_free_by_the_host() {
        for key in Slot::ALL.into_iter().flat_map(slot_keys) {
            assert!(HOST_KEYS.contains(&key.name), "{}", key.name);
        }
    }
}
