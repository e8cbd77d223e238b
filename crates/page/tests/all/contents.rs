//! What a page has, and what it must not have.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::Value;
use sha2::{Digest, Sha256};
use turnpath_page::{AblationPage, RunPage, ablation_page, run_page};
use turnpath_report::{AblationRun, FailedRun, RunOutcome};

use crate::support;

/// Texts that would end an element, an attribute or a script.
const HARMFUL: &str = "</script><b onclick='x()'>\"&amp;<!--</title></pre>";

const DATA: &str = "<script type=\"application/json\" id=\"data\">";
const SCRIPT: &str = "<script>";
const END: &str = "</script>";

/// The data of a page.
fn data(page: &str) -> Value {
    let (_, after) = page.split_once(DATA).expect("the data");
    let (data, _) = after.split_once(END).expect("the end of the data");
    serde_json::from_str(data).expect("JSON")
}

/// The scripts that a page runs.
fn scripts(page: &str) -> Vec<&str> {
    let scripts = page.split(SCRIPT).skip(1);
    scripts
        .map(|script| script.split_once(END).expect("an end").0)
        .collect()
}

/// A page without its scripts.
fn without_scripts(page: &str) -> String {
    let scripts = scripts(page);
    scripts
        .iter()
        .fold(page.to_owned(), |page, script| page.replace(script, ""))
}

fn harmful_run() -> RunPage {
    let mut page = support::run_page();
    page.report.name = HARMFUL.to_owned();
    page.recipe = Some(HARMFUL.to_owned());
    let stage = &mut page.chain[0];
    let texts = [&mut stage.name, &mut stage.summary, &mut stage.source];
    for text in texts.into_iter().chain([
        &mut stage.parameters[0].1,
        &mut page.report.turnpath,
        &mut page.report.plugins[0].name,
    ]) {
        HARMFUL.clone_into(text);
    }
    if let Some(recipe) = &mut page.report.recipe {
        HARMFUL.clone_into(&mut recipe.file);
        recipe.sets = vec![HARMFUL.to_owned()];
    }
    for file in page.report.files.iter_mut().flatten() {
        HARMFUL.clone_into(&mut file.file);
    }
    page
}

fn is_harmless(page: &str) {
    // Two scripts and the data.
    assert_eq!(
        (scripts(page).len(), page.matches("<script").count()),
        (2, 3)
    );
    let text = without_scripts(page);
    assert!(!text.contains("<b ") && !text.contains("<!--"));
    // In the data a quote is a letter like any other.
    let (before, after) = text.split_once(DATA).expect("the data");
    let (_, after) = after.split_once(END).expect("the end of the data");
    assert!(!before.contains("onclick='") && !after.contains("onclick='"));
    assert!(text.contains("&lt;/script&gt;&lt;b onclick=&#39;x()&#39;&gt;"));
}

#[test]
fn texts_of_a_recipe_do_no_harm_in_the_page_of_a_run() {
    let page = run_page(&harmful_run());
    is_harmless(&page);
    assert_eq!(data(&page)["report"]["name"], HARMFUL);
}

#[test]
fn texts_of_a_recipe_do_no_harm_in_the_page_of_an_ablation() {
    let mut report = support::ablation(2);
    for run in &mut report.runs {
        run.varied = vec![(HARMFUL.to_owned(), HARMFUL.to_owned())];
        if let RunOutcome::Measured(run) = &mut run.outcome {
            HARMFUL.clone_into(&mut run.report.name);
        }
    }
    let failed = FailedRun {
        chain: support::report().chain,
        error: HARMFUL.to_owned(),
    };
    report.runs.push(AblationRun {
        outcome: RunOutcome::Failed(failed),
        varied: vec![(HARMFUL.to_owned(), HARMFUL.to_owned())],
        not_recorded: Some(HARMFUL.to_owned()),
    });
    let page = ablation_page(&AblationPage { report });
    is_harmless(&page);
    assert_eq!(data(&page)["runs"][1]["name"], HARMFUL);
}

