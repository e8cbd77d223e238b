//! What the meters kept of a path, as part of a report.

use turnpath_core::Scalar;
use turnpath_report as report;
use turnpath_report::{
    AxisSketch, EdgeSketch, ErrorMap, ErrorProfile, ErrorSketch, RadialMean, Samples, SpiralSketch,
    TurnSketch,
};
use turnpath_verify::machined::ErrorRings;
use turnpath_verify::{AxisMotion, PathSketch, SpiralSample, TurnMotion};

/// Cells along each side of a run's map.
const RUN_CELLS: usize = 300;
/// Cells along each side of the map of a run of an ablation.
const ABLATION_CELLS: usize = 64;
/// The angles of the profiles, rad.
const PROFILES: [f64; 2] = [0.0, std::f64::consts::FRAC_PI_2];

/// What a run of an ablation keeps of its path.
pub fn error_sketch(sketch: &PathSketch) -> ErrorSketch {
    error(sketch, ABLATION_CELLS)
}

/// What a run keeps of its path.
pub fn path_sketch(sketch: &PathSketch) -> report::PathSketch {
    let profiles = sketch.rings.iter();
    report::PathSketch {
        error: error(sketch, RUN_CELLS),
        profiles: profiles
            .flat_map(|rings| PROFILES.map(|angle| profile(rings, angle)))
            .collect(),
        spiral: spiral(&sketch.spiral),
        turns: turns(&sketch.turns),
        edges: EdgeSketch {
            residual: finite(&sketch.residual),
            rim: finite(&sketch.edges.rim),
            hole: finite(&sketch.edges.hole),
        },
    }
}

fn error(sketch: &PathSketch, cells: usize) -> ErrorSketch {
    let rings = sketch.rings.as_ref();
    ErrorSketch {
        map: rings.map(|rings| ErrorMap {
            cells,
            half: rings.outer(),
            errors: Samples(rings.map(cells)),
        }),
        radial_mean: rings.map(|rings| RadialMean {
            radius: Samples(rings.radii()),
            errors: Samples(rings.radial_mean()),
        }),
        harmonics: Samples(sketch.harmonics.clone()),
    }
}

fn profile(rings: &ErrorRings, angle: f64) -> ErrorProfile {
    let (angle, places) = rings.profile(angle);
    ErrorProfile {
        angle,
        s: places.iter().map(|(s, _)| *s).collect(),
        errors: places.iter().map(|(_, error)| *error).collect(),
    }
}

fn spiral(samples: &[SpiralSample]) -> SpiralSketch {
    let turned = samples.iter().map(|sample| {
        let (sin, cos) = Scalar::sin_cos(sample.c);
        (sample.x * cos, sample.x * sin)
    });
    let (x, y): (Vec<f64>, Vec<f64>) = turned.unzip();
    SpiralSketch {
        x: Samples(x),
        y: Samples(y),
        errors: samples.iter().map(|sample| sample.error).collect(),
    }
}

fn turns(turns: &[TurnMotion]) -> TurnSketch {
    let each = |of: fn(&TurnMotion) -> f64| turns.iter().map(of).collect::<Samples>();
    let axis = |of: fn(&TurnMotion) -> &AxisMotion| AxisSketch {
        velocity: turns.iter().map(|turn| of(turn).velocity.amount).collect(),
        acceleration: turns
            .iter()
            .map(|turn| of(turn).acceleration.amount)
            .collect(),
        jerk: turns.iter().map(|turn| of(turn).jerk.amount).collect(),
    };
    TurnSketch {
        radius: each(TurnMotion::radius),
        feed: each(TurnMotion::feed),
        points_per_turn: each(TurnMotion::points_per_turn),
        spindle: each(TurnMotion::spindle),
        errors: each(|turn| turn.error),
        x: axis(|turn| &turn.axes.x),
        z: axis(|turn| &turn.axes.z),
    }
}

/// The heights, without those that are infinite since no pass reaches.
fn finite(heights: &[f64]) -> Samples {
    let known = |height: &f64| {
        if height.is_finite() {
            *height
        } else {
            f64::NAN
        }
    };
    heights.iter().map(known).collect()
}
