//! Nodes from estimates of |φ⁗|, held against nodes from all samples, and how many samples they take.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::f64::consts::TAU;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::common::{AtpgCase, Case, ast_5, ast_50, oap_213};
use crate::models::model;
use turnpath_atpg::AtpgSampler;
use turnpath_core::{
    CentreSeries, Centres, DEG, Locus, Misfit, NodeList, ParamValue, Params, Path, Radial, Rates,
    Result, Revolutions, Sampler, Scalar, Series, Strategy, SurfaceModel, ToolLocus,
};
use turnpath_nose_radius::ZDirection;
use turnpath_surfaces::{LensletArray, SinusoidalArray};

/// A tool locus that counts its series, and may say that ρ is the contact's radius: then the sampler evaluates every
/// sample.
struct Count<'a> {
    locus: &'a ToolLocus,
    radial: Radial,
    ripple: Ripple,
    series: AtomicUsize,
}

/// A ring of even features from a radius on: A cos mθ.
#[derive(Clone, Copy)]
struct Ripple {
    /// A, mm.
    height: f64,
    /// m.
    features: f64,
    /// mm.
    from: f64,
}

const NO_RIPPLE: Ripple = Ripple {
    height: 0.0,
    features: 0.0,
    from: f64::INFINITY,
};

impl Ripple {
    /// Adds it to the series of Z along curves on which θ grows at a rate of 1.
    fn add(&self, theta: &[Series], rho: &[Series], z: &mut [Series]) {
        let there = |rho: &Series| rho[0] >= self.from;
        for ((theta, _), z) in theta
            .iter()
            .zip(rho)
            .zip(z)
            .filter(|((_, rho), _)| there(rho))
        {
            let mut part = self.height;
            for (k, z) in z.iter_mut().enumerate() {
                *z += part * Scalar::cos(self.features * theta[0] + k as f64 * 0.25 * TAU);
                part *= self.features / (k + 1) as f64;
            }
        }
    }
}

impl Locus for Count<'_> {
    fn surface(&self) -> &dyn SurfaceModel {
        self.locus.surface()
    }

    fn radial(&self) -> Radial {
        self.radial
    }

    fn centre(&self, theta: &[f64], rho: &[f64], out: Centres<'_>) -> Result<()> {
        self.locus.centre(theta, rho, out)
    }

    fn series(&self, theta: &[Series], rho: &[Series], out: CentreSeries<'_>) -> Result<()> {
        self.series.fetch_add(theta.len(), Ordering::Relaxed);
        let (x, z) = (out.x, out.z);
        self.locus
            .series(theta, rho, CentreSeries { x, z: &mut *z })?;
        self.ripple.add(theta, rho, z);
        Ok(())
    }

    fn rates(&self, theta: &[f64], rho: &[f64], out: Rates<'_>) -> Result<()> {
        self.locus.rates(theta, rho, out)
    }

    fn residual_feed(
        &self,
        residual: f64,
        radial: Radial,
        theta: &[f64],
        rho: &[f64],
        feed: &mut [f64],
    ) -> Result<()> {
        self.locus.residual_feed(residual, radial, theta, rho, feed)
    }
}

/// The nodes of blocks of `turns` revolutions, one of `one_of`, and the number of series that they took.
fn place(
    case: &Case,
    ripple: Ripple,
    radial: Radial,
    turns: f64,
    one_of: usize,
) -> (Vec<f64>, usize) {
    let law = case.plan_law("held", "smooth").unwrap();
    let locus = Count {
        locus: &case.locus,
        radial,
        ripple,
        series: AtomicUsize::new(0),
    };
    let path = Path {
        task: &case.task,
        locus: &locus,
        law: &law,
        spindle: &case.spindle,
    };
    let mut params = Params::new().with("max_step", 45.0 * DEG);
    params.set("wander", ParamValue::Flag(false));
    let plan = AtpgSampler::new(&params).unwrap().plan(&path).unwrap();
    locus.series.store(0, Ordering::Relaxed);
    let blocks = (law.end() / turns).ceil() as usize;
    let mut nodes = NodeList::default();
    for block in (0..blocks).step_by(one_of) {
        let start = block as f64 * turns;
        let end = (start + turns).min(law.end());
        plan.place(&path, Revolutions { start, end }, &mut nodes)
            .unwrap();
    }
    (nodes.revolutions().to_vec(), locus.series.into_inner())
}

