//! Strategies with one fault each that the host's own checks let pass or cannot know, and the check
//! that sees it.

use std::sync::atomic::{AtomicU64, Ordering};

use turnpath_host::Catalogue;
use turnpath_plugin::prelude::*;
use turnpath_plugin_test::Check::{
    Closing, Derivatives, Played, Repetition, Residual, Speed, Touch,
};
use turnpath_plugin_test::{Check, Conformance, Promise, Trial};

/// Each strategy, the check that sees its fault, and words of the message.
const TABLE: [(&str, Check, &str); 22] = [
    ("slope-off", Derivatives, "∂z/∂x is"),
    ("slope-off-in-part", Derivatives, "∂z/∂x is"),
    ("curvature-off", Derivatives, "wrong in its term t^2"),
    ("batch-off", Repetition, "in a batch of other points"),
    ("gouges", Touch, "nm too low"),
    ("hangs", Touch, "nm above the surface"),
    (
        "misnamed",
        Touch,
        "`radial` says that ρ is X of the nose centre",
    ),
    ("wrong-foot", Touch, "`foot` is"),
    ("foot-in-bands", Touch, "the contact's radius is NaN"),
    ("wrong-rates", Derivatives, "∂X/∂θ at constant ρ is"),
    ("torn", Repetition, "as an answer of `centre_and_rates`"),
    (
        "looks-inside",
        Repetition,
        "as an answer of `curvature_outside`",
    ),
    ("open", Closing, "does not close at its"),
    ("coarse", Residual, "a cusp of"),
    ("counts", Repetition, "several threads ask in another order"),
    ("learns", Repetition, "by a strategy that is made anew"),
    ("sparse", Played, "before refinement"),
    ("slow", Check::Velocities, "of a motion of degree 1"),
    (
        "looks-around",
        Check::Velocities,
        "`dependence` says `Local`",
    ),
    (
        "looks-far",
        Check::Velocities,
        "`dependence` says `Overlap(1)`",
    ),
    ("parabolas", Check::Velocities, "of a motion of degree 3"),
    ("deaf", Speed, "the host asks for 0.5000 of the speed"),
];

/// A fault that shows by another check too: heights that differ in a batch differ from their series.
const ALSO: [(&str, Check); 1] = [("batch-off", Derivatives)];

macro_rules! strategy {
    ($type:ident, $name:literal) => {
        #[derive(Clone)]
        struct $type;

        impl Strategy for $type {
            const NAME: &'static str = $name;
            const SUMMARY: &'static str = "has a fault";

            fn new(_: &Params) -> Result<Self> {
                Ok(Self)
            }
        }
    };
}

/// z = 0.03 x² + 0.01 y².
struct Bowl;

impl Surface for Bowl {
    const IN_WIDE_REGISTERS: bool = false;

    fn sag<S: Scalar>(&self, x: S, y: S) -> S {
        x.squared() * 0.03 + y.squared() * 0.01
    }
}

/// The bowl with something wrong in its slopes, series or heights.
macro_rules! bowl {
    ($type:ident, $name:literal, $heights:expr, $slopes:expr, $series:expr) => {
        strategy!($type, $name);

        impl SurfaceModel for $type {
            fn heights(&self, x: &[f64], y: &[f64], z: &mut [f64]) -> Result<()> {
                Bowl.heights(x, y, z)?;
                let spoil: fn(&mut [f64]) = $heights;
                spoil(z);
                Ok(())
            }

            fn gradient(&self, x: &[f64], y: &[f64], out: Gradients<'_>) -> Result<()> {
                let Gradients { z, zx, zy } = out;
                let (heights, along_x) = (&mut *z, &mut *zx);
                let out = Gradients {
                    z: heights,
                    zx: along_x,
                    zy,
                };
                Bowl.gradient(x, y, out)?;
                let (heights, slope): (fn(&mut [f64]), fn(f64) -> f64) = ($heights, $slopes);
                heights(z);
                for (zx, x) in zx.iter_mut().zip(x) {
                    *zx += slope(*x);
                }
                Ok(())
            }

            fn series(&self, x: &[Series], y: &[Series], out: GradientSeries<'_>) -> Result<()> {
                let GradientSeries { z, zx, zy } = out;
                let heights = &mut *z;
                let out = GradientSeries { z: heights, zx, zy };
                Bowl.series(x, y, out)?;
                let spoil: fn(&mut Series) = $series;
                z.iter_mut().for_each(spoil);
                Ok(())
            }

            fn height_series(&self, x: &[Series], y: &[Series], z: &mut [Series]) -> Result<()> {
                Bowl.height_series(x, y, z)
            }
        }
    };
}

