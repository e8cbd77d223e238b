//! Strategies that a program brings as values: their source is in the report and in the keys of an
//! ablation, and what differs between machines, or is only fitted, is remarked on.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::path::Path;
use std::sync::{Arc, Mutex};

use turnpath::report::{Remark, RunReport};
use turnpath::{
    AblationOptions, AblationResult, Catalogue, Identity, Job, Outputs, OwnPlugin, OwnStrategy,
    OwnSurface, SilentObserver, SurfaceNeed, ablate, merge_ablation, plan_ablation,
    run_of_ablation,
};
use turnpath_core::{
    GradientSeries, Gradients, NodeList, Params, Path as ToolPath, Result, Revolutions,
    SamplerPlan, Scalar, Series, Slot, Surface, SurfaceData, SurfaceModel,
};

use crate::support::recipe;

const EVEN: &str = "sampler={ use = \"even\" }";

#[derive(Clone)]
struct Even(f64);

impl SamplerPlan for Even {
    fn place(&self, _: &ToolPath<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()> {
        nodes.extend(block.turns().flat_map(|turn| turn.subdivide(self.0)));
        Ok(())
    }
}

fn even(steps: f64) -> OwnStrategy {
    OwnStrategy::sampler("even", move |_| Ok(Box::new(Even(steps))))
}

/// z = x²/100, as if it were a spline that lies 3 nm off.
struct Parabola;

impl Surface for Parabola {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, _: S) -> S {
        x.squared() * 0.01
    }
}

/// A surface whose data name an error.
struct FittedParabola;

impl SurfaceModel for FittedParabola {
    fn heights(&self, x: &[f64], y: &[f64], z: &mut [f64]) -> Result<()> {
        SurfaceModel::heights(&Parabola, x, y, z)
    }

    fn gradient(&self, x: &[f64], y: &[f64], out: Gradients<'_>) -> Result<()> {
        SurfaceModel::gradient(&Parabola, x, y, out)
    }

    fn series(&self, x: &[Series], y: &[Series], out: GradientSeries<'_>) -> Result<()> {
        SurfaceModel::series(&Parabola, x, y, out)
    }

    fn height_series(&self, x: &[Series], y: &[Series], z: &mut [Series]) -> Result<()> {
        SurfaceModel::height_series(&Parabola, x, y, z)
    }

    fn data(&self) -> Result<Option<SurfaceData>> {
        Ok(Some(SurfaceData {
            points: 4225,
            filled: 0,
            continuation: "straight on".to_owned(),
            fit_error: Some(3e-6),
        }))
    }
}

fn lab(sha256: &str, strategies: Vec<OwnStrategy>) -> Catalogue {
    let plugin = OwnPlugin::new("lab", "1.2.0").with_source("lab.py", sha256);
    let plugin = strategies.into_iter().fold(plugin, OwnPlugin::with);
    Catalogue::linked().unwrap().with_own(plugin).unwrap()
}

fn report(catalogue: &Catalogue, sets: &[&str]) -> RunReport {
    let job = Job::new(recipe(sets), catalogue).unwrap();
    job.run(Outputs::nowhere(), &SilentObserver).unwrap().report
}

#[test]
fn the_source_of_an_own_strategy_is_in_the_report() {
    let report = report(&lab("c0ffee", vec![even(60.0)]), &[EVEN]);
    let own = report.plugins.iter().find(|plugin| plugin.name == "lab");
    let own = own.unwrap();
    assert_eq!(own.file.as_deref(), Some("lab.py"));
    assert_eq!(own.sha256.as_deref(), Some("c0ffee"));
    assert_eq!(own.version, "1.2.0");
    let inexact = |remark: &Remark| matches!(remark, Remark::NotByteExact { .. });
    assert!(!report.remarks.iter().any(inexact));
}

