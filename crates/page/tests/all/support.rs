//! The data of a page: a real summary, and a sketch of noise as large as a sketch may be.

use turnpath_page::{BestFit, FileAxes, RunPage, StageChoice, SurfaceSketch};
use turnpath_report::{
    AblationReport, AblationRun, AxisNotes, AxisSketch, Direction, EdgeSketch, ErrorMap,
    ErrorProfile, ErrorSketch, MeasuredRun, PathSketch, RadialMean, RunReport, Samples,
    SpiralSketch, TurnSketch, from_json,
};

/// `summary.json` of a small part.
const SUMMARY: &str = include_str!("../../../report/tests/data/summary.json");

/// Numbers that do not compress: no page may count on it.
pub fn noise(count: usize) -> Samples {
    let mut state = 7_u64;
    let next = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 40) as f64 * 1e-12
    };
    std::iter::repeat_with(next).take(count).collect()
}

/// The report of a real run.
pub fn report() -> RunReport {
    from_json(SUMMARY).unwrap()
}

/// The error of a path on a map of so many cells along each side.
pub fn error(cells: usize) -> ErrorSketch {
    ErrorSketch {
        map: Some(ErrorMap {
            cells,
            half: 2.5,
            errors: noise(cells * cells),
        }),
        radial_mean: Some(RadialMean {
            radius: noise(192),
            errors: noise(192),
        }),
        harmonics: noise(513),
    }
}

fn axis() -> AxisSketch {
    AxisSketch {
        velocity: noise(1024),
        acceleration: noise(1024),
        jerk: noise(1024),
    }
}

/// A sketch with as many numbers as that of a long path.
pub fn sketch() -> PathSketch {
    let profile = ErrorProfile {
        angle: 0.0,
        s: noise(384),
        errors: noise(384),
    };
    PathSketch {
        error: error(300),
        profiles: vec![profile.clone(), profile],
        spiral: SpiralSketch {
            x: noise(12_000),
            y: noise(12_000),
            errors: noise(12_000),
        },
        turns: TurnSketch {
            radius: noise(1024),
            feed: noise(1024),
            points_per_turn: noise(1024),
            spindle: noise(1024),
            errors: noise(1024),
            x: axis(),
            z: axis(),
        },
        edges: EdgeSketch {
            residual: noise(360),
            rim: noise(360),
            hole: noise(360),
        },
    }
}

/// A whole page of a run.
pub fn run_page() -> RunPage {
    RunPage {
        report: report(),
        sketch: Some(sketch()),
        surface: SurfaceSketch {
            cells: 160,
            half: 2.5,
            heights: noise(160 * 160),
            deviations: noise(160 * 160),
            best: Some(BestFit::Plane),
        },
        chain: vec![StageChoice {
            slot: "feed".to_owned(),
            name: "atpg".to_owned(),
            summary: "a feed".to_owned(),
            source: "doi:10.1364/OE.21.012".to_owned(),
            parameters: vec![("feed".to_owned(), "\"10 um/rev\"".to_owned())],
            defaults: vec![("at_least".to_owned(), "50".to_owned())],
        }],
        axes: vec![FileAxes {
            file: "a.pmc".to_owned(),
            notes: AxisNotes::new(Direction::Inward, true, true),
        }],
        recipe: Some("format = 1\n".to_owned()),
    }
}

/// An ablation of so many runs, and one that failed.
pub fn ablation(runs: usize) -> AblationReport {
    let run = |number: usize| {
        let varied = vec![("tolerance.residual".to_owned(), format!("{number} nm"))];
        let measured = MeasuredRun {
            sketch: Some(error(64)),
            ..MeasuredRun::from(report())
        };
        AblationRun::new(varied, measured)
    };
    AblationReport {
        format: turnpath_report::FORMAT,
        runs: (0..runs).map(run).collect(),
    }
}
