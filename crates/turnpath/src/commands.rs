//! The controller's commands in a recipe's own header and footer.

use turnpath_post::{AroundPath, Command, Post};
use turnpath_recipe::{Recipe, Span, Spanned};
use turnpath_report::ControllerCommand;

use crate::posts::posts;

/// The template before the path's lines.
const HEADER: &str = "header";
/// The one behind them.
const FOOTER: &str = "footer";
/// Most commands of a file's header that a report names, and most of its footer: a file of another maker may
/// have any number.
const MOST_OF_A_TEMPLATE: usize = 50;

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
            (FOOTER, footer.cloned()),
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

/// How the header and the footer of a program in a file differ from those of its recipe.
#[derive(Debug, Default)]
pub struct CommandDifferences {
    /// Commands of the file that the recipe's templates do not have, and that are not known to be harmless.
    /// Lines are those of the file. A command with a placeholder is none of the templates' once it has its value.
    pub foreign: Vec<ControllerCommand>,
    /// Commands of the recipe's templates that the file does not have. Lines are those of the template.
    /// Commands with placeholders are left out.
    pub missing: Vec<ControllerCommand>,
}

/// Compares the header and the footer of a program in a file with those of its recipe.
pub fn command_differences(
    recipe: &Recipe,
    post: &Post,
    around: &AroundPath,
) -> CommandDifferences {
    let settings = recipe.settings_of(post.name);
    let own_header = settings.and_then(|settings| settings.header.clone());
    let own_footer = settings.and_then(|settings| settings.footer.clone());
    let own_header = own_header.or_else(|| other_header(recipe, post));
    let text = |own: Option<Spanned<String>>, of_post: &str| {
        own.map_or_else(|| of_post.to_owned(), |own| own.value)
    };
    let parts = [
        (HEADER, &around.header, text(own_header, post.header), 0),
        (
            FOOTER,
            &around.footer,
            text(own_footer, post.footer),
            around.before_footer,
        ),
    ];
    let mut differences = CommandDifferences::default();
    for (name, found, own, lines) in parts {
        let (found, own) = (judged(post, name, found), judged(post, name, &own));
        let missing = missing_of(&own, &found).take(MOST_OF_A_TEMPLATE);
        let missing = missing.map(|one| of_command(post, name, one.clone(), 0));
        differences.missing.extend(missing);
        let foreign = beside_own(found, own).take(MOST_OF_A_TEMPLATE);
        let foreign = foreign.map(|one| of_command(post, name, one, lines));
        differences.foreign.extend(foreign);
    }
    differences
}

/// The recipe's commands for which none stands in the file, in their order.
fn missing_of<'a>(own: &'a [Command], found: &'a [Command]) -> impl Iterator<Item = &'a Command> {
    let mut rest = found;
    let fixed = own.iter().filter(|own| !own.text.contains('{'));
    fixed.filter(move |own| {
        let place = rest.iter().position(|one| one.is_same_as(own));
        if let Some(place) = place {
            rest = &rest[place + 1..];
        }
        place.is_none()
    })
}

/// The commands that are not known to be harmless, without those of the recipe: each of these stands for one
/// in the file, in their order.
fn beside_own(found: Vec<Command>, own: Vec<Command>) -> impl Iterator<Item = Command> {
    // What is harmless in the recipe's place may not be so at the place of the file.
    let mut own = own.into_iter().filter(|own| !own.harmless).peekable();
    let found = found.into_iter().filter(|one| !one.harmless);
    found.filter(move |one| own.next_if(|own| own.is_same_as(one)).is_none())
}

/// The commands of a template, or of the text that was made from one, each judged at its place.
fn judged(post: &Post, name: &str, text: &str) -> Vec<Command> {
    let mut commands = post.dialect.commands(text);
    if name == HEADER {
        // The path's lines follow, and the controller does not come to them.
        for command in &mut commands {
            command.harmless &= !post.dialect.ends_program(&command.text);
        }
    }
    if name == HEADER && !post.dialect.leaves_program_open(text) {
        // The path's lines follow, and go wherever this one leaves the controller.
        if let Some(last) = commands.last_mut() {
            last.harmless = false;
        }
    }
    commands
}

fn of_template(post: &Post, name: &str, own: &Spanned<String>) -> Vec<TemplateCommand> {
    let commands = judged(post, name, &own.value).into_iter();
    let found = commands.map(|command| TemplateCommand {
        command: of_command(post, name, command, 0),
        span: own.span.clone(),
    });
    found.collect()
}

/// A command behind so many lines of its file.
fn of_command(post: &Post, template: &str, command: Command, lines: u64) -> ControllerCommand {
    ControllerCommand {
        post: post.name.to_owned(),
        template: template.to_owned(),
        line: lines + command.line as u64,
        command: command.text,
        harmless: command.harmless,
    }
}
