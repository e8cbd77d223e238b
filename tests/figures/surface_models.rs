//! The surface models against programs that share no code with turnpath, and against their textbook
//! formulas in fifty digits.
//!
//! `tests/reference/surfaces` has the data and the scripts that make it: heights by optiland and
//! prysm, series of height and slopes by mpmath, alone, in a sum, and in poses.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use serde_json::Value;
use turnpath::{Catalogue, Recipe};
use turnpath_core::{
    Attitude, GradientSeries, Gradients, NamedConstant, ParamDefault, ParamKind, ParamValue,
    Params, Placement, Pose, Series, Slot, SurfaceModel,
};
use turnpath_pipeline::{PlacedSurface, PosedSurface, SurfaceSum};

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, with_table};
use crate::support::repository;

/// Largest difference of a height from another program's, mm.
const HEIGHT: f64 = 1e-13;
/// Largest difference of a coefficient, as a part of the reference's.
const RELATIVE: f64 = 1e-9;
/// A coefficient this small beside the largest of its series is what larger ones leave when they
/// cancel: it is held to the same part of this instead.
const CANCELLED: f64 = 1e-3;

fn catalogue() -> &'static Catalogue {
    static CATALOGUE: OnceLock<Catalogue> = OnceLock::new();
    CATALOGUE.get_or_init(|| Catalogue::linked().unwrap())
}

fn cases(file: &str) -> Vec<Value> {
    let file = repository().join("tests/reference/surfaces").join(file);
    let all: Value = serde_json::from_str(&fs::read_to_string(file).unwrap()).unwrap();
    all["cases"].as_array().unwrap().clone()
}

/// The surface of this name with the parameters of a case, and the defaults for the others.
fn model(of: &Value) -> Arc<dyn SurfaceModel> {
    let name = of["surface"].as_str().unwrap();
    let strategy = catalogue().find(Slot::Surface, name).unwrap();
    let mut params = Params::new();
    for param in strategy.info().params {
        let value = match (&of["params"][param.name], param.default) {
            (Value::Null, ParamDefault::Number(number)) => ParamValue::Number(number),
            (Value::Null, ParamDefault::Absent) => continue,
            (given, _) => param_value(given, param.kind),
        };
        params.set(param.name, value);
    }
    strategy.offer().surface(&params).unwrap()
}

fn param_value(given: &Value, kind: ParamKind) -> ParamValue {
    match (given, kind) {
        (Value::Object(table), ParamKind::Coefficients(..)) => {
            let row = |(key, value): (&String, &Value)| {
                let numbers = key.split(',').map(|number| number.parse().unwrap());
                numbers.chain([value.as_f64().unwrap()]).collect()
            };
            ParamValue::Rows(table.iter().map(row).collect())
        }
        (Value::Object(table), ParamKind::Constants) => {
            let constant = |(name, value): (&String, &Value)| NamedConstant {
                name: name.clone(),
                value: value[0].as_f64().unwrap(),
                length_power: i32::try_from(value[1].as_i64().unwrap()).unwrap(),
            };
            ParamValue::Constants(table.iter().map(constant).collect())
        }
        (Value::String(word), _) => ParamValue::Text(word.clone()),
        (given, kind) => ParamValue::Number(given.as_f64().unwrap_or_else(|| {
            panic!("{given} is no value of the kind {kind:?}");
        })),
    }
}

fn numbers<T: serde::de::DeserializeOwned>(case: &Value, key: &str) -> T {
    serde_json::from_value(case[key].clone()).unwrap()
}

/// The models of design programs.
const MODELS: [&str; 12] = [
    "biconic",
    "chebyshev",
    "even-asphere",
    "forbes-q2d",
    "forbes-qbfs",
    "forbes-qcon",
    "lenslet-array",
    "odd-asphere",
    "off-axis-conic",
    "toroid-yz",
    "xy-polynomial",
    "zernike",
];