#[test]
fn a_strategy_that_differs_between_machines_is_remarked_on_where_it_is_used() {
    let catalogue = lab("c0ffee", vec![even(60.0).differs_between_machines()]);
    let remark = Remark::NotByteExact {
        strategies: vec!["sampler even".to_owned()],
        plugin: "lab".to_owned(),
    };
    let with = report(&catalogue, &[EVEN]);
    assert!(with.remarks.contains(&remark));
    let text = turnpath::report::text::run(&with, &[]);
    let words: Vec<&str> = text.split_whitespace().collect();
    let text = words.join(" ");
    assert!(
        text.contains("sampler even of lab may call functions"),
        "{text}"
    );
    assert!(!report(&catalogue, &[]).remarks.contains(&remark));
}

#[test]
fn a_surface_that_stands_for_a_function_has_its_error_in_the_report() {
    let fitted = OwnStrategy::surface("fitted", |_| Ok(Box::new(FittedParabola)));
    let catalogue = lab("c0ffee", vec![fitted]);
    // A small part: the surface is not optimised here.
    let sets = [
        "surface={ use = \"fitted\", scale = -2 }",
        "part.aperture=0.4 mm",
        "tolerance.residual=20 um",
        "path={ lead = false, overrun = \"none\" }",
        "output.posts=[]",
    ];
    let remarks = report(&catalogue, &sets).remarks;
    let error = remarks.iter().find_map(|remark| match remark {
        Remark::FittedSurface { points, error, .. } => Some((*points, *error)),
        _ => None,
    });
    assert_eq!(error, Some((4225, 6e-6)));
}

/// The ablation of the recipe's own sampler and of `even` into a folder.
fn ablated(folder: &Path, strategies: Vec<OwnStrategy>, sha256: &str) -> AblationResult {
    let recipe = recipe(&["ablation.sampler=[{ use = \"even\" }]"]);
    let options = AblationOptions {
        folder: folder.to_owned(),
        fresh: false,
        threads: None,
    };
    ablate(&recipe, &lab(sha256, strategies), &options, &SilentObserver).unwrap()
}

#[test]
fn another_source_is_another_key() {
    let folder = tempfile::tempdir().unwrap();
    let reused = |sha256: &str| ablated(folder.path(), vec![even(60.0)], sha256).reused;
    let runs = ["c0ffee", "c0ffee", "decaf"].map(reused);
    // The recipe's own sampler is a run too, and has nothing of the lab.
    assert_eq!(runs, [0, 2, 1]);
}

#[test]
fn another_identity_is_another_key_and_a_strategy_beside_it_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let known = |steps: f64, of: &str| even(steps).with_identity(Identity::Hash(of.to_owned()));
    let beside = || OwnStrategy::surface("beside", |_| Ok(Box::new(FittedParabola)));
    let run = |strategies| ablated(folder.path(), strategies, "c0ffee");
    assert_eq!(run(vec![known(60.0, "one")]).reused, 0);
    assert_eq!(run(vec![known(60.0, "one"), beside()]).reused, 2);
    let other = run(vec![known(90.0, "other")]);
    assert_eq!(other.reused, 1);
    let points = |result: &AblationResult| {
        let run = result.report.runs[1].measured().unwrap();
        run.report.control_points
    };
    assert!(points(&other) > points(&run(vec![known(60.0, "one")])));
}

#[test]
fn a_strategy_without_an_identity_has_no_record_and_its_row_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let unknown = || even(60.0).with_identity(Identity::Unknown("it takes `rng`".to_owned()));
    for reused in [0, 1] {
        let result = ablated(folder.path(), vec![unknown()], "c0ffee");
        assert_eq!(result.reused, reused);
        let runs = result.report.runs.iter();
        let whys: Vec<Option<&str>> = runs.map(|run| run.not_recorded.as_deref()).collect();
        assert_eq!(whys, [None, Some("the sampler even: it takes `rng`")]);
        let table = std::fs::read_to_string(folder.path().join("ablation.csv")).unwrap();
        let ends: Vec<bool> = table.lines().map(|line| line.ends_with("`rng`")).collect();
        assert_eq!(ends, [false, false, true]);
    }
    let records = std::fs::read_dir(folder.path().join("runs")).unwrap();
    assert_eq!(records.count(), 1);
    let recipe = recipe(&["ablation.sampler=[{ use = \"even\" }]"]);
    let catalogue = lab("c0ffee", vec![unknown()]);
    let refused = [
        plan_ablation(&recipe, &catalogue, folder.path()).map(|_| ()),
        run_of_ablation(&recipe, &catalogue, folder.path(), "", &SilentObserver).map(|_| ()),
        merge_ablation(&recipe, &catalogue, folder.path(), &SilentObserver).map(|_| ()),
    ];
    for error in refused.map(|refused| refused.unwrap_err()) {
        assert_eq!(error.fault(), turnpath::Fault::Request);
        assert!(error.title().contains("the sampler even: it takes `rng`"));
        assert!(error.help().is_some());
    }
}

