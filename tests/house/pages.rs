//! The pages agree with the program on strategies, options and links. The tests of the recipe crate
//! check the keys of docs/recipe.md that belong to no strategy.
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

use std::fs;
use std::path::PathBuf;

use crate::support::bench::Bench;
use crate::support::repository;

const SLOTS: [&str; 5] = ["surface", "feed", "sampler", "compensator", "velocity"];

const COMMANDS: [&str; 14] = [
    "run",
    "check",
    "ablate",
    "verify",
    "sag",
    "import",
    "report",
    "list",
    "explain",
    "new-plugin",
    "init",
    "schema",
    "completions",
    "man",
];

fn page(name: &str) -> String {
    fs::read_to_string(repository().join(name)).expect("a page")
}

/// README.md and its neighbours, all of docs/, and the decisions.
fn pages() -> Vec<PathBuf> {
    let folders = ["", "docs", "docs/decisions"].map(|folder| repository().join(folder));
    let files = folders.iter().flat_map(|folder| {
        let entries = fs::read_dir(folder).expect("a folder of pages");
        entries.map(|entry| entry.expect("a file").path())
    });
    let mut pages: Vec<PathBuf> = files
        .filter(|path| path.extension().is_some_and(|end| end == "md"))
        .collect();
    pages.sort();
    pages
}

/// The first block of code in this language.
fn first_block<'a>(page: &'a str, language: &str) -> &'a str {
    let (_, rest) = page
        .split_once(&format!("```{language}\n"))
        .expect("a block of code");
    rest.split_once("```").expect("its end").0
}

/// The text below a heading, up to the next heading of any rank.
fn below<'a>(page: &'a str, heading: &str) -> &'a str {
    let (_, rest) = page
        .split_once(&format!("\n{heading}\n"))
        .expect("the heading");
    rest.split_once("\n##").map_or(rest, |(section, _)| section)
}

fn strategies(slot: &str) -> Vec<String> {
    let said = Bench::empty().call(["list", slot]).ends(0);
    let lines = said
        .stdout
        .lines()
        .filter_map(|line| line.strip_prefix("  "));
    let name = |line: &str| line.split(' ').next().expect("a name").to_owned();
    lines.map(name).collect()
}

/// Names of parameters, each with its defaults and limits in words.
fn parameters(slot: &str, name: &str) -> Vec<(String, String)> {
    let said = Bench::empty().call(["explain", &format!("{slot}/{name}")]);
    let said = said.ends(0).stdout;
    // What every surface takes has a table of its own.
    let own = said.split("\n\n  every surface takes:").next();
    let blocks = own.expect("a part").split("\n\n").skip(2);
    blocks
        .map(|block| {
            let lines: Vec<&str> = block.trim_end().lines().collect();
            let (key, _) = lines[0].split_once(" = ").expect("a parameter");
            let last = lines.last().expect("its range");
            (key.trim().to_owned(), last.trim().to_owned())
        })
        .collect()
}

/// Strategy, key and the last column of the rows that have a key; the first column stands once
/// for the rows below it.
fn rows(section: &str) -> Vec<(String, String, String)> {
    let mut strategy = String::new();
    let mut found = Vec::new();
    for line in section.lines().filter(|line| line.starts_with('|')) {
        let cells: Vec<&str> = line.split('|').map(|cell| cell.trim()).collect();
        let [_, name, key, .., range, _] = cells[..] else {
            panic!("a row of four cells: {line}");
        };
        let bare = |cell: &str| cell.trim_matches('`').to_owned();
        if name.starts_with('`') {
            strategy = bare(name);
            found.push((strategy.clone(), String::new(), range.to_owned()));
        }
        if key.starts_with('`') {
            found.push((strategy.clone(), bare(key), range.to_owned()));
        }
    }
    found.retain(|(strategy, ..)| strategy != "use");
    found
}

#[test]
fn docs_recipe_md_has_every_strategy_with_its_parameters_defaults_and_limits() {
    let page = page("docs/recipe.md");
    for slot in SLOTS {
        let mut written = rows(below(&page, &format!("### `[{slot}]`")));
        let mut known = Vec::new();
        for name in strategies(slot) {
            let parameters = parameters(slot, &name);
            known.push((name.clone(), String::new(), String::new()));
            known.extend(
                parameters
                    .into_iter()
                    .map(|(key, range)| (name.clone(), key, range)),
            );
        }
        written.sort();
        known.sort();
        assert_eq!(written, known, "[{slot}]");
    }
}

