//! Good plugins in the catalogue: found, loaded once, each with its own strategies.

#![allow(clippy::unwrap_used, reason = "helpers of tests may panic too")]

use std::fs;

use crate::common::{fixtures, nodes, place_more, with_file, with_fixture, with_path};
use turnpath_core::{DataFile, Dependence, ParamValue, Params, Slot};
use turnpath_host::{Catalogue, sha256_hex_of_file};

#[test]
fn the_authors_sampler_is_listed_with_its_parameters_and_answers() {
    let catalogue = with_fixture("constant-arc");
    assert_eq!(catalogue.names(Slot::Sampler), ["constant-arc"]);
    let strategy = catalogue.find(Slot::Sampler, "constant-arc").unwrap();
    let names: Vec<&str> = strategy.info().params.iter().map(|p| p.name).collect();
    assert_eq!(names, ["spacing", "at_least"]);

    let params = Params::new().with("spacing", 0.1).with("at_least", 36.0);
    let sampler = strategy.offer().sampler(&params).unwrap();
    // 2π·2 mm over 0.1 mm is 125.7 steps, then 2π·1.99 mm: 125.04.
    let nodes = nodes(sampler.as_ref(), 0.0, 2.0).unwrap();
    assert_eq!(nodes.len(), 252);
    assert_eq!((nodes[0], nodes[1]), (0.0, 1.0 / 126.0));
}

#[test]
fn the_origin_is_the_package_the_file_and_the_hash_of_its_bytes() {
    let file = fixtures::library("constant-arc");
    let catalogue = with_file(&file).unwrap();
    let [plugin] = catalogue.plugins() else {
        panic!("one plugin, not {:?}", catalogue.plugins());
    };
    assert_eq!((&*plugin.name, &*plugin.version), ("constant-arc", "0.1.0"));
    assert_eq!(plugin.file, Some(fs::canonicalize(&file).unwrap()));
    let hash = sha256_hex_of_file(&file).unwrap();
    assert_eq!(plugin.sha256().unwrap(), Some(hash.as_str()));
}

#[test]
fn several_plugins_each_give_their_own_strategies() {
    let folder = fixtures::plugin_folder(&[
        "unordered",
        "nan",
        "constant-arc",
        "sequential",
        "plain-compensator",
        "twins-b",
    ]);
    let catalogue = Catalogue::new().with_folder(folder.path()).unwrap();
    let found: Vec<(&str, &str, &str)> = catalogue
        .strategies()
        .map(|one| {
            let info = one.info();
            (info.slot.key(), info.name, one.plugin().name.as_str())
        })
        .collect();
    let expected = [
        ("surface", "nan-surface", "nan"),
        ("sampler", "constant-arc", "constant-arc"),
        ("sampler", "decreasing-nodes", "unordered"),
        ("sampler", "outside-block", "unordered"),
        ("sampler", "phase", "sequential"),
        ("sampler", "returns-nan", "nan"),
        ("sampler", "too-few", "unordered"),
        ("sampler", "twin", "twins-b"),
        ("compensator", "plain-normal", "plain-compensator"),
        ("velocity", "nan-velocity", "nan"),
    ];
    assert_eq!(found, expected);
    let order: Vec<&str> = catalogue
        .plugins()
        .iter()
        .map(|p| p.name.as_str())
        .collect();
    let by_file_name = [
        "constant-arc",
        "nan",
        "plain-compensator",
        "sequential",
        "twins-b",
        "unordered",
    ];
    assert_eq!(order, by_file_name);
}

#[test]
fn the_same_name_from_two_catalogues_is_two_strategies() {
    let count = |package| {
        let catalogue = with_fixture(package);
        let twin = catalogue.find(Slot::Sampler, "twin").unwrap();
        let sampler = twin.offer().sampler(&Params::new()).unwrap();
        nodes(sampler.as_ref(), 0.0, 1.0).unwrap().len()
    };
    assert_eq!([count("twins-a"), count("twins-b")], [24, 48]);
}

#[test]
fn a_renamed_library_is_the_same_plugin() {
    let folder = tempfile::tempdir().unwrap();
    let renamed = folder.path().join("our best one (2).so");
    fs::copy(fixtures::library("constant-arc"), &renamed).unwrap();
    let catalogue = with_file(&renamed).unwrap();
    let strategy = catalogue.find(Slot::Sampler, "constant-arc").unwrap();
    assert_eq!(strategy.plugin().name, "constant-arc");
}

#[test]
fn a_library_in_two_folders_is_added_once() {
    let (one, two) = (
        fixtures::plugin_folder(&["constant-arc"]),
        fixtures::plugin_folder(&["constant-arc", "sequential"]),
    );
    let mut catalogue = Catalogue::new();
    for folder in [&one, &one, &two] {
        catalogue.add_folder(folder.path()).unwrap();
    }
    assert_eq!(catalogue.names(Slot::Sampler), ["constant-arc", "phase"]);
    assert_eq!(catalogue.plugins().len(), 2);
}

