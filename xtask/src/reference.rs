//! `cargo xtask reference`: the figures under `tests/reference`, docs/reproduction.md and the
//! tables of docs/recipe.md and docs/measuring.md, made again.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::commands::{cargo, command, repository, run, target};
use crate::long::program;
use crate::python::{script, with_packages};
use crate::step::{Outcome, Step};

/// A script that prints one file of figures.
struct Figures {
    name: &'static str,
    packages: &'static [&'static str],
}

const FIGURES: [Figures; 10] = [
    figures("compensators", &["mpmath"]),
    figures("dropcutter", &["numpy", "opencamlib"]),
    figures("poses", &["mpmath"]),
    figures("series", &["mpmath"]),
    figures("splines", &["numpy", "scipy"]),
    figures("surfaces", &["mpmath"]),
    figures("surfaces/composites", &["mpmath"]),
    figures("surfaces/formula", &["mpmath"]),
    figures("surfaces/series", &["mpmath"]),
    figures("surfaces/values", &["numpy", "optiland", "prysm", "scipy"]),
];

const fn figures(name: &'static str, packages: &'static [&'static str]) -> Figures {
    Figures { name, packages }
}

/// What makes figures.
type Make = fn() -> Outcome;

/// What needs the program or a test of it.
const GRIDS: &str = "grids";
const MAPS: &str = "maps";
const PLAYBACK: &str = "playback";
const PMAC: &str = "pmac";
const RIMS: &str = "rims";
const SPOKES: &str = "spokes";
const REPRODUCTION: &str = "reproduction";
/// The tables of docs/recipe.md.
const RECIPE: &str = "recipe";
/// The table of docs/measuring.md.
const SPOILS: &str = "spoils";

/// Makes the figures of these names, or all; an unknown name is an error.
pub fn run_named(names: &[&str]) -> Result<Vec<Step>, String> {
    let own = FIGURES.iter().map(|figures| figures.name);
    let known: Vec<&str> = own
        .chain([
            GRIDS,
            MAPS,
            PLAYBACK,
            PMAC,
            RIMS,
            REPRODUCTION,
            RECIPE,
            SPOILS,
            SPOKES,
        ])
        .collect();
    if let Some(unknown) = names.iter().find(|name| !known.contains(name)) {
        return Err(format!(
            "there are no reference figures `{unknown}`; there are {}",
            known.join(", ")
        ));
    }
    // A folder's name stands for all figures in it.
    let folder = |name: &str| {
        name.split_once('/')
            .is_some_and(|(of, _)| names.contains(&of))
    };
    let chosen = |name: &str| names.is_empty() || names.contains(&name) || folder(name);
    let mut steps = Vec::new();
    for figures in FIGURES.iter().filter(|figures| chosen(figures.name)) {
        steps.push(Step::run(figures.name, || {
            with_packages(figures.packages, || figures.make())
        }));
    }
    let steps_of_the_program: [(&str, Make); 9] = [
        (GRIDS, || {
            with_packages(&["mpmath", "numpy", "prysm", "scipy"], grids)
        }),
        (MAPS, || with_packages(&["numpy"], maps)),
        (PLAYBACK, || with_packages(&["numpy"], playback)),
        (PMAC, || with_packages(&["numpy"], pmac)),
        (RIMS, || with_packages(&["numpy"], rims)),
        (REPRODUCTION, reproduction),
        (RECIPE, recipe),
        (SPOILS, spoils),
        (SPOKES, || with_packages(&["numpy"], spokes)),
    ];
    for (name, make) in steps_of_the_program {
        if chosen(name) {
            steps.push(Step::run(name, make));
        }
    }
    Ok(steps)
}

impl Figures {
    fn make(&self) -> Outcome {
        let folder = Path::new("tests/reference");
        let file = folder.join(format!("{}.json", self.name));
        write(
            script(&format!("tests/reference/{}.py", self.name), &[]),
            &file,
        )
    }
}

/// Keeps what a command prints in a file of the repository. The file changes only if the command
/// succeeds.
fn write(mut command: Command, file: &Path) -> Outcome {
    let draft = target().join("reference-draft");
    let written = fs::create_dir_all(target()).and_then(|()| File::create(&draft));
    let outcome = match written {
        Ok(output) => {
            command.stdout(output);
            run(command)
        }
        Err(error) => Outcome::Failed(format!("{}: {error}", draft.display())),
    };
    if outcome != Outcome::Passed {
        return outcome;
    }
    match fs::copy(&draft, repository().join(file)) {
        Ok(_) => Outcome::Passed,
        Err(error) => Outcome::Failed(format!("{}: {error}", file.display())),
    }
}

/// What playback.py measures on the path of every recipe.
fn playback() -> Outcome {
    let made = program().and_then(|program| Ok((program, plugins()?)));
    let (program, plugins) = match made {
        Ok(made) => made,
        Err(outcome) => return outcome,
    };
    let mut call = script("tests/reference/playback/measure_all.py", &[&program]);
    call.arg("--plugins").arg(plugins);
    let outcome = run(call);
    if outcome != Outcome::Passed {
        return outcome;
    }
    run(script(
        "tests/reference/playback/measure_fewest.py",
        &[&program],
    ))
}

/// The small maps of every format, and the splines through grids.
fn grids() -> Outcome {
    let outcome = run(script("tests/reference/grids/files.py", &[]));
    if outcome != Outcome::Passed {
        return outcome;
    }
    let splines = script("tests/reference/grids/splines.py", &[]);
    write(splines, Path::new("tests/reference/grids/splines.json"))
}

/// The path over grids of known surfaces, and a part that is corrected by its own error.
fn maps() -> Outcome {
    let program = match program() {
        Ok(program) => program,
        Err(outcome) => return outcome,
    };
    let outcome = run(script("tests/reference/grids/accuracy.py", &[&program]));
    if outcome != Outcome::Passed {
        return outcome;
    }
    run(script("tests/reference/grids/correction.py", &[&program]))
}

/// What rims.py measures at the rims of steep caps.
fn rims() -> Outcome {
    match program() {
        Ok(program) => run(script("tests/reference/rims/rims.py", &[&program])),
        Err(outcome) => outcome,
    }
}

/// What spokes.py measures on paths whose steps wander and do not.
fn spokes() -> Outcome {
    match program() {
        Ok(program) => run(script("tests/reference/spokes/spokes.py", &[&program])),
        Err(outcome) => outcome,
    }
}

/// A folder with the library of the fixture that some recipes use.
fn plugins() -> Result<PathBuf, Outcome> {
    let built = target().join("fixtures");
    let mut call = cargo(&[
        "build",
        "--locked",
        "--manifest-path",
        "tests/fixtures/Cargo.toml",
        "--package",
        "two-speeds",
        "--target-dir",
    ]);
    call.arg(&built).env("CARGO_BUILD_BUILD_DIR", target());
    match run(call) {
        Outcome::Passed => {}
        failed => return Err(failed),
    }
    let (prefix, suffix) = (std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let name = format!("{prefix}two_speeds{suffix}");
    let folder = target().join("reference-plugins");
    let copied = fs::create_dir_all(&folder)
        .and_then(|()| fs::copy(built.join("debug").join(&name), folder.join(&name)));
    match copied {
        Ok(_) => Ok(folder),
        Err(error) => Err(Outcome::Failed(format!("{name}: {error}"))),
    }
}

/// What read_pmac.py reads of a program.
fn pmac() -> Outcome {
    let program = match program() {
        Ok(program) => program,
        Err(outcome) => return outcome,
    };
    let folder = target().join("reference-pmac");
    let recipe = Path::new("tests/reference/pmac/ast-5.toml");
    let mut call = command(&program, &["run"]);
    call.arg(recipe).arg("-o").arg(&folder);
    let outcome = run(call);
    if outcome != Outcome::Passed {
        return outcome;
    }
    let files = [folder.join("ast-5.pmc"), folder.join("toolpath.csv")];
    let read = script(
        "tests/reference/pmac/read_pmac.py",
        &[recipe, &files[0], &files[1]],
    );
    write(read, Path::new("tests/reference/pmac/ast-5.json"))
}

/// The tables of docs/recipe.md from the declarations of their keys.
fn recipe() -> Outcome {
    let words = ["test", "--locked", "--package", "turnpath-recipe", "--lib"];
    let mut tests = cargo(&words);
    tests
        .args(["--", "docs_recipe_md"])
        .env("RECIPE_PAGE", "write");
    run(tests)
}

/// The table of docs/measuring.md: which faults of spoiled files `verify` finds.
fn spoils() -> Outcome {
    let words = ["test", "--locked", "--workspace", "--test", "figures"];
    let mut tests = cargo(&words);
    tests
        .args(["--", "spoils::every_spoil"])
        .env("SPOILS_PAGE", "write");
    run(tests)
}

/// docs/reproduction.md from docs/reproduction.toml. The step fails where a figure leaves its bound.
fn reproduction() -> Outcome {
    let words = [
        "test",
        "--locked",
        "--workspace",
        "--release",
        "--test",
        "papers",
    ];
    let mut tests = cargo(&words);
    tests
        .args(["--", "--ignored", "reproduction::long_the_page"])
        .env("REPRODUCTION", "write");
    run(tests)
}
