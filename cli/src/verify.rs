//! `turnpath verify`: any tool path against a recipe's surface, tool and tolerances.
//!
//! Control points do not say what is played between them: that is taken from the recipe's
//! velocity solver, cubics or straight lines.

use std::path::Path;

use rayon::prelude::*;
use serde::Serialize;
use turnpath_core::toolpath::{PathBlock, Section, SegmentShape};
use turnpath_core::{Radial, Slot, StrategyError};
use turnpath_pipeline::{PipelineError, Progress, Quiet};
use turnpath_post::{PathReader, PmacReader, ReadError, ReadPath};
use turnpath_recipe::Recipe;
use turnpath_verify::{
    FirstTouch, LeadMeter, LeadStretch, Measured as CutStretch, Meter, ServoMeter, ServoStart,
    ServoStretch, Subject, Suspects,
};

use crate::args::{Format, VerifyArgs};
use crate::coverage::Promise;
use crate::failure::Failure;
use crate::job::{of_pipeline, use_threads};
use crate::lead::Lead;
use crate::plots::{Wishes, make_folder};
use crate::plotting::{Played, plot};
use crate::programs::{PMAC_EXTENSION, pmac_format};
use crate::reach::Reach;
use crate::run::print;
use crate::summary::{Measured, to_json};
use crate::suspects::Suspicious;
use crate::unreached::Unreached;
use crate::{Done, Verdict, figures, strategies};

/// Rows that are measured in one go, and how many such blocks at a time.
pub const BLOCK_ROWS: usize = 20_000;
const BLOCKS: usize = 16;

#[derive(Debug, Serialize)]
struct Verified {
    name: String,
    file: String,
    control_points: u64,
    rows: u64,
    reach_mm: Reach,
    #[serde(flatten)]
    measured: Measured,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    files: Vec<String>,
    suspicious: Suspicious,
    unreached: Option<Unreached>,
}

/// What a file is measured against, and how it is played.
struct Held {
    subject: Subject,
    shape: SegmentShape,
    /// What the compensator's ρ stands for.
    radial: Radial,
}

/// Measures a file.
pub fn verify(args: &VerifyArgs) -> Done {
    use_threads(&args.work);
    let recipe = Recipe::load(&args.recipe.recipe, &args.recipe.set)?;
    let held = held(&recipe, args)?;
    let radial = held.radial;
    let wishes = wishes(args, &recipe)?;
    let verified = verified(args, &recipe, held, &wishes)?;
    print(&match args.work.format {
        Format::Json => to_json(&verified),
        Format::Human => human(&recipe, radial, &verified),
    })?;
    let holds = verified.measured.all_hold();
    Ok(if holds {
        Verdict::Holds
    } else {
        Verdict::Exceeded
    })
}

/// The file measured, and drawn as it is wished.
fn verified(
    args: &VerifyArgs,
    recipe: &Recipe,
    held: Held,
    wishes: &Wishes,
) -> Result<Verified, Failure> {
    let shape = held.shape;
    let compensates_nose = held.subject.compensates_nose;
    let mut reader = open(&args.file, recipe, compensates_nose)?;
    let failed = |error| of_pipeline(recipe, PipelineError::Measure(error));
    let touch = FirstTouch::new(held.subject).map_err(failed)?;
    let meters = PathMeters::new(recipe, touch).with_servo(recipe);
    let meters = measure(recipe, meters, shape, reader.as_mut(), &Quiet)?;
    let (meter, read) = (&meters.cut, reader.read_count());
    let range = meter.reach(held.radial).map_err(failed)?;
    let Some(range) = range.filter(|_| read.cutting_points() >= 2) else {
        let file = args.file.display();
        let message = format!("error: {file} has no cutting section to measure");
        return Err(Failure::File(message));
    };
    let reach = Reach::new(range);
    let machined = meter.machined().map_err(failed)?;
    let figures = meter.figures().map_err(failed)?;
    let unreached = Unreached::of(meter.touch(), &recipe.tolerance).map_err(failed)?;
    let lead = meters.lead.figures();
    let lead = lead.map(|figures| Lead::measured(figures, recipe));
    let mut measured = Measured::new(&figures, machined.as_ref(), recipe)
        .with_lead(lead, &recipe.tolerance)
        .with_servo(meters.servo.as_ref().map(ServoMeter::figures));
    measured.within.reach = Some(reach.covers(&recipe.part));
    let played = Played {
        recipe,
        touch: meter.touch(),
        shape,
        largest_error: figures.playback.max(),
        points: read.points(),
    };
    Ok(Verified {
        name: recipe.name.clone(),
        file: args.file.display().to_string(),
        control_points: read.cutting_points(),
        rows: read.points(),
        reach_mm: reach,
        measured,
        files: drawn(args, wishes, &played, compensates_nose)?,
        suspicious: Suspicious::of(meters.suspects.end()),
        unreached,
    })
}

