//! Surfaces made of surfaces, against closed forms and against references of 60 digits.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;
use std::sync::Arc;

use serde_json::Value;
use turnpath_core::{
    Attitude, GradientSeries, Gradients, Placement, Pose, Result, Scalar, Series, StrategyError,
    Surface, SurfaceData, SurfaceModel,
};
use turnpath_pipeline::{PlacedSurface, PoseError, PosedSurface, SurfaceSum};

use crate::common::formulas::{Conicoid, Plane, Segment, Waves};

const VERTEX: f64 = 915.0;

fn shared(surface: impl Surface + 'static) -> Arc<dyn SurfaceModel> {
    Arc::new(surface)
}

fn paraboloid() -> Arc<dyn SurfaceModel> {
    shared(Conicoid {
        curvature: 1.0 / VERTEX,
        conic: -1.0,
    })
}

fn level(x: f64, y: f64) -> Pose {
    Pose {
        x,
        y,
        attitude: Attitude::Level,
    }
}

fn posed(surface: Arc<dyn SurfaceModel>, pose: Pose) -> PosedSurface {
    PosedSurface::new(surface, pose).unwrap()
}

/// z, ∂z/∂x, ∂z/∂y at each point.
fn gradient(surface: &dyn SurfaceModel, x: &[f64], y: &[f64]) -> [Vec<f64>; 3] {
    let blank = vec![7.0; x.len()];
    let [mut z, mut zx, mut zy] = [blank.clone(), blank.clone(), blank];
    let out = Gradients {
        z: &mut z,
        zx: &mut zx,
        zy: &mut zy,
    };
    surface.gradient(x, y, out).unwrap();
    [z, zx, zy]
}

fn heights(surface: &dyn SurfaceModel, x: &[f64], y: &[f64]) -> Vec<f64> {
    let mut z = vec![7.0; x.len()];
    surface.heights(x, y, &mut z).unwrap();
    z
}

/// z(t), ∂z/∂x (t), ∂z/∂y (t) along each curve.
fn series(surface: &dyn SurfaceModel, x: &[Series], y: &[Series]) -> [Vec<Series>; 3] {
    let blank = vec![[7.0; 5]; x.len()];
    let [mut z, mut zx, mut zy] = [blank.clone(), blank.clone(), blank];
    let out = GradientSeries {
        z: &mut z,
        zx: &mut zx,
        zy: &mut zy,
    };
    surface.series(x, y, out).unwrap();
    [z, zx, zy]
}

fn height_series(surface: &dyn SurfaceModel, x: &[Series], y: &[Series]) -> Vec<Series> {
    let mut z = vec![[7.0; 5]; x.len()];
    surface.height_series(x, y, &mut z).unwrap();
    z
}

/// Points of a disc: as many as three calls of a surface take, and some.
fn disc(radius: f64) -> (Vec<f64>, Vec<f64>) {
    let place = |i: i32| {
        let (sin, cos) = Scalar::sin_cos(2.4 * f64::from(i));
        let rho = radius * (f64::from(i) / 170.0).sqrt();
        (rho * cos, rho * sin)
    };
    (0..=170).map(place).unzip()
}

/// Curves over a disc, at the scale of a tool path.
fn curves(radius: f64) -> (Vec<Series>, Vec<Series>) {
    let (x, y) = disc(radius);
    let along = |(x, y): (&f64, &f64)| {
        (
            [*x, 1.0 - 0.1 * y, 0.25, -0.125, 0.0625],
            [*y, 0.5 + 0.1 * x, -0.5, 0.25, 0.125],
        )
    };
    x.iter().zip(&y).map(along).unzip()
}

fn furthest(one: &[f64], other: &[f64]) -> f64 {
    assert_eq!(one.len(), other.len());
    let apart = one
        .iter()
        .zip(other)
        .map(|(one, other)| (one - other).abs());
    // A NaN is as far as can be.
    apart.fold(0.0, |most, apart| if apart <= most { most } else { apart })
}

fn furthest_series(one: &[Series], other: &[Series]) -> f64 {
    furthest(one.as_flattened(), other.as_flattened())
}

