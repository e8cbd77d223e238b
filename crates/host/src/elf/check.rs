//! Checks of an ELF library before the system's loader gets it.

use object::elf;
use object::read::elf::{FileHeader, ProgramHeader};

use super::headers::{ENDIAN, Elf, Header, Segment};
use super::tables;
use crate::{Refusal, machine};

/// Real libraries have about ten segments; the loader keeps them on its stack.
const MOST_SEGMENTS: usize = 256;
/// No real library needs more for every thread. With more, the system's loader would end the
/// program instead of refusing the library.
const MOST_THREAD_LOCAL: u64 = 1 << 24;
/// A segment that is write-protected after loading may be rounded up to a page, by this much at
/// most.
const LARGEST_PAGE: u64 = 1 << 16;

const NO_HEADERS: Refusal = Refusal::Damaged("its headers cannot be read");

/// Checks that the library is for this machine, complete, and safe to give to the loader.
///
/// # Errors
/// When it is not.
pub fn check(bytes: &[u8]) -> Result<Elf<'_>, Refusal> {
    fits_this_program(bytes)?;
    if bytes.len() < size_of::<Header>() {
        return Err(Refusal::Truncated);
    }
    let header = Header::parse(bytes).map_err(|_| NO_HEADERS)?;
    if header.e_type(ENDIAN) != elf::ET_DYN {
        return Err(Refusal::NotALibrary("a program or an object file"));
    }
    tables_are_whole(header, bytes)?;
    let segments = header
        .program_headers(ENDIAN, bytes)
        .map_err(|_| NO_HEADERS)?;
    segments_are_whole(segments, bytes)?;
    let library = Elf {
        bytes,
        header,
        segments,
    };
    views_are_whole(&library)?;
    tables::check_sections(&library)?;
    tables::check_dynamic(&library)?;
    Ok(library)
}

/// Class, byte order and processor, which the first bytes give, are this program's.
fn fits_this_program(bytes: &[u8]) -> Result<(), Refusal> {
    let (Some(class), Some(order), Some(machine)) = (bytes.get(4), bytes.get(5), bytes.get(18..20))
    else {
        return Err(Refusal::Truncated);
    };
    let number = match order {
        2 => u16::from_be_bytes([machine[0], machine[1]]),
        _ => u16::from_le_bytes([machine[0], machine[1]]),
    };
    let our_class = if cfg!(target_pointer_width = "32") {
        1
    } else {
        2
    };
    let our_order = if cfg!(target_endian = "big") { 2 } else { 1 };
    let our_number = machine::our_number().unwrap_or(number);
    if (*class, *order, number) == (our_class, our_order, our_number) {
        return Ok(());
    }
    let name = machine::name(number);
    let bits = match class {
        _ if *class == our_class || name.contains("-bit") => "",
        1 => "32-bit ",
        _ => "64-bit ",
    };
    let end = match order {
        _ if *order == our_order => "",
        2 => "big-endian ",
        _ => "little-endian ",
    };
    Err(Refusal::WrongMachine {
        found: format!("{bits}{end}{name}"),
        ours: machine::ours(),
    })
}

/// Both header tables lie within the file.
fn tables_are_whole(header: &Header, bytes: &[u8]) -> Result<(), Refusal> {
    let table = |offset: u64, entry: u16, count: u16| {
        offset.saturating_add(u64::from(entry) * u64::from(count))
    };
    let (phoff, shoff) = (
        u64::from(header.e_phoff(ENDIAN)),
        u64::from(header.e_shoff(ENDIAN)),
    );
    let ends = [
        table(phoff, header.e_phentsize(ENDIAN), header.e_phnum(ENDIAN)),
        table(shoff, header.e_shentsize(ENDIAN), header.e_shnum(ENDIAN)),
    ];
    if ends.iter().any(|end| *end > bytes.len() as u64) {
        return Err(Refusal::Truncated);
    }
    Ok(())
}

/// The bytes of each segment lie within the file, and the loadable segments follow each other in
/// memory.
fn segments_are_whole(segments: &[Segment], bytes: &[u8]) -> Result<(), Refusal> {
    if segments.len() > MOST_SEGMENTS {
        return Err(NO_HEADERS);
    }
    let mut free_from = 0;
    for segment in segments {
        let (offset, in_file) = segment.file_range(ENDIAN);
        if offset.saturating_add(in_file) > bytes.len() as u64 {
            return Err(Refusal::Truncated);
        }
        if segment.p_type(ENDIAN) != elf::PT_LOAD {
            continue;
        }
        let address = u64::from(segment.p_vaddr(ENDIAN));
        let in_memory = u64::from(segment.p_memsz(ENDIAN));
        let end = address.checked_add(in_memory).ok_or(NO_HEADERS)?;
        if address < free_from || in_memory < in_file {
            return Err(NO_HEADERS);
        }
        free_from = end;
    }
    Ok(())
}

/// Whatever else the program headers name (the dynamic table, notes, thread-local data) is the
/// same in memory as in the file.
fn views_are_whole(library: &Elf<'_>) -> Result<(), Refusal> {
    for segment in library.segments {
        let kind = segment.p_type(ENDIAN);
        let (offset, in_file) = segment.file_range(ENDIAN);
        let (address, in_memory) = (segment.p_vaddr(ENDIAN), segment.p_memsz(ENDIAN));
        let (address, in_memory) = (u64::from(address), u64::from(in_memory));
        if kind == elf::PT_TLS && in_memory > MOST_THREAD_LOCAL {
            return Err(NO_HEADERS);
        }
        if kind == elf::PT_GNU_RELRO && in_memory > in_file.saturating_add(LARGEST_PAGE) {
            return Err(NO_HEADERS);
        }
        let empty = in_file == 0 || kind == elf::PT_LOAD;
        // A write-protected segment may reach into zeroed data, which no file holds.
        let read = if kind == elf::PT_GNU_RELRO {
            0
        } else {
            in_file
        };
        if !empty && library.offset_of(address, read) != Some(offset) {
            return Err(NO_HEADERS);
        }
    }
    Ok(())
}
