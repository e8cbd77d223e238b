//! What a recipe's own header and footer tell the controller: named, and trusted or refused.

use crate::support::bench::Bench;
use crate::support::recipe::SADDLE;

/// The saddle with a program, and with these lines in the program's table.
fn bench(lines: &str) -> Bench {
    let output = "[output]\nposts = [\"pmac-pvt\"]\n\n[output.pmac-pvt]\n";
    Bench::with(&format!("{SADDLE}\n{output}{lines}\n"))
}

const HARMLESS: &str = "header = \"; {name}\\nCLOSE OPEN PROG 7 CLEAR\\n\"\nfooter = \"CLOSE\"";
const COOLANT: &str =
    "header = \"OPEN PROG 1 CLEAR\\nM1=1 ; coolant\\n\"\nfooter = \"M1=0\\nCLOSE\"";

#[test]
fn harmless_commands_are_named_and_need_no_trust() {
    let bench = bench(HARMLESS);
    for command in ["check recipe.toml", "run recipe.toml -o out"] {
        let said = bench.line(command).ends(0);
        assert!(
            said.stdout.contains("line 2: CLOSE OPEN PROG 7 CLEAR\n"),
            "{said}"
        );
        assert!(!said.stdout.contains("may move"), "{said}");
        let said = bench.line(&format!("{command} --format json")).ends(0);
        let named = &said.json()["controller_commands"];
        assert_eq!(named[0]["template"], "header");
        assert_eq!(named[1]["command"], "CLOSE");
        assert_eq!(named[1]["harmless"], true);
    }
}

#[test]
fn other_commands_are_refused_by_their_lines_and_no_file_is_written() {
    let bench = bench(COOLANT);
    for command in ["check recipe.toml", "run recipe.toml -o out"] {
        let said = bench.line(command).ends(2);
        for says in [
            "line 2 of the header takes --trust-recipe: it tells the controller `M1=1`",
            "line 1 of the footer takes --trust-recipe: it tells the controller `M1=0`",
        ] {
            assert!(said.stderr.contains(says), "{said}");
        }
        assert!(!said.stderr.contains("OPEN PROG 1 CLEAR`"), "{said}");
    }
    assert_eq!(bench.files(), ["recipe.toml"]);
}

#[test]
fn trusted_commands_are_named_and_written() {
    let bench = bench(COOLANT);
    let said = bench.line("run recipe.toml -o out --trust-recipe").ends(0);
    assert!(
        said.stdout.contains("line 2: M1=1 (may move, set or start"),
        "{said}"
    );
    assert!(bench.read("out/recipe.pmc").contains("M1=1 ; coolant\n"));
    let report: serde_json::Value =
        serde_json::from_str(&bench.read("out/summary.json")).unwrap_or_default();
    assert_eq!(report["controller_commands"][1]["command"], "M1=1");
    assert_eq!(report["controller_commands"][1]["harmless"], false);
}

/// The path's lines would be obeyed where they arrive, or go into whatever is open.
#[test]
fn a_header_without_an_open_program_and_a_rotary_buffer_need_trust() {
    for (header, command) in [
        ("CLOSE", "CLOSE"),
        ("OPEN PROG 7 CLEAR\\nCLOSE", "CLOSE"),
        ("CLOSE OPEN ROT", "CLOSE OPEN ROT"),
    ] {
        let bench = bench(&format!("header = \"{header}\""));
        let said = bench.line("check recipe.toml").ends(2);
        let title = format!("it tells the controller `{command}`");
        assert!(said.stderr.contains(&title), "{said}");
        bench.line("check recipe.toml --trust-recipe").ends(0);
    }
}

