//! Feeds up to half of the nose radius: the law of every feed strategy against cusps by brute
//! force, on bowls, domes, tori and waves.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::sync::Arc;

use crate::common::Case;
use crate::models::model;
use turnpath_atpg::AtpgFeed;
use turnpath_ats::AtsFeed;
use turnpath_constant::Constant;
use turnpath_core::locus::{CuspFeed, Profile, profile_at};
use turnpath_core::{
    CentreBuffers, Compensator, Direction, FeedStrategy, Locus, ParamValue, Params, SpiralLaw,
    Strategy, SurfaceModel, UM, angle,
};
use turnpath_fft_adaptive::FftAdaptiveFeed;
use turnpath_nose_radius::{Normal, ZDirection};
use turnpath_surfaces::{Conic, OffAxisParaboloid, SinusoidalArray, Toric};

/// Most of the tolerance that a cusp may take: brute force errs by far less.
const WHOLE: f64 = 1.0 + 1e-6;

/// Most places at which one law is tried along its spiral.
const MOST_PLACES: u32 = 1500;
/// Turns, and directions from the axis, at which one law is tried all around.
const TURNS: u32 = 40;
const DIRECTIONS: u32 = 48;

/// Where a law is tried.
#[derive(Debug, Clone, Copy)]
enum Places {
    /// Where its spiral lies: the feed belongs to the direction that the spiral has at a radius.
    AlongSpiral,
    /// In all directions: the feed belongs to the worst one, whether or not the spiral, which may have
    /// few turns, meets it.
    AllAround,
}

/// The strategies that promise the residual, and the part of it that each uses at its worst place.
/// `atpg` and `fft-adaptive` stay below the best feed of all radii within about a feed, which may
/// be half of the nose radius here.
const FEEDS: [(&str, Places, f64); 4] = [
    ("constant", Places::AllAround, 0.98),
    ("atpg", Places::AllAround, 0.9),
    ("ats", Places::AlongSpiral, 0.99),
    ("fft-adaptive", Places::AllAround, 0.9),
];
/// The part of the residual that all of them use on a bowl that the nose nearly fills. Its curvature is
/// largest on the axis, and no middle of two passes lies there.
const ON_A_BOWL: f64 = 0.9;
/// The same of `ats`, whose one factor holds for its whole law. Outward, the factor is that of a whole
/// feed with its middle half a feed from the axis. There the law has just begun, and its feed is nine
/// tenths of that. It uses 0.890 at the least; inward 0.896, with [`Normal`] and 31 um, for a reason that
/// is not known.
const OF_ATS_ON_A_BOWL: f64 = 0.88;
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
    /// A paraboloid that the nose fills to nine tenths at its vertex, cut about a place so far from
    /// the vertex, mm.
    LeaningBowl(f64),
}

impl Shape {
    fn surface(self) -> Arc<dyn SurfaceModel> {
        let conic = |radius: f64, conic: f64| {
            let params = Params::new().with("radius", radius).with("conic", conic);
            model::<Conic>(&params)
        };
        match self {
            Self::Flat => conic(1e9, 0.0),
            Self::Conic(radius, constant) => conic(radius, constant),
            Self::Bowl(filled) => conic(filled.recip(), -1.0),
            Self::Torus(rotation, base) => {
                let params = Params::new().with("radius_rotation", rotation);
                model::<Toric>(&params.with("radius_base", base))
            }
            Self::Waves(amplitude, frequency) => {
                let params = Params::new().with("amplitude_x", amplitude);
                let mut params = params.with("frequency_x", frequency);
                params.set("form", ParamValue::Text("sum".to_owned()));
                model::<SinusoidalArray>(&params)
            }
            Self::LeaningBowl(aside) => {
                let params = Params::new().with("vertex_radius", 0.9f64.recip());
                let params = params.with("off_axis_distance", aside);
                model::<OffAxisParaboloid>(&params)
            }
        }
    }
}

