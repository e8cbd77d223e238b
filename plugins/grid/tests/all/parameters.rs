//! The parameters as a recipe gives them.

#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::path::Path;

use turnpath_core::{
    DataFile, ParamDefault, ParamValue, Params, Strategy, StrategyError, SurfaceModel,
};
use turnpath_grid::GridSag;

fn params(file: &str) -> Params {
    let mut params = Params::new();
    for param in GridSag::PARAMS {
        match param.default {
            ParamDefault::Flag(value) => params.set(param.name, ParamValue::Flag(value)),
            ParamDefault::Text(word) => params.set(param.name, ParamValue::Text(word.to_owned())),
            _ => {}
        }
    }
    let folder = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../tests/reference/grids/files"
    );
    let file = DataFile {
        path: format!("maps/{file}"),
        bytes: std::fs::read(Path::new(folder).join(file)).unwrap().into(),
    };
    params.set("file", ParamValue::File(file));
    params
}

fn height(surface: &GridSag, x: f64, y: f64) -> f64 {
    let mut z = [0.0];
    surface.heights(&[x], &[y], &mut z).unwrap();
    z[0]
}

/// The surface that tests/reference/grids/files.py samples, mm.
fn sampled(x: f64, y: f64) -> f64 {
    1e-3 * (0.3 + 0.2 * x - 0.5 * y + 0.1 * x * x - 0.07 * x * y + 0.03 * y * y * y)
}

#[test]
fn a_file_of_each_format_is_the_surface_that_it_samples() {
    let text = |word: &str| ParamValue::Text(word.to_owned());
    // A cubic is its own spline but for the two holes, and for digits of the file.
    let check = |name: &str, params: &Params, bound: f64| {
        let surface = GridSag::new(params).unwrap();
        for (x, y) in [(-0.3, 0.2), (0.6, 0.5), (0.1, 0.75)] {
            let off = (height(&surface, x, y) - sampled(x, y)).abs();
            assert!(off < bound, "{name}: {off}");
        }
    };
    for name in [
        "zemax-mm.DAT",
        "zemax-in.DAT",
        "zemax-m.DAT",
        "field-um.gsf",
    ] {
        check(name, &params(name), 2e-6);
    }
    for name in ["metropro-1.dat", "metropro-2.dat"] {
        // Its pixels are square, so the distance along y is given.
        let mut params = params(name);
        params.set("pitch_x", ParamValue::Number(0.5));
        params.set("pitch_y", ParamValue::Number(0.4));
        check(name, &params, 3e-6);
    }
    let mut code_v = params("code-v.INT");
    code_v.set("pitch_x", ParamValue::Number(0.5));
    code_v.set("pitch_y", ParamValue::Number(0.4));
    check("code-v", &code_v, 2e-6);
    let mut xyz = params("points.xyz");
    xyz.set("xy_unit", text("mm"));
    xyz.set("z_unit", text("um"));
    let surface = GridSag::new(&xyz).unwrap();
    let off = height(&surface, 3.2, -2.3) - sampled(3.2, -2.3);
    assert!(off.abs() < 2e-6, "{off}");
}

#[test]
fn axes_are_mirrored_about_the_origin() {
    let straight = GridSag::new(&params("zemax-mm.DAT")).unwrap();
    for (key, sign) in [("flip_x", [-1.0, 1.0]), ("flip_y", [1.0, -1.0])] {
        let mut params = params("zemax-mm.DAT");
        params.set(key, ParamValue::Flag(true));
        let mirrored = GridSag::new(&params).unwrap();
        let (x, y) = (0.37, -0.61);
        let (found, wanted) = (
            height(&mirrored, sign[0] * x, sign[1] * y),
            height(&straight, x, y),
        );
        assert!((found - wanted).abs() < 1e-12, "{key}: {found} {wanted}");
    }
}

#[test]
fn what_is_wrong_names_its_parameter_and_the_files_line() {
    let refused = |params: &Params| match GridSag::new(params) {
        Err(StrategyError::Parameter { name, message, .. }) => format!("{name}: {message}"),
        other => panic!("{other:?}"),
    };
    let said = refused(&params("points.xyz"));
    assert_eq!(
        said,
        "file: maps/points.xyz: the file does not say its unit: give `xy_unit`"
    );
    let mut short = params("zemax-mm.DAT");
    let bytes = b"6 6 1 1 9 0 0\n".to_vec();
    let path = "maps/short.DAT".to_owned();
    short.set(
        "file",
        ParamValue::File(DataFile {
            path,
            bytes: bytes.into(),
        }),
    );
    let said = refused(&short);
    assert!(
        said.starts_with("file: maps/short.DAT: line 1: the flag of the units is 9"),
        "{said}"
    );
    let mut smooth = params("zemax-mm.DAT");
    smooth.set("smooth", ParamValue::Number(0.3));
    let said = refused(&smooth);
    assert!(
        said.starts_with("smooth: for this map the cutoff lies between 1.0000 mm"),
        "{said}"
    );
}
