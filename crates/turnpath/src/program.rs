//! The motion programs of a recipe: how they are laid out, put together and measured.

use std::path::Path;

use turnpath_core::Params;
use turnpath_core::toolpath::{SectionBlock, SegmentShape};
use turnpath_host::sha256_hex;
use turnpath_pipeline::{Leads, Observer, Outcome, Stage};
use turnpath_post::{
    Amount, FeedMeaning, Layout, Lines, MEMORY, PLACEHOLDERS, PartNumbers, PartsError, Post,
    ProgramError, ReadPath, SEGMENTS_PER_SECOND, SPLIT, Template, text_name,
};
use turnpath_recipe::{Recipe, Spanned, ZReference};
use turnpath_report::text::verified_figures;
use turnpath_report::{AxisNotes, Overrun, ProgramFigures, ProgramReport, Tolerances};
use turnpath_verify::FirstTouch;

use crate::axis_notes::axis_notes;
use crate::depths::refuse_depths;
use crate::diagnosis::{not_carried, of_measure};
use crate::error::Error;
use crate::figures::{coverage, form_error, residual, tolerances};
use crate::meters::{ProgramMeters, measure};
use crate::posts::{NotCarried, layout, posts};
use crate::read_blocks::BLOCK_ROWS;

/// The part of the residual tolerance by which digits may move X, so that the passes of a program of cubics count as
/// those of its path. A higher one would miss what digits do to cusps. With this one, the passes of programs of seven
/// decimals are measured where the residual is 5 nm or less, and with a lower one they would be more often, which
/// takes time and finds nothing.
const COARSE_DIGITS: f64 = 0.01;

/// A program that a recipe asks for.
#[derive(Clone)]
pub struct Program {
    /// How it is laid out.
    pub layout: Layout,
    /// Its file's name, which says whether the file is compressed.
    pub file: String,
    /// The largest part of the path in one file; `None` for one file whatever its size.
    pub(crate) split: Option<Amount>,
    /// The largest file that the controller takes.
    pub(crate) memory: Option<Amount>,
    /// The most segments that the controller reads in a second.
    pub(crate) segments_per_second: Option<f64>,
    pub(crate) header: Template,
    pub(crate) footer: Template,
}

/// The text of a program's path, as it is read back.
pub struct ProgramText<'a> {
    /// Reads it.
    pub reader: &'a mut (dyn ReadPath + Send),
    /// The program's file, for messages.
    pub name: &'a Path,
    /// The points that were written.
    pub points: u64,
}

/// The path that a program carries.
pub struct CarriedPath {
    /// Its largest interpolation error, mm.
    pub error: f64,
    /// The time of its longest segment, s.
    pub longest_time: f64,
    /// What is played between its control points.
    pub shape: SegmentShape,
    /// The residual tolerance that it was made for, mm.
    pub residual: f64,
}

/// What stands around the lines of a program.
pub struct Frame {
    /// Before the lines.
    pub header: String,
    /// After them.
    pub footer: String,
}

/// The programs that a recipe asks for.
pub fn programs(recipe: &Recipe, compensates_nose: bool) -> Result<Vec<Program>, Error> {
    posts(recipe)
        .map(|post| Program::new(recipe, post, compensates_nose))
        .collect()
}