impl Places {
    /// Revolutions where a turn begins, and directions from the axis, rad.
    fn of(self, law: &SpiralLaw) -> Vec<(f64, f64)> {
        let last = law.end() - 1.0;
        match self {
            Self::AlongSpiral => {
                let count = ((last * 48.0) as u32).min(MOST_PLACES);
                let revolution = |i: u32| last * (f64::from(i) + 0.37) / f64::from(count);
                (0..count).map(revolution).map(|n| (n, angle(n))).collect()
            }
            Self::AllAround => {
                let revolution = |i: u32| last * f64::from(i) / f64::from(TURNS - 1);
                let direction = |i: u32| angle(f64::from(i) / f64::from(DIRECTIONS));
                (0..TURNS)
                    .flat_map(|turn| (0..DIRECTIONS).map(move |at| (turn, at)))
                    .map(|(turn, at)| (revolution(turn), direction(at)))
                    .collect()
            }
        }
    }

    /// The largest cusp of a law, and how much of the residual its feeds use.
    fn largest(self, case: &Case, law: &SpiralLaw) -> Largest {
        let sign = match case.task.direction {
            Direction::Outward => 1.0,
            Direction::Inward => -1.0,
        };
        let mut largest = Largest::default();
        for (n, theta) in self.of(law) {
            let ends = [law.value(n), law.value(n + 1.0)];
            let step = sign * (ends[1] - ends[0]);
            assert!(step > 0.0);
            let of_feed = largest_cusp(case, theta, &ends);
            let standing = match ends[0] * ends[1] < 0.0 {
                true => largest_cusp(case, theta, &across_axis(law, n)),
                false => of_feed,
            };
            let of_cap = step / cap(case, theta, 0.5 * (ends[0] + ends[1]));
            largest.standing = largest.standing.max(standing);
            largest.used = largest.used.max(of_feed).max(of_cap * of_cap);
        }
        largest
    }
}

/// The largest values of a law, as parts of the tolerance.
#[derive(Debug, Clone, Copy, Default)]
struct Largest {
    /// The largest cusp that stands.
    standing: f64,
    /// The largest cusp between passes one turn apart, as if no other pass lay between them. Where
    /// the feed is the largest of which neighbouring noses meet within their edges, no residual
    /// makes it larger: there it is the square of the part of that feed.
    used: f64,
}

/// The largest cusp between neighbours of these places of a line, as a part of the tolerance.
fn largest_cusp(case: &Case, theta: f64, places: &[f64]) -> f64 {
    let cusp = |pair: &[f64]| {
        let (one, two) = (case.centre(theta, pair[0]), case.centre(theta, pair[1]));
        case.cusp(theta, one, two) / case.task.tolerance.residual
    };
    places.windows(2).map(cusp).fold(0.0, f64::max)
}

/// The passes of a line from that after `n` revolutions, which is on one side of the axis, to that
/// a turn later, which is on the other side. On the line lie also the passes of the opposite
/// direction, half a turn earlier and later. So the two are rarely neighbours.
fn across_axis(law: &SpiralLaw, n: f64) -> Vec<f64> {
    let ends = [law.value(n), law.value(n + 1.0)];
    let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    let earlier = (2.0 * n).floor() as i32;
    let later = (2.0 * (law.end() - n)).floor() as i32;
    let opposite = (-earlier..=later).filter(|halves| halves % 2 != 0);
    let opposite = opposite.map(|halves| -law.value(n + 0.5 * f64::from(halves)));
    let mut places: Vec<f64> = opposite.filter(|x| low < *x && *x < high).collect();
    places.extend(ends);
    places.sort_by(f64::total_cmp);
    // Two noses at one place leave no cusp.
    places.dedup_by(|one, other| (*one - *other).abs() < 1e-9);
    places
}