bowl!(SlopeOff, "slope-off", |_| {}, |x| 6e-6 * x, |_| {});
bowl!(
    SlopeOffInPart,
    "slope-off-in-part",
    |_| {},
    |x| 0.002 * (x + 0.4).min(0.0).squared(),
    |_| {}
);
bowl!(CurvatureOff, "curvature-off", |_| {}, |_| 0.0, |series| {
    series[2] *= 1.01;
});
bowl!(
    BatchOff,
    "batch-off",
    |z| {
        if z.len() > 8 {
            z.iter_mut().for_each(|z| *z += 1e-14);
        }
    },
    |_| 0.0,
    |_| {}
);

/// The nose centre on the profile's normal, off it by a part of the nose radius.
fn normal(cut: Cut<'_>, theta: &[f64], rho: &[f64], out: Centres<'_>, part: f64) -> Result<()> {
    let radius = cut.tool.nose_radius;
    let (mut z, mut zx, mut zy) = ([0.0], [0.0], [0.0]);
    for i in 0..theta.len() {
        let (sin, cos) = Scalar::sin_cos(theta[i]);
        let height = Gradients {
            z: &mut z,
            zx: &mut zx,
            zy: &mut zy,
        };
        cut.surface
            .gradient(&[rho[i] * cos], &[rho[i] * sin], height)?;
        let slope = zx[0] * cos + zy[0] * sin;
        let slant = (1.0 + slope * slope).sqrt();
        out.x[i] = rho[i] - radius * slope / slant;
        out.z[i] = z[0] + part * radius / slant;
        out.foot[i] = rho[i];
    }
    Ok(())
}

macro_rules! compensator {
    ($type:ident, $name:literal, $radial:expr, $part:expr, $foot:expr, $($more:tt)*) => {
        strategy!($type, $name);

        impl Compensator for $type {
            fn radial(&self) -> Radial {
                $radial
            }

            fn centre(
                &self,
                cut: Cut<'_>,
                theta: &[f64],
                rho: &[f64],
                out: Centres<'_>,
            ) -> Result<()> {
                let Centres { x, z, foot } = out;
                let feet = &mut *foot;
                normal(cut, theta, rho, Centres { x, z, foot: feet }, $part)?;
                let foot_of: fn(f64) -> f64 = $foot;
                foot.iter_mut().for_each(|foot| *foot = foot_of(*foot));
                Ok(())
            }

            $($more)*
        }
    };
}

compensator!(Gouges, "gouges", Radial::Contact, 0.99999, |foot| foot,);
compensator!(Hangs, "hangs", Radial::Contact, 1.00001, |foot| foot,);
compensator!(Misnamed, "misnamed", Radial::Centre, 1.0, |foot| foot,);
compensator!(WrongFoot, "wrong-foot", Radial::Contact, 1.0, |foot| foot
    + 0.01,);
compensator!(FootInBands, "foot-in-bands", Radial::Contact, 1.0, |foot| {
    match (0.9..1.5).contains(&foot) {
        true => f64::NAN,
        false => foot,
    }
},);
compensator!(
    WrongRates,
    "wrong-rates",
    Radial::Contact,
    1.0,
    |foot| foot,
    fn exact_rates(
        &self,
        _: Cut<'_>,
        _: &[f64],
        rho: &[f64],
        out: Rates<'_>,
    ) -> Option<Result<()>> {
        // Those of a cylinder: right in X alone, and on no part with a slope.
        for i in 0..rho.len() {
            (out.x_theta[i], out.x_rho[i]) = (0.0, 1.0);
            (out.z_theta[i], out.z_x[i]) = (0.0, 0.1);
        }
        Some(Ok(()))
    }
);

compensator!(
    LooksInside,
    "looks-inside",
    Radial::Contact,
    1.0,
    |foot| foot,
    // That within the part.
    fn curvature_outside(
        &self,
        cut: Cut<'_>,
        part: RadialRange,
        _: RadialRange,
    ) -> Result<Option<interference::Extreme>> {
        Ok(Some(self.interference(cut, part)?.curvature))
    }
);

