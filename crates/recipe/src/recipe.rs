//! A whole recipe: its values, read and checked.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use toml::de::DeTable;
use turnpath_core::{
    Direction, JobSpec, Machine, Overrun, Part, Pose, Servo, Slot, Tolerance, Tool,
};
use turnpath_post::POSTS;

use crate::choice::Choice;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::{Reader, Table};
use crate::folder_name::folder_name;
use crate::presets::Preset;
use crate::read::Sections;
use crate::recipe_text::{FileProblem, open_regular, read_text};
use crate::rough_place::RoughPlace;
use crate::set;
use crate::span::{Source, Span, Spanned};
use crate::surface_entry::{SurfaceEntry, surface_entries};
use crate::tables::{self, AskedTolerances, DEFAULT_SPINDLE, Output, PostSettings};
use crate::wrong_recipe::{WrongRecipe, readable_choices};

/// A recipe. Lengths in mm, angles in rad.
#[derive(Debug, Clone, PartialEq)]
pub struct Recipe {
    /// The job's name; the stem of the file if the recipe gives no name.
    pub name: String,
    /// The part.
    pub part: Part,
    /// Where the part lies on the surface; without a pose the part's axis is that of the surface.
    pub pose: Option<Pose>,
    /// The surfaces that are added up, one or more.
    pub surfaces: Vec<SurfaceEntry>,
    /// The tool.
    pub tool: Tool,
    /// The tolerances that the path is made for: those that the recipe gives, and where `form`
    /// stands for one, the first share of it.
    pub tolerance: Tolerance,
    /// The tolerances that the recipe gives.
    pub tolerances: AskedTolerances,
    /// The largest speed of the spindle, rad/s.
    pub spindle_speed: f64,
    /// The limits of the machine; there are none unless the recipe gives them.
    pub machine: Machine,
    /// The machine that the recipe names. Limits that the recipe gives itself replace those of the
    /// preset.
    pub preset: Option<&'static Preset>,
    /// How the machine's axes follow their commands, if the recipe has `[servo]`.
    pub servo: Option<Servo>,
    /// The direction of the feed.
    pub direction: Direction,
    /// How far the path runs beyond the aperture.
    pub overrun: Overrun,
    /// Whether the path runs from rest to rest.
    pub lead: bool,
    /// Height of the rest positions above the highest point of the part, mm.
    pub clearance: f64,
    /// Whether segments whose error exceeds the tolerance are halved. `span("refine")` is `Some` if
    /// the recipe gives the key itself.
    pub refine: bool,
    /// The files to write.
    pub output: Output,
    /// The tables of all posts, in the order of [`POSTS`].
    pub post_settings: Vec<PostSettings>,
    /// Folders and libraries to load plugins from, as the recipe gives them, relative to the recipe.
    pub plugins: Vec<Spanned<String>>,
    /// What it is, where this is the recipe of a rough path.
    pub(crate) rough: Option<RoughPlace>,
    choices: [Choice; 6],
    document: Table,
    sets: Vec<String>,
    whole: Span,
    path: PathBuf,
}

/// Why there is no recipe.
#[derive(Debug, thiserror::Error)]
pub enum RecipeError {
    /// The file could not be read.
    #[error("cannot read the recipe {}", path.display())]
    File {
        /// The path as the user gave it.
        path: PathBuf,
        /// Why.
        #[source]
        problem: FileProblem,
    },
    /// The recipe, or a `--set`, is wrong.
    #[error(transparent)]
    Wrong(#[from] WrongRecipe),
}

impl RecipeError {
    /// The messages as the user sees them; `color` adds the colours of a terminal.
    pub fn render(&self, color: bool) -> String {
        match self {
            Self::Wrong(wrong) => wrong.messages().render(color),
            Self::File { .. } => Diagnostic::from_error(self).render(color),
        }
    }
}

impl Recipe {
    /// Reads a recipe's file and applies `--set` arguments.
    ///
    /// # Errors
    /// When the file cannot be read, or the recipe or an argument is wrong.
    pub fn load(path: impl AsRef<Path>, sets: &[String]) -> Result<Self, RecipeError> {
        let path = path.as_ref();
        let text = open_regular(path).and_then(read_text);
        Self::of_text(text, path, sets)
    }