/// Who calls has written it, and not whoever wrote the recipe.
/// A comment character within quotes begins no comment: the line is shown whole, and a recipe's own words
/// are refused there. A word that ends the program keeps the path from running.
#[test]
fn text_in_quotes_is_a_command_and_so_is_the_end_of_a_program_before_the_path() {
    let of_siemens = |header: &str, trust: &str| {
        let output = "[output]\nposts = [\"siemens-840d-poly\"]\n\n[output.siemens-840d-poly]\n";
        let bench = Bench::with(&format!("{SADDLE}\n{output}header = '{header}'\n"));
        let said = bench.line(&format!("check recipe.toml{trust}")).ends(2);
        said.stderr
    };
    let said = of_siemens("MSG(\"; part\") G0 Z-50 ; a", "");
    assert!(
        said.contains("it tells the controller `MSG(\"; part\") G0 Z-50`"),
        "{said}"
    );
    let said = of_siemens("MSG(\"; {name}\")", " --trust-recipe");
    assert!(said.contains("`{name}` is outside a comment"), "{said}");
    let said = of_siemens("M30", "");
    assert!(said.contains("it tells the controller `M30`"), "{said}");
}

#[test]
fn a_name_that_makes_a_mark_of_a_comment_is_refused_with_its_template() {
    let text = SADDLE.replace("name = \"Saddle\"", "name = \"- cutting -\"");
    let output = "[output]\nposts = [\"pmac-pvt\"]\n\n[output.pmac-pvt]\n";
    let bench = Bench::with(&format!("{text}\n{output}header = '; -{{name}}-'\n"));
    let said = bench.line("check recipe.toml").ends(2);
    assert!(
        said.stderr
            .contains("would be taken for a mark of the path"),
        "{said}"
    );
    assert!(said.stderr.contains("in this template"), "{said}");
}

#[test]
fn what_the_caller_sets_needs_no_trust() {
    let bench = bench("");
    let set = "output.pmac-pvt.header=\"OPEN PROG 1 CLEAR\\nM1=1\"";
    let said = bench
        .call(["run", "recipe.toml", "-o", "out", "--set", set])
        .ends(0);
    assert!(said.stdout.contains("line 2: M1=1"), "{said}");
}

#[test]
fn the_posts_own_templates_and_unused_ones_are_not_named() {
    let said = bench("").line("run recipe.toml -o out").ends(0);
    assert!(!said.stdout.contains("line 1:"), "{said}");
    let unused = Bench::with(&format!("{SADDLE}\n[output.pmac-pvt]\n{COOLANT}\n"));
    let said = unused.line("run recipe.toml -o out").ends(0);
    assert!(!said.stdout.contains("M1=1"), "{said}");
}

#[test]
fn a_rotary_buffer_that_a_recipe_asks_for_needs_trust_and_the_path_stays_the_same() {
    let bench = bench("buffer = \"rotary\"");
    let said = bench.line("run recipe.toml -o out").ends(2);
    assert!(
        said.stderr
            .contains("it tells the controller `OPEN ROTARY`"),
        "{said}"
    );
    bench.line("run recipe.toml -o out --trust-recipe").ends(0);
    let rotary = bench.read("out/recipe.pmc");
    assert!(
        rotary.contains("CLOSE\nOPEN ROTARY\n; -- cutting --\n"),
        "{rotary:.900}"
    );
    let own = [
        "run",
        "recipe.toml",
        "-o",
        "own",
        "--set",
        "output.pmac-pvt.buffer=program",
    ];
    bench.call(own).ends(0);
    let program = bench.read("own/recipe.pmc");
    let path = |text: &str| text.split_once("; -- cutting").unwrap().1.to_owned();
    assert_eq!(path(&rotary), path(&program));
    bench.line("verify recipe.toml out/recipe.pmc").ends(0);
}

