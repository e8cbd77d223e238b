//! Strategies that a program brings as values: their source is in the report and in the keys of an
//! ablation, and what differs between machines, or is only fitted, is remarked on.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use turnpath::report::{Remark, RunReport};
use turnpath::{
    AblationOptions, Catalogue, Job, Outputs, OwnPlugin, OwnStrategy, SilentObserver, ablate,
};
use turnpath_core::{
    GradientSeries, Gradients, NodeList, Path as ToolPath, Result, Revolutions, SamplerPlan,
    Scalar, Series, Surface, SurfaceData, SurfaceModel,
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

#[test]
fn another_source_is_another_key() {
    let folder = tempfile::tempdir().unwrap();
    let recipe = recipe(&["ablation.sampler=[{ use = \"even\" }]"]);
    let reused = |sha256: &str| {
        let options = AblationOptions {
            folder: folder.path().to_owned(),
            fresh: false,
            threads: None,
        };
        let catalogue = lab(sha256, vec![even(60.0)]);
        let result = ablate(&recipe, &catalogue, &options, &SilentObserver);
        result.unwrap().reused
    };
    let runs = ["c0ffee", "c0ffee", "decaf"].map(reused);
    // The recipe's own sampler is a run too, and has nothing of the lab.
    assert_eq!(runs, [0, 2, 1]);
}