impl Program {
    fn new(recipe: &Recipe, post: &'static Post, compensates_nose: bool) -> Result<Self, Error> {
        let settings = recipe.settings_of(post.name);
        let header = settings.and_then(|settings| settings.header.as_ref());
        let footer = settings.and_then(|settings| settings.footer.as_ref());
        let none = Params::new();
        let params = settings.map_or(&none, |settings| &settings.params);
        let split = amount(recipe, post, params.find(SPLIT).flatten())?;
        let other = settings.and_then(|settings| post.dialect.other_header(&settings.params));
        if let (Some(_), Some((key, _))) = (split, other) {
            return Err(without_calls(recipe, post, key));
        }
        refuse_depths(recipe, post, params)?;
        if split.is_some() {
            refuse_many_rough_paths(recipe, post)?;
        }
        let own_header = other.map_or(post.header, |(_, text)| text);
        let text = format!("{}.{}", recipe.stem(), post.extension);
        Ok(Self {
            layout: layout(recipe, post, compensates_nose),
            file: recipe.output.compression.file_of(&text),
            split,
            memory: amount(recipe, post, params.find(MEMORY).flatten())?,
            segments_per_second: params.find(SEGMENTS_PER_SECOND).flatten(),
            header: template(recipe, header, own_header, post.comment)?,
            footer: template(recipe, footer, post.footer, post.comment)?,
        })
    }

    /// The name of the file with its dry run, which is never compressed.
    pub fn dry_run_file(&self) -> String {
        let stem = text_name(&self.file)
            .rsplit_once('.')
            .map_or("", |(stem, _)| stem);
        format!("{stem}-dry-run.{}", self.layout.post.extension)
    }

    /// A block of the path as program lines.
    pub fn lines(&self, block: &SectionBlock<'_>) -> Result<Lines, NotCarried> {
        let lines = self.layout.lines(block);
        lines.map_err(|error| NotCarried {
            post: self.layout.post.name,
            error,
        })
    }

    /// A program that could not be divided into parts.
    pub fn not_divided(&self, recipe: &Recipe, error: PartsError) -> Error {
        let post = self.layout.post.name;
        match error {
            PartsError::File(error) => error.into(),
            PartsError::Program(error) => not_carried(recipe, NotCarried { post, error }),
        }
    }

    pub(crate) fn carried<T>(&self, result: Result<T, ProgramError>) -> Result<T, NotCarried> {
        result.map_err(|error| NotCarried {
            post: self.layout.post.name,
            error,
        })
    }

    /// Header and footer with the figures of a path and those of its program.
    pub fn frame(
        &self,
        recipe: &Recipe,
        outcome: &Outcome,
        points: u64,
        report: &ProgramReport,
    ) -> Frame {
        let value = |placeholder: &str| match placeholder {
            "points" => points.to_string(),
            other => verified_value(other, report, &tolerances(recipe))
                .or_else(|| of_recipe(other, recipe))
                .unwrap_or_else(|| self.value(other, recipe, outcome)),
        };
        Frame {
            header: self.header.fill(value),
            footer: self.footer.fill(value),
        }
    }

    fn value(&self, placeholder: &str, recipe: &Recipe, outcome: &Outcome) -> String {
        let format = &self.layout.format;
        let either = |first: bool, one: &str, other: &str| {
            let chosen = if first { one } else { other };
            chosen.to_owned()
        };
        let tip = recipe.output.z_reference == ZReference::Tip;
        let lead = outcome.lead.as_ref();
        let with_leads = |cut: f64, leads: fn(&Leads) -> f64| cut + lead.map_or(0.0, leads);
        match placeholder {
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
            "axis_x" => self.axis_notes(recipe).x,
            "axis_z" => self.axis_notes(recipe).z,
            "axis_c" => self.axis_notes(recipe).c,
            "c_range" => either(format.c_wrapped, "within 0 to 360", "unwrapped"),
            "velocity_unit" => either(format.per_minute, "min", "s"),
            "f_means" => either(self.says_seconds(), "s", "1/min"),
            "ix90" => format.velocity_ms().to_string(),
            "time_axis" => {
                self.time_axis(with_leads(outcome.cutting_time, |l| l.in_time + l.out_time))
            }
            "increments" => 10_u64.pow(format.position_decimals).to_string(),
            _ => String::new(),
        }
    }

    /// The axis of time and how far it goes in `time`, s, where the controller has one.
    fn time_axis(&self, time: f64) -> String {
        let axis = self.layout.format.time_axis;
        axis.map_or_else(String::new, |axis| {
            let speed = axis.speed_um_per_s as f64 / 1e3;
            let (name, way) = (axis.name, time * speed);
            let step = speed / self.layout.format.steps_per_s as f64;
            format!("{name}, {speed} mm in a second, from 0 to {way:.3} mm in steps of {step} mm")
        })
    }

