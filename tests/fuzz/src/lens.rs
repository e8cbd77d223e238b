//! Lens designs: what is taken out of a file is a surface with numbers, and what is refused says why.

use turnpath_lens::{DesignSurface, LensText, Selection, Shape, Side};

/// Words of such files.
pub const WORDS: &[&str] = &[
    "SURF 1\n",
    "  TYPE EVENASPH\n",
    "  TYPE XPOLYNOM\n",
    "  TYPE SZERNSAG\n",
    "  TYPE TOROIDAL\n",
    "  TYPE BICONICX\n",
    "  CURV 0.01 0 0 0 0 \"\"\n",
    "  CONI -1\n",
    "  PARM 2 1e-6\n",
    "  XDAT 1 5 0 0 1 0 0 \"\"\n",
    "  XDAT 2 10 0 0 1 0 0 \"\"\n",
    "  XDAT 1000000000 1\n",
    "  GLAS MIRROR 0 0\n",
    "  DISZ INFINITY\n",
    "  DIAM 5 1 0 0 1 \"\"\n",
    "  CLAP 1 5 0\n",
    "  OBDC 3 4\n",
    "UNIT IN X W X CM MR CPMM\n",
    "MODE SEQ\n",
    "MNUM 1 1\n",
    "NaN",
    "inf",
    "-",
    "1e308",
    "1e-308",
    "99999999999999999999",
    "\u{1a}",
    "\r\n",
];

/// Takes surfaces out of a file: the only one that is bent, and some by their numbers from both
/// sides.
pub fn read(bytes: &[u8]) {
    let Ok(text) = LensText::new(bytes) else {
        return;
    };
    check(&text, &Selection::default());
    for number in 0..4 {
        let selection = |side| Selection {
            number: Some(number),
            side: Some(side),
            radius: Some(2.5),
        };
        let front = check(&text, &selection(Side::PlusZ));
        let behind = check(&text, &selection(Side::MinusZ));
        assert_eq!(front.is_some(), behind.is_some());
        let shapes = front.zip(behind);
        if let Some((front, behind)) = shapes {
            assert_eq!(front.shape.seen_from_behind(), behind.shape);
        }
    }
}

fn check(text: &LensText, selection: &Selection) -> Option<DesignSurface> {
    let surface = match text.surface(selection) {
        Ok(surface) => surface,
        Err(error) => {
            assert!(!error.problems().is_empty() && !error.to_string().is_empty());
            return None;
        }
    };
    let aperture = &surface.aperture;
    assert!(aperture.radius > aperture.inner && aperture.inner >= 0.0);
    assert!(aperture.x.is_finite() && aperture.y.is_finite());
    let bases = match &surface.shape {
        Shape::Biconic { x, y } => vec![x, y],
        Shape::Radial { base, .. }
        | Shape::Toroid { base, .. }
        | Shape::Polynomial { base, .. }
        | Shape::Zernike { base, .. } => vec![base],
    };
    for base in bases {
        assert!(
            base.radius
                .is_none_or(|radius| radius.is_finite() && radius != 0.0)
        );
        assert!(base.conic.is_finite());
    }
    Some(surface)
}
