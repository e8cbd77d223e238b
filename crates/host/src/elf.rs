//! ELF libraries, looked at before the system's loader is: it trusts headers, and a file cut short
//! within a segment would end the program with a signal.
#![allow(clippy::useless_conversion)] // a word of the headers is u32 or u64

use object::NativeEndian;
use object::elf;
use object::read::elf::{Dyn, FileHeader, ProgramHeader, SectionHeader, Sym};
use turnpath_plugin::loading;

use crate::{Refusal, machine};

#[cfg(target_pointer_width = "32")]
type Header = elf::FileHeader32<NativeEndian>;
#[cfg(not(target_pointer_width = "32"))]
type Header = elf::FileHeader64<NativeEndian>;
type Segment = <Header as FileHeader>::ProgramHeader;
type Symbol = <Header as FileHeader>::Sym;

const ENDIAN: NativeEndian = NativeEndian;
/// Real libraries have about ten; the loader keeps them on its stack.
const MOST_SEGMENTS: usize = 256;
/// A library that wants more for every thread is not one; the system would give up, not refuse.
const MOST_THREAD_LOCAL: u64 = 1 << 24;
/// What is write-protected after loading may be rounded up to a page, by so much at most.
const LARGEST_PAGE: u64 = 1 << 16;

const NO_HEADERS: Refusal = Refusal::Damaged("its headers cannot be read");
const NO_DYNAMIC: Refusal = Refusal::Damaged("its dynamic table does not fit its segments");
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
    library.check_sections()?;
    library.check_dynamic()?;
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
    let bits = if *class == 1 { "32-bit " } else { "64-bit " };
    let end = if *order == 2 { "big-endian " } else { "" };
    let (bits, end) = (
        if *class == our_class { "" } else { bits },
        if *order == our_order { "" } else { end },
    );
    Err(Refusal::WrongMachine {
        found: format!("{bits}{end}{}", machine::name(number)),
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

/// Tables that the loader follows: where each begins, and where its size stands.
const TABLES: [(elf::DynamicTag, Option<elf::DynamicTag>); 12] = [
    (elf::DT_STRTAB, Some(elf::DT_STRSZ)),
    (elf::DT_SYMTAB, None),
    (elf::DT_HASH, None),
    (elf::DT_GNU_HASH, None),
    (elf::DT_VERSYM, None),
    (elf::DT_VERNEED, None),
    (elf::DT_VERDEF, None),
    (elf::DT_RELA, Some(elf::DT_RELASZ)),
    (elf::DT_REL, Some(elf::DT_RELSZ)),
    (elf::DT_JMPREL, Some(elf::DT_PLTRELSZ)),
    (elf::DT_INIT_ARRAY, Some(elf::DT_INIT_ARRAYSZ)),
    (elf::DT_FINI_ARRAY, Some(elf::DT_FINI_ARRAYSZ)),
];

impl Elf<'_> {
    /// Where in the file the bytes stand that will be at an address.
    fn offset_of(&self, address: u64, size: u64) -> Option<u64> {
        let end = address.checked_add(size)?;
        self.segments
            .iter()
            .filter(|segment| segment.p_type(ENDIAN) == elf::PT_LOAD)
            .find_map(|segment| {
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
            if !empty && self.offset_of(address, in_file) != Some(offset) {
                return Err(NO_HEADERS);
            }
        }
        Ok(())
    }

    /// Sections say of every byte in memory where in the file it stands, as the segments do.
    fn check_sections(&self) -> Result<(), Refusal> {
        let sections = self
            .header
            .section_headers(ENDIAN, self.bytes)
            .map_err(|_| NO_SYMBOLS)?;
        for section in sections {
            let in_memory = section.sh_flags(ENDIAN).contains(elf::SHF_ALLOC);
            let Some((offset, size)) = section.file_range(ENDIAN) else {
                continue;
            };
            let address = u64::from(section.sh_addr(ENDIAN));
            if in_memory && size > 0 && self.offset_of(address, size) != Some(offset) {
                return Err(NO_HEADERS);
            }
        }
        Ok(())
    }

    /// The dynamic table is there, and what it points to lies in the segments.
    fn check_dynamic(&self) -> Result<(), Refusal> {
        let table = self
            .segments
            .iter()
            .find_map(|segment| segment.dynamic(ENDIAN, self.bytes).transpose())
            .ok_or(Refusal::NotALibrary("a program without dynamic linking"))?
            .map_err(|_| NO_DYNAMIC)?;
        let value = |tag: elf::DynamicTag| {
            let entry = table.iter().find(|entry| entry.d_tag(ENDIAN) == tag);
            entry.map(|entry| u64::from(entry.d_val(ENDIAN)))
        };
        if value(elf::DT_STRTAB).is_none() || value(elf::DT_SYMTAB).is_none() {
            return Err(NO_DYNAMIC);
        }
        for (start, size) in TABLES {
            let size = size.map_or(Some(1), value).unwrap_or(0);
            match value(start) {
                Some(start) if self.at(start, size).is_none() => return Err(NO_DYNAMIC),
                _ => (),
            }
        }
        Ok(())
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