#[test]
fn a_paraboloid_laid_level_off_its_axis_is_the_off_axis_paraboloid() {
    for (off_axis, radius) in [(VERTEX, 106.5), (213.0, 106.5), (-400.0, 25.0), (0.0, 50.0)] {
        let ours = posed(paraboloid(), level(off_axis, 0.0));
        let closed = Segment {
            vertex: VERTEX,
            off_axis,
        };
        let (x, y) = disc(radius);
        let [z, zx, zy] = gradient(&ours, &x, &y);
        let [closed_z, closed_zx, closed_zy] = gradient(&closed, &x, &y);
        assert!(furthest(&z, &closed_z) < 1e-12);
        assert!(furthest(&zx, &closed_zx) < 1e-12);
        assert!(furthest(&zy, &closed_zy) < 1e-12);
        assert_eq!(heights(&ours, &x, &y), z);
        let (x, y) = curves(radius);
        let [z, zx, zy] = series(&ours, &x, &y);
        let [closed_z, closed_zx, closed_zy] = series(&closed, &x, &y);
        assert!(furthest_series(&z, &closed_z) < 1e-12);
        assert!(furthest_series(&zx, &closed_zx) < 1e-13);
        assert!(furthest_series(&zy, &closed_zy) < 1e-13);
        assert_eq!(height_series(&ours, &x, &y), z);
    }
}

#[test]
fn the_same_paraboloid_as_a_sum_is_the_off_axis_paraboloid() {
    let half = |scale, turn| -> Arc<dyn SurfaceModel> {
        let placement = Placement {
            scale,
            clocking: turn,
            piston: 3.0,
            ..Placement::PLAIN
        };
        Arc::new(PlacedSurface::new(paraboloid(), placement))
    };
    let sum = SurfaceSum::new(vec![half(0.25, 0.4), half(1.5, -2.0), half(-0.75, 0.0)]);
    let ours = posed(Arc::new(sum), level(VERTEX, 0.0));
    let closed = Segment {
        vertex: VERTEX,
        off_axis: VERTEX,
    };
    let (x, y) = curves(106.5);
    let [z, zx, zy] = series(&ours, &x, &y);
    let [closed_z, closed_zx, closed_zy] = series(&closed, &x, &y);
    assert!(furthest_series(&z, &closed_z) < 1e-11);
    assert!(furthest_series(&zx, &closed_zx) < 1e-12);
    assert!(furthest_series(&zy, &closed_zy) < 1e-12);
}

#[test]
fn a_sphere_in_any_level_pose_is_the_sphere() {
    let sphere = |curvature| Conicoid {
        curvature,
        conic: 0.0,
    };
    let (x, y) = curves(55.0);
    for curvature in [0.01, -0.01] {
        let whole = series(&sphere(curvature), &x, &y);
        for (at_x, at_y) in [(0.0, 0.0), (30.0, -20.0), (-55.0, 10.0)] {
            let turned = posed(shared(sphere(curvature)), level(at_x, at_y));
            let turned = series(&turned, &x, &y);
            for (turned, whole) in turned.iter().zip(&whole) {
                assert!(furthest_series(turned, whole) < 1e-12);
            }
        }
    }
}

#[test]
fn a_tilt_about_x_lifts_positive_y_and_one_about_y_lowers_positive_x() {
    let flat = |tilt_x, tilt_y| {
        let attitude = Attitude::Tilted { tilt_x, tilt_y };
        let pose = Pose {
            x: 3.0,
            y: -2.0,
            attitude,
        };
        let tilted = posed(shared(Plane(0.0, 0.0, 5.0)), pose);
        gradient(&tilted, &[2.0], &[3.0]).map(|one| one[0])
    };
    let near = |found: [f64; 3], expected: [f64; 3]| furthest(&found, &expected) < 1e-15;
    assert!(near(flat(0.0, 0.0), [0.0, 0.0, 0.0]));
    let tan = Scalar::tan(0.25);
    assert!(near(flat(0.25, 0.0), [3.0 * tan, 0.0, tan]));
    assert!(near(flat(0.0, 0.25), [-2.0 * tan, -tan, 0.0]));
    // About x first: what the second turn lowers is already oblique.
    let second = Scalar::tan(0.5);
    let slopes = [-second, tan / Scalar::cos(0.5)];
    let z = 2.0 * slopes[0] + 3.0 * slopes[1];
    assert!(near(flat(0.25, 0.5), [z, slopes[0], slopes[1]]));
}

