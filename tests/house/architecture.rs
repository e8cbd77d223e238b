//! Which crate may depend on which: dependencies run one way.
#![allow(clippy::expect_used, reason = "helpers of tests may panic too")]

use cargo_metadata::{Dependency, DependencyKind, Metadata, Package};

use crate::workspace::workspace;

/// Which crates of the workspace a crate may use. A crate without a rule fails the test: decide first
/// where it belongs.
struct Rule {
    package: &'static str,
    /// In what is built.
    uses: &'static [&'static str],
    /// In its tests besides; `PLUGINS` stands for every crate in `plugins/`.
    tests_use: &'static [&'static str],
}

const PLUGINS: &str = "plugins/*";

const RULES: &[Rule] = &[
    rule("turnpath-units", &[], &[]),
    rule("turnpath-files", &[], &[]),
    rule("turnpath-lens", &[], &[]),
    rule("turnpath-maps", &[], &[]),
    rule("turnpath-core", &["turnpath-units"], &[]),
    rule("turnpath-plugin", &["turnpath-core"], &[]),
    rule("turnpath-recipe", &["turnpath-core", "turnpath-post"], &[]),
    rule(
        "turnpath-verify",
        &["turnpath-core"],
        &["turnpath-grid", "turnpath-maps", "turnpath-surfaces"],
    ),
    rule("turnpath-post", &["turnpath-core", "turnpath-files"], &[]),
    rule(
        "turnpath-pipeline",
        &["turnpath-core", "turnpath-verify"],
        &[],
    ),
    rule(
        "turnpath-host",
        &["turnpath-core", "turnpath-files", "turnpath-plugin"],
        &[PLUGINS],
    ),
    rule(
        PLUGINS,
        &["turnpath-maps", "turnpath-plugin"],
        &["turnpath-core", PLUGINS],
    ),
    rule(
        "turnpath-plugin-test",
        &[
            "turnpath-core",
            "turnpath-host",
            "turnpath-pipeline",
            "turnpath-recipe",
            "turnpath-verify",
            PLUGINS,
        ],
        &[PLUGINS],
    ),
    rule("turnpath-report", &["turnpath-core"], &[]),
    rule(
        "turnpath-drawing",
        &["turnpath-core", "turnpath-report"],
        &[],
    ),
    rule("turnpath-page", &["turnpath-report"], &[]),
    rule("turnpath", LIBRARIES, &[]),
    rule(
        PROGRAM,
        &["turnpath", "turnpath-core", "turnpath-files"],
        LIBRARIES,
    ),
    rule("xtask", &[], &[]),
];

/// What the library `turnpath` puts together.
const LIBRARIES: &[&str] = &[
    "turnpath-core",
    "turnpath-drawing",
    "turnpath-files",
    "turnpath-host",
    "turnpath-lens",
    "turnpath-maps",
    "turnpath-page",
    "turnpath-pipeline",
    "turnpath-post",
    "turnpath-recipe",
    "turnpath-report",
    "turnpath-verify",
    PLUGINS,
];

const fn rule(
    package: &'static str,
    uses: &'static [&'static str],
    tests_use: &'static [&'static str],
) -> Rule {
    Rule {
        package,
        uses,
        tests_use,
    }
}

/// The crate of the program, to which this test belongs. Only its tests look behind the library.
const PROGRAM: &str = env!("CARGO_PKG_NAME");

fn is_plugin(metadata: &Metadata, name: &str) -> bool {
    let plugins = metadata.workspace_root.join("plugins");
    let of_name = |package: &&Package| package.name == name;
    let found = metadata.packages.iter().find(of_name);
    found.is_some_and(|package| package.manifest_path.starts_with(&plugins))
}

fn rule_for(metadata: &Metadata, name: &str) -> &'static Rule {
    let key = if is_plugin(metadata, name) {
        PLUGINS
    } else {
        name
    };
    RULES
        .iter()
        .find(|rule| rule.package == key)
        .unwrap_or_else(|| panic!("no rule says what `{name}` may depend on"))
}

fn allowed(metadata: &Metadata, list: &[&str], name: &str) -> bool {
    list.contains(&name) || (list.contains(&PLUGINS) && is_plugin(metadata, name))
}

/// Tests that use plugins may use what every plugin is built with.
fn allowed_in_tests(metadata: &Metadata, list: &[&str], name: &str) -> bool {
    let has_plugins = list
        .iter()
        .any(|one| *one == PLUGINS || is_plugin(metadata, one));
    allowed(metadata, list, name) || (has_plugins && name == "turnpath-plugin")
}

/// Dependencies on other crates of the workspace.
fn inner<'a>(metadata: &'a Metadata, package: &'a Package) -> impl Iterator<Item = &'a Dependency> {
    package.dependencies.iter().filter(|dependency| {
        let of_name = |other: &Package| other.name == dependency.name;
        metadata.packages.iter().any(of_name)
    })
}

fn is_for_tests(dependency: &Dependency) -> bool {
    dependency.kind == DependencyKind::Development
}

/// The packages that name a dependency, of whatever kind.
fn users_of(metadata: &Metadata, name: &str) -> Vec<String> {
    let uses = |package: &&Package| package.dependencies.iter().any(|one| one.name == name);
    let users = metadata.packages.iter().filter(uses);
    users.map(|package| package.name.to_string()).collect()
}

#[test]
fn every_crate_depends_only_on_those_before_it() {
    let metadata = workspace();
    let mut seen = 0;
    for package in &metadata.packages {
        let rule = rule_for(&metadata, &package.name);
        for dependency in inner(&metadata, package) {
            let (from, to) = (&package.name, dependency.name.as_str());
            let fits = allowed(&metadata, rule.uses, to)
                || (is_for_tests(dependency) && allowed_in_tests(&metadata, rule.tests_use, to));
            assert!(
                fits,
                "`{from}` may not depend on `{to}` ({})",
                dependency.kind
            );
            seen += 1;
        }
    }
    assert!(seen >= RULES.len(), "only {seen} dependencies found");
}

#[test]
fn nothing_depends_on_the_program() {
    let metadata = workspace();
    assert_eq!(users_of(&metadata, PROGRAM), Vec::<String>::new());
}

#[test]
fn a_plugin_never_sees_host_pipeline_or_recipe_even_in_its_tests() {
    let metadata = workspace();
    let plugins = metadata.packages.iter();
    for package in plugins.filter(|package| is_plugin(&metadata, &package.name)) {
        for dependency in inner(&metadata, package) {
            let within = ["turnpath-maps", "turnpath-plugin"].contains(&dependency.name.as_str())
                || (is_for_tests(dependency)
                    && (dependency.name == "turnpath-core"
                        || is_plugin(&metadata, &dependency.name)));
            assert!(within, "{} sees {}", package.name, dependency.name);
        }
    }
}

#[test]
fn the_boundarys_library_stays_in_the_boundary() {
    let metadata = workspace();
    assert_eq!(users_of(&metadata, "abi_stable"), ["turnpath-plugin"]);
    assert_eq!(users_of(&metadata, "libloading"), ["turnpath-host"]);
}
