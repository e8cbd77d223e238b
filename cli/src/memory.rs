//! Memory that is kept.
#![allow(unsafe_code)] // the C library's allocator is asked through the C library

/// Lets the allocator keep the memory that a batch gives back, for the next batch, which takes pieces of the same
/// sizes. Otherwise it gives large pieces to the system, which clears them before it lends them again: a twentieth
/// of the processor time of a run.
///
/// It changes the whole process, for good. It does so on Linux with the C library of GNU, and nothing elsewhere.
pub fn keep_memory() {
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    set_allocator();
}

#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn set_allocator() {
    /// Largest piece of its own mapping, which the allocator permits: 32 MiB.
    const LARGEST: libc::c_int = 1 << 25;
    /// What the allocator takes from the system beyond what it needs: 16 MiB.
    const AHEAD: libc::c_int = 1 << 24;
    for (setting, value) in [
        (libc::M_MMAP_THRESHOLD, LARGEST),
        (libc::M_TRIM_THRESHOLD, libc::c_int::MAX),
        (libc::M_TOP_PAD, AHEAD),
    ] {
        // SAFETY: it changes only when memory goes back to the system. A setting that the allocator refuses
        // leaves it as it was.
        unsafe { libc::mallopt(setting, value) };
    }
}