#[test]
fn a_placed_surface_has_its_origin_at_the_decentre_and_turns_from_x_to_y() {
    let placement = Placement {
        scale: -2.0,
        decentre_x: 3.0,
        decentre_y: 1.0,
        clocking: std::f64::consts::FRAC_PI_2,
        piston: 0.5,
    };
    let placed = PlacedSurface::new(shared(Plane(0.25, 0.0, 1.0)), placement);
    // The plane rises along its own x axis, which is now y; -2 makes it fall.
    let [z, zx, zy] = gradient(&placed, &[3.0, 3.0, 8.0], &[1.0, 2.0, 1.0]);
    assert!(furthest(&z, &[-1.5, -2.0, -1.5]) < 1e-15);
    assert!(furthest(&zx, &[0.0; 3]) < 1e-15);
    assert!(furthest(&zy, &[-0.5; 3]) < 1e-15);
}

#[test]
fn a_plain_placement_changes_no_bit() {
    let waves = || Waves {
        height: 0.1,
        wave: 0.7,
    };
    let placed = PlacedSurface::new(shared(waves()), Placement::default());
    let (x, y) = disc(20.0);
    assert!(Placement::default().is_plain());
    assert_eq!(gradient(&placed, &x, &y), gradient(&waves(), &x, &y));
    let (x, y) = curves(20.0);
    assert_eq!(series(&placed, &x, &y), series(&waves(), &x, &y));
}

fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap()
}

fn line(case: &Value, key: &str) -> Series {
    let coefficients = case[key].as_array().unwrap();
    std::array::from_fn(|k| coefficients[k].as_f64().unwrap())
}

fn reference_surface(case: &Value) -> PosedSurface {
    let (sum, place, pose) = (&case["sum"], &case["placement"], &case["pose"]);
    let placement = Placement {
        scale: number(place, "scale"),
        decentre_x: place["decentre"][0].as_f64().unwrap(),
        decentre_y: place["decentre"][1].as_f64().unwrap(),
        clocking: number(place, "clocking"),
        piston: number(place, "piston"),
    };
    let conicoid = Conicoid {
        curvature: number(sum, "curvature"),
        conic: number(sum, "conic"),
    };
    let waves = Waves {
        height: number(sum, "height"),
        wave: number(sum, "wave"),
    };
    let placed = PlacedSurface::new(shared(waves), placement);
    let sum = SurfaceSum::new(vec![shared(conicoid), Arc::new(placed)]);
    let attitude = match pose.get("level") {
        Some(_) => Attitude::Level,
        None => Attitude::Tilted {
            tilt_x: number(pose, "tilt_x"),
            tilt_y: number(pose, "tilt_y"),
        },
    };
    let pose = Pose {
        x: number(pose, "x"),
        y: number(pose, "y"),
        attitude,
    };
    posed(Arc::new(sum), pose)
}

#[test]
fn sums_in_poses_agree_with_references_of_many_digits() {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../tests/reference/poses.json"
    );
    let cases: Value = serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap();
    let cases = cases["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 18);
    for case in cases {
        let surface = reference_surface(case);
        let (x, y) = (line(case, "x"), line(case, "y"));
        let expected = ["z", "zx", "zy"].map(|key| line(case, key));
        let found = series(&surface, &[x], &[y]).map(|one| one[0]);
        for (found, expected) in found.iter().zip(&expected) {
            assert!(furthest(found, expected) < 2e-14, "{case}: {found:?}");
        }
        // The slopes of a point are those before its last step.
        let found = gradient(&surface, &[x[0]], &[y[0]]).map(|one| one[0]);
        let expected = expected.map(|one| one[0]);
        assert!((found[0] - expected[0]).abs() < 2e-14);
        assert!(furthest(&found, &expected) < 1e-12);
    }
}

