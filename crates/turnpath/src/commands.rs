//! The controller's commands in a recipe's own header and footer.

use turnpath_post::Post;
use turnpath_recipe::{Recipe, Span, Spanned};
use turnpath_report::ControllerCommand;

use crate::posts::posts;

/// The template before the path's lines.
const HEADER: &str = "header";

/// A command with the span of its template.
struct TemplateCommand {
    command: ControllerCommand,
    span: Span,
}

/// What the recipe's own header and footer tell the controller besides the path. The post's own
/// templates are not named, and none are where no program is asked for.
pub fn controller_commands(recipe: &Recipe) -> Vec<ControllerCommand> {
    found(recipe).map(|found| found.command).collect()
}

/// The commands of the recipe's file that may move, set or start something, each with the span of
/// its template. Those that were given with `--set` are the caller's own and need no trust.
pub fn commands_to_trust(recipe: &Recipe) -> Vec<(ControllerCommand, Span)> {
    found(recipe)
        .filter(|found| !found.command.harmless && found.span.source().rank == 0)
        .map(|found| (found.command, found.span))
        .collect()
}

fn found(recipe: &Recipe) -> impl Iterator<Item = TemplateCommand> {
    posts(recipe).flat_map(|post| {
        let settings = recipe.settings_of(post.name);
        let header = settings.and_then(|settings| settings.header.as_ref());
        let footer = settings.and_then(|settings| settings.footer.as_ref());
        let other = other_header(recipe, post).filter(|_| header.is_none());
        let templates = [
            (HEADER, other.or(header.cloned())),
            ("footer", footer.cloned()),
        ];
        let own = templates.into_iter();
        own.filter_map(|(name, own)| Some((name, own?)))
            .flat_map(|(name, own)| of_template(post, name, &own))
    })
}

/// The header that a setting of the recipe asks for in place of the post's usual one.
fn other_header(recipe: &Recipe, post: &Post) -> Option<Spanned<String>> {
    let settings = recipe.settings_of(post.name)?;
    let (key, text) = post.dialect.other_header(&settings.params)?;
    let span = recipe.nearest_span(&format!("{}.{key}", post.table));
    let value = text.to_owned();
    Some(Spanned { value, span })
}

fn of_template(post: &Post, name: &str, own: &Spanned<String>) -> Vec<TemplateCommand> {
    let mut commands = post.dialect.commands(&own.value);
    if name == HEADER {
        // The path's lines follow, and the controller does not come to them.
        for command in &mut commands {
            command.harmless &= !post.dialect.ends_program(&command.text);
        }
    }
    if name == HEADER && !post.dialect.leaves_program_open(&own.value) {
        // The path's lines follow, and go wherever this one leaves the controller.
        if let Some(last) = commands.last_mut() {
            last.harmless = false;
        }
    }
    let found = commands.into_iter().map(|command| TemplateCommand {
        command: ControllerCommand {
            post: post.name.to_owned(),
            template: name.to_owned(),
            line: command.line as u64,
            command: command.text,
            harmless: command.harmless,
        },
        span: own.span.clone(),
    });
    found.collect()
}
