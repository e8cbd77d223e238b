//! docs/telescope-mirror.md: its commands are called in their order, and print what is quoted.
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

use std::fs;

use crate::support::bench::Bench;
use crate::support::repository;

/// The blocks of a page that show a console: each a command and what it prints.
fn console(page: &str) -> Vec<(&str, &str)> {
    let blocks = page.split("```console\n$ turnpath ").skip(1);
    blocks
        .map(|rest| {
            let (block, _) = rest.split_once("```").expect("the end of the block");
            block.split_once('\n').expect("a command")
        })
        .collect()
}

#[test]
fn the_commands_of_the_telescope_mirror_print_what_the_page_quotes() {
    let docs = repository().join("docs");
    let page = fs::read_to_string(docs.join("telescope-mirror.md")).expect("the page");
    let bench = Bench::empty();
    for file in ["telescope-mirror.zmx", "telescope-mirror.DAT"] {
        fs::copy(docs.join("recipes").join(file), bench.path(file)).expect("a file");
    }
    let commands = console(&page);
    assert_eq!(commands.len(), 5);
    for (command, quoted) in commands {
        // Words with brackets stand in the quotes of a shell; none has a blank.
        let said = bench.line(&command.replace('\'', "")).ends(0);
        assert_eq!(
            format!("{}{}", said.stdout, said.stderr),
            quoted,
            "{command}"
        );
    }
    let (_, recipe) = page.split_once("```toml\n").expect("the recipe");
    let (recipe, _) = recipe.split_once("```").expect("its end");
    assert!(bench.read("mirror.toml").starts_with(recipe), "{recipe}");
    assert!(bench.read("out/mirror.pmc").contains("PVT"));
    assert!(bench.read("out/mirror-dry-run.pmc").contains("C = 270 deg"));
}