    /// Reads a recipe's text from anything, such as standard input, and applies `--set` arguments.
    /// Messages name `path`, and files that the recipe names are relative to it.
    ///
    /// # Errors
    /// As those of [`Recipe::load`].
    pub fn read(
        reader: impl Read,
        path: impl AsRef<Path>,
        sets: &[String],
    ) -> Result<Self, RecipeError> {
        Self::of_text(read_text(reader), path.as_ref(), sets)
    }

    fn of_text(
        text: Result<String, FileProblem>,
        path: &Path,
        sets: &[String],
    ) -> Result<Self, RecipeError> {
        let text = text.map_err(|problem| RecipeError::File {
            path: path.to_owned(),
            problem,
        })?;
        Self::parse(&text, path, sets)
    }

    /// Reads a recipe's text and applies `--set` arguments. Messages name `path`, and files that the
    /// recipe names are relative to it.
    ///
    /// # Errors
    /// When the recipe or an argument is wrong.
    pub fn parse(text: &str, path: impl AsRef<Path>, sets: &[String]) -> Result<Self, RecipeError> {
        let path = path.as_ref();
        let name = path.display().to_string();
        let source = Arc::new(Source {
            name,
            text: text.to_owned(),
            rank: 0,
        });
        let mut document = read_document(&source).map_err(WrongRecipe::from)?;
        let mut diagnostics = Vec::new();
        set::apply_all(&mut document, sets, &mut diagnostics);
        let whole = Span::whole(source);
        Ok(read_whole(
            document,
            sets.to_vec(),
            whole,
            path,
            diagnostics,
        )?)
    }

    /// The recipe with one more value, as the argument `--set key=value` gives it: it replaces the
    /// value under the key, or adds the key.
    ///
    /// ```
    /// # use turnpath_recipe::{Recipe, RecipeError};
    /// # let text = r#"
    /// # format = 1
    /// # part = { aperture = "5 mm" }
    /// # surface = { use = "astigmatic", k = "0.08 /mm" }
    /// # tool = { nose_radius = "1 mm" }
    /// # tolerance = { interpolation = "100 nm", residual = "100 nm" }
    /// # spindle = { speed = "500 rpm" }
    /// # feed = { use = "constant", feed = "10 um/rev" }
    /// # sampler = { use = "equal-angle", step = "6 deg" }
    /// # compensator = { use = "z-direction" }
    /// # velocity = { use = "triangle-rotary" }
    /// # "#;
    /// let recipe = Recipe::parse(text, "mirror.toml", &[])?;
    /// let recipe = recipe
    ///     .set("tolerance.residual", "50 nm")?
    ///     .set("spindle.speed", "400 rpm")?;
    /// assert_eq!(recipe.tolerance.residual, 50e-6);
    /// let sets = ["tolerance.residual=50 nm", "spindle.speed=400 rpm"];
    /// assert_eq!(recipe.sets(), sets);
    /// # Ok::<(), RecipeError>(())
    /// ```
    ///
    /// # Errors
    /// When the key or the value is wrong.
    pub fn set(mut self, key: &str, value: &str) -> Result<Self, RecipeError> {
        let rank = self.sets.len() + 1;
        let argument = set::argument(key, value, rank);
        let argument = argument.map_err(|wrong| WrongRecipe::from(Diagnostics::from(wrong)))?;
        let applied = set::apply(&mut self.document, &argument, rank);
        let diagnostics = applied.err().into_iter().collect();
        self.sets.push(argument);
        // The document has all values of the text and of the sets before, so it need not be read
        // again; and a variant of an ablation keeps its own values.
        let (document, sets) = (self.document, self.sets);
        Ok(read_whole(
            document,
            sets,
            self.whole,
            &self.path,
            diagnostics,
        )?)
    }

    /// The `--set` arguments that were applied, in their order.
    pub fn sets(&self) -> &[String] {
        &self.sets
    }

    /// The strategies chosen for a slot: of surfaces one or more, else one.
    pub fn choices(&self, slot: Slot) -> Vec<&Choice> {
        match slot {
            Slot::Surface => self.surfaces.iter().map(|entry| &entry.choice).collect(),
            slot => vec![self.choice(slot)],
        }
    }

