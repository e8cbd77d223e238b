//! Compensators: the nose against the first touch, ρ, batches, and derivatives against differences.

use turnpath_core::fit::{LADDER, STENCIL, evaluate, fit, steps};
use turnpath_core::{
    CentreBuffers, CentreSeries, Compensator, Cut, Locus, ORDER, Radial, RadialRange, Rates,
    Result as Answer, Series, Tool,
};
use turnpath_verify::Touch;

use crate::batches;
use crate::chain::TrialChain;
use crate::convergence::{STEPS, ladder, wrong_term};
use crate::fault::FaultKind;
use crate::place::OnPart;
use crate::sections::{points, polar};

/// Places at which the nose is held against its first touch.
const TOUCHES: usize = 400;
/// Places whose derivatives are compared, and which are asked for in batches.
const CURVES: usize = 60;
/// How far the nose may be off the surface, mm: a tenth of a nanometre, far above rounding and far
/// below a tolerance.
const LARGEST_GAP: f64 = 1e-7;
/// How far ρ may be from what it means, and `foot` from the contact, as a part of the nose radius. A
/// foot that is off by this much moves the centre by its square.
const FOOT_GAP: f64 = 1e-6;
/// How far a rate may be from that of differences, as a part of the largest one: the fit of
/// differences is good to a billionth.
const RATE_GAP: f64 = 1e-6;
/// How far a largest curvature may be from that of the interference check, as a part of it: two
/// searches that begin on other grids.
const CURVATURE_GAP: f64 = 1e-6;
/// Length of the curves: rad along θ, and as a part of the aperture's radius along ρ.
const WIDEST: f64 = 0.08;

/// Checks a compensator on the chain's part.
pub fn check(chain: &TrialChain) -> Vec<FaultKind> {
    let range = chain.task().range;
    let inner = range.inner.max(0.0);
    let some = points(inner, range.outer, CURVES);
    let all = points(inner, range.outer, TOUCHES);
    let checks = [
        in_batches(chain, &some),
        touches(chain, &all),
        series(chain, &some),
        rates(chain, &some),
        at_once(chain, &some),
        outside(chain),
    ];
    checks.into_iter().filter_map(Result::err).collect()
}

fn compensator(chain: &TrialChain) -> &dyn Compensator {
    chain.chain.compensator.strategy.as_ref()
}

fn cut(chain: &TrialChain) -> Cut<'_> {
    Cut {
        surface: chain.preparation.locus.surface(),
        tool: &chain.task().tool,
    }
}

fn failed(call: &'static str) -> impl Fn(turnpath_core::StrategyError) -> FaultKind {
    move |error| FaultKind::Call { call, error }
}

fn centres(chain: &TrialChain, theta: &[f64], rho: &[f64]) -> Answer<CentreBuffers> {
    let mut room = CentreBuffers::default();
    room.resize(theta.len());
    compensator(chain).centre(cut(chain), theta, rho, room.as_centres())?;
    Ok(room)
}

fn in_batches(chain: &TrialChain, points: &[OnPart]) -> Result<(), FaultKind> {
    let names = ["X of the centre", "Z of the centre", "the contact's radius"];
    batches::check("centre", names, points, |points| {
        let (theta, rho) = polar(points);
        let CentreBuffers { x, z, foot } = centres(chain, &theta, &rho)?;
        Ok((0..x.len()).map(|i| [x[i], z[i], foot[i]]).collect())
    })
}

/// The nose neither gouges nor hangs, ρ is what it is said to be, and the contact lies where the nose
/// touches.
fn touches(chain: &TrialChain, points: &[OnPart]) -> Result<(), FaultKind> {
    let (theta, rho) = polar(points);
    let CentreBuffers { x, z, foot } = centres(chain, &theta, &rho).map_err(failed("centre"))?;
    let mut found: Vec<Touch> = Vec::new();
    let touch = &chain.preparation.touch;
    let asked = touch.find(&theta, &x, &mut found);
    asked.map_err(|error| FaultKind::Path(turnpath_pipeline::PipelineError::Measure(error)))?;
    let slack = FOOT_GAP * chain.task().tool.nose_radius;
    for i in 0..points.len() {
        let place = OnPart {
            theta: theta[i],
            rho: x[i],
        };
        let answers = [
            ("X of the centre", x[i]),
            ("Z of the centre", z[i]),
            ("the contact's radius", foot[i]),
        ];
        if let Some((of, value)) = answers.into_iter().find(|(_, value)| !value.is_finite()) {
            let place = points[i];
            return Err(FaultKind::NoNumber { of, place, value });
        }
        let differs = |one: f64, other: f64| (one - other).abs() > slack;
        let height = z[i] - found[i].z;
        if height < -LARGEST_GAP {
            let depth = -height;
            return Err(FaultKind::Gouge { place, depth });
        }
        if height > LARGEST_GAP {
            return Err(FaultKind::Hangs { place, height });
        }
        if differs(foot[i], found[i].foot) {
            return Err(FaultKind::Foot {
                place,
                found: foot[i],
                touch: found[i].foot,
            });
        }
        let (declared, means) = match compensator(chain).radial() {
            Radial::Contact => ("the radius of the contact", foot[i]),
            Radial::Centre => ("X of the nose centre", x[i]),
        };
        if differs(means, rho[i]) {
            return Err(FaultKind::Radial {
                declared,
                place: points[i],
                found: means,
            });
        }
    }
    Ok(())
}

