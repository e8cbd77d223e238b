//! Feeds up to half of the nose radius: the law of every feed strategy against cusps by brute
//! force, on bowls, domes, tori and waves.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::sync::Arc;

use crate::common::Case;
use turnpath_atpg::AtpgFeed;
use turnpath_ats::AtsFeed;
use turnpath_constant::Constant;
use turnpath_core::{
    Compensator, Direction, FeedStrategy, ParamValue, Params, SpiralLaw, Strategy, SurfaceModel,
    UM, angle,
};
use turnpath_fft_adaptive::FftAdaptiveFeed;
use turnpath_nose_radius::{Normal, ZDirection};
use turnpath_surfaces::{Conic, SinusoidalArray, Toric};

/// Most of the tolerance that a cusp may take: brute force errs by far less.
const WHOLE: f64 = 1.0 + 1e-6;

/// Most places at which one law is tried.
const MOST_PLACES: u32 = 1500;

/// The strategies that promise the residual, and the part of it that each uses at its worst place.
/// `atpg` and `fft-adaptive` stay below the best feed of all radii within about a feed, which may
/// be half of the nose radius here.
const FEEDS: [(&str, f64); 4] = [
    ("constant", 0.98),
    ("atpg", 0.9),
    ("ats", 0.99),
    ("fft-adaptive", 0.9),
];
/// The part of the residual that all of them use on a bowl that the nose nearly fills. Its curvature is
/// largest on the axis, and no middle of two passes lies there.
const ON_A_BOWL: f64 = 0.9;
/// The part of the residual that all of them use on a flat part.
const ON_A_FLAT: f64 = 0.99;

fn strategy(name: &str) -> Box<dyn FeedStrategy> {
    let mut words = Params::new();
    let mut word = |name: &str, word: &str| words.set(name, ParamValue::Text(word.to_owned()));
    match name {
        "constant" => Box::new(Constant::new(&words).unwrap()),
        "atpg" => {
            word("residual", "held");
            word("fit", "smooth");
            Box::new(AtpgFeed::new(&words).unwrap())
        }
        "ats" => Box::new(AtsFeed::default()),
        _ => {
            word("chord", "half");
            words.set("limit_residual", ParamValue::Flag(true));
            words.set("angles", ParamValue::Number(72.0));
            // A chord that never limits the feed.
            let words = words.with("tolerance", 0.5);
            Box::new(FftAdaptiveFeed::new(&words).unwrap())
        }
    }
}

/// A part under a nose of 1 mm.
#[derive(Debug, Clone, Copy)]
enum Shape {
    Flat,
    /// Radius of curvature, mm, and conic constant.
    Conic(f64, f64),
    /// A paraboloid that the nose fills to this part at the axis.
    Bowl(f64),
    /// Radii along x and y, mm.
    Torus(f64, f64),
    /// Amplitude, mm, and frequency, 1/mm.
    Waves(f64, f64),
}

impl Shape {
    fn surface(self) -> Arc<dyn SurfaceModel> {
        let conic = |radius: f64, conic: f64| {
            let params = Params::new().with("radius", radius).with("conic", conic);
            Arc::new(Conic::new(&params).unwrap())
        };
        match self {
            Self::Flat => conic(1e9, 0.0),
            Self::Conic(radius, constant) => conic(radius, constant),
            Self::Bowl(filled) => conic(filled.recip(), -1.0),
            Self::Torus(rotation, base) => {
                let params = Params::new().with("radius_rotation", rotation);
                Arc::new(Toric::new(&params.with("radius_base", base)).unwrap())
            }
            Self::Waves(amplitude, frequency) => {
                let params = Params::new().with("amplitude_x", amplitude);
                let mut params = params.with("frequency_x", frequency);
                params.set("form", ParamValue::Text("sum".to_owned()));
                Arc::new(SinusoidalArray::new(&params).unwrap())
            }
        }
    }
}

