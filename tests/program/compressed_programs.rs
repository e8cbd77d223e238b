//! Programs as `.zst`: written, read, damaged, and far larger than their files, through the whole program.
#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use serde_json::Value;

use crate::support::bench::{Answer, Bench, TURNPATH};
use crate::support::recipe::{SADDLE, changed};

/// The saddle with leads, this key of `[output]`, and one program in a file and one in parts.
fn saddle(compress: &str) -> String {
    let recipe = changed(SADDLE, "lead = false", "lead = true");
    format!(
        "{recipe}\n[output]\nposts = [\"pmac-pvt\", \"beckhoff-g93\"]\n{compress}\n\n\
         [output.beckhoff-g93]\nsplit = \"40 kB\"\n"
    )
}

const ZST: &str = "compress = \"zst\"";

fn bytes(bench: &Bench, file: &str) -> Vec<u8> {
    std::fs::read(bench.path(format!("out/{file}"))).unwrap()
}

/// A text with the hash of its recipe taken out: a key of the recipe changes it.
fn without_hash(text: &[u8]) -> Vec<String> {
    let text = String::from_utf8(text.to_vec()).unwrap();
    let lines = text.lines().filter(|line| !line.contains("SHA-256"));
    lines.map(str::to_owned).collect()
}

#[test]
fn compressed_programs_have_the_text_the_figures_and_the_rows_of_those_that_are_not() {
    let plain = Bench::with(&saddle(""));
    let bench = Bench::with(&saddle(ZST));
    let run = |bench: &Bench| {
        let said = bench.line("run recipe.toml -o out --dry-run --format json");
        said.ends(0).json()
    };
    let (expected, found) = (run(&plain), run(&bench));
    let listed = found["files"].as_array().unwrap();
    let mut files = 0;
    for file in expected["files"].as_array().unwrap() {
        let name = file["file"].as_str().unwrap();
        let is_program = !name.ends_with(".csv") && !name.contains("dry-run");
        let own = if is_program {
            format!("{name}.zst")
        } else {
            name.to_owned()
        };
        assert!(
            listed.iter().any(|file| file["file"] == own.as_str()),
            "{own}"
        );
        if is_program {
            let text = zstd::decode_all(bytes(&bench, &own).as_slice()).unwrap();
            assert_eq!(
                without_hash(&text),
                without_hash(&bytes(&plain, name)),
                "{own}"
            );
            files += 1;
        }
    }
    assert!(files > 3, "{files}");
    for (k, file) in ["recipe.pmc", "recipe.cnc"].into_iter().enumerate() {
        let mut program = found["programs"][k].clone();
        assert_eq!(program["file"], format!("{file}.zst"));
        program["file"] = Value::from(file);
        assert_eq!(program, expected["programs"][k]);
        let verify = |bench: &Bench, file: &str| {
            let line = format!("verify recipe.toml out/{file} --format json");
            bench.line(&line).ends(0).json()
        };
        let (own, text) = (verify(&bench, &format!("{file}.zst")), verify(&plain, file));
        assert_eq!(own["anomalies"]["count"], 0, "{file}");
        assert_eq!(own["result"]["holds"], true, "{file}");
        for key in ["rows", "interpolation_error", "surface_error", "lead"] {
            assert_eq!(own[key], text[key], "{file}: {key}");
        }
    }
}

#[test]
fn compressed_programs_have_the_same_bytes_whatever_the_threads() {
    let bench = Bench::with(&saddle(ZST));
    bench.line("run recipe.toml -o out --threads 1").ends(0);
    bench.line("run recipe.toml -o again --threads 3").ends(0);
    for file in ["recipe.pmc.zst", "recipe.cnc.zst", "recipe-part-1.cnc.zst"] {
        let again = std::fs::read(bench.path(format!("again/{file}"))).unwrap();
        assert!(bytes(&bench, file) == again, "{file}");
    }
}

/// `check` says the text, as the controller gets it.
#[test]
fn check_says_the_size_of_the_text() {
    let bench = Bench::with(&saddle(ZST));
    let check = bench.line("check recipe.toml --format json").ends(0).json();
    bench.line("run recipe.toml -o out").ends(0);
    let program = &check["expected"]["programs"][0];
    assert_eq!(program["file"], "recipe.pmc.zst");
    let text = zstd::decode_all(bytes(&bench, "recipe.pmc.zst").as_slice()).unwrap();
    let part = program["bytes"].as_f64().unwrap() / text.len() as f64 - 1.0;
    assert!(part.abs() < 0.05, "{part}");
    let said = bench.line("check recipe.toml").ends(0);
    assert!(said.stdout.contains("of text: recipe.pmc.zst"), "{said}");
}

#[test]
fn a_damaged_program_is_refused_by_its_name() {
    let bench = Bench::with(&saddle(ZST));
    bench.line("run recipe.toml -o out").ends(0);
    for (file, damaged) in [
        ("recipe.pmc.zst", "recipe.pmc.zst"),
        ("recipe.cnc.zst", "recipe-part-2.cnc.zst"),
    ] {
        let whole = bytes(&bench, damaged);
        let half = whole.len() / 2;
        let mut changed = whole.clone();
        changed[half] ^= 0x10;
        let text = b"OPEN PROG 1 CLEAR\n".to_vec();
        for bytes in [changed, whole[..half].to_vec(), Vec::new(), text] {
            bench.write(&format!("out/{damaged}"), bytes);
            let said = bench.line(&format!("verify recipe.toml out/{file}"));
            let said = said.ends(4);
            assert!(said.stderr.contains(damaged), "{said}");
            assert!(!said.stderr.contains("panicked"), "{said}");
        }
    }
}

/// 64 GiB of empty lines in some hundred kilobytes: refused in little time and little memory.
#[test]
fn a_small_file_of_very_much_text_is_refused_in_little_memory() {
    let bench = Bench::with(&saddle(ZST));
    let mut encoder = zstd::Encoder::new(Vec::new(), 3).unwrap();
    encoder.include_checksum(true).unwrap();
    std::io::Write::write_all(&mut encoder, &vec![b'\n'; 1 << 26]).unwrap();
    let frame = encoder.finish().unwrap();
    let bomb = frame.repeat((1 << 10) + 1);
    assert!(bomb.len() < 1 << 24, "{}", bomb.len());
    bench.write("recipe.pmc.zst", bomb);
    let script = "ulimit -v 1500000; exec \"$0\" verify recipe.toml recipe.pmc.zst";
    let mut shell = bench.command_of("sh".as_ref(), ["-c", script]);
    let said = Answer::from(shell.arg(TURNPATH).output().unwrap()).ends(4);
    assert!(
        said.stderr.contains("no point of a path in 8 MiB"),
        "{said}"
    );
}