/// A surface of the library: those of a test are not optimised.
struct Saddle(Arc<dyn SurfaceModel>);

impl SurfaceModel for Saddle {
    fn heights(&self, x: &[f64], y: &[f64], z: &mut [f64]) -> Result<()> {
        self.0.heights(x, y, z)
    }

    fn gradient(&self, x: &[f64], y: &[f64], out: Gradients<'_>) -> Result<()> {
        self.0.gradient(x, y, out)
    }

    fn series(&self, x: &[Series], y: &[Series], out: GradientSeries<'_>) -> Result<()> {
        self.0.series(x, y, out)
    }

    fn height_series(&self, x: &[Series], y: &[Series], z: &mut [Series]) -> Result<()> {
        self.0.height_series(x, y, z)
    }
}

fn saddle() -> Saddle {
    let linked = Catalogue::linked().unwrap();
    let found = linked.find(Slot::Surface, "astigmatic").unwrap();
    let params = Params::new().with("k", 0.01);
    Saddle(found.offer().surface(&params).unwrap())
}

/// A surface that writes down what it is made for; its bytes differ below an error of 100 nm.
fn needing(needs: &Arc<Mutex<Vec<SurfaceNeed>>>) -> OwnStrategy {
    let needs = Arc::clone(needs);
    OwnStrategy::surface_for("needing", move |_, need| {
        needs.lock().unwrap().push(need);
        let model = Box::new(saddle());
        let byte_exact = need.error > 1e-4;
        Ok(OwnSurface { model, byte_exact })
    })
}

#[test]
fn each_variant_has_a_surface_of_its_own_need() {
    let (folder, needs) = (tempfile::tempdir().unwrap(), Arc::default());
    let recipe = recipe(&[
        "surface={ use = \"needing\", decentre_x = \"3 mm\", decentre_y = \"-4 mm\", scale = -2 }",
        "part.aperture=0.4 mm",
        "tool.nose_radius=1 mm",
        "tolerance.residual=200 um",
        "tolerance.interpolation=10 um",
        "path={ lead = false, overrun = \"0.1 mm\" }",
        "output.posts=[]",
        "ablation.part.aperture=[\"0.8 mm\"]",
        "ablation.tolerance.interpolation=[\"1 um\"]",
        "ablation.mode=one-at-a-time",
    ]);
    let options = AblationOptions {
        folder: folder.path().to_owned(),
        fresh: false,
        threads: std::num::NonZero::new(1),
    };
    let catalogue = lab("c0ffee", vec![needing(&needs)]);
    let result = ablate(&recipe, &catalogue, &options, &SilentObserver).unwrap();
    let needs = needs.lock().unwrap();
    let rounded = |need: &SurfaceNeed| {
        let pair = [need.half_width * 1e3, need.error * 1e9];
        pair.map(|number| number.round() as i64)
    };
    let found: Vec<[i64; 2]> = needs.iter().map(rounded).collect();
    // In micrometres and picometres: half the part, the nose, the overrun and 5 mm of decentre; a
    // twentieth of the tolerance below a scale of 2.
    assert_eq!(found, [[6300, 250_000], [6500, 250_000], [6300, 25_000]]);
    let is_inexact = |remark: &Remark| match remark {
        Remark::NotByteExact { strategies, .. } => strategies == &["surface needing".to_owned()],
        _ => false,
    };
    let runs = result.report.runs.iter();
    let inexact = runs.map(|run| {
        run.measured()
            .unwrap()
            .report
            .remarks
            .iter()
            .any(is_inexact)
    });
    let inexact: Vec<bool> = inexact.collect();
    assert_eq!(inexact, [false, false, true]);
}
