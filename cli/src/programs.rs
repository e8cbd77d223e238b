//! The motion programs of a recipe: how they are laid out, how they are made and measured.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};
use turnpath_core::toolpath::{PathStretch, SegmentShape};
use turnpath_pipeline::{Leads, Outcome, PipelineError, Progress, Stage};
use turnpath_post::{
    Draft, FileError, PLACEHOLDERS, PMAC_FOOTER, PMAC_HEADER, PmacError, PmacFormat, PmacReader,
    PmacWriter, ReadPath, Template,
};
use turnpath_recipe::{Recipe, Spanned, ZReference};
use turnpath_verify::FirstTouch;

use crate::failure::Failure;
use crate::job::of_pipeline;
use crate::summary::ProgramSummary;
use crate::verify::{BLOCK_ROWS, PathMeters, measure};

/// The post's name in recipes.
pub const PMAC_PVT: &str = "pmac-pvt";
/// What its files end with.
pub const PMAC_EXTENSION: &str = "pmc";

/// A program that the recipe asks for.
pub struct Program {
    /// How it is laid out.
    pub format: PmacFormat,
    /// Its file's name.
    pub file: String,
    header: Template,
    footer: Template,
}

/// The programs that the recipe asks for.
pub fn asked(recipe: &Recipe, compensates_nose: bool) -> Result<Vec<Program>, Failure> {
    let posts = recipe.output.posts.iter();
    posts
        .map(|_| Program::new(recipe, compensates_nose))
        .collect()
}

/// How the recipe lays out PMAC programs. A path that is not compensated is that of the contact,
/// so its Z is the tip's already.
pub fn pmac_format(recipe: &Recipe, compensates_nose: bool) -> PmacFormat {
    let settings = &recipe.pmac_pvt;
    let tip = recipe.output.z_reference == ZReference::Tip && compensates_nose;
    PmacFormat {
        position_decimals: settings.position_decimals,
        velocity_decimals: settings.velocity_decimals,
        per_minute: settings.per_minute,
        c_reversed: settings.c_reversed,
        c_wrapped: settings.c_wrapped,
        incremental: settings.incremental,
        z_above: if tip { recipe.tool.nose_radius } else { 0.0 },
    }
}

impl Program {
    fn new(recipe: &Recipe, compensates_nose: bool) -> Result<Self, Failure> {
        let settings = &recipe.pmac_pvt;
        Ok(Self {
            format: pmac_format(recipe, compensates_nose),
            file: format!("{}.{PMAC_EXTENSION}", recipe.stem()),
            header: template(recipe, settings.header.as_ref(), PMAC_HEADER)?,
            footer: template(recipe, settings.footer.as_ref(), PMAC_FOOTER)?,
        })
    }

    /// Begins its file.
    pub fn begin(&self, folder: &Path) -> Result<PmacWriter, FileError> {
        PmacWriter::begin(folder.join(&self.file))
    }

    /// A stretch of the path as program lines.
    pub fn lines(&self, stretch: &PathStretch<'_>) -> std::io::Result<Vec<u8>> {
        PmacWriter::lines(&self.format, stretch)
    }

    /// Bytes that it will take.
    pub fn expected_bytes(&self, radius: f64, expected: &turnpath_pipeline::Expected) -> f64 {
        let c = std::f64::consts::TAU * expected.revolutions;
        PmacWriter::expected_bytes(
            &self.format,
            radius,
            expected.cutting_time,
            c,
            expected.control_points,
        )
    }

    /// The whole file, still without its name.
    pub fn assemble(
        &self,
        writer: PmacWriter,
        recipe: &Recipe,
        sets: &[String],
        outcome: &Outcome,
    ) -> Result<Draft, FileError> {
        let value = |placeholder: &str| self.value(placeholder, recipe, sets, outcome);
        writer.assemble(&self.header.fill(value), &self.footer.fill(value))
    }

