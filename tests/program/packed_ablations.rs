//! A folder that `ablate --pack` writes: all that the runs need, on another machine.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::support::bench::Bench;
use crate::support::fixtures::{file_name, library};
use crate::support::recipe::{changed, saddle_with};

/// Two maps, and a sampler for a row of its own.
const LISTS: &str = "
[ablation]
mode = \"one-at-a-time\"
surface.file = [\"./other.txt\"]
velocity = [{ use = \"three-point\" }]
";

fn recipe() -> String {
    saddle_with("surface", "use = \"bowl-file\"\nfile = \"maps/bowl.txt\"") + LISTS
}

/// A folder `lab` with the recipe, its data and its plugins.
fn bench(recipe: &str) -> Bench {
    let bench = Bench::empty();
    fs::create_dir_all(bench.path("lab/maps")).unwrap();
    fs::create_dir(bench.path("plugins")).unwrap();
    bench.write("lab/recipe.toml", recipe);
    bench.write("lab/maps/bowl.txt", "-0.02\n");
    bench.write("lab/other.txt", "-0.03\n");
    let copy = bench.path("plugins").join(file_name("bowl-file"));
    fs::copy(library("bowl-file"), copy).unwrap();
    bench
}

fn keys(plan: &str) -> Vec<String> {
    let plan: Value = serde_json::from_str(plan).unwrap();
    let runs = plan["runs"].as_array().unwrap().iter();
    runs.map(|run| run["key"].as_str().unwrap().to_owned())
        .collect()
}

fn table(bench: &Bench, file: &str) -> Value {
    let mut table: Value = serde_json::from_str(&bench.read(file)).unwrap();
    for run in table["runs"].as_array_mut().unwrap() {
        for key in ["planning_time_s", "measuring_time_s"] {
            run.as_object_mut().unwrap().remove(key);
        }
    }
    table
}

#[test]
fn a_packed_folder_gives_the_table_when_all_else_is_gone() {
    let bench = bench(&recipe());
    let from = "ablate lab/recipe.toml --plugin-dir plugins";
    bench.line(&format!("{from} -o whole")).ends(0);
    let said = bench.line(&format!("{from} --pack there/packed")).ends(0);
    let files = [
        "maps/bowl.txt",
        "other.txt",
        "plan.json",
        "plugins.lock",
        "recipe.toml",
    ];
    for file in files {
        assert!(bench.path("there/packed").join(file).is_file(), "{file}");
        assert!(said.stdout.contains(file), "{said}");
    }
    // It is carried away, and what it was made from is gone.
    fs::rename(bench.path("there/packed"), bench.path("carried")).unwrap();
    for folder in ["lab", "plugins", "there"] {
        fs::remove_dir_all(bench.path(folder)).unwrap();
    }
    let planned = keys(&bench.read("carried/plan.json"));
    let with = "--plugin-dir carried/plugins --plugins-lock carried/plugins.lock";
    for key in &planned {
        let line = format!("ablate carried/recipe.toml {with} -o carried --only {key}");
        bench.line(&line).ends(0);
    }
    bench
        .line(&format!(
            "ablate carried/recipe.toml {with} -o carried --merge"
        ))
        .ends(0);
    let (own, whole) = ["carried/ablation.json", "whole/ablation.json"]
        .map(|file| table(&bench, file))
        .into();
    let without_paths = |mut table: Value| {
        for run in table["runs"].as_array_mut().unwrap() {
            run["plugins"] = Value::Null;
        }
        table
    };
    assert_eq!(without_paths(own), without_paths(whole));
}

#[test]
fn a_recipe_that_lists_its_plugins_has_them_where_it_lists_them() {
    let library = file_name("bowl-file");
    let listed = format!("plugins = [\"own\"]\n{}", recipe());
    let bench = bench(&listed);
    fs::create_dir(bench.path("lab/own")).unwrap();
    fs::rename(
        bench.path("plugins").join(&library),
        bench.path("lab/own").join(&library),
    )
    .unwrap();
    bench
        .line("ablate lab/recipe.toml --trust-recipe --pack packed")
        .ends(0);
    assert!(bench.path("packed/own").join(&library).is_file());
    assert!(!bench.path("packed/plugins").exists());
    let plan = "ablate packed/recipe.toml --trust-recipe --plan";
    let again = bench.line(plan).ends(0);
    assert_eq!(keys(&again.stdout), keys(&bench.read("packed/plan.json")));
}

#[test]
fn what_cannot_travel_is_refused_and_leaves_nothing() {
    for (from, to, rest, says) in [
        (
            "maps/bowl.txt",
            "../lab/maps/bowl.txt",
            "",
            "`../lab/maps/bowl.txt` is not below the recipe's folder",
        ),
        ("maps", "maps", "--set refine=true", "the call changes"),
        ("three-point", "three-points", "", "three-point"),
    ] {
        let bench = bench(&changed(&recipe(), from, to));
        let line = format!("ablate lab/recipe.toml --plugin-dir plugins --pack packed {rest}");
        let said = bench.line(line.trim()).ends(2);
        assert!(said.stderr.contains(says), "{said}");
        assert!(!bench.path("packed").exists(), "{to}");
    }
}

#[test]
fn a_folder_with_files_in_it_is_left_as_it_is() {
    let bench = bench(&recipe());
    fs::create_dir(bench.path("packed")).unwrap();
    let line = "ablate lab/recipe.toml --plugin-dir plugins --pack packed";
    // An empty one is taken.
    bench.line(line).ends(0);
    let said = bench.line(line).ends(2);
    assert!(said.stderr.contains("packed is not empty"), "{said}");
    let recipe = bench.path("packed").join(Path::new("recipe.toml"));
    assert!(recipe.is_file());
}
