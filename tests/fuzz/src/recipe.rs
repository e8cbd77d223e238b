//! Recipes: read, bound against the built-in strategies, made; and every message about them.

use std::sync::OnceLock;

use turnpath::{Catalogue, Diagnostic, Diagnostics, Recipe, RecipeError, Slot};
use turnpath_host::Strategy;

use turnpath_core::Params;

/// What begins a line that is an argument of `--set` rather than a part of the recipe. TOML takes the
/// line for a comment.
const SET: &str = "#--set ";
/// Most variants of an ablation that are looked at.
const MOST_VARIANTS: usize = 50;

/// Words of recipes.
pub const WORDS: &[&str] = &[
    "[part]\n",
    "[part.pose]\n",
    "[surface]\n",
    "[[surface]]\n",
    "[tool]\n",
    "[tolerance]\n",
    "[spindle]\n",
    "[path]\n",
    "[machine]\n",
    "[servo]\n",
    "[output]\n",
    "[output.pmac-pvt]\n",
    "[ablation]\n",
    "[feed]\n",
    "[sampler]\n",
    "[compensator]\n",
    "[velocity]\n",
    "use = ",
    "\"conic\"",
    "\"xy-polynomial\"\nterms = [[1, 1, 0.16]]",
    "\"astigmatic\"",
    "\"atpg\"",
    "\"none\"",
    "\"contact\"",
    "aperture = \"5 mm\"\n",
    "format = 1\n",
    "name = \"a\"\n",
    "posts = [\"pmac-pvt\"]",
    "header = \"; {name}\"",
    "plugins = []\n",
    "level = true\n",
    "\n#--set part.aperture=1mm\n",
    "\n#--set surface.0.use=\"conic\"\n",
    "\n#--set tool={nose_radius=\"1 mm\"}\n",
    "[",
    "]",
    "{",
    "}",
    "=",
    ".",
    ",",
    "\"",
    "'''",
    "\"\"\"",
    "\n",
    "\r",
    "\t",
    "\\u0000",
    "\u{1b}[2J",
    "\u{7}",
    "\u{202e}",
    "\u{fffd}",
    "\u{10ffff}",
    "inf",
    "nan",
    "1e300",
    "-1",
    "0",
    "9223372036854775808",
    "0x7fffffffffffffff",
    "0o17",
    "1979-05-27T07:32:00Z",
    " mm",
    " um/rev",
    " deg",
    " /mm",
    "\u{b5}m",
    " rpm",
];

/// Reads a recipe with the arguments of `--set` that it has in its comments.
pub fn read(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    let sets: Vec<String> = text
        .lines()
        .filter_map(|line| line.strip_prefix(SET))
        .map(str::to_owned)
        .collect();
    match Recipe::parse(text, "folder/recipe.toml", &sets) {
        Err(error) => check_error(&error),
        Ok(recipe) => {
            check_names(&recipe);
            bind(&recipe);
            for variant in recipe.variants().iter().flatten().take(MOST_VARIANTS) {
                bind(&variant.recipe);
            }
            if let Err(wrong) = recipe.variants() {
                check_messages(&wrong);
            }
            // The same value once more changes nothing that could be refused.
            let again = recipe.set("format", "1");
            assert!(again.is_ok(), "{again:?}");
        }
    }
}

fn check_error(error: &RecipeError) {
    match error {
        RecipeError::Wrong(wrong) => check_messages(wrong.messages()),
        RecipeError::File { .. } => panic!("no file was read"),
    }
}

/// There is a message, and what a person sees of it cannot repaint the terminal.
fn check_messages(wrong: &Diagnostics) {
    assert!(wrong.iter().next().is_some(), "refused without a message");
    wrong.iter().for_each(check_message);
}

fn check_message(message: &Diagnostic) {
    assert!(!message.title().is_empty());
    assert!(!message.render(true).is_empty());
    let plain = message.render(false);
    let strange = |c: char| c.is_control() && c != '\n';
    assert!(!plain.contains(strange), "{plain:?}");
}

/// The name of the output folder is one name, and none that stands for another folder.
fn check_names(recipe: &Recipe) {
    let folder = recipe.folder_name();
    let strange = |c: char| c.is_control() || "/\\".contains(c);
    assert!(!folder.contains(strange), "{folder:?}");
    assert!(!["", ".", ".."].contains(&folder.as_str()), "{folder:?}");
    assert!(!recipe.surface_name().is_empty());
}

/// The built-in strategies.
fn catalogue() -> &'static Catalogue {
    static CATALOGUE: OnceLock<Catalogue> = OnceLock::new();
    CATALOGUE.get_or_init(|| Catalogue::linked().expect("the built-in strategies"))
}

/// Looks the strategies up, binds their parameters, and makes them.
fn bind(recipe: &Recipe) {
    for choice in Slot::ALL.into_iter().flat_map(|slot| recipe.choices(slot)) {
        let Some(strategy) = catalogue().find(choice.slot, choice.name()) else {
            check_message(&choice.unknown(&catalogue().names(choice.slot)));
            continue;
        };
        match choice.bind(&strategy.info()) {
            Ok(binding) => make(strategy, &binding.params),
            Err(wrong) => check_messages(&wrong),
        }
    }
}

/// Makes a strategy. It may refuse its parameters; it must not panic.
fn make(strategy: &Strategy, params: &Params) {
    let offer = strategy.offer();
    let refusal = match strategy.info().slot {
        Slot::Surface => offer.surface(params).err(),
        Slot::Feed => offer.feed(params).err(),
        Slot::Sampler => offer.sampler(params).err(),
        Slot::Compensator => offer.compensator(params).err(),
        Slot::Velocity => offer.velocity(params).err(),
        Slot::Spindle => offer.spindle(params).err(),
    };
    if let Some(error) = refusal {
        let panicked = matches!(error, turnpath_core::StrategyError::Panicked(_));
        assert!(!panicked, "{error}");
    }
}
