//! The command line.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand, ValueEnum};
use turnpath::report::comparison;
use turnpath_core::Slot;

use crate::crash::TimeLimit;

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
    /// Write the surface of a recipe on a grid, as CSV
    Sag(SagArgs),
    /// List the strategies that can be chosen
    List(ListArgs),
    /// Explain one strategy, or one table of the recipe: its keys, defaults and limits
    Explain(ExplainArgs),
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
    /// The recipe
    pub recipe: PathBuf,
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
    /// Write a dry run beside each program: it stops at C = 0, 90, 180 and 270 deg with the tool high
    /// above the rim, and says how high the part is there
    #[arg(long)]
    pub dry_run: bool,
    #[command(flatten)]
    pub plots: PlotArgs,
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
    /// Make all runs anew, also those that were made before
    #[arg(long)]
    pub fresh: bool,
    #[command(flatten)]
    pub work: WorkArgs,
}

#[derive(Debug, Args)]
pub struct VerifyArgs {
    #[command(flatten)]
    pub recipe: RecipeArgs,
    /// The tool path to measure: a toolpath.csv, or a program of a post (.pmc, .ppmc, .ascript, .mpf)
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
    pub grid: u32,
    /// The file to write; - for standard output
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
}

#[derive(Debug, Args)]
pub struct ListArgs {
    /// Only the strategies of this slot
    #[arg(value_parser = PossibleValuesParser::new(Slot::ALL.map(Slot::key)))]
    pub slot: Option<String>,
    /// Print a lock of the plugins that are loaded, or write it to FILE
    #[arg(long, value_name = "FILE", num_args = 0..=1, require_equals = true)]
    pub lock: Option<Option<PathBuf>>,
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

impl Command {
    /// Where its strategies come from.
    pub fn plugins(&self) -> &PluginArgs {
        match self {
            Self::Run(args) => &args.recipe.plugins,
            Self::Check(args) => &args.recipe.plugins,
            Self::Ablate(args) => &args.recipe.plugins,
            Self::Verify(args) => &args.recipe.plugins,
            Self::Sag(args) => &args.recipe.plugins,
            Self::List(args) => &args.plugins,
            Self::Explain(args) => &args.plugins,
        }
    }
}

/// The slot with this key, if there is one.
pub fn slot_of(key: &str) -> Option<Slot> {
    Slot::ALL.into_iter().find(|slot| slot.key() == key)
}