#[test]
fn the_recipe_of_docs_recipe_md_is_one_whose_tolerances_hold() {
    let bench = Bench::with(first_block(&page("docs/recipe.md"), "toml"));
    bench.line("run recipe.toml").ends(0);
}

#[test]
fn the_readme_names_every_strategy_in_its_slot() {
    let readme = page("README.md");
    let table = below(&readme, "## Strategies");
    for slot in SLOTS {
        let start = format!("| {slot} | ");
        let row = table.lines().find(|line| line.starts_with(&start));
        let row = row.expect("the slot's row");
        for name in strategies(slot) {
            assert!(row.contains(&format!("`{name}`")), "{slot}: {name}");
        }
    }
}

#[test]
fn docs_commands_md_has_every_command_and_every_option() {
    let page = page("docs/commands.md");
    for command in COMMANDS {
        assert!(page.contains(&format!("`turnpath {command} ")), "{command}");
        let help = Bench::empty().call([command, "--help"]).ends(0).stdout;
        let words = help.split(|c: char| c.is_whitespace() || ",[]".contains(c));
        let options = words.filter(|word| word.starts_with("--") && word.len() > 2);
        for option in options.filter(|option| !["--help", "--version"].contains(option)) {
            let short = match option {
                "--output" => "-o",
                long => long,
            };
            let written = [
                format!("`{short}`"),
                format!("`{short} "),
                format!(" {short} "),
            ];
            let found = written.iter().any(|written| page.contains(written));
            assert!(found, "{command} {option}");
        }
    }
}

#[test]
fn the_sample_of_docs_plugins_md_is_the_one_that_the_tests_build_and_run() {
    let sample = page("tests/fixtures/constant-arc/src/lib.rs");
    assert_eq!(first_block(&page("docs/plugins.md"), "rust"), sample);
}

/// Every slot has a section, and what it quotes stands in the template of `turnpath new-plugin`.
#[test]
fn the_examples_of_docs_plugins_md_are_the_templates() {
    let page = page("docs/plugins.md");
    for slot in SLOTS.into_iter().chain(["spindle"]) {
        let mut heading = format!("### {slot}");
        heading[4..5].make_ascii_uppercase();
        let section = below(&page, &heading);
        let template = self::page(&format!("crates/turnpath/templates/{slot}.rs"));
        let quoted = first_block(section, "rust");
        assert!(template.contains(quoted), "{slot}:\n{quoted}");
        assert!(section.contains(&format!("templates/{slot}.rs`")), "{slot}");
    }
}

/// The command in the text before a page's block, as words behind the program's name.
fn command_before<'a>(page: &'a str, block: &str) -> Vec<&'a str> {
    let (before, _) = page.split_once(block).expect("the block");
    let (_, command) = before.rsplit_once("`turnpath ").expect("a command");
    let (words, _) = command.split_once('`').expect("its end");
    // Words with brackets stand in the quotes of a shell; none has a blank.
    let bare = |word: &'a str| word.trim_matches('\'');
    words.split_whitespace().map(bare).collect()
}

#[test]
fn the_program_of_docs_pmac_md_is_what_its_command_writes() {
    is_what_its_command_writes(&page("docs/pmac.md"), "pmc");
}

#[test]
fn the_programs_of_docs_posts_md_are_what_their_commands_write() {
    let page = page("docs/posts.md");
    for (heading, extension) in [
        ("## Aerotech Automation1", "ascript"),
        ("## Siemens Sinumerik 840D", "mpf"),
        ("## Beckhoff TwinCAT CNC: polynomials", "ncp"),
    ] {
        is_what_its_command_writes(below(&page, heading), extension);
    }
}