    /// The name of the surface; of a sum "conic + zernike".
    pub fn surface_name(&self) -> String {
        let names: Vec<&str> = self
            .surfaces
            .iter()
            .map(|entry| entry.choice.name())
            .collect();
        names.join(" + ")
    }

    /// The strategy chosen for a slot; of a sum the first surface.
    pub fn choice(&self, slot: Slot) -> &Choice {
        match slot {
            Slot::Surface => &self.choices[0],
            Slot::Feed => &self.choices[1],
            Slot::Sampler => &self.choices[2],
            Slot::Compensator => &self.choices[3],
            Slot::Velocity => &self.choices[4],
            Slot::Spindle => &self.choices[5],
        }
    }

    /// Part, tool, tolerances, overrun, direction, largest spindle speed and machine, for the pipeline.
    pub fn job_spec(&self) -> JobSpec {
        JobSpec {
            part: self.part,
            tool: self.tool,
            tolerance: self.tolerance,
            overrun: self.overrun,
            direction: self.direction,
            spindle_speed: self.spindle_speed,
            machine: self.machine,
        }
    }

    /// The table of a post, by its name.
    pub fn settings_of(&self, post: &str) -> Option<&PostSettings> {
        self.post_settings.iter().find(|table| table.post == post)
    }

    /// Whether the spindle turns at one speed over the whole cut.
    pub fn has_constant_spindle(&self) -> bool {
        self.choice(Slot::Spindle).name() == DEFAULT_SPINDLE
    }

    /// The span of the value under a path of keys, `tool.nose_radius`; `None` if the recipe leaves
    /// the key out.
    pub fn span(&self, path: &str) -> Option<Span> {
        self.document
            .find(path.split('.'))
            .map(|node| node.span.clone())
    }

    /// The span of the value under a path of keys, else of its table, else of the recipe as a whole.
    pub fn nearest_span(&self, path: &str) -> Span {
        let table = || self.span(path.split('.').next().unwrap_or(path));
        self.span(path)
            .or_else(table)
            .unwrap_or_else(|| self.whole.clone())
    }

    /// The span of the header of a slot's table.
    pub fn table_span(&self, slot: Slot) -> Span {
        self.choice(slot).span.clone()
    }

    /// All values of the recipe, with the `--set` arguments applied.
    pub fn document(&self) -> &Table {
        &self.document
    }

    /// The recipe as a whole, for messages about no single value.
    pub(crate) fn whole(&self) -> &Span {
        &self.whole
    }

    /// The recipe's text, without the `--set` arguments.
    pub fn text(&self) -> &str {
        &self.whole.source().text
    }

    /// The recipe's path, as the user gave it.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The beginning of the names of its programs: the recipe's file name without its extension, `recipe`
    /// if it has none, and the name of the rough path.
    pub fn stem(&self) -> String {
        match &self.rough {
            Some(rough) => format!("{}-{}", stem(&self.path), rough.name),
            None => stem(&self.path),
        }
    }

    /// What the path leaves on the wanted surface, along z, mm: zero but for a rough path.
    pub fn allowance(&self) -> f64 {
        self.rough.as_ref().map_or(0.0, |rough| rough.allowance)
    }

    /// The name of the rough path whose recipe this is.
    pub fn rough_name(&self) -> Option<&str> {
        self.rough.as_ref().map(|rough| rough.name.as_str())
    }

    /// The recipe's name as the name of a folder, with characters that Linux, macOS and Windows allow.
    /// Other characters stand as their bytes, `%2F` for `/`, so that names that differ have folders
    /// that differ. A name of more than 255 bytes, and on Windows a name of a device such as `NUL`,
    /// stay: the system refuses the folder.
    pub fn folder_name(&self) -> String {
        folder_name(&self.name)
    }

    /// The path of a file that the recipe names: relative names start at the recipe's folder.
    pub fn resolve(&self, file: &str) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(file)
    }

    /// A message about a span, for callers that find something wrong later.
    pub fn diagnostic(
        &self,
        span: Span,
        title: impl Into<String>,
        label: impl Into<String>,
        help: impl IntoIterator<Item = String>,
    ) -> Diagnostic {
        Diagnostic::new(span, title)
            .with_label(label)
            .with_helps(help)
    }
}