/// Writes what is wished, from a second reading; gives the names of the files.
fn drawn(
    args: &VerifyArgs,
    wishes: &Wishes,
    played: &Played<'_>,
    compensates_nose: bool,
) -> Result<Vec<String>, Failure> {
    if wishes.is_empty() {
        return Ok(Vec::new());
    }
    let mut again = open(&args.file, played.recipe, compensates_nose)?;
    let mut files = Vec::new();
    for draft in plot(wishes, played, again.as_mut(), &Quiet)? {
        files.push(draft.complete()?.display().to_string());
    }
    Ok(files)
}

/// Maps and the like that are asked for; their folder is made.
fn wishes(args: &VerifyArgs, recipe: &Recipe) -> Result<Wishes, Failure> {
    let folder = args.output.as_deref().unwrap_or(Path::new("."));
    let wishes = Wishes::of(&args.plots, &recipe.part, folder)?;
    if !wishes.is_empty() {
        make_folder(folder)?;
    }
    Ok(wishes)
}

fn held(recipe: &Recipe, args: &VerifyArgs) -> Result<Held, Failure> {
    let catalogue = strategies::catalogue_for(recipe, &args.recipe)?;
    let surface = strategies::surface(recipe, &catalogue)?.strategy;
    let compensator = strategies::compensator(recipe, &catalogue)?.strategy;
    let shape = strategies::velocity(recipe, &catalogue)?
        .strategy
        .segments();
    let subject = Subject {
        surface,
        part: recipe.part,
        tool: recipe.tool,
        compensates_nose: compensator.compensates_nose(),
    };
    Ok(Held {
        subject,
        shape,
        radial: compensator.radial(),
    })
}

/// Opens a motion program or a table, as the file's name says.
fn open(
    file: &Path,
    recipe: &Recipe,
    compensates_nose: bool,
) -> Result<Box<dyn ReadPath>, ReadError> {
    let is_program = file
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case(PMAC_EXTENSION));
    Ok(if is_program {
        Box::new(PmacReader::open(
            file,
            pmac_format(recipe, compensates_nose),
        )?)
    } else {
        Box::new(PathReader::open(file)?)
    })
}

/// What measures a path.
pub struct PathMeters {
    /// Its cutting section.
    pub cut: Meter,
    /// Its leads.
    pub lead: LeadMeter,
    /// What the servo makes of it, where that is asked.
    pub servo: Option<ServoMeter>,
    /// Points that stand out.
    pub suspects: Suspects,
}

/// A block of a path, measured.
enum Stretch {
    Cut(Box<(CutStretch, Option<ServoStretch>, PathBlock)>),
    Lead(Box<(LeadStretch, PathBlock)>),
}

