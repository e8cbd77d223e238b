//! Processors by their number in ELF files.

use std::env::consts::{ARCH, OS};

/// `std::env::consts::ARCH`, the number in `e_machine`, and the usual name.
const PROCESSORS: [(&str, u16, &str); 9] = [
    ("x86_64", 62, "x86-64"),
    ("aarch64", 183, "64-bit ARM"),
    ("x86", 3, "32-bit x86"),
    ("arm", 40, "32-bit ARM"),
    ("riscv64", 243, "RISC-V"),
    ("powerpc64", 21, "64-bit PowerPC"),
    ("s390x", 22, "IBM Z"),
    ("loongarch64", 258, "LoongArch"),
    ("mips64", 8, "MIPS"),
];

/// The number of this program's processor, if it is known.
pub fn our_number() -> Option<u16> {
    let ours = PROCESSORS.iter().find(|(arch, ..)| *arch == ARCH);
    ours.map(|(_, number, _)| *number)
}

/// The name of the processor with this number.
pub fn name(number: u16) -> String {
    match PROCESSORS.iter().find(|(_, known, _)| *known == number) {
        Some((.., name)) => (*name).to_owned(),
        None => format!("processor type {number}"),
    }
}

/// The names of this program's processor and system.
pub fn ours() -> String {
    format!("{} {OS}", our_number().map_or(ARCH.to_owned(), name))
}