/// The exact series against centres along the same curves.
fn series(chain: &TrialChain, points: &[OnPart]) -> Result<(), FaultKind> {
    let (theta, rho) = polar(points);
    let reach = WIDEST * chain.task().part.aperture_radius;
    let bend = |middle: &f64, reach: f64, bend: f64| {
        [*middle, reach, bend * reach, -0.2 * bend * reach, 0.0]
    };
    let theta: Vec<Series> = theta.iter().map(|t| bend(t, WIDEST, 0.3)).collect();
    let rho: Vec<Series> = rho.iter().map(|r| bend(r, -reach, 0.4)).collect();
    let mut x = vec![[f64::NAN; ORDER + 1]; points.len()];
    let mut z = x.clone();
    let out = CentreSeries {
        x: &mut x,
        z: &mut z,
    };
    let Some(asked) = compensator(chain).exact_series(cut(chain), &theta, &rho, out) else {
        return Ok(());
    };
    asked.map_err(failed("exact_series"))?;
    let along = |curves: &[Series]| -> Vec<f64> {
        let places = curves
            .iter()
            .flat_map(|curve| ladder().map(|t| evaluate(curve, t)));
        places.collect()
    };
    let values = centres(chain, &along(&theta), &along(&rho)).map_err(failed("centre"))?;
    debug_assert_eq!(values.x.len(), STEPS * points.len());
    for (of, series, values) in [
        ("X of the centre", &x, &values.x),
        ("Z of the centre", &z, &values.z),
    ] {
        if let Some(wrong) = wrong_term(series, values, ORDER) {
            return Err(FaultKind::Series {
                of,
                order: wrong.order,
                place: points[wrong.curve],
                found: wrong.found,
                measured: wrong.measured,
            });
        }
    }
    Ok(())
}

/// ∂X/∂θ, ∂X/∂ρ, ∂Z/∂θ at constant X, and ∂Z/∂X.
type RateColumns = [Vec<f64>; 4];
/// What messages call them.
const RATE_NAMES: [&str; 4] = [
    "∂X/∂θ at constant ρ",
    "∂X/∂ρ at constant θ",
    "∂Z/∂θ at constant X",
    "∂Z/∂X at constant θ",
];

fn blank_rates(count: usize) -> RateColumns {
    std::array::from_fn(|_| vec![f64::NAN; count])
}

fn as_rates([x_theta, x_rho, z_theta, z_x]: &mut RateColumns) -> Rates<'_> {
    Rates {
        x_theta,
        x_rho,
        z_theta,
        z_x,
    }
}

/// Centres and rates at once are those of the two calls, to the last bit.
fn at_once(chain: &TrialChain, points: &[OnPart]) -> Result<(), FaultKind> {
    let (theta, rho) = polar(points);
    let mut room = CentreBuffers::default();
    room.resize(points.len());
    let mut rates = blank_rates(points.len());
    let (centres_out, rates_out) = (room.as_centres(), as_rates(&mut rates));
    let asked =
        compensator(chain).centre_and_rates(cut(chain), &theta, &rho, centres_out, rates_out);
    let Some(asked) = asked else {
        return Ok(());
    };
    asked.map_err(failed("centre_and_rates"))?;
    let alone = centres(chain, &theta, &rho).map_err(failed("centre"))?;
    let mut exact = blank_rates(points.len());
    let out = as_rates(&mut exact);
    if let Some(asked) = compensator(chain).exact_rates(cut(chain), &theta, &rho, out) {
        asked.map_err(failed("exact_rates"))?;
    }
    let [x_theta, x_rho, z_theta, z_x] = &exact;
    let of_two_calls = [
        &alone.x,
        &alone.z,
        &alone.foot,
        x_theta,
        x_rho,
        z_theta,
        z_x,
    ];
    let [x_theta, x_rho, z_theta, z_x] = &rates;
    let of_one = [&room.x, &room.z, &room.foot, x_theta, x_rho, z_theta, z_x];
    let names = [
        "X of the centre",
        "Z of the centre",
        "the contact's radius",
        RATE_NAMES[0],
        RATE_NAMES[1],
        RATE_NAMES[2],
        RATE_NAMES[3],
    ];
    for ((of, first), second) in names.into_iter().zip(of_two_calls).zip(of_one) {
        let differs = |i: &usize| first[*i].to_bits() != second[*i].to_bits();
        if let Some(i) = (0..points.len()).find(differs) {
            return Err(FaultKind::Repeat {
                what: format!("{of} at {}", points[i]),
                when: "as an answer of `centre_and_rates`",
                first: first[i],
                second: second[i],
            });
        }
    }
    Ok(())
}