#[test]
fn a_page_loads_nothing_and_runs_its_own_scripts_alone() {
    let run = run_page(&support::run_page());
    let report = support::ablation(2);
    let ablation = ablation_page(&AblationPage { report });
    for page in [run, ablation] {
        let text = without_scripts(&page);
        for loader in [
            "src=", "<link", "@import", "url(", "<iframe", "<img", "http:", "srcset",
        ] {
            assert!(!text.contains(loader), "{loader}");
        }
        // Links lead to the sources of methods, and load nothing.
        let doi = "<a href=\"https://doi.org/";
        assert_eq!(text.matches("https:").count(), text.matches(doi).count());
        let hashes = scripts(&page).into_iter();
        let hashes = hashes.map(|script| STANDARD.encode(Sha256::digest(script)));
        let hashes: Vec<String> = hashes.map(|hash| format!("'sha256-{hash}'")).collect();
        let policy = format!("default-src 'none'; script-src {};", hashes.join(" "));
        assert!(text.contains(&policy), "{policy}");
    }
}

#[test]
fn the_same_data_give_the_same_page() {
    let page = support::run_page();
    assert_eq!(run_page(&page), run_page(&page.clone()));
    let text = serde_json::to_string(&page).unwrap();
    let read: RunPage = serde_json::from_str(&text).unwrap();
    assert_eq!(run_page(&read), run_page(&page));
}

#[test]
fn the_verdict_stands_first_and_says_what_fails() {
    let mut page = support::run_page();
    let holds = run_page(&page);
    assert!(holds.contains("<p class=\"verdict holds\">All tolerances and limits hold.</p>"));
    page.report.path.tolerance.residual = Some(1e-9);
    page.report = page.report.with_verdict();
    let exceeded = run_page(&page);
    let sentence = "<p class=\"verdict exceeded\">EXCEEDED: residual, coverage.</p>";
    let verdict = exceeded.find(sentence).expect("a verdict");
    assert!(verdict < exceeded.find("<h2>").expect("a section"));
}

#[test]
fn warnings_stand_beside_the_verdict() {
    let mut page = support::run_page();
    assert!(!run_page(&page).contains("class=\"warnings\""));
    page.report.path.axis_crossing.x = 0.585;
    let text = run_page(&page);
    let warning = text
        .find("<li>X crosses the axis by 585")
        .expect("a warning");
    assert!(warning < text.find("<h2>").expect("a section"));
    assert!(text.contains("<td>1 program</td>"));
}

#[test]
fn a_page_without_a_sketch_says_so_and_has_the_surface() {
    let mut page = support::run_page();
    page.sketch = None;
    let text = run_page(&page);
    assert!(text.contains("wrote no file of its path"));
    assert!(text.contains("id=\"surface\"") && !text.contains("id=\"error-map\""));
    assert!(data(&text)["sketch"].is_null());
}

#[test]
fn a_run_that_failed_is_a_row_with_its_reason() {
    let mut report = support::ablation(2);
    report.runs[1].outcome = RunOutcome::Failed(FailedRun {
        chain: support::report().chain,
        error: "the tool gouges".to_owned(),
    });
    let page = ablation_page(&AblationPage { report });
    assert!(page.contains("2 runs, 1 failed") && page.contains(">failed: the tool gouges</td>"));
    assert_eq!(data(&page)["runs"].as_array().unwrap().len(), 1);
}

#[test]
fn a_run_without_a_record_is_told_with_its_reason() {
    let mut report = support::ablation(3);
    for run in &mut report.runs[1..] {
        run.not_recorded = Some("its surface is < new".to_owned());
    }
    let page = ablation_page(&AblationPage { report });
    let told = "<p>2 runs have no record, and are made each time: its surface is &lt; new</p>";
    assert!(page.contains(told));
}

#[test]
fn the_axes_of_each_file_stand_on_the_page_as_its_program_has_them() {
    let page = run_page(&support::run_page());
    assert!(page.contains("<td>a.pmc</td>"));
    assert!(page.contains("+ turns the part anticlockwise, seen from the tool"));
}

/// The real summary has limits of the machine.
#[test]
fn each_limit_has_a_row_with_what_was_found() {
    let report = support::report();
    let machine = report.path.machine.as_ref().expect("limits");
    let page = run_page(&support::run_page());
    for figure in machine
        .limits
        .iter()
        .filter(|figure| figure.measured.is_some())
    {
        let name = turnpath_report::text::limit_name(figure.limit.axis, figure.limit.derivative);
        let row = format!("<tr><td>{name}</td><td>");
        assert!(page.contains(&row), "{name}");
    }
}

/// A reader of the page sees the whole chain, and what of it the recipe says.
#[test]
fn the_chain_has_the_parameters_of_the_recipe_and_the_defaults_of_the_rest() {
    let page = run_page(&support::run_page());
    assert!(page.contains("feed = &quot;10 um/rev&quot;<br>at_least = 50 (default)"));
}
