//! The files of a new plugin: one small strategy for each slot, and a recipe that compares it.

use turnpath_core::Slot;

use super::source::CrateSource;

/// A strategy to begin with.
struct Template {
    /// The source, as `tests/fixtures` builds it too.
    source: &'static str,
    /// The strategy's name in it.
    name: &'static str,
    /// What it is compared with, as `[ablation]` has it.
    rivals: &'static str,
}

macro_rules! template {
    ($file:literal, $name:literal, $rivals:literal) => {
        Template {
            source: include_str!(concat!("../../templates/", $file)),
            name: $name,
            rivals: $rivals,
        }
    };
}

fn template(slot: Slot) -> Template {
    match slot {
        Slot::Surface => template!(
            "surface.rs",
            "rippled-sphere",
            r#"{ use = "conic", radius = "60 mm" }"#
        ),
        Slot::Feed => template!(
            "feed.rs",
            "even-pitch",
            r#"{ use = "constant" }, { use = "atpg" }"#
        ),
        Slot::Sampler => template!(
            "sampler.rs",
            "chord-steps",
            r#"{ use = "equal-angle" }, { use = "atpg" }, { use = "minimax" }"#
        ),
        Slot::Compensator => template!(
            "compensator.rs",
            "z-by-cosine",
            r#"{ use = "z-direction" }, { use = "normal" }"#
        ),
        Slot::Velocity => template!(
            "velocity.rs",
            "five-points",
            r#"{ use = "analytic" }, { use = "three-point" }, { use = "triangle-rotary" }"#
        ),
        Slot::Spindle => template!("spindle.rs", "two-speeds", r#"{ use = "constant" }"#),
    }
}

const README: &str = include_str!("../../templates/README.md");
const RECIPE: &str = include_str!("../../templates/recipe.toml");

/// The source file of a new strategy.
pub fn source(slot: Slot, name: &str) -> String {
    let template = template(slot);
    template.source.replace(template.name, name)
}

/// The page beside it.
pub fn readme(slot: Slot, name: &str) -> String {
    README
        .replace("NAME", name)
        .replace("SLOT_NOUN", slot.noun())
        .replace("SLOT", slot.key())
}

/// The recipe beside it: a saddle whose `[ablation]` compares the strategy with others.
pub fn recipe(slot: Slot, name: &str) -> String {
    let header = format!("[{}]\n", slot.key());
    let (before, after) = RECIPE.split_once(&header).unwrap_or((RECIPE, ""));
    let mut rest = after;
    if let Some((_, below)) = after.split_once('\n') {
        rest = below;
    }
    // The first line of a slot's table is its `use`. A surface has keys of its own besides, which end
    // with the table.
    if slot == Slot::Surface {
        rest = after.find("\n[").map_or("", |end| &after[end..]);
    }
    let (key, rivals) = (slot.key(), template(slot).rivals);
    let chosen = format!("{before}{header}use = \"{name}\"\n{rest}");
    format!("{chosen}\n[ablation]\n{key} = [{rivals}]\n")
}

/// The manifest of the crate.
pub fn manifest(name: &str, crates: &CrateSource) -> String {
    let (plugin, plugin_test) = (crates.plugin(), crates.plugin_test());
    format!(
        "[package]\n\
         name = \"{name}\"\n\
         version = \"0.1.0\"\n\
         edition = \"2024\"\n\
         publish = false\n\
         \n\
         [lib]\n\
         crate-type = [\"cdylib\"]\n\
         \n\
         [dependencies]\n\
         {plugin}\n\
         \n\
         [dev-dependencies]\n\
         {plugin_test}\n\
         \n\
         # Strategies compute: unoptimised, checks and paths take minutes.\n\
         [profile.dev]\n\
         opt-level = 2\n\
         debug = false\n\
         \n\
         # The crate stands alone, also in the folder of another workspace.\n\
         [workspace]\n"
    )
}

#[cfg(test)]
mod tests {
    use turnpath_recipe::Recipe;

    use super::*;

    #[test]
    fn every_template_has_its_name_once_as_a_name() {
        for slot in Slot::ALL {
            let template = template(slot);
            let declared = format!("const NAME: &'static str = \"{}\";", template.name);
            assert_eq!(template.source.matches(&declared).count(), 1, "{slot}");
            let source = source(slot, "my-own");
            assert!(source.contains("const NAME: &'static str = \"my-own\";"));
            assert!(!source.contains(template.name), "{slot}");
            assert!(template.source.lines().count() <= 150, "{slot}");
        }
    }

    #[test]
    fn every_recipe_chooses_the_strategy_and_compares_it() {
        for slot in Slot::ALL {
            let text = recipe(slot, "my-own");
            let recipe = Recipe::parse(&text, "recipe.toml", &[])
                .unwrap_or_else(|error| panic!("{slot}: {}\n{text}", error.render(false)));
            assert_eq!(recipe.choice(slot).name(), "my-own", "{text}");
            let variants = recipe.variants().unwrap();
            assert!(variants.len() >= 2, "{text}");
        }
    }

    #[test]
    fn the_readme_has_five_lines_with_the_names() {
        let text = readme(Slot::Sampler, "my-own");
        assert!(text.starts_with("# my-own, a sampler for turnpath\n"));
        assert_eq!(
            text.lines()
                .filter(|line| line.starts_with(|c: char| c.is_ascii_digit()))
                .count(),
            5
        );
        assert!(!text.contains("NAME") && !text.contains("SLOT"), "{text}");
    }
}
