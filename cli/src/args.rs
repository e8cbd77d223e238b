//! The command line.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use turnpath::MapFormat;
use turnpath::report::comparison;
use turnpath_core::Slot;

use crate::crash::TimeLimit;

/// The recipe where none is given.
pub const RECIPE: &str = "recipe.toml";

/// Tool paths for slow-tool-servo diamond turning of freeform optics.
///
/// Exit status: 0 done, and all tolerances hold; 1 done, and a tolerance or a limit of the
/// machine does not hold; 2 the recipe or the call is wrong; 3 a plugin failed; 4 a file could not
/// be written or read.
#[derive(Debug, Parser)]
#[command(name = "turnpath", version, propagate_version = true)]
pub struct Program {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Make the tool path of a recipe, measure it and write its files
    Run(RunArgs),
    /// Check a recipe without making its path: parameters, interference, expected size
    Check(CheckArgs),
    /// Make the variants of a recipe that its `[ablation]` lists, and set their figures side by side
    Ablate(AblateArgs),
    /// Measure a tool path against a recipe's surface, tool and tolerances
    Verify(VerifyArgs),
    /// Make the page of a result, report.html, from its files
    Report(ReportArgs),
    /// Write the surface of a recipe on a grid, or compare it with a map
    Sag(SagArgs),
    /// Make a recipe of a surface of a lens design, a Zemax .zmx
    Import(ImportArgs),
    /// List the strategies that can be chosen
    List(ListArgs),
    /// Explain one strategy, or one table of the recipe: its keys, defaults and limits
    Explain(ExplainArgs),
    /// Write a plugin with a small strategy that works, for you to change
    NewPlugin(NewPluginArgs),
    /// Write a commented recipe to begin with
    Init(InitArgs),
    /// Print a JSON schema of recipes, with which an editor completes and checks them
    Schema(SchemaArgs),
    /// Print what completes the program's words in a shell
    Completions(CompletionsArgs),
    /// Write the manual pages, one for each command
    Man(ManArgs),
}

/// Where strategies come from.
#[derive(Debug, Args)]
pub struct PluginArgs {
    /// Take plugins from this folder too; may be given several times
    #[arg(long, value_name = "DIR")]
    pub plugin_dir: Vec<PathBuf>,
    /// End a run in which one call into a plugin takes longer, such as "2 min"; none for no limit
    #[arg(long, value_name = "DURATION", default_value_t)]
    pub plugin_time_limit: TimeLimit,
    /// Load only plugins that this lock has, with the SHA-256 that it has for them
    #[arg(long, value_name = "FILE")]
    pub plugins_lock: Option<PathBuf>,
    /// Print the whole comparison when a plugin's layout differs
    #[arg(long)]
    pub layout_details: bool,
}

/// A recipe, and how it is changed.
#[derive(Debug, Args)]
pub struct RecipeArgs {
    /// The recipe; recipe.toml unless given, - for standard input
    pub recipe: Option<PathBuf>,
    /// Set a key of the recipe, such as tolerance.residual="50 nm"; may be given several times
    #[arg(long, value_name = "KEY.PATH=VALUE")]
    pub set: Vec<String>,
    #[command(flatten)]
    pub plugins: PluginArgs,
    /// Load the plugins that the recipe itself lists, native code with your rights, and put the
    /// commands of its header and footer into the program, whatever they make the machine do
    #[arg(long)]
    pub trust_recipe: bool,
}

/// How a command works and answers.
#[derive(Debug, Args)]
pub struct WorkArgs {
    /// How many threads to use; as many as there are cores unless given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// What to print on standard output
    #[arg(long, value_enum, default_value_t = Format::Human)]
    pub format: Format,
    /// Print no summary and no progress; the exit status says the verdict
    #[arg(short, long, conflicts_with_all = ["verbose", "format"])]
    pub quiet: bool,
    /// Say on standard error how long each stage took, and what was counted (run, check, verify, report)
    #[arg(short, long)]
    pub verbose: bool,
}