    fn value(
        &self,
        placeholder: &str,
        recipe: &Recipe,
        sets: &[String],
        outcome: &Outcome,
    ) -> String {
        let either = |first: bool, one: &str, other: &str| {
            let chosen = if first { one } else { other };
            chosen.to_owned()
        };
        let tip = recipe.output.z_reference == ZReference::Tip;
        let lead = outcome.lead.as_ref();
        let with_leads = |cut: f64, leads: fn(&Leads) -> f64| cut + lead.map_or(0.0, leads);
        let file = || recipe.path().file_name().unwrap_or_default();
        match placeholder {
            "name" => recipe.name.clone(),
            "recipe" => file().to_string_lossy().into_owned(),
            "sha256" => sha256(recipe.text()),
            "changes" if sets.is_empty() => "nothing".to_owned(),
            "changes" => sets.join(", "),
            "turnpath" => env!("CARGO_PKG_VERSION").to_owned(),
            "points" => {
                let points = outcome.control_points + lead.map_or(0, |lead| lead.points);
                points.to_string()
            }
            "revolutions" => {
                let turns = with_leads(outcome.revolutions, |l| l.turns_in + l.turns_out);
                format!("{turns:.2}")
            }
            "time_s" => {
                let time = with_leads(outcome.cutting_time, |l| l.in_time + l.out_time);
                format!("{time:.3}")
            }
            "ends" => either(lead.is_some(), "at rest", "in motion"),
            "z_reference" => either(tip, "tool tip", "nose centre"),
            "c_range" => either(self.format.c_wrapped, "within 0 to 360", "unwrapped"),
            "velocity_unit" => either(self.format.per_minute, "min", "s"),
            "ix90" => self.format.ix90().to_string(),
            _ => String::new(),
        }
    }

    /// Reads it back and measures it on its own text.
    pub fn measure(
        &self,
        draft: &mut Draft,
        recipe: &Recipe,
        touch: FirstTouch,
        points: u64,
        progress: &dyn Progress,
    ) -> Result<ProgramSummary, Failure> {
        let name: PathBuf = draft.path().to_owned();
        let reader = PmacReader::open(draft.readable()?, self.format);
        let mut reader = reader.map_err(|error| error.named(&name))?.named(&name);
        progress.begin(Stage::ReadBack, points.div_ceil(BLOCK_ROWS as u64));
        let meters = PathMeters::new(recipe, touch);
        let measured = measure(recipe, meters, SegmentShape::Cubic, &mut reader, progress)?;
        let count = reader.read_count().points();
        if count != points {
            let name = name.display();
            let message = format!("error: {name} has {count} points of the path's {points}");
            return Err(Failure::File(message));
        }
        let figures = measured.cut.figures();
        let figures = figures.map_err(|e| of_pipeline(recipe, PipelineError::Measure(e)))?;
        let file = self.file.clone();
        Ok(ProgramSummary::new(
            file,
            PMAC_PVT,
            &figures,
            measured.lead.figures(),
            &recipe.tolerance,
        ))
    }
}

/// A template of the recipe, or the post's own.
fn template(
    recipe: &Recipe,
    given: Option<&Spanned<String>>,
    own: &str,
) -> Result<Template, Failure> {
    let text = given.map_or(own, |given| &given.value);
    Template::parse(text).map_err(|error| {
        let place = given.map_or_else(|| recipe.nearest_span("output"), |given| given.span.clone());
        let known = format!("placeholders: {{{}}}", PLACEHOLDERS.join("}, {"));
        recipe
            .diagnostic(place, error.to_string(), "in this template", [known])
            .into()
    })
}

fn sha256(text: &str) -> String {
    let mut hex = String::new();
    for byte in Sha256::digest(text.as_bytes()) {
        // Writing to a string cannot fail.
        let _ = write!(hex, "{byte:02x}");
    }
    hex
}

/// A path that the post cannot carry is the recipe's fault.
pub fn not_carried(recipe: &Recipe, error: &PmacError) -> Failure {
    let post = recipe.output.posts.first();
    let place = post.map_or_else(|| recipe.nearest_span("output"), |post| post.span.clone());
    let title = format!("the post `{PMAC_PVT}` cannot carry this path: {error}");
    recipe
        .diagnostic(place, title, "chosen here", [error.help().to_owned()])
        .into()
}