    /// What the axes of the program mean.
    pub fn axis_notes(&self, recipe: &Recipe) -> AxisNotes {
        axis_notes(recipe, self.layout.format.c_sign() < 0.0)
    }

    /// Whether F is the seconds of a line.
    fn says_seconds(&self) -> bool {
        let chords = self.layout.format.chords;
        chords.is_some_and(|chords| chords.feed == FeedMeaning::Seconds)
    }

    /// Reads a whole program of several files to its end. Its path was measured; header, footer and cuts must
    /// not hide any of it.
    pub fn read_whole(
        &self,
        reader: &mut dyn ReadPath,
        name: &Path,
        expected: u64,
    ) -> Result<(), Error> {
        while reader.next_point()?.is_some() {}
        let found = reader.read_count().points();
        match found == expected {
            true => Ok(()),
            false => Err(Error::PointsLost {
                file: name.to_owned(),
                found,
                expected,
            }),
        }
    }

    /// Whether the passes of the program may leave more than those of its path: straight lines in place of a path's
    /// cubics move them, and so do coarse digits.
    fn moves_passes(&self, path: &CarriedPath) -> bool {
        let format = &self.layout.format;
        let moved = format.moves_x_by(path.longest_time);
        format.shape() != path.shape || moved > COARSE_DIGITS * path.residual
    }

    /// Measures the program on the text of its path, which `text` reads. What its passes leave is measured too, where
    /// it may be more than what those of the path leave.
    pub fn measure(
        &self,
        text: ProgramText<'_>,
        (recipe, touch): (&Recipe, FirstTouch),
        path: CarriedPath,
        observer: &dyn Observer,
    ) -> Result<ProgramReport, Error> {
        let ProgramText {
            reader,
            name,
            points,
        } = text;
        observer.begin(Stage::ReadBack, points.div_ceil(BLOCK_ROWS as u64));
        let meters = ProgramMeters::new(recipe, touch).with_servo(recipe);
        let mut meters = meters.with_speed_steps(self.layout.post.c_is_even);
        let shape = self.layout.format.shape();
        if self.moves_passes(&path) {
            meters = meters.with_passes(recipe);
        }
        let measured = measure(recipe, meters, shape, reader, observer)?;
        let found = reader.read_count().points();
        if found != points {
            return Err(Error::PointsLost {
                file: name.to_owned(),
                found,
                expected: points,
            });
        }
        let rate = self.carried(measured.rate.within(self.segments_per_second));
        rate.map_err(|error| not_carried(recipe, error))?;
        let failed = |error| of_measure(recipe, error);
        let form = measured.cut.form().map_err(failed)?;
        let passes = measured.cut.passes().map_err(failed)?;
        let overrun = Overrun::from(recipe.overrun);
        let lead_clearance = measured.lead.figures().map(|lead| lead.clearance);
        let figures = ProgramFigures {
            interpolation_error: measured.cut.playback().max(),
            path_error: path.error,
            residual: passes.map(|passes| residual(&passes.residual, overrun)),
            coverage: passes.map(|passes| coverage(&passes.coverage)),
            covers_part: overrun.covers_part(),
            c_speed_step: measured.speed_steps.map(|steps| steps.largest()),
            servo_error: measured.servo.map(|servo| servo.figures().max()),
            form_error: form_error(form.as_ref(), lead_clearance),
            lead_clearance,
            lines: (shape == SegmentShape::Linear).then(|| points.saturating_sub(1)),
        };
        let tolerances = tolerances(recipe);
        Ok(ProgramReport::new(
            self.file.clone(),
            self.layout.post.name,
            &figures,
            &tolerances,
        ))
    }
}