#[test]
fn heights_are_those_of_optiland_and_prysm() {
    let mut seen = BTreeSet::new();
    for case in cases("values.json") {
        let (x, y): (Vec<f64>, Vec<f64>) = (numbers(&case, "x"), numbers(&case, "y"));
        let z: Vec<f64> = numbers(&case, "z");
        let mut found = vec![f64::NAN; x.len()];
        model(&case).heights(&x, &y, &mut found).unwrap();
        assert!(z.len() > 20);
        for i in 0..z.len() {
            let off = (found[i] - z[i]).abs();
            assert!(
                off <= HEIGHT,
                "{} {} at {}, {}: {} for {} of {}, {off:e}",
                case["surface"],
                case["params"],
                x[i],
                y[i],
                found[i],
                z[i],
                case["source"]
            );
        }
        seen.insert(case["surface"].as_str().unwrap().to_owned());
    }
    assert!(seen.into_iter().eq(MODELS));
}

/// The series of height and slopes along a curve.
fn series(surface: &dyn SurfaceModel, x: Series, y: Series) -> [Series; 3] {
    let (mut z, mut zx, mut zy) = ([[f64::NAN; 5]], [[f64::NAN; 5]], [[f64::NAN; 5]]);
    let out = GradientSeries {
        z: &mut z,
        zx: &mut zx,
        zy: &mut zy,
    };
    surface.series(&[x], &[y], out).unwrap();
    [z[0], zx[0], zy[0]]
}

/// Holds height and slopes, and their series, to those of a case.
fn agrees(what: &str, surface: &dyn SurfaceModel, case: &Value) {
    let (x, y): (Series, Series) = (numbers(case, "x"), numbers(case, "y"));
    let expected: [Series; 3] = ["z", "zx", "zy"].map(|key| numbers(case, key));
    let found = series(surface, x, y);
    let mut height = [[f64::NAN; 5]];
    surface.height_series(&[x], &[y], &mut height).unwrap();
    for (name, found, expected) in [
        ("z", &found[0], &expected[0]),
        ("zx", &found[1], &expected[1]),
        ("zy", &found[2], &expected[2]),
        ("z alone", &height[0], &expected[0]),
    ] {
        let largest = expected.iter().fold(0.0f64, |most, c| most.max(c.abs()));
        for (k, (found, expected)) in found.iter().zip(expected).enumerate() {
            let allowed = RELATIVE * expected.abs().max(CANCELLED * largest);
            let off = (found - expected).abs();
            assert!(
                off <= allowed,
                "{what}: {name}, coefficient {k}: {found} for {expected}, {:e}",
                off / expected.abs()
            );
        }
    }
    let (mut z, mut zx, mut zy) = ([f64::NAN], [f64::NAN], [f64::NAN]);
    let out = Gradients {
        z: &mut z,
        zx: &mut zx,
        zy: &mut zy,
    };
    surface.gradient(&[x[0]], &[y[0]], out).unwrap();
    for (found, series) in [z[0], zx[0], zy[0]].into_iter().zip(&found) {
        let most = series.iter().fold(0.0f64, |most, c| most.max(c.abs()));
        let off = (found - series[0]).abs();
        assert!(off <= 1e-12 * most, "{what}: {found} for {}", series[0]);
    }
}

#[test]
fn series_of_height_and_slopes_are_those_of_fifty_digits() {
    let cases = cases("series.json");
    assert!(cases.len() > 150);
    for case in cases {
        let what = format!("{} {} at {}", case["surface"], case["params"], case["x"]);
        agrees(&what, model(&case).as_ref(), &case);
    }
}

#[test]
fn series_of_formulas_are_those_of_fifty_digits() {
    let cases = cases("formula.json");
    assert_eq!(cases.len(), 40);
    let at_axis = |case: &&Value| case["x"][0] == 0.0 && case["y"][0] == 0.0;
    assert_eq!(cases.iter().filter(at_axis).count(), 12);
    for case in cases {
        let what = format!("{} at {}", case["params"]["z"], case["x"]);
        agrees(&what, model(&case).as_ref(), &case);
    }
}

fn placement(place: &Value) -> Placement {
    let number = |key: &str| place[key].as_f64().unwrap();
    Placement {
        scale: number("scale"),
        decentre_x: number("decentre_x"),
        decentre_y: number("decentre_y"),
        clocking: number("clocking"),
        piston: number("piston"),
    }
}

fn pose(pose: &Value) -> Pose {
    let number = |key: &str| pose[key].as_f64().unwrap();
    let attitude = match pose["level"].as_bool() {
        Some(true) => Attitude::Level,
        _ => Attitude::Tilted {
            tilt_x: number("tilt_x"),
            tilt_y: number("tilt_y"),
        },
    };
    Pose {
        x: number("x"),
        y: number("y"),
        attitude,
    }
}

