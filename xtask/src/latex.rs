//! The tables of the ablations as LaTeX compiles them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::commands::{command, repository, run, succeeds, target};
use crate::step::Outcome;

/// The ablations: the three papers' methods on two parts, and the fewest points.
const RECIPES: [&str; 3] = [
    "ablation-papers",
    "ablation-papers-mla-5",
    "ablation-fewest-points",
];
/// The package whose rules the tables have.
const PACKAGE: &str = "booktabs.sty";
/// What a log of LaTeX has where a letter was lost.
const LOST: &str = "Missing character";

/// Compiles the table of each ablation.
pub fn tables(program: impl FnOnce() -> Result<PathBuf, Outcome>) -> Outcome {
    if !succeeds(command("pdflatex", &["--version"])) {
        return Outcome::Skipped("`pdflatex` is not installed".to_owned());
    }
    if !succeeds(command("kpsewhich", &[PACKAGE])) {
        return Outcome::Skipped(format!("LaTeX has no {PACKAGE}"));
    }
    let program = match program() {
        Ok(program) => program,
        Err(outcome) => return outcome,
    };
    let outcomes = RECIPES.map(|recipe| compiled(&program, recipe));
    let mut failed = outcomes.into_iter().filter(|one| *one != Outcome::Passed);
    failed.next().unwrap_or(Outcome::Passed)
}

fn compiled(program: &Path, recipe: &str) -> Outcome {
    let folder = target().join("long").join("latex");
    let table = match table(program, recipe, &folder) {
        Ok(table) => table,
        Err(reason) => return Outcome::Failed(reason),
    };
    let text = format!(
        "\\documentclass{{article}}\n\\usepackage[utf8]{{inputenc}}\n\\usepackage{{booktabs}}\n\
         \\begin{{document}}\n\\scriptsize\\noindent\n{table}\\end{{document}}\n"
    );
    let file = folder.join(format!("{recipe}.tex"));
    if let Err(error) = fs::write(&file, text) {
        return Outcome::Failed(format!("{}: {error}", file.display()));
    }
    let mut latex = command("pdflatex", &["-halt-on-error", "-interaction=nonstopmode"]);
    latex.arg("-output-directory").args([&folder, &file]);
    match run(latex) {
        Outcome::Passed => whole(&file.with_extension("log")),
        failed => failed,
    }
}

/// The table that the program prints.
fn table(program: &Path, recipe: &str, folder: &Path) -> Result<String, String> {
    let recipe_file = format!("docs/recipes/{recipe}.toml");
    let answer = Command::new(program)
        .current_dir(repository())
        .args(["ablate", &recipe_file, "--table", "latex"])
        .args(["--columns", "points,time,error-max,residual,z-acceleration"])
        .arg("-o")
        .arg(folder.join(recipe))
        .stderr(Stdio::inherit())
        .output();
    let answer = answer.map_err(|error| error.to_string())?;
    if !answer.status.success() {
        return Err(format!("the ablation of {recipe_file} failed"));
    }
    String::from_utf8(answer.stdout).map_err(|error| error.to_string())
}

/// LaTeX leaves out letters that its fonts do not have, and is content.
fn whole(log: &Path) -> Outcome {
    match fs::read(log) {
        Ok(bytes) if String::from_utf8_lossy(&bytes).contains(LOST) => {
            Outcome::Failed(format!("{}: a letter is missing", log.display()))
        }
        Ok(_) => Outcome::Passed,
        Err(error) => Outcome::Failed(format!("{}: {error}", log.display())),
    }
}
