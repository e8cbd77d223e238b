//! The posts of a recipe, and how it lays out what they write.

use turnpath_core::Params;
use turnpath_post::{Layout, PartNumbers, Post, ProgramError, ProgramFormat, post_named};
use turnpath_recipe::{Recipe, ZReference};

use crate::error::Error;

/// Seconds of a minute: a format has the feed of its approach per minute.
const MINUTE: f64 = 60.0;

/// A path that the program of a post cannot carry.
#[derive(Debug, Clone, PartialEq)]
pub struct NotCarried {
    /// The post.
    pub post: &'static str,
    /// Why.
    pub error: ProgramError,
}

/// The posts that a recipe asks for.
pub fn posts(recipe: &Recipe) -> impl Iterator<Item = &'static Post> {
    let names = recipe.output.posts.iter();
    names.filter_map(|name| post_named(&name.value))
}

/// Refuses to read a program of a post if the recipe lacks a key that has no default.
pub fn refuse_undecided(recipe: &Recipe, post: &Post) -> Result<(), Error> {
    let none = Params::new();
    let settings = recipe.settings_of(post.name);
    let settings = settings.map_or(&none, |settings| &settings.params);
    let Some(key) = post.undecided(settings) else {
        return Ok(());
    };
    let title = format!(
        "a program of `{}` cannot be read without `{}`",
        post.name, key.name
    );
    let help = format!("give it in [{}]: {}", post.table, key.help);
    let span = recipe.nearest_span(post.table);
    let diagnostic = recipe.diagnostic(span, title, "the recipe has no such key", [help]);
    Err(Error::refused(diagnostic))
}

/// How a recipe lays out the programs of a post. A path that is not compensated is that of the
/// contact, so its Z is the tip's already.
pub fn layout(recipe: &Recipe, post: &'static Post, compensates_nose: bool) -> Layout {
    let tip = recipe.output.z_reference == ZReference::Tip && compensates_nose;
    let z_above = if tip { recipe.tool.nose_radius } else { 0.0 };
    let settings = recipe.settings_of(post.name);
    let none = Params::new();
    let params = settings.map_or(&none, |settings| &settings.params);
    let output = &recipe.output;
    let format = post.format(params, z_above, recipe.tolerance.interpolation);
    let format = ProgramFormat {
        // A rough path is played once: the loop is that of the finishing path.
        depths: format.depths.filter(|_| recipe.rough_name().is_none()),
        part_numbers: part_numbers(recipe, post, format.part_numbers),
        approach_height: output.approach_height,
        approach_feed: output.approach_feed * MINUTE,
        ..format
    };
    Layout { post, format }
}

/// The numbers of the parts of a recipe's path; `alone` are those of a path without others. All paths of a run may
/// lie in one controller, so none has the number of a part of another.
fn part_numbers(recipe: &Recipe, post: &Post, alone: PartNumbers) -> PartNumbers {
    match recipe.path_of_several() {
        Some(path) if post.dialect.calls_by_number() => PartNumbers::of_path(path),
        _ => alone,
    }
}