impl WorkArgs {
    /// What to print on standard output; nothing where that is asked.
    pub fn answer(&self) -> Option<Format> {
        (!self.quiet).then_some(self.format)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// A summary for a person
    Human,
    /// The same as JSON
    Json,
}

/// What is drawn of the machined surface: machined − wanted along z.
#[derive(Debug, Args)]
pub struct PlotArgs {
    /// Write a map of the surface error: .gsf (Gwyddion) or .xyz (lines x y z), both in metres; a
    /// relative name is taken from DIR, as with the files below
    #[arg(long, value_name = "FILE")]
    pub map: Option<PathBuf>,
    /// Cells of the map along each side; on a polar grid N rings of N angles
    #[arg(long, value_name = "N", default_value_t = 1024,
          value_parser = clap::value_parser!(u32).range(2..=20_000))]
    pub map_size: u32,
    /// How the map's cells lie; a .gsf has a Cartesian grid
    #[arg(long, value_enum, default_value_t = MapGrid::Cartesian)]
    pub map_grid: MapGrid,
    /// Write the profile through the axis at this angle, such as "45 deg", and its power spectrum;
    /// may be given several times
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true)]
    pub profile: Vec<String>,
    /// Write the surface error around a circle of this radius, such as "2 mm"; may be given
    /// several times
    #[arg(long, value_name = "RADIUS", allow_hyphen_values = true)]
    pub circle: Vec<String>,
    /// Write the power spectrum of the played X and Z over the cut, spectrum.csv
    #[arg(long)]
    pub spectrum: bool,
}

/// Figures for papers.
#[derive(Debug, Args)]
pub struct DrawingArgs {
    /// Draw a figure for a paper as .svg or .png: map, spiral, feed, axes or spectrum, such as
    /// map=error.svg, or spectrum.png; may be given several times; a relative name is taken from DIR
    #[arg(long, value_name = "[FIGURE=]FILE")]
    pub plot: Vec<String>,
    /// Width and height of each figure in mm, such as 85x60; the figure's own unless given
    #[arg(long, value_name = "WxH", requires = "plot")]
    pub plot_size: Option<String>,
    /// Dots an inch of a .png
    #[arg(long, value_name = "N", default_value_t = 300, requires = "plot")]
    pub plot_dpi: u32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum MapGrid {
    /// Squares over the square around the part
    Cartesian,
    /// Rings and angles
    Polar,
}

#[derive(Debug, Args)]
pub struct RunArgs {
    #[command(flatten)]
    pub recipe: RecipeArgs,
    /// Where the files go; `out/<name>` unless given
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Write a dry run beside each program: it stops at C = 0, 90, 180 and 270 deg, and at an angle that
    /// shows more, with the tool high above the rim, and says how high the part is there
    #[arg(long)]
    pub dry_run: bool,
    /// Leave out the page of the result, report.html
    #[arg(long)]
    pub no_report: bool,
    #[command(flatten)]
    pub drawings: DrawingArgs,
    #[command(flatten)]
    pub plots: PlotArgs,
    #[command(flatten)]
    pub work: WorkArgs,
}

#[derive(Debug, Args)]
pub struct ReportArgs {
    /// The folders of results: of `run`, or of `ablate`
    #[arg(required = true, value_name = "DIR")]
    pub folders: Vec<PathBuf>,
    /// The recipe, where its data files lie beside it, or where the summary does not have its text
    #[arg(long, value_name = "FILE")]
    pub recipe: Option<PathBuf>,
    #[command(flatten)]
    pub drawings: DrawingArgs,
    #[command(flatten)]
    pub plugins: PluginArgs,
    /// Load the plugins that the recipe itself lists, native code with your rights
    #[arg(long)]
    pub trust_recipe: bool,
    #[command(flatten)]
    pub work: WorkArgs,
}

#[derive(Debug, Args)]
pub struct CheckArgs {
    #[command(flatten)]
    pub recipe: RecipeArgs,
    #[command(flatten)]
    pub work: WorkArgs,
}

#[derive(Debug, Args)]
pub struct AblateArgs {
    #[command(flatten)]
    pub recipe: RecipeArgs,
    /// Where the figures go; `out/<name>-ablation` unless given
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// The columns of the table, in this order
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    #[arg(value_parser = PossibleValuesParser::new(comparison::names()))]
    pub columns: Vec<String>,
    /// Sort the rows by this column, the best first
    #[arg(long, value_name = "NAME")]
    #[arg(value_parser = PossibleValuesParser::new(comparison::names()))]
    pub sort: Option<String>,
    /// Leave out the ratios to the first run
    #[arg(long)]
    pub no_ratio: bool,
    /// Print the table alone, for a paper or a page
    #[arg(long, value_enum, value_name = "LANGUAGE", conflicts_with_all = ["format", "quiet"])]
    pub table: Option<TableLanguage>,
    /// Refine every variant until it holds its tolerance, as with `refine = true`: then the points
    /// and the times compare chains of the same accuracy
    #[arg(long)]
    pub equal_tolerance: bool,
    /// Make all runs anew, also those that were made before
    #[arg(long)]
    pub fresh: bool,
    /// Print the runs with their keys, and which of them are done, as JSON; or the keys of those that
    /// are not, a line each; make nothing
    #[arg(long, value_enum, value_name = "FORM", num_args = 0..=1, require_equals = true)]
    #[arg(default_missing_value = "json")]
    #[arg(conflicts_with_all = ["only", "merge", "fresh", "table", "format", "quiet"])]
    #[arg(conflicts_with_all = ["sort", "columns", "no_ratio"])]
    pub plan: Option<PlanForm>,
    /// Write the recipe, its data files and plugins, and the plan into a new folder, which can be
    /// carried to another machine; make nothing
    #[arg(long, value_name = "DIR", conflicts_with_all = ["plan", "only", "merge", "fresh", "table"])]
    #[arg(conflicts_with_all = ["format", "equal_tolerance", "output"])]
    pub pack: Option<PathBuf>,
    /// Make the run of this key alone, and leave its record
    #[arg(long, value_name = "KEY", conflicts_with_all = ["merge", "fresh", "table"])]
    pub only: Option<String>,
    /// Make nothing, and write the table of the records that are there; status 1 if some are missing
    #[arg(long, conflicts_with = "fresh")]
    pub merge: bool,
    #[command(flatten)]
    pub work: WorkArgs,
}

/// The form of a plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum PlanForm {
    /// All runs, with what varies and whether they are done
    Json,
    /// The keys of the runs that are not done, a line each
    Open,
}