/// Compares blocks of several lengths, and gives the numbers of series a node of the longest blocks, with estimates and
/// without.
fn compare(case: &Case, ripple: Ripple, one_of: usize) -> (f64, f64) {
    for (turns, one_of) in [(0.3, 97 * one_of), (5.7, 11 * one_of)] {
        let (nodes, _) = place(case, ripple, Radial::Centre, turns, one_of);
        assert_eq!(nodes, place(case, ripple, Radial::Contact, turns, one_of).0);
    }
    let (nodes, estimated) = place(case, ripple, Radial::Centre, 64.0, one_of);
    let (all, every) = place(case, ripple, Radial::Contact, 64.0, one_of);
    assert_eq!(nodes, all);
    let a_node = |series: usize| series as f64 / nodes.len() as f64;
    (a_node(estimated), a_node(every))
}

#[test]
fn nodes_of_the_papers_parts_are_those_of_all_samples_from_a_third_of_the_series() {
    for (case, one_of) in [
        (ast_5(ZDirection), 1),
        (ast_50(ZDirection), 4),
        (oap_213(ZDirection), 40),
    ] {
        let (estimated, every) = compare(&case, NO_RIPPLE, one_of);
        assert!(
            3.0 * estimated < every,
            "{estimated} and {every} series a node"
        );
    }
}

#[test]
fn nodes_of_waves_are_those_of_all_samples() {
    let mut waves = Params::new()
        .with("amplitude_x", 5e-3)
        .with("amplitude_y", 3e-3)
        .with("frequency_x", 0.4)
        .with("frequency_y", 0.7);
    waves.set("form", ParamValue::Text("sum".to_owned()));
    let surface = model::<SinusoidalArray>(&waves);
    let case = Case::new(surface, Arc::new(ZDirection), 10.0, 0.5, 50.0);
    compare(&case, NO_RIPPLE, 1);
}

#[test]
fn nodes_across_the_seams_of_a_lens_array_are_those_of_all_samples() {
    let mut lenses = Params::new()
        .with("pitch", 1.5)
        .with("radius", 8.0)
        .with("conic", 0.0);
    lenses.set("layout", ParamValue::Text("square".to_owned()));
    let surface = model::<LensletArray>(&lenses);
    let mut case = Case::new(surface, Arc::new(ZDirection), 8.0, 0.5, 200.0);
    case.task.tool.misfit = Misfit::CutWhatFits;
    compare(&case, NO_RIPPLE, 5);
}

#[test]
fn nodes_of_rings_that_the_first_samples_do_not_see_are_those_of_all_samples() {
    // One of eight samples of the coarsest grid is 45.875 to a turn.
    for features in [23.0, 46.0, 92.0] {
        for from in [1.03, 1.71] {
            let ripple = Ripple {
                height: 2e-5 * (46.0 / features) * (46.0 / features),
                features,
                from,
            };
            compare(&ast_5(ZDirection), ripple, 3);
        }
    }
}

/// About two periods of the ripple lie in a step, and less than two of the first samples in a period.
#[test]
fn ripples_that_estimates_cannot_follow_take_few_more_series_than_all_samples() {
    let ripple = Ripple {
        height: 1e-6,
        features: 200.0,
        from: 0.0,
    };
    let (estimated, every) = compare(&ast_5(ZDirection), ripple, 3);
    assert!(
        estimated < 1.02 * every,
        "{estimated} and {every} series a node"
    );
}