/// The largest cusp of a law as a part of the tolerance, between all its turns.
fn largest_cusp(case: &Case, law: &SpiralLaw) -> f64 {
    let sign = match case.task.direction {
        Direction::Outward => 1.0,
        Direction::Inward => -1.0,
    };
    let places = (((law.end() - 1.0) * 48.0) as u32).min(MOST_PLACES);
    let mut largest: f64 = 0.0;
    for i in 0..places {
        let n = (law.end() - 1.0) * (f64::from(i) + 0.37) / f64::from(places);
        let (rho, next) = (law.value(n), law.value(n + 1.0));
        assert!(sign * (next - rho) > 0.0);
        let (one, two) = (case.centre(angle(n), rho), case.centre(angle(n), next));
        largest = largest.max(case.cusp(angle(n), one, two));
    }
    largest / case.task.tolerance.residual
}

/// One part with one compensator, one residual and one direction, under all strategies.
#[derive(Debug)]
struct Trial {
    shape: Shape,
    residual_um: f64,
    normal: bool,
    inward: bool,
}

impl Trial {
    fn case(&self) -> Case {
        let part = |compensator: Arc<dyn Compensator>| {
            Case::new(self.shape.surface(), compensator, 9.0, 1.0, 100.0)
        };
        let mut case = match self.normal {
            true => part(Arc::new(Normal)),
            false => part(Arc::new(ZDirection)),
        };
        case.task.tolerance.residual = self.residual_um * UM;
        if self.inward { case.inward() } else { case }
    }

    /// The largest cusp under a strategy.
    fn largest(&self, feed: &str) -> f64 {
        let case = self.case();
        let law = case.law(strategy(feed).as_ref()).unwrap();
        assert!(law.end() > 4.0, "{feed}: {} turns", law.end());
        largest_cusp(&case, &law)
    }

    /// Every strategy holds the residual and uses it.
    fn check(&self) {
        for (feed, used) in FEEDS {
            let largest = self.largest(feed);
            let least = match self.shape {
                Shape::Flat => ON_A_FLAT,
                Shape::Bowl(_) => ON_A_BOWL,
                _ => used,
            };
            assert!(
                (least..=WHOLE).contains(&largest),
                "{feed}, {self:?}: {largest} of the tolerance"
            );
        }
    }
}

const SHAPES: [Shape; 12] = [
    Shape::Flat,
    Shape::Conic(8.0, 0.0),
    Shape::Conic(-6.0, 0.0),
    Shape::Conic(5.0, -1.0),
    Shape::Conic(-3.0, -1.0),
    Shape::Conic(-1.5, -2.0),
    Shape::Torus(8.0, 12.0),
    Shape::Torus(-7.0, 10.0),
    Shape::Waves(0.2, 0.2),
    Shape::Bowl(0.8),
    Shape::Bowl(0.9),
    Shape::Bowl(0.95),
];

/// Within the passage from the parabola to circles, and then feeds up to half of the nose radius.
const RESIDUALS_UM: [f64; 4] = [0.3, 2.0, 10.0, 31.0];

/// Some of the shapes, with feeds of all sizes, both compensators and both directions. The last one
/// is a bowl that the nose fills to nine tenths at the axis.
#[test]
fn large_feeds_hold_the_residual_and_use_it() {
    let trials = [
        (0, 31.0),
        (2, 0.3),
        (4, 10.0),
        (6, 31.0),
        (7, 2.0),
        (10, 2.0),
    ];
    for (at, residual_um) in trials {
        Trial {
            shape: SHAPES[at],
            residual_um,
            normal: at % 4 == 0,
            inward: at > 3,
        }
        .check();
    }
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_large_feeds_hold_the_residual_and_use_it() {
    for shape in SHAPES {
        for residual_um in RESIDUALS_UM {
            for (normal, inward) in [(false, false), (false, true), (true, false), (true, true)] {
                Trial {
                    shape,
                    residual_um,
                    normal,
                    inward,
                }
                .check();
            }
        }
    }
}