#[test]
fn any_length_of_batch_gives_what_single_points_give() {
    let steep = Waves {
        height: 0.25,
        wave: 2.0,
    };
    let surface = posed(shared(steep), level(0.3, -0.2));
    let (mut x, y) = disc(3.0);
    x[5] = f64::NAN;
    let [z, zx, zy] = gradient(&surface, &x, &y);
    let (mut at_x, at_y) = curves(3.0);
    at_x[5][0] = f64::NAN;
    let [z_series, ..] = series(&surface, &at_x, &at_y);
    for i in 0..x.len() {
        let alone = gradient(&surface, &x[i..=i], &y[i..=i]).map(|one| one[0].to_bits());
        assert_eq!(alone, [z[i].to_bits(), zx[i].to_bits(), zy[i].to_bits()]);
        let [alone, ..] = series(&surface, &at_x[i..=i], &at_y[i..=i]);
        assert_eq!(alone[0].map(f64::to_bits), z_series[i].map(f64::to_bits));
    }
    assert!(z[5].is_nan() && z.iter().filter(|z| z.is_nan()).count() == 1);
}

/// Heights of a kilometre that cancel leave 0.1 nm of rounding: the search ends there.
#[test]
fn rounding_of_large_heights_ends_the_search() {
    let lifted = |piston| -> Arc<dyn SurfaceModel> {
        let placement = Placement {
            scale: 0.5,
            piston,
            ..Placement::PLAIN
        };
        Arc::new(PlacedSurface::new(paraboloid(), placement))
    };
    let sum = Arc::new(SurfaceSum::new(vec![lifted(1e6), lifted(-1e6)]));
    let closed = Segment {
        vertex: VERTEX,
        off_axis: 100.0,
    };
    let (x, y) = disc(50.0);
    let found = heights(&posed(sum, level(100.0, 0.0)), &x, &y);
    assert!(furthest(&found, &heights(&closed, &x, &y)) < 1e-9);
}

#[test]
fn beyond_the_surface_there_is_no_height() {
    let sphere = Conicoid {
        curvature: 0.01,
        conic: 0.0,
    };
    let turned = posed(shared(sphere), level(60.0, 0.0));
    // The parent ends at its equator, where the turned sphere has the height 20 on one side.
    let [z, zx, _] = gradient(&turned, &[39.0, 79.0, 85.0, 200.0, -99.0], &[0.0; 5]);
    let heights = z.iter().map(|z| z.is_finite()).collect::<Vec<_>>();
    assert_eq!(heights, [true, true, false, false, true]);
    assert_eq!(zx.iter().filter(|zx| zx.is_nan()).count(), 2);
}

#[test]
fn a_pose_needs_a_height_and_no_overhang_at_its_middle() {
    let sphere = || {
        shared(Conicoid {
            curvature: 0.01,
            conic: 0.0,
        })
    };
    let error = PosedSurface::new(sphere(), level(120.0, 0.0)).err();
    assert_eq!(error, Some(PoseError::NoMiddle));
    let attitude = Attitude::Tilted {
        tilt_x: 1.75,
        tilt_y: 0.0,
    };
    let pose = Pose {
        attitude,
        ..level(0.0, 0.0)
    };
    assert_eq!(
        PosedSurface::new(sphere(), pose).err(),
        Some(PoseError::Overhang)
    );
}

/// A surface that always fails.
struct Broken;

impl SurfaceModel for Broken {
    fn heights(&self, _: &[f64], _: &[f64], _: &mut [f64]) -> Result<()> {
        Err(StrategyError::failed("broken"))
    }

    fn gradient(&self, _: &[f64], _: &[f64], _: Gradients<'_>) -> Result<()> {
        Err(StrategyError::failed("broken"))
    }

    fn series(&self, _: &[Series], _: &[Series], _: GradientSeries<'_>) -> Result<()> {
        Err(StrategyError::failed("broken"))
    }

    fn height_series(&self, _: &[Series], _: &[Series], _: &mut [Series]) -> Result<()> {
        Err(StrategyError::failed("broken"))
    }
}

#[test]
fn the_error_of_an_entry_comes_through() {
    let placed = PlacedSurface::new(Arc::new(Broken), Placement::PLAIN);
    let sum = Arc::new(SurfaceSum::new(vec![paraboloid(), Arc::new(placed)]));
    let error = sum.heights(&[0.0], &[0.0], &mut [0.0]).unwrap_err();
    assert_eq!(error, StrategyError::failed("broken"));
    let error = PosedSurface::new(sum, level(0.0, 0.0)).err();
    assert_eq!(
        error,
        Some(PoseError::Strategy(StrategyError::failed("broken")))
    );
}