compensator!(
    Torn,
    "torn",
    Radial::Contact,
    1.0,
    |foot| foot,
    // Half a nanometre below the centre that `centre` gives, and without slopes.
    fn centre_and_rates(
        &self,
        cut: Cut<'_>,
        theta: &[f64],
        rho: &[f64],
        centres: Centres<'_>,
        rates: Rates<'_>,
    ) -> Option<Result<()>> {
        rates.x_theta.fill(0.0);
        rates.x_rho.fill(1.0);
        rates.z_theta.fill(0.0);
        rates.z_x.fill(0.0);
        let Centres { x, z, foot } = centres;
        let out = Centres {
            x,
            z: &mut *z,
            foot,
        };
        let answer = self.centre(cut, theta, rho, out);
        z.iter_mut().for_each(|z| *z -= 5e-7);
        Some(answer)
    }
);

/// A law of one call.
struct Whole(Vec<FeedPiece>);

impl FeedPlan for Whole {
    fn extend(&mut self, _: Setup<'_>, pieces: &mut Vec<FeedPiece>) -> Result<Continuation> {
        pieces.append(&mut self.0);
        Ok(Continuation::End)
    }
}

strategy!(Open, "open");

impl FeedStrategy for Open {
    /// Each turn moves on its first half alone, and the last turn ends there.
    fn plan(&self, setup: Setup<'_>) -> Result<Box<dyn FeedPlan>> {
        let RadialRange { inner, outer } = setup.task.range;
        let (from, to) = match setup.task.direction {
            Direction::Outward => (inner, outer),
            Direction::Inward => (outer, inner),
        };
        let turns = ((outer - inner) / 0.02).ceil();
        let step = (to - from) / turns;
        let mut pieces = Vec::new();
        for turn in 0..turns as usize {
            let rho = from + step * turn as f64;
            let rest = |rho: f64| [rho, 0.0, 0.0];
            pieces.push(FeedPiece::between(rest(rho), rest(rho + step), 0.5));
            pieces.push(FeedPiece::between(rest(rho + step), rest(rho + step), 0.5));
        }
        Ok(Box::new(Whole(pieces)))
    }
}

strategy!(Coarse, "coarse");

impl FeedStrategy for Coarse {
    fn plan(&self, setup: Setup<'_>) -> Result<Box<dyn FeedPlan>> {
        let RadialRange { inner, outer } = setup.task.range;
        let (from, to) = match setup.task.direction {
            Direction::Outward => (inner, outer),
            Direction::Inward => (outer, inner),
        };
        let turns = (outer - inner) / 0.05;
        let line = [from, (to - from) / turns, 0.0, 0.0, 0.0, 0.0];
        let piece = FeedPiece {
            length: turns,
            coefficients: line,
        };
        Ok(Box::new(Whole(vec![piece])))
    }
}

/// As many steps as blocks were asked for before.
struct Counting(AtomicU64);

impl SamplerPlan for Counting {
    fn place(&self, _: &Path<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()> {
        let steps = 60 + self.0.fetch_add(1, Ordering::Relaxed);
        nodes.extend(block.turns().flat_map(|turn| turn.subdivide(steps as f64)));
        Ok(())
    }
}

strategy!(Counts, "counts");

impl Sampler for Counts {
    fn plan(&self, _: &Path<'_>) -> Result<Box<dyn SamplerPlan>> {
        Ok(Box::new(Counting(AtomicU64::new(0))))
    }
}

static MADE: AtomicU64 = AtomicU64::new(0);

/// As many steps as samplers were made before.
#[derive(Clone)]
struct Learns(f64);

impl Strategy for Learns {
    const NAME: &'static str = "learns";
    const SUMMARY: &'static str = "has a fault";

