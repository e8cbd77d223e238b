//! Words that lines of a `.zmx` begin with and that cannot change the shape of a surface.
//!
//! The format has no published description. The lists are those of open readers: ray-optics
//! (`zemax/zmxread.py`), optiland (`fileio/zemax`) and acorn (`zmx.tcl`), and of the designs that these
//! have for their tests.

/// Most letters of a word that a line begins with.
const MOST_LETTERS: usize = 4;

/// Lines of the system: title, units of analyses, pupils, fields, wavelengths, glasses, ray aiming,
/// polarisation, catalogues, tolerances, authors, marks of catalogue lenses, and operands of the merit
/// function that only measure.
const SYSTEM: &[&str] = &[
    "AUTH", "BLNK", "COFN", "DBDT", "DMFS", "EDGE", "EERA", "EFFL", "EFLX", "EFLY", "ENPD", "ENVD",
    "FCOM", "FLOA", "FNUM", "FTYP", "FWGN", "FWGT", "GCAT", "GFAC", "GLRS", "GSTD", "HYPR", "IMAE",
    "ISNA", "IWDP", "LANG", "LUID", "MNCA", "MNCG", "MNEA", "MNEG", "MOFF", "MXCA", "MXCG", "MXEA",
    "MXEG", "NAME", "NOTE", "NSCD", "OBNA", "OMMA", "OPDX", "OPGT", "OPLT", "PFIL", "PICB", "PMAG",
    "POLS", "PUPD", "PUSH", "PWAV", "PZUP", "RAIM", "RCMF", "REAX", "REAY", "REAZ", "RGLA", "ROPD",
    "RSCE", "RSCH", "SDMA", "STEL", "STUD", "TCED", "TCMM", "TOL", "TOLE", "TOTR", "TRAC", "TTHI",
    "UDAD", "VANN", "VCXN", "VCYN", "VDSZ", "VDXN", "VDYN", "VERS", "WAVE", "WAVL", "WAVM", "WAVN",
    "WFNO", "WWGN", "WWGT", "XFIE", "XFLD", "XFLN", "YFIE", "YFLD", "YFLN", "ZVAN", "ZVCX", "ZVCY",
    "ZVDX", "ZVDY",
];

/// Lines of a surface: glass, coating, thickness, drawing, stop, colours, physical optics, its number in
/// the program, the width between its edge and the blank's, and marks of variables.
const SURFACE: &[&str] = &[
    "BLNK", "COAT", "COMM", "DISZ", "EDGE", "FIMP", "GLAS", "HIDE", "MAZH", "MEMA", "MIRR", "OEMA",
    "POPS", "PZUP", "RSCE", "SCOL", "SLAB", "SSID", "STOP", "TCED", "VCON", "VDSZ", "VPAR",
];

/// Lines of a surface that say where its edge is.
const APERTURE: &[&str] = &["CLAP", "DIAM", "FLAP", "OBDC", "OBSC"];

/// Lines of a surface with an edge that is not a circle.
const OTHER_APERTURE: &[&str] = &[
    "ELAP", "ELOB", "SPID", "SQAP", "SQOB", "UDAD", "UDOB", "USAP",
];

/// Lines of a surface that make its shape.
const SHAPE: &[&str] = &[
    "CONI", "CURV", "IGNR", "PARM", "PKUP", "PPAR", "TYPE", "XDAT",
];

/// Whether a line of the system is known and cannot change a shape.
pub fn is_system(key: &str) -> bool {
    SYSTEM.contains(&key)
}

/// Whether a word is like those of the lists: two to four capitals, or digits behind the first one.
pub fn is_word(key: &str) -> bool {
    let is_like_them = |c: char| c.is_ascii_uppercase() || c.is_ascii_digit();
    (2..=MOST_LETTERS).contains(&key.len())
        && key.starts_with(|c: char| c.is_ascii_uppercase())
        && key.chars().all(is_like_them)
}

/// Whether a line has an edge that is not a circle.
pub fn is_other_aperture(key: &str) -> bool {
    OTHER_APERTURE.contains(&key)
}

/// Whether a line may belong to a surface.
pub fn is_of_surface(key: &str) -> bool {
    [SURFACE, APERTURE, OTHER_APERTURE, SHAPE]
        .iter()
        .any(|keys| keys.contains(&key))
}
