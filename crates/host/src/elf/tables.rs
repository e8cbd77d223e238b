//! The tables that the loader trusts. Sections, segments and the dynamic table must agree, and none
//! may have a hole, as an unfinished copy has.

use object::elf::{self, DynamicTag};
use object::read::elf::{Dyn, FileHeader, ProgramHeader, SectionHeader};

use super::headers::{ENDIAN, Elf, Header, Section, Segment};
use crate::Refusal;

const DISAGREE: Refusal = Refusal::Damaged("its sections and segments disagree");
const NO_DYNAMIC: Refusal = Refusal::Damaged("its dynamic table does not fit its sections");
const HOLE: Refusal = Refusal::Damaged("a part of it is empty");

/// File systems and downloads leave out blocks of this size or of a multiple of it.
const BLOCK: usize = 4096;
/// Fewer zeros than this may be padding.
const SMALL: usize = 256;

/// Every section that will be in memory lies where the segments say and has the rights that it
/// needs. No section that the loader or the processor reads has a block of zeros.
pub fn check_sections(library: &Elf<'_>) -> Result<(), Refusal> {
    for section in library.sections()? {
        let flags = section.sh_flags(ENDIAN);
        // Zeroed thread-local data take no memory of their own.
        let template = flags.contains(elf::SHF_TLS) && section.sh_type(ENDIAN) == elf::SHT_NOBITS;
        if !flags.contains(elf::SHF_ALLOC) || template || u64::from(section.sh_size(ENDIAN)) == 0 {
            continue;
        }
        if !library.loadable().any(|segment| holds(segment, section)) {
            return Err(DISAGREE);
        }
        let Some((offset, size)) = section.file_range(ENDIAN) else {
            continue;
        };
        if is_never_empty(section) && has_hole(library.bytes, offset, size) {
            return Err(HOLE);
        }
    }
    Ok(())
}

/// Whether a segment puts a section at the section's address, with the rights that it needs.
fn holds(segment: &Segment, section: &Section) -> bool {
    let (file_start, in_file) = segment.file_range(ENDIAN);
    let start = u64::from(segment.p_vaddr(ENDIAN));
    let in_memory = u64::from(segment.p_memsz(ENDIAN));
    let address = u64::from(section.sh_addr(ENDIAN));
    let Some(offset_in_segment) = address.checked_sub(start) else {
        return false;
    };
    let end = offset_in_segment.saturating_add(section.sh_size(ENDIAN).into());
    let fits = match section.file_range(ENDIAN) {
        Some((offset, _)) => {
            end <= in_file && file_start.checked_add(offset_in_segment) == Some(offset)
        }
        None => offset_in_segment >= in_file && end <= in_memory,
    };
    let (rights, flags) = (segment.p_flags(ENDIAN), section.sh_flags(ENDIAN));
    let may = |needed: bool, right| !needed || rights.contains(right);
    fits && may(true, elf::PF_R)
        && may(flags.contains(elf::SHF_WRITE), elf::PF_W)
        && may(flags.contains(elf::SHF_EXECINSTR), elf::PF_X)
}

/// Whether a section holds code, relocations, symbols or their names.
fn is_never_empty(section: &Section) -> bool {
    let kinds = [
        elf::SHT_RELA,
        elf::SHT_REL,
        elf::SHT_DYNSYM,
        elf::SHT_STRTAB,
    ];
    section.sh_flags(ENDIAN).contains(elf::SHF_EXECINSTR)
        || kinds.contains(&section.sh_type(ENDIAN))
}

/// Whether the range covers a part of a block of the file in which all bytes are zero.
fn has_hole(bytes: &[u8], offset: u64, size: u64) -> bool {
    let (Ok(start), Ok(size)) = (usize::try_from(offset), usize::try_from(size)) else {
        return false;
    };
    let end = start.saturating_add(size).min(bytes.len());
    let first = start - start % BLOCK;
    (first..end).step_by(BLOCK).any(|block| {
        let part = bytes.get(block.max(start)..(block + BLOCK).min(end));
        part.is_some_and(|part| part.len() >= SMALL && part.iter().all(|byte| *byte == 0))
    })
}

type Rela = <Header as FileHeader>::Rela;
type Rel = <Header as FileHeader>::Rel;
type Symbol = <Header as FileHeader>::Sym;
type Entry = <Header as FileHeader>::Dyn;

