//! The headers, segments and symbols of an ELF library.

use object::NativeEndian;
use object::elf;
use object::read::elf::{FileHeader, ProgramHeader, Sym};
use turnpath_plugin::loading;

use crate::Refusal;

#[cfg(target_pointer_width = "32")]
pub(super) type Header = elf::FileHeader32<NativeEndian>;
#[cfg(not(target_pointer_width = "32"))]
pub(super) type Header = elf::FileHeader64<NativeEndian>;
pub(super) type Segment = <Header as FileHeader>::ProgramHeader;
pub(super) type Symbol = <Header as FileHeader>::Sym;
pub(super) type Section = <Header as FileHeader>::SectionHeader;

pub(super) const ENDIAN: NativeEndian = NativeEndian;

const NO_SYMBOLS: Refusal = Refusal::Damaged("its symbols cannot be read");

/// A library whose headers, segments and dynamic table are complete and agree with each other.
pub struct Elf<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) header: &'a Header,
    pub(super) segments: &'a [Segment],
}

impl Elf<'_> {
    /// The segments that the loader maps into memory.
    pub(super) fn loadable(&self) -> impl Iterator<Item = &Segment> {
        self.segments
            .iter()
            .filter(|segment| segment.p_type(ENDIAN) == elf::PT_LOAD)
    }

    /// The offset in the file of the bytes that will be at an address.
    pub(super) fn offset_of(&self, address: u64, size: u64) -> Option<u64> {
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

    /// The section headers.
    pub(super) fn sections(&self) -> Result<&[Section], Refusal> {
        self.header
            .section_headers(ENDIAN, self.bytes)
            .map_err(|_| NO_SYMBOLS)
    }

    /// The exported symbols and their names.
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

    /// Checks that the exported entry belongs to a plugin for this program's version.
    ///
    /// # Errors
    /// When it does not.
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