/// A recipe's own words and those of turnpath: what is known before there is a path.
fn of_recipe(placeholder: &str, recipe: &Recipe) -> Option<String> {
    let file = || recipe.path().file_name().unwrap_or_default();
    Some(match placeholder {
        "name" => recipe.name.clone(),
        "recipe" => file().to_string_lossy().into_owned(),
        "sha256" => sha256_hex(recipe.text().as_bytes()),
        "changes" if recipe.sets().is_empty() => "nothing".to_owned(),
        "changes" => recipe.sets().join(", "),
        "turnpath" => env!("CARGO_PKG_VERSION").to_owned(),
        _ => return None,
    })
}

/// What was measured on the program's own text.
fn verified_value(
    placeholder: &str,
    report: &ProgramReport,
    tolerances: &Tolerances,
) -> Option<String> {
    let nm = |length: Option<f64>| {
        length.map_or_else(|| "none".to_owned(), |mm| format!("{:.2}", 1e6 * mm))
    };
    Some(match placeholder {
        "interpolation_error_nm" => nm(Some(report.interpolation_error)),
        "form_error_nm" => nm(report.form_error),
        "lead_clearance_nm" => nm(report.lead_clearance),
        "verified" => verified_figures(report, tolerances),
        _ => return None,
    })
}

/// An amount that a recipe gives as a text.
fn amount(recipe: &Recipe, post: &Post, text: Option<&str>) -> Result<Option<Amount>, Error> {
    let read = |text: &str| {
        text.parse::<Amount>().map_err(|error| {
            let span = recipe.nearest_span(post.table);
            let help = "write \"100 MB\" (B, kB, MB, GB) or \"200000 blocks\"".to_owned();
            let diagnostic = recipe.diagnostic(span, error.to_string(), "in this table", [help]);
            Error::refused_by(diagnostic, error)
        })
    };
    text.map(read).transpose()
}

/// A program that takes no calls, by a key of its table.
fn without_calls(recipe: &Recipe, post: &Post, key: &str) -> Error {
    let span = recipe.nearest_span(post.table);
    let title = format!("`split` makes a program that calls its parts, and `{key}` takes no calls");
    let help = "leave out one of them: a buffer that is filled while it empties needs no parts";
    let diagnostic = recipe.diagnostic(span, title, "in this table", [help.to_owned()]);
    Error::refused_by(diagnostic, ProgramError::NoCalls)
}

/// Refuses more rough paths than have numbers for their parts, where the controller calls parts by numbers.
fn refuse_many_rough_paths(recipe: &Recipe, post: &Post) -> Result<(), Error> {
    let most = PartNumbers::MOST_ROUGH_PATHS;
    if !post.dialect.calls_by_number() || recipe.rough_path_count() <= most as usize {
        return Ok(());
    }
    let error = ProgramError::ManyRoughPaths { most };
    let span = recipe.nearest_span(post.table);
    let help = error.help(post.keys).to_owned();
    let diagnostic = recipe.diagnostic(span, error.to_string(), "in this table", [help]);
    Err(Error::refused_by(diagnostic, error))
}

/// A template of the recipe, or the post's own.
fn template(
    recipe: &Recipe,
    given: Option<&Spanned<String>>,
    own: &str,
    comment: &'static str,
) -> Result<Template, Error> {
    let text = given.map_or(own, |given| &given.value);
    let template = Template::parse(text, comment).and_then(|template| {
        // Numbers are no marks of a path; a recipe's own words may be a part of one.
        template.check(|name| of_recipe(name, recipe).unwrap_or_else(|| "0".to_owned()))?;
        Ok(template)
    });
    template.map_err(|error| {
        let span = given.map_or_else(|| recipe.nearest_span("output"), |given| given.span.clone());
        let known = format!("placeholders: {{{}}}", PLACEHOLDERS.join("}, {"));
        let diagnostic = recipe.diagnostic(span, error.to_string(), "in this template", [known]);
        Error::refused_by(diagnostic, error)
    })
}