/// Tables in memory, and the entries with their sizes.
const TABLES: [(DynamicTag, Option<DynamicTag>); 12] = [
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

/// Pairs of entries that need each other.
const PAIRS: [(DynamicTag, DynamicTag); 10] = [
    (elf::DT_STRTAB, elf::DT_STRSZ),
    (elf::DT_SYMTAB, elf::DT_SYMENT),
    (elf::DT_SYMTAB, elf::DT_STRTAB),
    (elf::DT_RELA, elf::DT_RELASZ),
    (elf::DT_REL, elf::DT_RELSZ),
    (elf::DT_JMPREL, elf::DT_PLTRELSZ),
    (elf::DT_JMPREL, elf::DT_PLTREL),
    (elf::DT_INIT_ARRAY, elf::DT_INIT_ARRAYSZ),
    (elf::DT_FINI_ARRAY, elf::DT_FINI_ARRAYSZ),
    (elf::DT_VERNEED, elf::DT_VERNEEDNUM),
];

/// Entries that are the offset of a text in the table of strings.
const TEXTS: [DynamicTag; 4] = [
    elf::DT_NEEDED,
    elf::DT_SONAME,
    elf::DT_RPATH,
    elf::DT_RUNPATH,
];

/// The size of one entry, for the tables that have entries.
const ENTRIES: [(DynamicTag, DynamicTag, usize); 3] = [
    (elf::DT_SYMTAB, elf::DT_SYMENT, size_of::<Symbol>()),
    (elf::DT_RELA, elf::DT_RELAENT, size_of::<Rela>()),
    (elf::DT_REL, elf::DT_RELENT, size_of::<Rel>()),
];

/// The library has a dynamic table, and every table that it names is a complete section.
pub fn check_dynamic(library: &Elf<'_>) -> Result<(), Refusal> {
    let entries = library
        .segments
        .iter()
        .find_map(|segment| segment.dynamic(ENDIAN, library.bytes).transpose())
        .ok_or(Refusal::NotALibrary("a program without dynamic linking"))?
        .map_err(|_| NO_DYNAMIC)?;
    let is_end = |entry: &Entry| entry.d_tag(ENDIAN) == elf::DT_NULL;
    let entries = entries.split(is_end).next().unwrap_or_default();
    let value = |tag: DynamicTag| {
        let entry = entries.iter().find(|entry| entry.d_tag(ENDIAN) == tag);
        entry.map(|entry| u64::from(entry.d_val(ENDIAN)))
    };
    let sections = library.sections()?;
    let whole = |(table, size): (DynamicTag, Option<DynamicTag>)| {
        value(table).is_none_or(|start| is_whole(sections, start, size.and_then(value)))
    };
    let paired = |(one, other)| value(one).is_some() == value(other).is_some();
    let right_size =
        |(table, size, expected)| value(table).is_none() || value(size) == Some(expected as u64);
    let strings = value(elf::DT_STRSZ).unwrap_or(0);
    let is_text = |entry: &Entry| {
        !TEXTS.contains(&entry.d_tag(ENDIAN)) || u64::from(entry.d_val(ENDIAN)) < strings
    };
    // The loader does not look at the kind of so many relocations at the beginning.
    let plain = value(elf::DT_RELACOUNT)
        .unwrap_or(0)
        .saturating_mul(size_of::<Rela>() as u64);
    let versioned = value(elf::DT_VERNEED).is_none() || value(elf::DT_VERSYM).is_some();
    let functions = [value(elf::DT_INIT), value(elf::DT_FINI)];
    let fits = value(elf::DT_SYMTAB).is_some()
        && TABLES.into_iter().all(whole)
        && PAIRS.into_iter().all(paired)
        && ENTRIES.into_iter().all(right_size)
        && entries.iter().all(is_text)
        && plain <= value(elf::DT_RELASZ).unwrap_or(0)
        && versioned
        && is_relocation_kind(value(elf::DT_PLTREL))
        && functions
            .into_iter()
            .flatten()
            .all(|function| is_code(sections, function));
    if fits { Ok(()) } else { Err(NO_DYNAMIC) }
}

fn is_relocation_kind(kind: Option<u64>) -> bool {
    let kinds = [elf::DT_RELA, elf::DT_REL].map(|tag| tag.0 as u64);
    kind.is_none_or(|kind| kinds.contains(&kind))
}

/// Whether a table begins where a section begins and ends where a section ends.
fn is_whole(sections: &[Section], start: u64, size: Option<u64>) -> bool {
    let mut loaded = sections
        .iter()
        .filter(|section| section.sh_flags(ENDIAN).contains(elf::SHF_ALLOC))
        .map(|section| {
            let start = u64::from(section.sh_addr(ENDIAN));
            (start, start.saturating_add(section.sh_size(ENDIAN).into()))
        });
    let Some((_, first_end)) = loaded.clone().find(|(begins, _)| *begins == start) else {
        return false;
    };
    match size {
        None | Some(0) => true,
        Some(size) => {
            let end = start.saturating_add(size);
            end == first_end || loaded.any(|(_, ends)| end == ends)
        }
    }
}

/// Whether a function that the loader calls lies in a section of code.
fn is_code(sections: &[Section], function: u64) -> bool {
    sections
        .iter()
        .filter(|section| section.sh_flags(ENDIAN).contains(elf::SHF_EXECINSTR))
        .any(|section| {
            let start = u64::from(section.sh_addr(ENDIAN));
            (start..start.saturating_add(section.sh_size(ENDIAN).into())).contains(&function)
        })
}