/// The language of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum TableLanguage {
    /// With bars
    Markdown,
    /// A tabular with the rules of booktabs
    Latex,
    /// Comma-separated values with all digits
    Csv,
}

#[derive(Debug, Args)]
#[command(allow_missing_positional = true)]
pub struct VerifyArgs {
    #[command(flatten)]
    pub recipe: RecipeArgs,
    /// The tool path to measure: a toolpath.csv, or a program of a post (.pmc, .ppmc, .ascript, .mpf, .ncp,
    /// .cnc, .nc, .ngc), also with .zst behind it
    pub file: PathBuf,
    /// Where maps, profiles, circles and the spectrum go; the present folder unless given
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub plots: PlotArgs,
    #[command(flatten)]
    pub work: WorkArgs,
}

#[derive(Debug, Args)]
pub struct SagArgs {
    #[command(flatten)]
    pub recipe: RecipeArgs,
    /// Points along each side of the square around the aperture, its edges included
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=20_000))]
    #[arg(required_unless_present = "against", conflicts_with = "against")]
    pub grid: Option<u32>,
    /// The file to write: .gsf (Gwyddion), .DAT (Zemax), or CSV for all others; - for CSV on
    /// standard output
    #[arg(short, long, value_name = "FILE", required_unless_present = "against")]
    pub output: Option<PathBuf>,
    /// Compare a map with the surface instead, at the map's own points on the part; -o then writes
    /// the difference, map minus surface
    #[arg(long, value_name = "MAP")]
    pub against: Option<PathBuf>,
    #[command(flatten)]
    pub map: MapArgs,
    /// What to print on standard output
    #[arg(long, value_enum, requires = "against", conflicts_with = "grid")]
    pub format: Option<Format>,
}

/// What the file of a map does not say. What is given goes before what the file says.
#[derive(Debug, Args)]
pub struct MapArgs {
    /// Format of the map: zemax, code-v, xyz, gsf or metropro; as its first bytes or its name say
    /// unless given
    #[arg(
        long,
        value_name = "FORMAT",
        requires = "against",
        conflicts_with = "grid"
    )]
    #[arg(value_parser = PossibleValuesParser::new(MapFormat::WORDS.map(|(word, _)| word)))]
    pub map_format: Option<String>,
    /// Unit of x, y and distances in the map: m, cm, mm, um, nm or in
    #[arg(
        long,
        value_name = "UNIT",
        requires = "against",
        conflicts_with = "grid"
    )]
    pub xy_unit: Option<String>,
    /// Unit of heights in the map
    #[arg(
        long,
        value_name = "UNIT",
        requires = "against",
        conflicts_with = "grid"
    )]
    pub z_unit: Option<String>,
    /// Distance of neighbouring points of the map, such as "0.1 mm"
    #[arg(
        long,
        value_name = "LENGTH",
        requires = "against",
        conflicts_with = "grid"
    )]
    pub pitch: Option<String>,
    /// Change the sign of x in the map
    #[arg(long, requires = "against", conflicts_with = "grid")]
    pub flip_x: bool,
}

