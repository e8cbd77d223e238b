//! README.md quotes what the program prints.

use std::fs;

use crate::support::bench::Bench;
use crate::support::repository;

/// The text between two fences, the first that begins with this line.
fn quoted<'a>(readme: &'a str, first_line: &str) -> Option<&'a str> {
    let begin = readme.find(&format!("```\n{first_line}\n"))?;
    let (block, _) = readme.get(begin + 4..)?.split_once("```")?;
    Some(block)
}

/// The first recipe that the text names.
fn first_recipe(readme: &str) -> Option<&str> {
    let begin = readme.find("docs/recipes/")?;
    let rest = readme.get(begin..)?;
    let end = rest.find(".toml")?;
    rest.get(..end + ".toml".len())
}

/// The program's text, with the names of files in place of their paths.
fn with_names(said: &str) -> Vec<&str> {
    let name = |line: &'_ str| -> usize {
        let path = line.starts_with("  file ").then(|| line.rfind('/'));
        path.flatten().map_or(0, |slash| slash + 1)
    };
    said.lines().map(|line| &line[name(line)..]).collect()
}

#[test]
fn the_quoted_run_of_the_first_recipe_is_what_the_program_prints() {
    let readme = fs::read_to_string(repository().join("README.md")).expect("README.md");
    let recipe = repository().join(first_recipe(&readme).expect("a recipe is named"));
    let said = Bench::empty().call(["run".as_ref(), recipe.as_os_str()]);
    let said = said.ends(0).stdout;
    let name = said.lines().next().expect("the recipe's name");
    let quoted = quoted(&readme, name).expect("a block that begins with the recipe's name");
    assert_eq!(with_names(quoted), with_names(&said));
}
