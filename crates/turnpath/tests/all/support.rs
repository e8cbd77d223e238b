//! A small recipe and its job.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use turnpath::{Catalogue, Job, Recipe};

/// A saddle of 5 mm with leads and a program; a run takes a fraction of a second.
pub const SADDLE: &str = r#"format = 1
name = "Saddle"
[part]
aperture = "5 mm"
[surface]
use = "astigmatic"
k = "0.08 /mm"
[tool]
nose_radius = "1 mm"
[tolerance]
interpolation = "500 nm"
residual = "2 um"
[spindle]
speed = "100 rpm"
[feed]
use = "atpg"
[sampler]
use = "atpg"
[compensator]
use = "z-direction"
[velocity]
use = "triangle-rotary"
[output]
posts = ["pmac-pvt"]
"#;

/// The saddle with changes.
pub fn recipe(sets: &[&str]) -> Recipe {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    Recipe::parse(SADDLE, "saddle.toml", &sets).unwrap()
}

/// The job of the saddle with changes.
pub fn job(sets: &[&str]) -> Job {
    Job::new(recipe(sets), &Catalogue::linked().unwrap()).unwrap()
}

/// Changes for a path of some 70 blocks, of which the last ones alone, at the rim, are to be refined:
/// all blocks before are written by then.
pub const REFINED_LATE: [&str; 6] = [
    "tolerance.interpolation=1600 nm",
    "path.direction=outward",
    "feed={ use = \"constant\", feed = \"0.56 um/rev\" }",
    "sampler={ use = \"equal-angle\", step = \"30 deg\" }",
    "velocity={ use = \"analytic\" }",
    "output.data=[\"csv\", \"npz\"]",
];