#[test]
fn other_files_in_a_plugin_folder_are_ignored() {
    let folder = fixtures::plugin_folder(&["constant-arc"]);
    fs::write(folder.path().join("README.md"), "how to build these").unwrap();
    fs::write(folder.path().join("libolder.so.1"), "not looked at").unwrap();
    fs::write(folder.path().join("so"), "not looked at").unwrap();
    fs::create_dir(folder.path().join("sources.so")).unwrap();
    let mut catalogue = Catalogue::new();
    catalogue.add_folder(folder.path()).unwrap();
    assert_eq!(catalogue.names(Slot::Sampler), ["constant-arc"]);
}

#[test]
fn a_plugin_that_holds_anothers_code_gives_its_own_strategies() {
    let catalogue = with_fixture("builds-on");
    assert_eq!(catalogue.names(Slot::Surface), ["rippled-conic"]);
    let strategy = catalogue.find(Slot::Surface, "rippled-conic").unwrap();
    let params = Params::new().with("radius", 100.0).with("conic", 0.0);
    let (surface, mut z) = (strategy.offer().surface(&params).unwrap(), [f64::NAN]);
    surface.heights(&[0.0], &[0.0], &mut z).unwrap();
    assert_eq!(z, [0.001]);
}

#[test]
fn a_sequential_sampler_hands_its_state_to_the_next_block() {
    let catalogue = with_fixture("sequential");
    let strategy = catalogue.find(Slot::Sampler, "phase").unwrap();
    let sampler = strategy.offer().sampler(&Params::new()).unwrap();
    let dependence = with_path(|path| sampler.plan(path).map(|plan| plan.dependence()));
    assert_eq!(dependence.unwrap(), Dependence::Sequential);
    let mut state = Vec::new();
    let mut in_two = place_more(sampler.as_ref(), 0.0, 1.0, &mut state).unwrap();
    in_two.extend(place_more(sampler.as_ref(), 1.0, 2.0, &mut state).unwrap());
    let whole = nodes(sampler.as_ref(), 0.0, 2.0).unwrap();
    assert_eq!(in_two.len(), whole.len());
    for (one, other) in in_two.iter().zip(&whole) {
        assert!((one - other).abs() < 1e-14);
    }
}

#[test]
fn loaded_strategies_work_on_many_threads() {
    let catalogue = with_fixture("constant-arc");
    let strategy = catalogue.find(Slot::Sampler, "constant-arc").unwrap();
    let params = Params::new().with("spacing", 0.1).with("at_least", 36.0);
    let sampler = strategy.offer().sampler(&params).unwrap();
    let alone: Vec<Vec<f64>> = (0..16)
        .map(|i| nodes(sampler.as_ref(), f64::from(i), f64::from(i + 3)).unwrap())
        .collect();
    std::thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(|| {
                for (i, expected) in (0..16).zip(&alone) {
                    let nodes = nodes(sampler.as_ref(), f64::from(i), f64::from(i + 3)).unwrap();
                    assert_eq!(nodes, *expected);
                }
            });
        }
    });
}

#[test]
fn catalogues_of_many_threads_hold_the_same() {
    let names = || {
        let catalogue = with_fixture("unordered");
        let strategy = catalogue.find(Slot::Sampler, "too-few").unwrap();
        let sampler = strategy.offer().sampler(&Params::new()).unwrap();
        assert_eq!(nodes(sampler.as_ref(), 0.0, 1.0), Ok(Vec::new()));
        catalogue.names(Slot::Sampler)
    };
    let alone = names();
    std::thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(|| assert_eq!(names(), alone));
        }
    });
}

fn data_file(bytes: &[u8]) -> DataFile {
    DataFile {
        path: "maps/one.csv".to_owned(),
        bytes: bytes.into(),
    }
}

#[test]
fn the_bytes_of_a_file_reach_a_loaded_strategy() {
    let catalogue = with_fixture("bowl-file");
    let strategy = catalogue.find(Slot::Surface, "bowl-file").unwrap();
    let surface = |bytes: &[u8]| {
        let mut params = Params::new();
        params.set("file", ParamValue::File(data_file(bytes)));
        strategy.offer().surface(&params)
    };
    let mut z = [f64::NAN];
    surface(b"0.25\n")
        .unwrap()
        .heights(&[2.0], &[0.0], &mut z)
        .unwrap();
    assert_eq!(z, [0.5]);
    let Err(error) = surface(b"") else {
        panic!("an empty file is refused");
    };
    let expected = "parameter `file`: the file maps/one.csv is empty";
    assert_eq!(error.to_string(), expected);
}

#[test]
fn a_value_of_every_kind_reaches_the_constructor() {
    let catalogue = with_fixture("constant-arc");
    let strategy = catalogue.find(Slot::Sampler, "constant-arc").unwrap();
    let mut params = Params::new().with("spacing", 0.1).with("at_least", 400.0);
    params.set("flag", ParamValue::Flag(true));
    params.set("text", ParamValue::Text("säge".into()));
    params.set("rows", ParamValue::Rows(vec![vec![1.0], vec![]]));
    params.set("file", ParamValue::File(data_file(b"\0\xff")));
    let sampler = strategy.offer().sampler(&params).unwrap();
    assert_eq!(nodes(sampler.as_ref(), 0.0, 1.0).unwrap().len(), 400);
}