#[test]
fn series_of_a_sum_and_of_its_poses_are_those_of_fifty_digits() {
    let cases = cases("composites.json");
    assert_eq!(cases.len(), 9);
    for case in cases {
        let placed = case["sum"].as_array().unwrap().iter().map(|one| {
            let placed = PlacedSurface::new(model(one), placement(&one["place"]));
            Arc::new(placed) as Arc<dyn SurfaceModel>
        });
        let sum = Arc::new(SurfaceSum::new(placed.collect()));
        let what = format!("the sum in the pose {} at {}", case["pose"], case["x"]);
        match &case["pose"] {
            Value::Null => agrees(&what, sum.as_ref(), &case),
            of => agrees(&what, &PosedSurface::new(sum, pose(of)).unwrap(), &case),
        }
    }
}

/// A tolerance that is coarse enough for a run of every recipe in every run of the tests.
const COARSE: [&str; 4] = [
    "--set",
    "tolerance.interpolation=1 um",
    "--set",
    "tolerance.residual=2 um",
];

/// Every model has a ready recipe. The tool fits its part, and the path holds a coarse tolerance.
#[test]
fn the_recipe_of_each_model_holds_at_a_coarse_setting() {
    let bench = Bench::empty();
    for model in MODELS.into_iter().chain(["formula"]) {
        let recipe = repository().join(format!("docs/recipes/surfaces/{model}.toml"));
        let text = fs::read_to_string(&recipe).unwrap();
        assert!(text.contains(&format!("use = \"{model}\"")), "{model}");
        let recipe = recipe.to_str().unwrap();
        let run = ["run", recipe, "-o", model];
        bench.call(run.iter().chain(&COARSE)).ends(0);
    }
}

/// The surfaces of all ready recipes, by their names. Those of `docs/recipes` are run at their own
/// setting, and those of the folder `surfaces` at a coarse one: here, and the map in the suite
/// `program`.
fn ready_recipes() -> Vec<(String, PathBuf)> {
    let folder = repository().join("docs/recipes");
    let mut found = Vec::new();
    for folder in [folder.clone(), folder.join("surfaces")] {
        let files = fs::read_dir(folder)
            .unwrap()
            .map(|file| file.unwrap().path());
        for file in files.filter(|file| file.extension().is_some_and(|end| end == "toml")) {
            let recipe = Recipe::load(file.to_str().unwrap(), &[]).unwrap();
            let names = recipe
                .surfaces
                .iter()
                .map(|one| one.choice.name().to_owned());
            found.extend(names.map(|name| (name, file.clone())));
        }
    }
    found
}

#[test]
fn each_model_has_a_ready_recipe() {
    let models = catalogue().names(Slot::Surface).into_iter();
    let models: BTreeSet<String> = models.map(str::to_owned).collect();
    let ready: BTreeSet<String> = ready_recipes().into_iter().map(|(name, _)| name).collect();
    assert_eq!(ready, models);
}

/// `sag` asks for the square around the aperture: its corners lie 1.4 radii from the axis.
#[test]
fn the_surface_of_each_ready_recipe_goes_on_beyond_its_aperture() {
    let bench = Bench::empty();
    for (name, file) in ready_recipes() {
        let recipe = file.to_str().unwrap();
        let said = bench
            .call(["sag", recipe, "--grid", "21", "-o", "-"])
            .ends(0);
        assert_eq!(said.stdout.lines().count(), 21 * 21 + 1);
        assert!(!said.stdout.contains("NaN"), "{name}: {recipe}");
    }
}

/// Columns of a path's rows before the velocities. Those are what heights differ by over a step of some
/// milliseconds.
const POSITIONS: usize = 4;