#[test]
fn slices_of_unequal_length_are_an_error() {
    let sum: Arc<dyn SurfaceModel> = Arc::new(SurfaceSum::new(vec![paraboloid(), paraboloid()]));
    let placed = PlacedSurface::new(sum.clone(), Placement::PLAIN);
    let posed = posed(sum.clone(), level(1.0, 2.0));
    let surfaces: [&dyn SurfaceModel; 3] = [sum.as_ref(), &placed, &posed];
    for surface in surfaces {
        let error = surface.heights(&[1.0; 3], &[1.0; 2], &mut [0.0; 3]);
        let text = "a batch of 3 points came with a slice of length 2";
        assert_eq!(error, Err(StrategyError::failed(text)));
    }
}

/// The plane z = 0.75 x, from data that end at x = 1 mm.
struct PlaneOfData;

const SLOPE: f64 = 0.75;

impl SurfaceModel for PlaneOfData {
    fn heights(&self, x: &[f64], _: &[f64], z: &mut [f64]) -> Result<()> {
        for (z, x) in z.iter_mut().zip(x) {
            *z = SLOPE * x;
        }
        Ok(())
    }

    fn gradient(&self, x: &[f64], y: &[f64], out: Gradients<'_>) -> Result<()> {
        out.zx.fill(SLOPE);
        out.zy.fill(0.0);
        self.heights(x, y, out.z)
    }

    fn series(&self, x: &[Series], y: &[Series], out: GradientSeries<'_>) -> Result<()> {
        out.zx.fill([SLOPE, 0.0, 0.0, 0.0, 0.0]);
        out.zy.fill([0.0; 5]);
        self.height_series(x, y, out.z)
    }

    fn height_series(&self, x: &[Series], _: &[Series], z: &mut [Series]) -> Result<()> {
        for (z, x) in z.iter_mut().zip(x) {
            *z = x.map(|c| SLOPE * c);
        }
        Ok(())
    }

    fn beyond_data(&self, x: &[f64], _: &[f64], distance: &mut [f64]) -> Result<()> {
        for (distance, x) in distance.iter_mut().zip(x) {
            *distance = (x - 1.0).max(0.0);
        }
        Ok(())
    }

    fn data(&self) -> Result<Option<SurfaceData>> {
        Ok(Some(SurfaceData {
            points: 100,
            filled: 7,
            continuation: "straight on".into(),
            fit_error: Some(2e-6),
        }))
    }
}

/// Where the data end moves with the surface: turned by a right angle, laid level, or farther away in
/// one of two.
#[test]
fn the_end_of_the_data_goes_with_the_surface() {
    let distance = |surface: &dyn SurfaceModel, x: f64, y: f64| {
        let mut distance = [f64::NAN];
        surface.beyond_data(&[x], &[y], &mut distance).unwrap();
        distance[0]
    };
    let near =
        |found: f64, wanted: f64| assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
    let plane = || -> Arc<dyn SurfaceModel> { Arc::new(PlaneOfData) };
    let place = Placement {
        scale: -2.0,
        decentre_y: 0.5,
        clocking: 0.5 * std::f64::consts::PI,
        ..Placement::PLAIN
    };
    let placed = PlacedSurface::new(plane(), place);
    near(distance(&placed, 9.0, 4.0), 2.5);
    near(distance(&placed, 0.0, 1.4), 0.0);
    let tilted = posed(plane(), level(0.25, 0.0));
    // Along the slope 5 mm of the part are 4 mm of the surface.
    near(distance(&tilted, 5.0, 3.0), 3.25);
    let sum = SurfaceSum::new(vec![paraboloid(), plane(), Arc::new(placed)]);
    near(distance(&sum, 2.0, 4.0), 2.5);
    near(distance(&sum, 6.0, 4.0), 5.0);
    let data = sum.data().unwrap().unwrap();
    assert_eq!((data.points, data.filled), (200, 14));
    assert_eq!(data.continuation, "straight on");
    // 2 nm, and 2 nm with the scale −2.
    assert_eq!(data.fit_error, Some(6e-6));
    assert_eq!(tilted.data().unwrap().unwrap().points, 100);
    assert_eq!(paraboloid().data(), Ok(None));
    near(distance(paraboloid().as_ref(), 1e3, 0.0), 0.0);
}