    fn new(_: &Params) -> Result<Self> {
        Ok(Self((60 + MADE.fetch_add(1, Ordering::Relaxed)) as f64))
    }
}

impl SamplerPlan for Learns {
    fn place(&self, _: &Path<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()> {
        nodes.extend(block.turns().flat_map(|turn| turn.subdivide(self.0)));
        Ok(())
    }
}

strategy!(Sparse, "sparse");

impl SamplerPlan for Sparse {
    fn place(&self, _: &Path<'_>, block: Revolutions, nodes: &mut NodeList) -> Result<()> {
        nodes.extend(block.turns().flat_map(|turn| turn.subdivide(12.0)));
        Ok(())
    }
}

/// The slopes of parabolas through each node and its neighbours, and of lines at the ends.
fn parabolas(t: &[f64], p: &[f64], out: &mut [f64]) {
    let rate = |i: usize, j: usize| (p[j] - p[i]) / (t[j] - t[i]);
    let last = t.len() - 1;
    for (k, out) in out.iter_mut().enumerate() {
        *out = if last == 0 {
            0.0
        } else if k == 0 {
            rate(0, 1)
        } else if k == last {
            rate(last - 1, last)
        } else {
            let (before, after) = (t[k] - t[k - 1], t[k + 1] - t[k]);
            (rate(k - 1, k) * after + rate(k, k + 1) * before) / (before + after)
        };
    }
}

macro_rules! solver {
    ($type:ident, $name:literal, $dependence:expr, $solve:expr) => {
        strategy!($type, $name);

        impl VelocitySolver for $type {
            fn dependence(&self) -> Dependence {
                $dependence
            }

            fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
                let axis: fn(&[f64], &[f64], &mut [f64]) = $solve;
                axis(nodes.t, nodes.c, out.c);
                axis(nodes.t, nodes.x, out.x);
                axis(nodes.t, nodes.z, out.z);
                Ok(())
            }
        }
    };
}

solver!(Slow, "slow", Dependence::Overlap(1), |t, p, out| {
    parabolas(t, p, out);
    out.iter_mut().for_each(|rate| *rate *= 0.999);
});
solver!(LooksAround, "looks-around", Dependence::Local, parabolas);
solver!(
    LooksFar,
    "looks-far",
    Dependence::Overlap(1),
    |t, p, out| {
        let last = t.len() - 1;
        for (k, out) in out.iter_mut().enumerate() {
            let (i, j) = (k.saturating_sub(3), (k + 3).min(last));
            *out = if i == j {
                0.0
            } else {
                (p[j] - p[i]) / (t[j] - t[i])
            };
        }
    }
);
solver!(Parabolas, "parabolas", Dependence::Overlap(1), parabolas);

strategy!(Deaf, "deaf");

impl SpindleStrategy for Deaf {
    fn plan(&self, _: &Path<'_>, ask: &SpindleAsk<'_>) -> Result<SpindleLaw> {
        Ok(SpindleLaw::constant(ask.speed))
    }

    fn follows_factors(&self) -> bool {
        true
    }
}

turnpath_plugin::export!(
    surface_models: [SlopeOff, SlopeOffInPart, CurvatureOff, BatchOff],
    feeds: [Open, Coarse],
    samplers: [Counts, Learns, Sparse],
    compensators: [Gouges, Hangs, Misnamed, WrongFoot, FootInBands, WrongRates, Torn, LooksInside],
    velocities: [Slow, LooksAround, LooksFar, Parabolas],
    spindles: [Deaf],
);

#[test]
fn each_fault_is_seen_by_its_check_in_words_of_the_trade() {
    let promises = [
        Trial::of("coarse").promising(Promise::Residual),
        Trial::of("sparse").promising(Promise::Tolerance),
        Trial::of("parabolas").promising(Promise::ExactOnCubics),
    ];
    let checks = Conformance::of(Catalogue::linked(), "all");
    let findings = promises
        .into_iter()
        .fold(checks, Conformance::with)
        .findings();
    let mut unseen = Vec::new();
    for (name, check, words) in TABLE {
        let mut of_strategy = findings.faults.iter().filter(|one| one.strategy == name);
        let seen =
            of_strategy.any(|one| one.kind.check() == check && one.to_string().contains(words));
        if !seen {
            unseen.push((name, check, words));
        }
    }
    assert!(unseen.is_empty(), "{unseen:?}\n{findings}");
    let others = findings.faults.iter().filter(|fault| {
        let own = (fault.strategy.as_str(), fault.kind.check());
        let in_table = TABLE.iter().any(|(name, check, _)| (*name, *check) == own);
        !in_table && !ALSO.contains(&own)
    });
    let others: Vec<String> = others.map(|fault| fault.to_string()).collect();
    assert!(others.is_empty(), "no fault of theirs: {others:#?}");
}