fn stem(path: &Path) -> String {
    path.file_stem()
        .map_or("recipe".into(), |stem| stem.to_string_lossy().into_owned())
}

fn read_document(source: &Arc<Source>) -> Result<Table, Diagnostics> {
    let reader = Reader {
        source: source.clone(),
        offset: 0,
    };
    match DeTable::parse(&source.text) {
        Ok(table) => Ok(reader.table(table.get_ref())),
        Err(error) => {
            let span = match error.span() {
                Some(span) => reader.span(span),
                None => Span::whole(source.clone()),
            };
            let title = format!("the recipe is not TOML: {}", error.message());
            Err(Diagnostic::new(span, title).into())
        }
    }
}

/// Reads a recipe's values, in whose document the `diagnostics` were found already.
fn read_whole(
    document: Table,
    sets: Vec<String>,
    whole: Span,
    path: &Path,
    mut diagnostics: Vec<Diagnostic>,
) -> Result<Recipe, WrongRecipe> {
    let recipe = build(
        document.clone(),
        sets,
        whole.clone(),
        path,
        &mut diagnostics,
    );
    Diagnostics::unless_any(recipe, diagnostics)
        .map_err(|messages| WrongRecipe::new(messages, readable_choices(&document, &whole)))
}

/// Reads a recipe's values and adds a message for each that is wrong.
pub(crate) fn build(
    document: Table,
    sets: Vec<String>,
    whole: Span,
    path: &Path,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<Recipe> {
    let mut sections = Sections {
        root: &document,
        whole: &whole,
        schema: tables::SCHEMA,
        diagnostics,
    };
    if !tables::format_is_one(&mut sections.top()) {
        return None;
    }
    let top = tables::top(&mut sections.top());
    let part = tables::part(&mut sections.open("part"));
    let pose = tables::pose(&mut sections.open("part.pose"));
    let tool = tables::tool(&mut sections.open("tool"));
    let tolerance = tables::tolerance(&mut sections.open("tolerance"));
    let speed = tables::spindle(&mut sections.open("spindle"));
    let machine = tables::machine(&mut sections.open("machine"));
    if let Some(speed) = speed {
        tables::check_spindle(&mut sections.open("spindle"), speed, &machine.machine);
    }
    let has_servo = document.get("servo").is_some() || document.has_like("servo");
    tables::check_servo_tolerance(&mut sections.open("tolerance"), has_servo);
    let servo = tables::servo(&mut sections.open("servo"), machine.preset);
    let path_table = tables::path(&mut sections.open("path"));
    let output = tables::output(&mut sections.open("output"));
    let posts = POSTS.iter();
    let post_settings = posts
        .map(|post| {
            let is_asked = output.posts.iter().any(|asked| asked.value == post.name);
            tables::post_settings(post, &mut sections.open(post.table), is_asked)
        })
        .collect();
    let surfaces = surface_entries(&mut sections);
    let mut choose = |slot: Slot| Choice::read(slot, &mut sections.open(slot.key()));
    let [feed, sampler, compensator, velocity, spindle] = [
        Slot::Feed,
        Slot::Sampler,
        Slot::Compensator,
        Slot::Velocity,
        Slot::Spindle,
    ]
    .map(&mut choose);
    let (tool, path_table, surfaces, tolerance) = (tool?, path_table?, surfaces?, tolerance?);
    let surface = surfaces.first().map(|entry| entry.choice.clone());
    Some(Recipe {
        name: top.name.unwrap_or_else(|| stem(path)),
        part: part?,
        pose: pose?,
        surfaces,
        tool,
        tolerance: tolerance.path,
        tolerances: tolerance.asked,
        spindle_speed: speed?,
        machine: machine.machine,
        preset: machine.preset,
        servo,
        direction: path_table.direction,
        overrun: path_table.overrun,
        lead: path_table.lead,
        clearance: path_table.clearance,
        refine: top.refine,
        output,
        post_settings,
        plugins: top.plugins,
        rough: None,
        choices: [surface?, feed?, sampler?, compensator?, velocity?, spindle?],
        document,
        sets,
        whole,
        path: path.to_owned(),
    })
}
