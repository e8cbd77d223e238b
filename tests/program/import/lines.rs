//! Designs with lines that turnpath does not know, and designs that are cut off.

use crate::support::bench::Bench;
use crate::support::recipe::changed;

use super::{DESIGN, import, refused};

/// A copy that stopped half-way: within the surface, between its lines, and behind it.
#[test]
fn a_file_that_is_cut_off_is_refused_wherever_it_ends() {
    let surface = DESIGN.find("SURF 2\n").unwrap();
    let next = DESIGN.find("SURF 3\n").unwrap();
    let bench = Bench::empty();
    let refused = |end: usize, wanted: &str| {
        bench.write("lens.zmx", &DESIGN[..end]);
        let said = bench.line("import lens.zmx --surface 2").ends(2);
        assert!(said.stderr.contains(wanted), "{}: {said}", &DESIGN[..end]);
    };
    for (end, _) in DESIGN.match_indices('\n').filter(|(end, _)| *end > surface) {
        let line = DESIGN[..end].lines().last().unwrap();
        // A character of the line is lost, then its end alone. A surface without its number is told as
        // such.
        if !line.starts_with("SURF") {
            refused(end - 1, "the file ends within this line");
        }
        refused(end, "the file ends within this line");
        if end < next {
            refused(end + 1, "line 16: surface 2 is the file's last");
        }
    }
    bench.write("lens.zmx", format!("{DESIGN}\u{1a}"));
    bench.line("import lens.zmx --surface 2").ends(0);
}

/// Makers of lenses publish files whose last line has no end.
#[test]
fn a_file_may_end_as_it_likes_behind_the_number_of_configurations() {
    let last = "MOFF 0 1 \"\" 0 0 0 1 1 0 0.0 \"\" 0";
    import("MNUM 1 1\n", &format!("MNUM 1 1\n{last}"), "--surface 2").ends(0);
    let said = refused("MNUM 1 1\n", last, "--surface 2");
    assert!(
        said[0].contains("line 33: the file ends within this line"),
        "{said:?}"
    );
    // A value of a configuration that has lost its end has ten numbers, too.
    let value = "MNUM 1 1\nCRVT 2 1 -1.0E-2 0 0 0 1 1 0 0.0";
    let said = refused("MNUM 1 1\n", value, "--surface 2");
    assert!(said[0].contains("line 34: `CRVT` is not known"), "{said:?}");
    // The number of configurations counts where it belongs: the last line may be the start of `MNUM 12`.
    let early = changed(DESIGN, "NAME Test\n", "NAME Test\nMNUM 1 1\n");
    let bench = Bench::empty();
    bench.write("lens.zmx", early.trim_end());
    let said = bench.line("import lens.zmx --surface 2").ends(2);
    assert!(
        said.stderr.contains("the file ends within this line"),
        "{said}"
    );
}

/// Newer programs write lines before the surfaces that no list has. None of them is about a surface.
#[test]
fn unknown_settings_of_the_whole_design_are_notes() {
    let header = "UNIT MM X W X CM MR CPMM\n";
    let with = |lines: &str| format!("{header}{lines}\n");
    let known = "AUTH Somebody\nIWDP 0\nSTUD 1\nLUID 23\nEERA 0 0 0 10 10\nDBDT 1 4 1 0 0 0 0";
    let said = import(header, &with(known), "--surface 2").ends(0);
    assert_eq!(said.stderr, "");
    // Each word is named once.
    let said = import(header, &with("WXYZ 1 0\nWXYZ 2 0"), "--surface 2").ends(0);
    let note = "line 5: WXYZ is not known: it stands before the surfaces";
    assert!(said.stderr.contains(note), "{said}");
    assert_eq!(said.stderr.matches("WXYZ").count(), 1, "{said}");
    assert!(
        said.stdout.contains("# Line 5: WXYZ is not known"),
        "{said}"
    );
    for line in ["  WXYZ 1", "wxyz 1", "W 1", "1234 5", "CONFIGURATION 2"] {
        let key = line.split_whitespace().next().unwrap();
        let said = refused(header, &with(line), "--surface 2");
        let wanted = format!("line 5: `{key}` is not known");
        assert!(said[0].contains(&wanted), "{line}: {said:?}");
    }
    for line in ["CURV 0.02", "CURV 0.02 0 0 0 0 0 0 0 0 0", "PARM 2 1E-6"] {
        let key = line.split_whitespace().next().unwrap();
        let said = refused(header, &with(line), "--surface 2");
        let wanted = format!("line 5: `{key}` is a line of a surface and does not stand with one");
        assert!(said[0].contains(&wanted), "{line}: {said:?}");
    }
    // What stands in place of the mode may be the mode, misspelt.
    let said = refused("MODE SEQ", "MODF NSC", "--surface 2");
    assert!(said[0].contains("line 2: `MODF` is not known"), "{said:?}");
}

#[test]
fn the_number_of_a_surface_and_the_width_of_its_blank_change_no_shape() {
    let lines = "SURF 2\n  SSID 0\n  OEMA 0.75 0 0 0 1 \"\"\n";
    let said = import("SURF 2\n", lines, "--surface 2").ends(0);
    assert_eq!(said.stderr, "");
}

/// Operands of the merit function have hundreds of names, ten numbers, and one place.
#[test]
fn operands_of_the_merit_function_measure_whatever_their_name() {
    let behind = |line: &str| {
        (
            "TOL TOFF 0 0\n",
            format!("{line}\nRCMF 25 0\nTOL TOFF 0 0\n"),
        )
    };
    let (tolerances, operand) = behind("WXYZ 3 1 0 0 0 0 114.8 1.0E+0 0 0");
    let said = import(tolerances, &operand, "--surface 2").ends(0);
    assert_eq!(said.stderr, "");
    let ten = "3 1 0 0 0 0 0 0 0 0";
    for (passage, with) in [
        behind("WXYZ 3 1 0 0 0 0 0 0 0"),
        behind("WXYZ 3 1 0 0 0 0 0 0 0 0 0"),
        behind("WXYZ 3 1 0 0 0 0 0 0 0 nan"),
        behind(&format!("wxyz {ten}")),
        // Behind the tolerances stand configurations, whose values change shapes.
        ("TOL TOFF 0 0\n", format!("TOL TOFF 0 0\nCRVT {ten}\n")),
        ("MNUM 1 1\n", format!("MNUM 1 1\nCRVT {ten}\n")),
        // Between the surfaces a line may be one of theirs.
        ("SURF 3\n", format!("WXYZ {ten}\nSURF 3\n")),
    ] {
        let said = refused(passage, &with, "--surface 2");
        assert!(said[0].contains("is not known"), "{with}: {said:?}");
    }
}

#[test]
fn a_line_of_a_surface_that_stands_with_none_is_told_as_such() {
    let ten = "3 1 0 0 0 0 0 0 0 0";
    for (passage, with) in [
        ("SURF 3\n", format!("LUID 1\n  CONI {ten}\nSURF 3\n")),
        ("SURF 3\n", format!("LUID 1\n  IGNR {ten}\nSURF 3\n")),
        ("SURF 0\n", format!("CONI {ten}\nSURF 0\n")),
    ] {
        let said = refused(passage, &with, "--surface 2");
        assert!(
            said[0].contains("does not stand with one"),
            "{with}: {said:?}"
        );
    }
}
