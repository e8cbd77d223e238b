//! ELF libraries, looked at before the system's loader is: it trusts headers, and a file cut short
//! within a segment would end the program with a signal.
#![allow(clippy::useless_conversion)] // a word of the headers is u32 or u64

mod tables;

use object::NativeEndian;
use object::elf;
use object::read::elf::{FileHeader, ProgramHeader, Sym};
use turnpath_plugin::loading;

use crate::{Refusal, machine};

#[cfg(target_pointer_width = "32")]
type Header = elf::FileHeader32<NativeEndian>;
#[cfg(not(target_pointer_width = "32"))]
type Header = elf::FileHeader64<NativeEndian>;
type Segment = <Header as FileHeader>::ProgramHeader;
type Symbol = <Header as FileHeader>::Sym;
type Section = <Header as FileHeader>::SectionHeader;

const ENDIAN: NativeEndian = NativeEndian;
/// Real libraries have about ten; the loader keeps them on its stack.
const MOST_SEGMENTS: usize = 256;
/// A library that wants more for every thread is not one; the system would give up, not refuse.
const MOST_THREAD_LOCAL: u64 = 1 << 24;
/// What is write-protected after loading may be rounded up to a page, by so much at most.
const LARGEST_PAGE: u64 = 1 << 16;

const NO_HEADERS: Refusal = Refusal::Damaged("its headers cannot be read");
const NO_SYMBOLS: Refusal = Refusal::Damaged("its symbols cannot be read");

/// A library whose headers, segments and dynamic table are whole and agree.
pub struct Elf<'a> {
    bytes: &'a [u8],
    header: &'a Header,
    segments: &'a [Segment],
}

/// Checks that the library is for this machine, whole, and fit to be handed to the loader.
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
    library.check_views()?;
    tables::check_sections(&library)?;
    tables::check_dynamic(&library)?;
    Ok(library)
}

/// Class, byte order and processor, from the first bytes.
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

/// Every segment's bytes lie within the file, and the loadable ones follow each other in memory.
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

impl Elf<'_> {
    fn loadable(&self) -> impl Iterator<Item = &Segment> {
        self.segments
            .iter()
            .filter(|segment| segment.p_type(ENDIAN) == elf::PT_LOAD)
    }

    /// Where in the file the bytes stand that will be at an address.
    fn offset_of(&self, address: u64, size: u64) -> Option<u64> {
        let end = address.checked_add(size)?;
        self.loadable().find_map(|segment| {
            let (offset, in_file) = segment.file_range(ENDIAN);
            let start = u64::from(segment.p_vaddr(ENDIAN));
            let holds = start <= address && end <= start.saturating_add(in_file);
            holds.then(|| offset + (address - start))
        })
    }

    /// The bytes that will be at an address.
    fn at(&self, address: u64, size: u64) -> Option<&[u8]> {
        let start = usize::try_from(self.offset_of(address, size)?).ok()?;
        self.bytes
            .get(start..start.checked_add(usize::try_from(size).ok()?)?)
    }

    /// What else the program headers name (the dynamic table, notes, thread-local data) is the
    /// same in memory as in the file.
    fn check_views(&self) -> Result<(), Refusal> {
        for segment in self.segments {
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
            // What is write-protected may reach into zeroed data, which no file holds.
            let read = if kind == elf::PT_GNU_RELRO {
                0
            } else {
                in_file
            };
            if !empty && self.offset_of(address, read) != Some(offset) {
                return Err(NO_HEADERS);
            }
        }
        Ok(())
    }

    fn sections(&self) -> Result<&[Section], Refusal> {
        self.header
            .section_headers(ENDIAN, self.bytes)
            .map_err(|_| NO_SYMBOLS)
    }

    /// The symbols that the library exports, by name.
    fn exports(&self) -> Result<Vec<(&[u8], &Symbol)>, Refusal> {
        let sections = self
            .header
            .sections(ENDIAN, self.bytes)
            .map_err(|_| NO_SYMBOLS)?;
        let symbols = sections
            .symbols(ENDIAN, self.bytes, elf::SHT_DYNSYM)
            .map_err(|_| NO_SYMBOLS)?;
        let mut exports = Vec::new();
        for symbol in symbols.iter().filter(|symbol| !symbol.is_undefined(ENDIAN)) {
            let name = symbol
                .name(ENDIAN, symbols.strings())
                .map_err(|_| NO_SYMBOLS)?;
            exports.push((name, symbol));
        }
        Ok(exports)
    }

    /// The names of exported symbols that begin with `prefix`.
    pub fn exports_with(&self, prefix: &str) -> Result<Vec<String>, Refusal> {
        let named = |(name, _): &(&[u8], _)| std::str::from_utf8(name).ok().map(str::to_owned);
        let mut names: Vec<String> = self.exports()?.iter().filter_map(named).collect();
        names.retain(|name| name.starts_with(prefix));
        Ok(names)
    }

    /// The exported plugin entry is one, and of this program's version.
    pub fn check_entry(&self, symbol: &str) -> Result<(), Refusal> {
        let exports = self.exports()?;
        let entry = exports
            .iter()
            .find(|(name, _)| *name == symbol.as_bytes())
            .and_then(|(_, symbol)| {
                let (address, size) = (symbol.st_value(ENDIAN), symbol.st_size(ENDIAN));
                self.at(u64::from(address), u64::from(size))
            });
        loading::inspect(entry.ok_or(Refusal::NotAPlugin)?).map_err(Refusal::from)
    }
}