/// The first block of a text is quoted from the program that the command before it writes.
fn is_what_its_command_writes(page: &str, extension: &str) {
    let quoted = first_block(page, "");
    let mut command = command_before(page, quoted);
    let recipe = repository().join(command[1]);
    command[1] = recipe.to_str().expect("a path in UTF-8");
    let bench = Bench::empty();
    bench.call(command.iter().chain(&["-o", "out"])).ends(0);
    let program = bench.read(format!("out/astigmatic-5mm.{extension}"));
    let mut lines = program.lines();
    for line in quoted.lines().filter(|line| *line != "…") {
        // A hash is quoted by its beginning, and lines are left out where the page says so.
        let begins = line.trim_end_matches('…');
        let found = lines.any(|written| match line == begins {
            true => written == line,
            false => written.starts_with(begins),
        });
        assert!(found, "{line}");
    }
}

/// The worked example of a dialect is the code that is there, and the files that it names are too.
#[test]
fn the_dialect_of_docs_posts_md_is_the_code() {
    let page = page("docs/posts.md");
    let section = below(&page, "## To add a dialect");
    let folder = repository().join("crates/post/src");
    let writer = fs::read_to_string(folder.join("automation1/write.rs")).expect("the writer");
    // The block stands in a list.
    let block: Vec<&str> = section
        .lines()
        .skip_while(|line| line.trim() != "```rust")
        .skip(1)
        .take_while(|line| line.trim() != "```")
        .map(|line| line.strip_prefix("   ").unwrap_or(line))
        .collect();
    assert!(
        block.len() > 2 && writer.contains(&block.join("\n")),
        "{block:#?}"
    );
    let named = section.split('`').skip(1).step_by(2);
    let files: Vec<&str> = named.filter(|word| word.ends_with(".rs")).collect();
    assert!(files.len() > 8, "{files:?}");
    for file in files {
        let places = ["", "crates/post/src", "crates/post/src/automation1"];
        let is_there = |place: &str| repository().join(place).join(file).is_file();
        assert!(places.into_iter().any(is_there), "{file}");
    }
    let trait_of_posts = fs::read_to_string(folder.join("post.rs")).expect("the trait");
    for method in ["write_travel", "read_travel", "part_lines", "called_part"] {
        assert!(section.contains(method) && trait_of_posts.contains(&format!("fn {method}(")));
    }
}

#[test]
fn the_links_of_all_pages_lead_to_files_and_headings() {
    let mut seen = 0;
    let docs = repository().join("docs").canonicalize().expect("the pages");
    for file in pages() {
        let file = file.canonicalize().expect("a page");
        let text = fs::read_to_string(&file).expect("a page");
        for target in links(&text).filter(|target| !target.contains("://")) {
            let (path, heading) = target.split_once('#').unwrap_or((target, ""));
            let to = match path {
                "" => file.clone(),
                path => file.parent().expect("its folder").join(path),
            };
            assert!(to.exists(), "{}: {target}", file.display());
            if let (Ok(to), true) = (to.canonicalize(), file.starts_with(&docs)) {
                // A page of the book may lead to what the book has.
                assert!(to.starts_with(&docs), "{}: {target}", file.display());
            }
            if !heading.is_empty() {
                let there = fs::read_to_string(&to).expect("a page");
                let found = there.lines().any(|line| anchor(line) == heading);
                assert!(found, "{}: {target}", file.display());
            }
            seen += 1;
        }
    }
    assert!(seen > 20, "only {seen} links");
}

/// The targets of a page's links.
fn links(text: &str) -> impl Iterator<Item = &str> {
    let after = text.split("](").skip(1);
    after.filter_map(|rest| rest.split_once(')').map(|(target, _)| target))
}

/// The name by which a heading is linked: lower case, words joined, nothing but letters.
fn anchor(line: &str) -> String {
    let title = line.trim_start_matches('#').trim().to_lowercase();
    let kept = title
        .chars()
        .filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

/// The book has every page, so that none is found by its search alone.
#[test]
fn docs_summary_md_has_every_page() {
    let docs = repository().join("docs");
    let summary = page("docs/SUMMARY.md");
    for path in pages() {
        let Ok(name) = path.strip_prefix(&docs) else {
            continue;
        };
        let name = name.to_string_lossy().replace('\\', "/");
        let is_listed = name == "SUMMARY.md" || summary.contains(&format!("]({name})"));
        assert!(is_listed, "{name}");
    }
}