#[derive(Debug, Args)]
pub struct ImportArgs {
    /// The lens design: a Zemax .zmx
    pub file: PathBuf,
    /// The number of the surface in the design; the only one that is bent unless given
    #[arg(long, value_name = "N")]
    pub surface: Option<usize>,
    /// The side of the surface on which the tool stands; the side without material unless given
    #[arg(long, value_enum, value_name = "SIDE")]
    pub tool_side: Option<ToolSide>,
    /// The diameter of the part, such as "60 mm"; that of the aperture in the design unless given
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub aperture: Option<String>,
    /// The recipe to write; standard output unless given, as with -
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Replace a file that is there
    #[arg(long)]
    pub force: bool,
}

/// A side of a surface, by the z axis of its design.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ToolSide {
    /// Where z of the design is less
    MinusZ,
    /// Where z of the design is more
    PlusZ,
}

#[derive(Debug, Args)]
pub struct ListArgs {
    /// Only the strategies of this slot
    #[arg(value_parser = PossibleValuesParser::new(Slot::ALL.map(Slot::key)))]
    pub slot: Option<String>,
    /// Print a lock of the plugins that are loaded, or write it to FILE
    #[arg(long, value_name = "FILE", num_args = 0..=1, require_equals = true)]
    pub lock: Option<Option<PathBuf>>,
    /// What to print on standard output
    #[arg(long, value_enum, default_value_t = Format::Human, conflicts_with = "lock")]
    pub format: Format,
    #[command(flatten)]
    pub plugins: PluginArgs,
}

#[derive(Debug, Args)]
pub struct ExplainArgs {
    /// The strategy's name, with its slot before it where two slots have one of that name; or a
    /// table's, such as tool, and recipe for the keys above the first table
    #[arg(value_name = "[SLOT/]NAME")]
    pub name: String,
    #[command(flatten)]
    pub plugins: PluginArgs,
}

#[derive(Debug, Args)]
pub struct NewPluginArgs {
    /// The strategy's name, which is that of its crate and of its folder: lower-case letters, digits
    /// and hyphens
    pub name: String,
    /// The slot of the strategy
    #[arg(long, value_parser = PossibleValuesParser::new(Slot::ALL.map(Slot::key)))]
    pub slot: String,
    /// The folder in which the folder of the crate is made
    #[arg(long, value_name = "DIR", default_value = ".")]
    pub dir: PathBuf,
    /// Where turnpath's crates come from: a folder with turnpath's repository, the address of a git
    /// repository (and # with a revision), or `registry`; as this program was built unless given
    #[arg(long, value_name = "SOURCE")]
    pub crates: Option<String>,
    #[command(flatten)]
    pub plugins: PluginArgs,
}

#[derive(Debug, Args)]
pub struct InitArgs {
    /// The recipe to write; - for standard output
    #[arg(value_name = "FILE", default_value = RECIPE)]
    pub file: PathBuf,
    /// Replace a file that is there
    #[arg(long)]
    pub force: bool,
}

#[derive(Debug, Args)]
pub struct SchemaArgs {
    #[command(flatten)]
    pub plugins: PluginArgs,
}

#[derive(Debug, Args)]
pub struct CompletionsArgs {
    /// The shell
    #[arg(value_enum)]
    pub shell: Shell,
}

#[derive(Debug, Args)]
pub struct ManArgs {
    /// The folder to write them into
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}

impl Command {
    /// Where its strategies come from, if it needs any.
    pub fn plugins(&self) -> Option<&PluginArgs> {
        Some(match self {
            Self::Run(args) => &args.recipe.plugins,
            Self::Check(args) => &args.recipe.plugins,
            Self::Ablate(args) => &args.recipe.plugins,
            Self::Verify(args) => &args.recipe.plugins,
            Self::Report(args) => &args.plugins,
            Self::Sag(args) => &args.recipe.plugins,
            Self::Import(_) | Self::Init(_) | Self::Completions(_) | Self::Man(_) => return None,
            Self::Schema(args) => &args.plugins,
            Self::List(args) => &args.plugins,
            Self::Explain(args) => &args.plugins,
            Self::NewPlugin(args) => &args.plugins,
        })
    }
}

/// The slot with this key, if there is one.
pub fn slot_of(key: &str) -> Option<Slot> {
    Slot::ALL.into_iter().find(|slot| slot.key() == key)
}
