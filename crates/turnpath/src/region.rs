//! Whether a place is on the part, or on its overrun.

use turnpath_core::Part;
use turnpath_report::Region;

/// A place is on the part up to this much beyond its edges, mm.
const ON_PART: f64 = 1e-9;

/// The region of a place at this radius, mm.
pub fn region(rho: f64, part: &Part) -> Region {
    let inside = rho < part.inner_radius - ON_PART;
    let outside = rho > part.aperture_radius + ON_PART;
    match inside || outside {
        true => Region::Overrun,
        false => Region::Part,
    }
}