/// `verify` judges what a file tells the controller outside of its path, too: no reader of paths sees it.
#[test]
fn verify_names_what_a_program_tells_besides_its_recipe() {
    let posts = ["pmac-pvt", "siemens-840d-poly", "beckhoff-g93"];
    let names = posts.map(|post| format!("\"{post}\"")).join(", ");
    let bench = Bench::with(&format!("{SADDLE}\n[output]\nposts = [{names}]\n"));
    bench.line("run recipe.toml -o out").ends(0);
    for (file, command) in [
        ("recipe.pmc", "X0Z-5"),
        ("recipe.pmc", "ENABLE PLC 1"),
        ("recipe.mpf", "G0 Z-5"),
        ("recipe.cnc", "G70"),
    ] {
        let text = bench.read(format!("out/{file}"));
        let verify = format!("verify recipe.toml {file}");
        bench.write(file, &text);
        let said = bench.line(&verify).ends(0);
        assert!(!said.stdout.contains("may move"), "{said}");
        let begin = text.find("-- cutting").unwrap();
        let at = text[..begin].rfind('\n').unwrap() + 1;
        let (head, rest) = text.split_at(at);
        bench.write(file, format!("{head}{command}\n{rest}{command}\n"));
        let said = bench.line(&verify).ends(0);
        let first = head.lines().count() + 1;
        let last = text.lines().count() + 2;
        for (line, template) in [(first, "header"), (last, "footer")] {
            let says = format!(
                "line {line}: {command}, which the recipe's {template} does not have there"
            );
            assert!(said.stdout.contains(&says), "{says}: {said}");
        }
        let report = bench
            .line(&format!("{verify} --format json"))
            .ends(0)
            .json();
        let named = &report["controller_commands"];
        assert_eq!(
            (&named[0]["command"], &named[0]["line"]),
            (&command.into(), &first.into())
        );
    }
}

/// A word that is harmless where the recipe has it may end the program at another place.
#[test]
fn verify_names_a_harmless_word_at_a_place_where_the_path_does_not_follow() {
    let bench = bench("");
    bench.line("run recipe.toml -o out").ends(0);
    let text = bench.read("out/recipe.pmc");
    let opens = "OPEN PROG 1 CLEAR\n";
    assert!(text.contains(opens));
    bench.write(
        "recipe.pmc",
        text.replacen(opens, &format!("{opens}CLOSE\n"), 1),
    );
    let said = bench.line("verify recipe.toml recipe.pmc").ends(0);
    let says = ": CLOSE, which the recipe's header does not have there; it may move";
    assert!(said.stdout.contains(says), "{said}");
}

/// What the recipe's own header has is the recipe's, and `run` has asked for trust.
#[test]
fn verify_does_not_name_what_the_recipe_has() {
    let bench = bench(COOLANT);
    bench.line("run recipe.toml -o out --trust-recipe").ends(0);
    let said = bench.line("verify recipe.toml out/recipe.pmc").ends(0);
    assert!(!said.stdout.contains("may move"), "{said}");
}

/// Each command of the recipe stands for one of the file. A move that stands there twice moves twice.
#[test]
fn verify_names_what_stands_there_once_more_and_a_footer_behind_a_long_header() {
    let bench = bench(COOLANT);
    bench.line("run recipe.toml -o out --trust-recipe").ends(0);
    let text = bench.read("out/recipe.pmc");
    let opens = "OPEN PROG 1 CLEAR\n";
    let many = "M9=1\n".repeat(60);
    let text = text.replacen(opens, &format!("{many}{opens}"), 1);
    bench.write("recipe.pmc", format!("{text}M1=0\n"));
    let said = bench.line("verify recipe.toml recipe.pmc").ends(0);
    let last = text.lines().count() + 1;
    let says = format!("line {last}: M1=0, which the recipe's footer does not have there");
    assert!(said.stdout.contains(&says), "{says}: {said}");
    assert_eq!(said.stdout.matches(": M9=1, which").count(), 50, "{said}");
}