/// The largest feed of which neighbouring noses meet within their edges, mm.
fn cap(case: &Case, theta: f64, rho: f64) -> f64 {
    let mut room = CentreBuffers::default();
    room.resize(1);
    let at = (&[theta], &[rho]);
    case.locus.centre(at.0, at.1, room.as_centres()).unwrap();
    let mut profile = [Profile::default()];
    profile_at(case.surface.as_ref(), at.0, &room.foot, &mut profile).unwrap();
    let (residual, tool) = (case.task.tolerance.residual, &case.task.tool);
    let law = CuspFeed::new(residual, case.locus.radial(), tool);
    law.cap(profile[0].slope, law.gap(profile[0].curvature()))
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
            let aperture = match self.shape {
                Shape::LeaningBowl(_) => 5.0,
                _ => 9.0,
            };
            Case::new(self.shape.surface(), compensator, aperture, 1.0, 100.0)
        };
        let mut case = match self.normal {
            true => part(Arc::new(Normal)),
            false => part(Arc::new(ZDirection)),
        };
        case.task.tolerance.residual = self.residual_um * UM;
        if self.inward { case.inward() } else { case }
    }

    /// The largest cusp under a strategy, and how much its feeds use.
    fn largest(&self, feed: &str, places: Places) -> Largest {
        let case = self.case();
        let law = case.law(strategy(feed).as_ref()).unwrap();
        assert!(law.end() > 4.0, "{feed}: {} turns", law.end());
        places.largest(&case, &law)
    }

    /// What each strategy leaves of the residual, or takes beyond it, where it should not.
    fn misses(&self) -> Vec<String> {
        let miss = |(feed, places, used): (&str, Places, f64)| {
            let largest = self.largest(feed, places);
            let least = match self.shape {
                Shape::Flat => ON_A_FLAT,
                Shape::Bowl(_) if feed == AtsFeed::NAME => OF_ATS_ON_A_BOWL,
                Shape::Bowl(_) => ON_A_BOWL,
                _ => used,
            };
            let is_good = largest.used >= least && largest.standing <= WHOLE;
            (!is_good).then(|| format!("{feed}, {self:?}: {largest:?} of the tolerance"))
        };
        FEEDS.into_iter().filter_map(miss).collect()
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
    let misses = trials.map(|(at, residual_um)| {
        let trial = Trial {
            shape: SHAPES[at],
            residual_um,
            normal: at % 4 == 0,
            inward: at > 3,
        };
        trial.misses()
    });
    assert_eq!(misses.concat(), Vec::<String>::new());
}

/// The largest cusps that `ats` leaves with normal compensation.
fn standing_of_ats(shape: Shape, residual_um: f64, inward: bool) -> f64 {
    let trial = Trial {
        shape,
        residual_um,
        normal: true,
        inward,
    };
    trial.largest(AtsFeed::NAME, Places::AlongSpiral).standing
}

/// Contacts are far apart where the nose nearly fills a hollow, and the curvature is another one at
/// the ends of such a feed.
#[test]
fn ats_holds_the_residual_in_hollows_off_the_axis() {
    for (residual_um, inward) in [
        (0.1, true),
        (0.3, false),
        (2.0, true),
        (10.0, false),
        (31.0, true),
    ] {
        let largest = standing_of_ats(Shape::Waves(0.2, 0.34), residual_um, inward);
        assert!(largest <= WHOLE, "{residual_um} um: {largest}");
    }
}

/// Around the axis both halves of a line have passes. On a part of revolution those of one half lie
/// in the middle between those of the other, but not where one half takes larger feeds.
#[test]
fn ats_holds_the_residual_around_the_axis_of_a_bowl_that_leans() {
    for (aside, residual_um) in [(0.05, 10.0), (0.1, 2.0), (0.1, 31.0)] {
        let largest = standing_of_ats(Shape::LeaningBowl(aside), residual_um, true);
        assert!(largest <= WHOLE, "{aside} mm, {residual_um} um: {largest}");
    }
}

#[test]
#[ignore = "too slow for every run of the tests; `cargo xtask long` runs it"]
fn long_large_feeds_hold_the_residual_and_use_it() {
    let mut misses = Vec::new();
    for shape in SHAPES {
        for residual_um in RESIDUALS_UM {
            for (normal, inward) in [(false, false), (false, true), (true, false), (true, true)] {
                let trial = Trial {
                    shape,
                    residual_um,
                    normal,
                    inward,
                };
                misses.extend(trial.misses());
            }
        }
    }
    assert_eq!(misses, Vec::<String>::new());
}
