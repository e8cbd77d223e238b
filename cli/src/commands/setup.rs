//! What several commands begin with: threads, the recipe, and the strategies.

use std::io;
use std::path::Path;
use std::sync::Arc;

use turnpath::report::ControllerCommand;
use turnpath::{
    Catalogue, Diagnostic, Error, Job, PluginsLock, Recipe, commands_to_trust, with_listed_plugins,
    with_wrong_strategies,
};

use super::output::is_standard;
use crate::args::{PluginArgs, RECIPE, RecipeArgs, WorkArgs};
use crate::crash::watch;
use crate::failure::Failure;
use crate::trial::Trial;

/// What messages call a recipe of standard input. Files that it names are relative to the present
/// folder.
const FROM_INPUT: &str = "stdin.toml";
/// Folders to take plugins from, besides those on the command line.
const PLUGIN_PATH: &str = "TURNPATH_PLUGIN_PATH";

/// Sets how many threads work. It fails only when that is set already, which changes no result.
pub fn use_threads(work: &WorkArgs) {
    let threads = work.threads.map_or(0, usize::from);
    let _ = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global();
}

/// The catalogue with the plugins of `--plugin-dir` and of the environment. It has asked the lock,
/// and tried each library, before it loads one, and does so for what is added later.
pub fn with_plugins(catalogue: Catalogue, args: &PluginArgs) -> Result<Catalogue, Failure> {
    watch(args.plugin_time_limit);
    let mut catalogue = match &args.plugins_lock {
        Some(lock) => catalogue.with_admission(Arc::new(PluginsLock::load(lock)?)),
        None => catalogue,
    }
    .with_admission(Arc::new(Trial::new(args.plugin_time_limit)));
    for folder in &args.plugin_dir {
        catalogue.add_folder(folder)?;
    }
    if let Some(folders) = std::env::var_os(PLUGIN_PATH) {
        for folder in std::env::split_paths(&folders).filter(|path| !path.as_os_str().is_empty()) {
            catalogue.add_folder(&folder)?;
        }
    }
    Ok(catalogue)
}

/// The recipe of the arguments: a file, `-` for standard input, or the usual one of the folder.
fn read(recipe: Option<&Path>, sets: &[String]) -> Result<Recipe, Failure> {
    Ok(match recipe {
        Some(path) if is_standard(path) => Recipe::read(io::stdin(), FROM_INPUT, sets)?,
        Some(path) => Recipe::load(path, sets)?,
        None if Path::new(RECIPE).exists() => Recipe::load(RECIPE, sets)?,
        None => return Err(Failure::NoRecipe),
    })
}

/// The failure of a recipe that could not be read, with what is wrong with its strategies. Where plugins
/// cannot be loaded, that comes later: the recipe is to be mended first.
fn with_strategies(failure: Failure, catalogue: Catalogue, args: &PluginArgs) -> Failure {
    match failure {
        Failure::Work(error) => match with_plugins(catalogue, args) {
            Ok(catalogue) => with_wrong_strategies(error, &catalogue).into(),
            Err(_) => error.into(),
        },
        other => other,
    }
}

/// The recipe, and the catalogue with the plugins that the recipe lists, if the user trusts it.
pub fn recipe(args: &RecipeArgs, catalogue: Catalogue) -> Result<(Recipe, Catalogue), Failure> {
    let recipe = match read(args.recipe.as_deref(), &args.set) {
        Ok(recipe) => recipe,
        Err(failure) => return Err(with_strategies(failure, catalogue, &args.plugins)),
    };
    if !args.trust_recipe {
        refuse_listed_plugins(&recipe)?;
    }
    let catalogue = with_plugins(catalogue, &args.plugins)?;
    let catalogue = with_listed_plugins(catalogue, &recipe)?;
    Ok((recipe, catalogue))
}

/// Refuses a recipe that lists plugins of its own: they are native code with the user's rights.
pub fn refuse_listed_plugins(recipe: &Recipe) -> Result<(), Error> {
    let Some(first) = recipe.plugins.first() else {
        return Ok(());
    };
    let title = "the recipe asks to load plugins of its own, which takes --trust-recipe";
    let label = "native code that runs with your rights";
    let help = "look at what it lists; then call again with `--trust-recipe`, or leave \
                `plugins` out and give folders that you trust with `--plugin-dir`";
    let diagnostic = recipe.diagnostic(first.span.clone(), title, label, [help.to_owned()]);
    Err(Error::Refused {
        diagnostics: diagnostic.into(),
        source: None,
    })
}

/// Refuses a recipe whose own header or footer may make the controller do something besides the path.
fn refuse_commands(recipe: &Recipe) -> Result<(), Error> {
    let diagnostics: Vec<Diagnostic> = commands_to_trust(recipe)
        .into_iter()
        .map(|(command, span)| {
            let ControllerCommand {
                template,
                line,
                command,
                ..
            } = command;
            let title = format!(
                "line {line} of the {template} takes --trust-recipe: it tells the controller \
                 `{command}`"
            );
            let label = "may move an axis, set a variable, or start what does";
            let help = "if that is right for your machine, call again with `--trust-recipe`; the \
                        words that need no trust stand in docs/posts.md";
            recipe.diagnostic(span, title, label, [help.to_owned()])
        })
        .collect();
    match diagnostics.is_empty() {
        true => Ok(()),
        false => Err(Error::Refused {
            diagnostics: diagnostics.into_iter().collect(),
            source: None,
        }),
    }
}

/// A recipe whose own header and footer are trusted or need no trust, with the catalogue.
pub fn trusted_recipe(
    args: &RecipeArgs,
    catalogue: Catalogue,
) -> Result<(Recipe, Catalogue), Failure> {
    let (recipe, catalogue) = recipe(args, catalogue)?;
    if !args.trust_recipe {
        refuse_commands(&recipe)?;
    }
    Ok((recipe, catalogue))
}

/// The job of a recipe.
pub fn job(args: &RecipeArgs, work: &WorkArgs, catalogue: Catalogue) -> Result<Job, Failure> {
    use_threads(work);
    let (recipe, catalogue) = trusted_recipe(args, catalogue)?;
    Ok(Job::new(recipe, &catalogue)?)
}
