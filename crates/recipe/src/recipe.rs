//! A whole recipe: read, checked, and ready for the stages to ask.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use toml::de::DeTable;
use turnpath_core::{Direction, Machine, Overrun, Part, Servo, Slot, Tolerance, Tool};

use crate::choice::Choice;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::document::{Reader, Table};
use crate::place::{Located, Place, Source};
use crate::presets::Preset;
use crate::read::Sections;
use crate::set;
use crate::tables::{self, Output, PmacPvt};

/// Largest recipe, in bytes; a hundred times any that a person writes.
const LARGEST: u64 = 1 << 20;

/// A recipe. Lengths in mm, angles in rad.
#[derive(Debug, Clone, PartialEq)]
pub struct Recipe {
    /// The job's name; the file's stem if it has none.
    pub name: String,
    /// What is cut.
    pub part: Part,
    /// With what.
    pub tool: Tool,
    /// How exactly.
    pub tolerance: Tolerance,
    /// Speed of the spindle, rad/s.
    pub spindle_speed: f64,
    /// What the machine can do; no limits unless the recipe says so.
    pub machine: Machine,
    /// The machine that the recipe names; its own limits go before those of the preset.
    pub preset: Option<&'static Preset>,
    /// How its axes answer, where the recipe asks what that comes to.
    pub servo: Option<Servo>,
    /// Which way the tool feeds.
    pub direction: Direction,
    /// How far the path runs beyond the aperture.
    pub overrun: Overrun,
    /// Whether the path runs from rest to rest.
    pub lead: bool,
    /// How far it rests above the highest place of the part, mm.
    pub clearance: f64,
    /// Whether segments whose error exceeds the tolerance are halved. `place("refine")` tells
    /// whether the recipe says so itself.
    pub refine: bool,
    /// The files to write.
    pub output: Output,
    /// How the post `pmac-pvt` lays out its programs.
    pub pmac_pvt: PmacPvt,
    /// Folders and libraries to take plugins from, as written, relative to the recipe.
    pub plugins: Vec<Located<String>>,
    choices: [Choice; 5],
    document: Table,
    whole: Place,
    path: PathBuf,
}

/// Why there is no recipe.
#[derive(Debug, thiserror::Error)]
pub enum RecipeError {
    /// The file could not be read.
    #[error("cannot read the recipe {}: {problem}", path.display())]
    File {
        /// The path as the user gave it.
        path: PathBuf,
        /// Why.
        problem: FileProblem,
    },
    /// The recipe, or a `--set`, is wrong.
    #[error(transparent)]
    Wrong(#[from] Diagnostics),
}

/// Why a file could not be read as a recipe.
#[derive(Debug, thiserror::Error)]
pub enum FileProblem {
    /// The system says why.
    #[error("{0}")]
    Io(#[from] std::io::Error),
    /// It is a folder.
    #[error("it is a folder; give the file in it")]
    Folder,
    /// It is no text.
    #[error("it is not UTF-8 text (line {line})")]
    NotText {
        /// The first line that is none, counted from 1.
        line: usize,
    },
    /// It is far larger than any recipe.
    #[error("it is larger than 1 MiB, which no recipe is")]
    TooLarge,
}

impl RecipeError {
    /// The messages as the user sees them; `color` for a terminal.
    pub fn render(&self, color: bool) -> String {
        match self {
            Self::Wrong(diagnostics) => diagnostics.render(color),
            Self::File { .. } => Diagnostic {
                title: self.to_string(),
                place: None,
                label: String::new(),
                help: Vec::new(),
            }
            .render(color),
        }
    }
}

impl Recipe {
    /// Reads a recipe's file and applies `--set` arguments.
    pub fn load(path: impl AsRef<Path>, sets: &[String]) -> Result<Self, RecipeError> {
        let path = path.as_ref();
        let text = read_text(path).map_err(|problem| RecipeError::File {
            path: path.to_owned(),
            problem,
        })?;
        Self::parse(&text, path, sets)
    }

    /// Reads a recipe's text; messages and relative files refer to `path`.
    pub fn parse(text: &str, path: impl AsRef<Path>, sets: &[String]) -> Result<Self, RecipeError> {
        let path = path.as_ref();
        let name = path.display().to_string();
        let source = Arc::new(Source {
            name,
            text: text.to_owned(),
            rank: 0,
        });
        let mut document = read_document(&source)?;
        let mut found = Vec::new();
        set::apply(&mut document, sets, &mut found);
        let whole = Place::whole(source);
        let recipe = build(document, whole, path, &mut found);
        Ok(Diagnostics::unless_any(recipe, found)?)
    }

    /// The strategy chosen for a slot.
    pub fn choice(&self, slot: Slot) -> &Choice {
        match slot {
            Slot::Surface => &self.choices[0],
            Slot::Feed => &self.choices[1],
            Slot::Sampler => &self.choices[2],
            Slot::Compensator => &self.choices[3],
            Slot::Velocity => &self.choices[4],
        }
    }

    /// Where the value under a path of keys stands, `tool.nose_radius`; none if it was left out.
    pub fn place(&self, path: &str) -> Option<Place> {
        self.document
            .find(path.split('.'))
            .map(|entry| entry.node.place.clone())
    }

