//! `turnpath check`: everything but the path.

use serde::Serialize;
use turnpath_pipeline::{expect, largest_nose};

use crate::args::{CheckArgs, Format};
use crate::interference::Report;
use crate::job::{Job, of_pipeline};
use crate::machine::MachineAsked;
use crate::programs::asked;
use crate::run::print;
use crate::summary::to_json;
use crate::unreached::Unreached;
use crate::{Done, Verdict, figures};

/// Bytes that a row of `toolpath.csv` takes, give or take a tenth: seven doubles and a digit.
const ROW_BYTES: f64 = 125.0;

#[derive(Debug, Serialize)]
struct Checked {
    name: String,
    #[serde(flatten)]
    interference: Report,
    /// Limits that the path will be held against; null without any.
    machine: Option<MachineAsked>,
    unreached: Option<Unreached>,
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
    let radius = job.prepared.task.range.outer;
    let nose = largest_nose(&job.chain, &job.prepared);
    let nose = nose.map_err(|e| of_pipeline(&job.recipe, e))?;
    let checked = Checked {
        name: job.recipe.name.clone(),
        interference: Report::new(&job.prepared, &nose),
        machine: MachineAsked::new(&job.recipe),
        unreached: Unreached::of_job(&job)?,
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
        Format::Human => human(&job, &checked),
    })?;
    Ok(Verdict::Holds)
}

fn human(job: &Job, checked: &Checked) -> String {
    let mut text = format!("{}\n", checked.name);
    text += &checked.interference.lines();
    if let Some(unreached) = &checked.unreached {
        text += &unreached.lines();
    }
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