/// The largest curvature outside a part of the region is that of the interference check there, with the nose
/// of the task and with one of half its radius.
fn outside(chain: &TrialChain) -> Result<(), FaultKind> {
    let RadialRange { inner, outer } = chain.task().range;
    let region = RadialRange {
        inner: inner.max(0.0),
        outer,
    };
    let half = 0.5 * (region.inner + outer);
    let part = RadialRange {
        outer: half,
        ..region
    };
    let ring = RadialRange { inner: half, outer };
    let checked = compensator(chain).interference(cut(chain), ring);
    let checked = checked.map_err(failed("interference"))?.curvature.value;
    for (part_of_radius, when) in [
        (1.0, "as an answer of `curvature_outside`"),
        (
            0.5,
            "from `curvature_outside` for a nose of half the radius",
        ),
    ] {
        let tool = Tool {
            nose_radius: part_of_radius * chain.task().tool.nose_radius,
            ..chain.task().tool
        };
        let cut = Cut {
            tool: &tool,
            ..cut(chain)
        };
        let asked = compensator(chain).curvature_outside(cut, part, region);
        let Some(found) = asked.map_err(failed("curvature_outside"))? else {
            return Ok(());
        };
        // The comparison also fails for what is no number.
        if (found.value - checked).abs() <= CURVATURE_GAP * checked.abs() {
            continue;
        }
        return Err(FaultKind::Repeat {
            what: format!("the largest curvature beyond ρ = {half} mm"),
            when,
            first: checked,
            second: found.value,
        });
    }
    Ok(())
}

/// The exact rates against those of the host's fit of centres.
fn rates(chain: &TrialChain, points: &[OnPart]) -> Result<(), FaultKind> {
    let (theta, rho) = polar(points);
    let mut exact = blank_rates(points.len());
    let out = as_rates(&mut exact);
    let Some(asked) = compensator(chain).exact_rates(cut(chain), &theta, &rho, out) else {
        return Ok(());
    };
    asked.map_err(failed("exact_rates"))?;
    let fitted = fitted_rates(chain, &theta, &rho).map_err(failed("centre"))?;
    for ((which, exact), fitted) in RATE_NAMES.into_iter().zip(&exact).zip(&fitted) {
        let largest = fitted.iter().fold(0.0, |m: f64, rate| m.max(rate.abs()));
        let slack = RATE_GAP * largest.max(chain.task().tool.nose_radius * RATE_GAP);
        let differs = |i: &usize| {
            let gap = (exact[*i] - fitted[*i]).abs();
            gap.is_nan() || gap > slack
        };
        if let Some(i) = (0..points.len()).find(differs) {
            return Err(FaultKind::Rate {
                which,
                place: points[i],
                found: exact[i],
                measured: fitted[i],
            });
        }
    }
    Ok(())
}

/// The rates by the host's fit.
fn fitted_rates(chain: &TrialChain, theta: &[f64], rho: &[f64]) -> Answer<RateColumns> {
    let nose = chain.task().tool.nose_radius;
    let along = |i: usize, moves: [f64; 2]| -> Answer<[Series; 2]> {
        let curve = [
            [theta[i], moves[0], 0.0, 0.0, 0.0],
            [rho[i], moves[1], 0.0, 0.0, 0.0],
        ];
        let steps = steps(&curve[0], &curve[1], nose);
        let place = |k: usize| steps[k / STENCIL] * ((k % STENCIL) as f64 - 4.0);
        let at = |series: &Series| -> Vec<f64> {
            (0..LADDER * STENCIL)
                .map(|k| evaluate(series, place(k)))
                .collect()
        };
        let room = centres(chain, &at(&curve[0]), &at(&curve[1]))?;
        let by_step = |values: &[f64]| {
            std::array::from_fn(|step| std::array::from_fn(|j| values[step * STENCIL + j]))
        };
        Ok([
            fit(&steps, &by_step(&room.x)),
            fit(&steps, &by_step(&room.z)),
        ])
    };
    let mut columns: RateColumns = std::array::from_fn(|_| Vec::new());
    for i in 0..theta.len() {
        let ([turned_x, turned_z], [moved_x, moved_z]) =
            (along(i, [1.0, 0.0])?, along(i, [0.0, 1.0])?);
        let slope = moved_z[1] / moved_x[1];
        columns[0].push(turned_x[1]);
        columns[1].push(moved_x[1]);
        columns[2].push(turned_z[1] - slope * turned_x[1]);
        columns[3].push(slope);
    }
    Ok(columns)
}