    /// Where the value under a path of keys stands, else its table, else the recipe as a whole.
    pub fn nearest_place(&self, path: &str) -> Place {
        let table = || self.place(path.split('.').next().unwrap_or(path));
        self.place(path)
            .or_else(table)
            .unwrap_or_else(|| self.whole.clone())
    }

    /// The header of a slot's table.
    pub fn whole(&self, slot: Slot) -> Place {
        self.choice(slot).place.clone()
    }

    /// All values as they stand in the recipe, `--set` applied.
    pub fn document(&self) -> &Table {
        &self.document
    }

    /// The recipe as a whole, for messages that have no place in it.
    pub(crate) fn everywhere(&self) -> &Place {
        &self.whole
    }

    /// The recipe's text as it stands in its file.
    pub fn text(&self) -> &str {
        &self.whole.source().text
    }

    /// The recipe's path, as the user gave it.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The recipe's file name without its extension; `recipe` if it has none.
    pub fn stem(&self) -> String {
        stem(&self.path)
    }

    /// The name as that of one folder: separators and control characters become hyphens.
    pub fn folder_name(&self) -> String {
        let name: String = self.name.trim().chars().map(folder_char).collect();
        match name.strip_prefix('.') {
            Some(rest) => format!("-{rest}"),
            None => name,
        }
    }

    /// A file that the recipe names, relative to it.
    pub fn resolve(&self, file: &str) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(file)
    }

    /// A message about a place, for the stages after this one.
    pub fn complaint(
        &self,
        place: Place,
        title: impl Into<String>,
        label: impl Into<String>,
        help: impl IntoIterator<Item = String>,
    ) -> Diagnostic {
        Diagnostic::new(place, title).label(label).helps(help)
    }
}

/// A character that a folder's name may have on every system.
fn folder_char(c: char) -> char {
    if c.is_control() || "/\\:*?\"<>|".contains(c) {
        '-'
    } else {
        c
    }
}

fn stem(path: &Path) -> String {
    path.file_stem()
        .map_or("recipe".into(), |stem| stem.to_string_lossy().into_owned())
}

fn read_text(path: &Path) -> Result<String, FileProblem> {
    let file = File::open(path)?;
    if file.metadata()?.is_dir() {
        return Err(FileProblem::Folder);
    }
    let mut bytes = Vec::new();
    file.take(LARGEST + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > LARGEST {
        return Err(FileProblem::TooLarge);
    }
    String::from_utf8(bytes).map_err(|error| {
        let good = error.utf8_error().valid_up_to();
        let lines = error
            .as_bytes()
            .iter()
            .take(good)
            .filter(|byte| **byte == b'\n')
            .count();
        FileProblem::NotText { line: lines + 1 }
    })
}

fn read_document(source: &Arc<Source>) -> Result<Table, Diagnostics> {
    let reader = Reader {
        source: source.clone(),
        offset: 0,
    };
    match DeTable::parse(&source.text) {
        Ok(table) => Ok(reader.table(table.get_ref())),
        Err(error) => {
            let place = match error.span() {
                Some(span) => reader.place(span),
                None => Place::whole(source.clone()),
            };
            let title = format!("the recipe is not TOML: {}", error.message());
            Err(Diagnostic::new(place, title).into())
        }
    }
}

/// A recipe from its values, and what is wrong with them.
pub(crate) fn build(
    document: Table,
    whole: Place,
    path: &Path,
    found: &mut Vec<Diagnostic>,
) -> Option<Recipe> {
    let mut sections = Sections {
        root: &document,
        whole: &whole,
        found,
    };
    if !tables::format_is_one(&mut sections.top()) {
        return None;
    }
    let top = tables::top(&mut sections.top());
    let part = tables::part(&mut sections.open("part"));
    let tool = tables::tool(&mut sections.open("tool"));
    let tolerance = tables::tolerance(&mut sections.open("tolerance"));
    let speed = tables::spindle(&mut sections.open("spindle"));
    let machine = tables::machine(&mut sections.open("machine"));
    if let Some(speed) = speed {
        tables::check_spindle(&mut sections.open("spindle"), speed, &machine.machine);
    }
    let servo = tables::servo(&mut sections.open("servo"), machine.preset);
    let way = tables::path(&mut sections.open("path"));
    let output = tables::output(&mut sections.open("output"));
    let pmac_pvt = tables::pmac_pvt(&mut sections.open("output.pmac-pvt"));
    let choices = Slot::ALL.map(|slot| Choice::read(slot, &mut sections.open(slot.key())));
    let [surface, feed, sampler, compensator, velocity] = choices;
    let tool = tool?;
    Some(Recipe {
        name: top.name.unwrap_or_else(|| stem(path)),
        part: part?,
        tool,
        tolerance: tolerance?,
        spindle_speed: speed?,
        machine: machine.machine,
        preset: machine.preset,
        servo,
        direction: way.direction,
        overrun: way.overrun,
        lead: way.lead,
        clearance: way.clearance,
        refine: top.refine,
        output,
        pmac_pvt,
        plugins: top.plugins,
        choices: [surface?, feed?, sampler?, compensator?, velocity?],
        document,
        whole,
        path: path.to_owned(),
    })
}
