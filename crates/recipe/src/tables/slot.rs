//! The keys of the host in a strategy's table.

use turnpath_core::kind::Text;
use turnpath_core::{Param, ParamInfo, Slot};

use super::cutting::SPINDLE;

/// The name of the strategy.
pub(crate) const USE: Param<Text> = Param::text(
    "use",
    "the name of the strategy; `turnpath list` shows all names",
);

/// The keys that the host itself reads from a slot's table. All of them are among
/// [`HOST_KEYS`](turnpath_core::HOST_KEYS), so that no strategy has a parameter of that name.
pub fn slot_keys(slot: Slot) -> &'static [ParamInfo] {
    // The keys of a slot of its own, such as the place of a surface in a sum, join `use` here.
    match slot {
        Slot::Spindle => SPINDLE.keys,
        Slot::Surface | Slot::Feed | Slot::Sampler | Slot::Compensator | Slot::Velocity => {
            const { &[USE.info()] }
        }
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
