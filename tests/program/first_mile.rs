//! The first mile: a recipe to begin with, the schema, completions, manual pages, lists for scripts.

use std::process::{Command, Stdio};

use serde_json::Value;
use turnpath::{Catalogue, Slot};

use crate::support::bench::Bench;
use crate::support::recipe::{SADDLE, changed};

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

#[test]
fn init_and_run_hold_in_an_empty_folder() {
    let bench = Bench::empty();
    bench.line("init").ends(0);
    let said = bench.line("run").ends(0);
    assert!(!said.stdout.contains("EXCEEDED"), "{said}");
    assert!(bench.path("out/My first part/recipe.pmc").exists());
    // The one file that may be a person's own is kept.
    let said = bench.line("init").ends(2);
    assert!(said.stderr.contains("--force"), "{said}");
    bench.line("init --force").ends(0);
}

#[test]
fn without_a_recipe_the_program_says_how_to_get_one() {
    let said = Bench::empty().line("run").ends(2);
    assert!(said.stderr.contains("turnpath init"), "{said}");
}

#[test]
fn a_recipe_on_standard_input_makes_the_same_path() {
    let bench = Bench::with(SADDLE);
    bench.line("run recipe.toml -o file").ends(0);
    let mut command = bench.command(["run", "-", "-o", "input"]);
    command.stdin(Stdio::piped());
    let mut child = command.stdout(Stdio::null()).spawn().unwrap();
    let mut input = child.stdin.take().unwrap();
    std::io::Write::write_all(&mut input, SADDLE.as_bytes()).unwrap();
    drop(input);
    assert!(child.wait().unwrap().success());
    let path = |folder: &str| bench.read(format!("{folder}/toolpath.csv"));
    assert_eq!(path("file"), path("input"));
}

#[test]
fn quiet_prints_nothing_and_verbose_the_time_of_each_stage() {
    let bench = Bench::with(SADDLE);
    let said = bench.line("run recipe.toml --quiet").ends(0);
    assert!(said.stdout.is_empty() && said.stderr.is_empty(), "{said}");
    let said = bench.line("run recipe.toml -v").ends(0);
    for stage in [
        "planning the feed: ",
        "measuring and writing: ",
        "counted: ",
    ] {
        assert!(said.stderr.contains(stage), "{said}");
    }
    let said = bench.line("check recipe.toml -v").ends(0);
    for stage in ["planning the feed: ", "making a sample of the path: "] {
        assert!(said.stderr.contains(stage), "{said}");
    }
}

/// The schema has every strategy with its parameters, and the tables of the host.
#[test]
fn the_schema_has_each_strategy_and_each_table() {
    let schema = json(&Bench::empty().line("schema").ends(0).stdout);
    let catalogue = Catalogue::linked().unwrap();
    for strategy in catalogue.strategies() {
        let info = strategy.info();
        let of_slot = schema["definitions"][info.slot.key()]["allOf"].as_array();
        let own = of_slot
            .unwrap()
            .iter()
            .find(|one| one["then"]["properties"]["use"]["const"].as_str() == Some(info.name));
        let own = own.unwrap_or_else(|| panic!("{} is not there", info.name));
        for param in info.params {
            let declared = &own["then"]["properties"][param.name];
            let help = declared["description"].as_str().unwrap_or_default();
            assert!(help.starts_with(param.help), "{}.{}", info.name, param.name);
        }
    }
    for table in turnpath::tables().filter(|table| !table.name.is_empty()) {
        let mut at = &schema;
        for name in table.name.split('.') {
            at = &at["properties"][name];
        }
        let is_slot = Slot::ALL.iter().any(|slot| slot.key() == table.name);
        assert!(is_slot || at["type"] == "object", "{}", table.name);
    }
    assert!(
        schema["required"]
            .as_array()
            .unwrap()
            .contains(&"part".into())
    );
}

#[test]
fn each_shell_has_its_completions_and_each_command_its_page() {
    let bench = Bench::empty();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = bench.call(["completions", shell]).ends(0).stdout;
        for word in ["ablate", "plugin-dir"] {
            assert!(script.contains(word), "{shell}");
        }
    }
    bench.line("man pages").ends(0);
    let page = bench.read("pages/turnpath-run.1");
    assert!(page.contains(r"\-\-dry\-run"), "{page}");
}

#[test]
fn bash_reads_its_completions() {
    let bench = Bench::empty();
    let script = bench.call(["completions", "bash"]).ends(0).stdout;
    let read = Command::new("bash").args(["-n", "-c", &script]).status();
    // A machine without bash has nothing to check.
    assert!(read.is_err() || read.is_ok_and(|status| status.success()));
}

#[test]
fn a_list_for_scripts_has_what_explain_says() {
    let bench = Bench::empty();
    let list = json(&bench.line("list sampler --format json").ends(0).stdout);
    let strategies = list["strategies"].as_array().unwrap();
    let atpg = strategies.iter().find(|one| one["name"] == "atpg").unwrap();
    assert_eq!(atpg["slot"], "sampler");
    assert!(strategies.iter().all(|one| one["slot"] == "sampler"));
    let explained = bench.line("explain sampler/atpg").ends(0).stdout;
    for param in atpg["params"].as_array().unwrap() {
        let name = param["name"].as_str().unwrap();
        assert!(explained.contains(&format!("{name} = {}", param["kind"].as_str().unwrap())));
    }
}

#[test]
fn all_strategies_that_are_misspelt_are_named_in_one_go() {
    let recipe = changed(SADDLE, "\"equal-angle\"", "\"Equal_Angle\"");
    let recipe = changed(&recipe, "\"z-direction\"", "\"zdirection\"");
    let said = Bench::with(&recipe).line("run recipe.toml").ends(2);
    for name in ["equal-angle", "z-direction"] {
        let hint = format!("did you mean `{name}`?");
        assert!(said.stderr.contains(&hint), "{said}");
    }
    assert!(said.stderr.contains("--plugin-dir DIR"), "{said}");
    let said = Bench::empty().line("explain ATPG").ends(2);
    assert!(said.stderr.contains("did you mean `atpg`?"), "{said}");
}
