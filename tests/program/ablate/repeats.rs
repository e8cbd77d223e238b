//! Which runs an ablation makes again.

use super::*;

#[test]
fn an_interrupted_ablation_goes_on_with_what_is_missing() {
    let residuals: Vec<String> = (50..90).map(|nm| format!("\"{nm} nm\"")).collect();
    let lists = format!("tolerance.residual = [{}]", residuals.join(", "));
    let bench = Bench::with(&saddle(&lists));
    let mut command = bench.command(["ablate", "recipe.toml", "-o", "out", "--threads", "2"]);
    let mut child = command.stdout(Stdio::null()).spawn().unwrap();
    while records(&bench).len() < 3 {
        assert!(
            child.try_wait().unwrap().is_none(),
            "it ended without records"
        );
        thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let left = records(&bench);
    let count = left.len();
    assert!((3..41).contains(&count), "{count}");
    assert!(!bench.path("out/ablation.json").exists());
    for name in left.keys() {
        let record: Value = serde_json::from_str(&bench.read(format!("out/runs/{name}"))).unwrap();
        assert_eq!(format!("{}.json", record["key"].as_str().unwrap()), *name);
    }
    let said = ablate(&bench, "").ends(0);
    assert_eq!(said.stderr, "");
    assert_eq!(
        headline(&said),
        format!("41 runs, {count} taken over from before")
    );
    let all = records(&bench);
    assert_eq!(all.len(), 41);
    for (name, written) in &left {
        assert_eq!(all.get(name), Some(written), "{name} was made again");
    }
}

#[test]
fn a_run_that_was_taken_over_is_what_would_be_made() {
    let bench = Bench::with(&eight());
    ablate(&bench, "").ends(0);
    let (made, table) = (
        bench.read("out/ablation.json"),
        bench.read("out/ablation.csv"),
    );
    let said = ablate(&bench, "").ends(0);
    assert_eq!(headline(&said), "8 runs, 8 taken over from before");
    assert!(made == bench.read("out/ablation.json"));
    assert!(table == bench.read("out/ablation.csv"));
    let before: Vec<Value> = runs(&bench).iter().map(without_times).collect();
    let said = ablate(&bench, "--fresh").ends(0);
    assert_eq!(headline(&said), "8 runs");
    let after: Vec<Value> = runs(&bench).iter().map(without_times).collect();
    assert_eq!(before, after);
}

#[test]
fn only_the_runs_that_a_change_touches_are_made_again() {
    let recipe = eight();
    let bench = Bench::with(&recipe);
    ablate(&bench, "").ends(0);
    for (from, to, taken_over) in [
        ("step = \"6 deg\"", "step = \"5 deg\"", 4),
        (
            "{ use = \"analytic\" }",
            "{ use = \"area\" }, { use = \"analytic\" }",
            8,
        ),
        ("name = \"Saddle\"", "# a saddle\nname = \"Another\"", 8),
        ("[feed]", "[output]\ndata = []\n\n[feed]", 8),
        ("residual = \"100 nm\"", "residual = \"90 nm\"", 0),
    ] {
        bench.write("recipe.toml", changed(&recipe, from, to));
        let said = ablate(&bench, "").ends(0);
        let reported = format!("{taken_over} taken over from before");
        let fits = match taken_over {
            0 => headline(&said) == "8 runs",
            _ => headline(&said).contains(&reported),
        };
        assert!(fits, "{to}: {}", headline(&said));
    }
    let said = ablate(&bench, "--set name=Another");
    assert!(said.stdout.starts_with("Another: "), "{said}");
    assert_eq!(runs(&bench)[0]["name"], "Another");
}

#[test]
fn a_damaged_record_is_reported_and_made_again() {
    let bench = Bench::with(&saddle(
        "velocity = [{ use = \"analytic\" }, { use = \"area\" }]",
    ));
    ablate(&bench, "").ends(0);
    let names: Vec<String> = records(&bench).into_keys().collect();
    let [first, second, third] = names.as_slice() else {
        panic!("{names:?}");
    };
    let path = |name: &str| format!("out/runs/{name}");
    let text = bench.read(path(first));
    bench.write(&path(first), &text[..text.len() / 2]);
    let text = bench.read(path(second));
    bench.write(&path(second), changed(&text, "\"rows\": ", "\"rows\": 1"));
    let whole = bench.read(path(third));
    let said = ablate(&bench, "").ends(0);
    assert_eq!(headline(&said), "3 runs, 1 taken over from before");
    assert_eq!(said.stderr.matches("is damaged").count(), 2, "{said}");
    assert_eq!(said.stderr.matches("its figures have changed").count(), 1);
    assert!(bench.read(path(third)) == whole);
    let said = ablate(&bench, "").ends(0);
    assert_eq!(headline(&said), "3 runs, 3 taken over from before");
}