/// A program that lost its end stays open, and one that lost its units or its plane plays another path.
#[test]
fn verify_names_what_a_program_lacks_of_its_recipe() {
    let posts = [
        "pmac-pvt",
        "siemens-840d-poly",
        "beckhoff-g93",
        "power-pmac-pvt",
    ];
    let names = posts.map(|post| format!("\"{post}\"")).join(", ");
    let bench = Bench::with(&format!("{SADDLE}\n[output]\nposts = [{names}]\n"));
    bench.line("run recipe.toml -o out").ends(0);
    for (file, command, template) in [
        ("recipe.pmc", "OPEN PROG 1 CLEAR", "header"),
        ("recipe.pmc", "CLOSE", "footer"),
        ("recipe.mpf", "M30", "footer"),
        ("recipe.cnc", "M30", "footer"),
        ("recipe.ppmc", "close", "footer"),
    ] {
        let text = bench.read(format!("out/{file}"));
        let verify = format!("verify recipe.toml {file}");
        bench.write(file, &text);
        let said = bench.line(&verify).ends(0);
        assert!(!said.stdout.contains(" is missing: line"), "{said}");
        let line = format!("{command}\n");
        let at = match template {
            "header" => text.find(&line).unwrap(),
            _ => text.rfind(&line).unwrap(),
        };
        let without = format!("{}{}", &text[..at], &text[at + line.len()..]);
        bench.write(file, without);
        let said = bench.line(&verify).ends(0);
        let says = format!("of the recipe's {template} has it");
        let lines = said.stdout.lines().filter(|line| line.contains(&says));
        let lines: Vec<&str> = lines.collect();
        assert!(
            matches!(lines.as_slice(), [only] if only.contains(command)),
            "{file}, {command}: {said}"
        );
        let report = bench.line(&format!("{verify} --format json")).ends(0);
        let missing = &report.json()["missing_commands"];
        assert_eq!(missing.as_array().map(Vec::len), Some(1), "{missing}");
        assert_eq!(
            (&missing[0]["command"], &missing[0]["template"]),
            (&command.into(), &template.into())
        );
    }
}

/// Whoever numbers the lines of a program, or writes it in small letters, changes nothing that it does.
#[test]
fn numbered_lines_and_small_letters_are_the_commands_of_the_recipe() {
    let posts = [
        ("siemens-840d-poly", "mpf"),
        ("beckhoff-poly", "ncp"),
        ("beckhoff-g93", "cnc"),
        ("nanotech-g93", "nc"),
        ("linuxcnc-g93", "ngc"),
        ("pmac-pvt", "pmc"),
    ];
    let names: Vec<&str> = posts.iter().map(|(post, _)| *post).collect();
    let led = SADDLE.replace("lead = false", "lead = true");
    let lines = "nanotech-g93 = { f_means = \"1/min\", depths = 3, depth_step = \"2 um\" }\n\
                 linuxcnc-g93.servo_period = \"0.05 ms\"\n";
    let bench = Bench::with(&format!("{led}\n[output]\nposts = {names:?}\n{lines}"));
    bench.line("run recipe.toml -o out --no-report").ends(0);
    for (post, end) in posts {
        let file = format!("out/recipe.{end}");
        let text = bench.read(&file);
        let numbered = |line: &str| {
            let is_code = !line.is_empty() && !line.starts_with([';', '(', '%']);
            match is_code && !post.starts_with("pmac") {
                true => format!("N10 {line}\n"),
                false => format!("{line}\n"),
            }
        };
        let numbered: String = text.lines().map(numbered).collect();
        for changed in [numbered, text.to_lowercase()] {
            bench.write(&file, changed);
            let said = bench.line(&format!("verify recipe.toml {file} --format json"));
            let json = said.json();
            for list in ["controller_commands", "missing_commands"] {
                let named = json[list].as_array().map_or(0, Vec::len);
                assert_eq!(named, 0, "{post}: {}", json[list]);
            }
            assert_eq!(json["anomalies"]["count"], 0, "{post}: {json}");
        }
    }
}
