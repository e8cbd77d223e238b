//! `turnpath check`: everything but the path.

use serde::Serialize;
use turnpath_core::DEG;
use turnpath_core::interference::Interference;
use turnpath_pipeline::expect;

use crate::args::{CheckArgs, Format};
use crate::job::{Job, of_pipeline};
use crate::machine::MachineAsked;
use crate::programs::asked;
use crate::run::print;
use crate::summary::to_json;
use crate::{Done, Verdict, figures};

/// Bytes that a row of `toolpath.csv` takes, give or take a tenth: seven doubles and a digit.
const ROW_BYTES: f64 = 125.0;

#[derive(Debug, Serialize)]
struct Checked {
    name: String,
    largest_nose_radius_mm: Option<f64>,
    least_included_angle_deg: f64,
    least_clearance_angle_deg: f64,
    /// Limits that the path will be held against; null without any.
    machine: Option<MachineAsked>,
    expected: Expected,
}

/// Before refinement.
#[derive(Debug, Serialize)]
struct Expected {
    revolutions: f64,
    cutting_time_s: f64,
    control_points: f64,
    toolpath_bytes: f64,
    programs: Vec<ExpectedProgram>,
}

#[derive(Debug, Serialize)]
struct ExpectedProgram {
    file: String,
    bytes: f64,
}

/// Checks a recipe.
pub fn check(args: &CheckArgs) -> Done {
    let job = Job::ready(&args.recipe, &args.work)?;
    let expected = expect(&job.chain, &job.prepared).map_err(|e| of_pipeline(&job.recipe, e))?;
    let programs = asked(&job.recipe, job.compensates_nose())?;
    let radius = job.prepared.job.range.outer;
    let found = &job.prepared.interference;
    let checked = Checked {
        name: job.recipe.name.clone(),
        largest_nose_radius_mm: Some(found.largest_nose_radius()).filter(|r| r.is_finite()),
        least_included_angle_deg: 2.0 * found.contact_angle.value / DEG,
        least_clearance_angle_deg: found.cut_angle.value / DEG,
        machine: MachineAsked::new(&job.recipe),
        expected: Expected {
            revolutions: expected.revolutions,
            cutting_time_s: expected.cutting_time,
            control_points: expected.control_points.round(),
            toolpath_bytes: expected.control_points * ROW_BYTES,
            programs: programs
                .into_iter()
                .map(|program| ExpectedProgram {
                    bytes: program.expected_bytes(radius, &expected),
                    file: program.file,
                })
                .collect(),
        },
    };
    print(&match args.work.format {
        Format::Json => to_json(&checked),
        Format::Human => human(&job, &checked, found),
    })?;
    Ok(Verdict::Holds)
}

fn human(job: &Job, checked: &Checked, found: &Interference) -> String {
    let tool = &job.recipe.tool;
    let mut text = format!("{}\n", checked.name);
    let at = found.curvature.place();
    let largest = match checked.largest_nose_radius_mm {
        Some(largest) => {
            let largest = figures::millimetres(largest, 4);
            let (x, y) = (figures::millimetres(at.x, 3), figures::millimetres(at.y, 3));
            format!("at most {largest} (at x = {x}, y = {y})")
        }
        None => "any: the part has no hollow".to_owned(),
    };
    text += &figures::line(
        "nose radius",
        format!("{}; {largest}", figures::millimetres(tool.nose_radius, 4)),
    );
    let angle = |given: Option<f64>, least: f64| match given {
        Some(given) => format!("{:.2} deg; at least {least:.2} deg", given / DEG),
        None => format!("not given, check not made; it takes {least:.2} deg"),
    };
    let included = angle(tool.included_angle, checked.least_included_angle_deg);
    text += &figures::line("included angle", included);
    let clearance = angle(tool.clearance_angle, checked.least_clearance_angle_deg);
    text += &figures::line("clearance angle", clearance);
    if let Some(machine) = &checked.machine {
        text += &machine.lines(&job.recipe);
    }
    let expected = &checked.expected;
    let points = figures::grouped(expected.control_points as u64);
    text += &figures::line("points", format!("about {points}, before refinement"));
    text += &figures::line("revolutions", format!("{:.2}", expected.revolutions));
    text += &figures::line("cutting time", figures::duration(expected.cutting_time_s));
    let size = figures::bytes(expected.toolpath_bytes);
    text += &figures::line("toolpath.csv", format!("about {size}, before refinement"));
    for program in &expected.programs {
        let size = figures::bytes(program.bytes);
        text += &figures::line(
            "program",
            format!("about {size}, before refinement: {}", program.file),
        );
    }
    text
}