impl Stretch {
    fn of(
        touch: &FirstTouch,
        section: Section,
        block: PathBlock,
        start: Option<ServoStart>,
    ) -> Result<Self, StrategyError> {
        Ok(match section {
            Section::Cutting => {
                let served = start.map(|start| ServoMeter::measure(touch, &start, &block));
                let measured = Meter::measure(touch, &block)?;
                Self::Cut(Box::new((measured, served.transpose()?, block)))
            }
            Section::LeadIn | Section::LeadOut => {
                Self::Lead(Box::new((LeadMeter::measure(touch, &block)?, block)))
            }
        })
    }
}

impl PathMeters {
    /// Nothing measured yet.
    pub fn new(recipe: &Recipe, touch: FirstTouch) -> Self {
        Self {
            cut: Meter::new(touch).counting_centre(Promise::of(recipe.overrun).covers_centre),
            lead: LeadMeter::default(),
            servo: None,
            suspects: Suspects::new(recipe.tolerance.interpolation, recipe.part.aperture_radius),
        }
    }

    /// The same with the servo that the recipe asks for.
    pub fn with_servo(mut self, recipe: &Recipe) -> Self {
        self.servo = recipe.servo.as_ref().map(ServoMeter::new);
        self
    }

    fn append(&mut self, stretch: &Stretch) -> Result<(), StrategyError> {
        match stretch {
            Stretch::Cut(cut) => {
                let (measured, served, block) = cut.as_ref();
                self.lead.pass(block);
                self.suspects.pass(block, &measured.per_point);
                if let (Some(servo), Some(served)) = (&mut self.servo, served) {
                    servo.append(served);
                }
                self.cut.append(measured)
            }
            Stretch::Lead(lead) => {
                let (measured, block) = lead.as_ref();
                self.suspects.pass(block, &[]);
                self.lead.append(measured);
                Ok(())
            }
        }
    }
}

/// Reads a path and measures it, in blocks, in parallel.
pub fn measure(
    recipe: &Recipe,
    mut meters: PathMeters,
    shape: SegmentShape,
    reader: &mut dyn ReadPath,
    progress: &dyn Progress,
) -> Result<PathMeters, Failure> {
    let failed = |error: StrategyError| of_pipeline(recipe, PipelineError::Measure(error));
    loop {
        let mut blocks: Vec<(Section, PathBlock)> = Vec::new();
        while blocks.len() < BLOCKS {
            match reader.next_block(BLOCK_ROWS)? {
                Some((section, block)) => blocks.push((section, PathBlock { shape, ..block })),
                None => break,
            }
        }
        if blocks.is_empty() {
            return Ok(meters);
        }
        let starts: Vec<Option<ServoStart>> = blocks
            .iter()
            .map(|(_, block)| meters.servo.as_mut().map(|servo| servo.pass(block)))
            .collect();
        let (touch, count) = (meters.cut.touch(), blocks.len() as u64);
        let stretches: Vec<Stretch> = blocks
            .into_par_iter()
            .zip(starts)
            .map(|((section, block), start)| Stretch::of(touch, section, block, start))
            .collect::<Result<_, _>>()
            .map_err(failed)?;
        for stretch in &stretches {
            meters.append(stretch).map_err(failed)?;
        }
        progress.advance(count);
    }
}

fn human(recipe: &Recipe, radial: Radial, verified: &Verified) -> String {
    let mut text = format!("{}\n", verified.name);
    text += &figures::line("file", &verified.file);
    text += &figures::line("surface", recipe.choice(Slot::Surface).name());
    let cutting = figures::grouped(verified.control_points);
    let rows = figures::grouped(verified.rows);
    text += &figures::line("points", format!("{cutting} that cut, of {rows} rows"));
    text += &verified.reach_mm.line(radial, &recipe.part);
    text += &figures::measured(&verified.measured, recipe);
    if let Some(lead) = &verified.measured.lead {
        text += &lead.lines(verified.measured.within.lead);
    }
    text += &verified.suspicious.lines();
    if let Some(servo) = &verified.measured.servo {
        text += &servo.lines();
    }
    if let Some(unreached) = &verified.unreached {
        text += &unreached.lines();
    }
    for file in &verified.files {
        text += &figures::line("file", file);
    }
    text
}