/// A recipe with a formula for a surface makes the points that the native model makes.
#[test]
fn a_formula_makes_the_path_of_the_native_model() {
    let tables = [
        (
            "use = \"conic\"\nradius = \"40 mm\"\nconic = -0.7",
            "use = \"formula\"\nz = \"c*rho^2/(1 + sqrt(1 - (1 + K)*c^2*rho^2))\"\n\
             constants = { c = \"0.025 /mm\", K = -0.7 }",
        ),
        (
            "use = \"toric\"\nradius_rotation = \"50 mm\"\nradius_base = \"32 mm\"",
            "use = \"formula\"\nz = \"R - sqrt((R - a + sqrt(a^2 - y^2))^2 - x^2)\"\n\
             constants = { R = \"50 mm\", a = \"32 mm\" }",
        ),
        (
            "use = \"astigmatic\"\nk = \"0.08 /mm\"",
            "use = \"formula\"\nz = \"k*rho^2*sin(2*theta)\"\n\
             constants = { k = \"0.08 /mm\" }",
        ),
    ];
    for (native, formula) in tables {
        let [native, formula] = [native, formula].map(rows);
        assert_eq!(native.len(), formula.len());
        for (native, formula) in native.iter().zip(&formula) {
            for (column, (native, formula)) in native.iter().zip(formula).enumerate() {
                let allowed = if column < POSITIONS { 1e-12 } else { 1e-9 };
                let off = (native - formula).abs();
                assert!(
                    off <= allowed * (1.0 + native.abs()),
                    "column {column}: {formula} for {native}"
                );
            }
        }
    }
}

/// The rows of the path over a surface, with even steps and an even feed: what follows the surface is
/// searched for, and a search ends where rounding lets it.
fn rows(surface: &str) -> Vec<Vec<f64>> {
    let recipe = with_table(SADDLE, "surface", surface);
    let feed = "use = \"constant\"\nfeed = \"20 um/rev\"";
    let bench = Bench::with(&with_table(&recipe, "feed", feed));
    bench.line("run recipe.toml -o out").ends(0);
    let text = bench.read("out/toolpath.csv");
    let number = |cell: &str| cell.parse().unwrap();
    let row = |line: &str| line.split(',').map(number).collect();
    text.lines().skip(1).map(row).collect()
}

/// With a spline, the rounds of refinement ended while every second segment waited for its turn: at
/// 21.4 nm and at 42.9 nm.
#[test]
fn a_zernike_surface_with_a_spline_of_velocities_holds_its_tolerance() {
    let recipe = repository().join("docs/recipes/surfaces/zernike.toml");
    let bench = Bench::with(&fs::read_to_string(recipe).unwrap());
    for tolerance in ["20 nm", "40 nm"] {
        let tolerance = format!("tolerance.interpolation={tolerance}");
        let solver = "velocity.use=triangle-rotary";
        let run = [
            "run",
            "recipe.toml",
            "-o",
            "out",
            "--set",
            solver,
            "--set",
            &tolerance,
        ];
        bench.call(run).ends(0);
    }
}

/// Domes meet in valleys that no nose reaches. Between two domes of radius r, whose slopes at the
/// seam are s, a nose of radius R stays s²/2 · Rr/(R + r) above the bottom, up to the fourth power
/// of s.
#[test]
fn the_valleys_between_domes_are_refused_or_cut_as_far_as_the_nose_fits() {
    let recipe = repository().join("docs/recipes/surfaces/lenslet-array.toml");
    let bench = Bench::with(&fs::read_to_string(recipe).unwrap());
    let domes = ["--set", "surface.radius=-12 mm"];
    let said = bench.call(["check", "recipe.toml"].iter().chain(&domes));
    let said = said.ends(2).stderr;
    assert!(
        said.contains("no nose reaches the bottom of the crease"),
        "{said}"
    );
    // One lens and a half is enough.
    let fits = "--set tool.interference=cut-what-fits --set part.aperture=1.4mm";
    let fits: Vec<&str> = fits.split(' ').collect();
    let run = ["run", "recipe.toml", "-o", "out"];
    let run = run.iter().chain(&domes).chain(&fits).chain(&COARSE);
    bench.call(run).ends(0);
    let summary: Value = serde_json::from_str(&bench.read("out/summary.json")).unwrap();
    let (nose, radius, slope): (f64, f64, f64) = (0.2, 12.0, 0.5 / 12.0);
    let expected = 1e3 * 0.5 * slope * slope * nose * radius / (nose + radius);
    let found = summary["unreached"]["height_um"].as_f64().unwrap();
    assert!(
        (found / expected - 1.0).abs() < 0.005,
        "{found} for {expected}"
    );
}
