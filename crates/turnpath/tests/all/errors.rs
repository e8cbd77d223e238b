//! Errors are data: whose fault they are, their places in the recipe, and their sources.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::error::Error as _;

use turnpath::{Catalogue, Error, Fault, Job};

use crate::support::recipe;

fn refused(sets: &[&str]) -> Error {
    match Job::new(recipe(sets), &Catalogue::linked().unwrap()) {
        Err(error) => error,
        Ok(_) => panic!("nothing was refused of {sets:?}"),
    }
}

#[test]
fn a_tool_that_does_not_fit_is_refused_with_its_place_and_its_source() {
    let error = refused(&["tool.nose_radius=50 mm"]);
    assert_eq!(error.fault(), Fault::Request);
    let [diagnostic] = error.diagnostics()[..] else {
        panic!("one diagnostic of {error}");
    };
    assert!(diagnostic.title().starts_with("the tool would gouge: "));
    let span = diagnostic.span().unwrap();
    assert_eq!(&span.source().text[span.range()], "50 mm");
    assert_eq!(error.title(), diagnostic.title());
    assert_eq!(error.source().unwrap().to_string(), "the tool would gouge");
}

#[test]
fn a_path_of_straight_lines_is_refused_before_the_work_where_a_program_is_asked_for() {
    let error = refused(&["velocity.use=linear"]);
    assert_eq!(error.fault(), Fault::Request);
    let title = error.title();
    assert!(
        title.contains("`pmac-pvt` cannot carry this path"),
        "{title}"
    );
}

#[test]
fn a_strategy_that_is_not_there_is_refused() {
    let error = refused(&["sampler.use=equal-angel"]);
    assert_eq!(error.fault(), Fault::Request);
    let help = error.diagnostics()[0].help().join("\n");
    assert!(help.contains("equal-angle"), "{help}");
}
