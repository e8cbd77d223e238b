//! The files of a run: begun with its first control points, and named together when all is done.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;
use turnpath_core::toolpath::{Section, SectionBlock};
use turnpath_files::{Contents, Draft, FileError, FolderError, ResultFolder, WholeFile};
use turnpath_pipeline::{DraftSink, Estimate, Observer, Outcome, Sink};
use turnpath_post::{
    ColumnFormat, Columns, Lines, PathReader, PathWriter, ProgramPath, ProgramWriter, WriteColumns,
};
use turnpath_recipe::DataFormat;
use turnpath_report::{ProgramReport, ResultFile};

use crate::diagnosis::not_carried;
use crate::error::Error;
use crate::job::Job;
use crate::plots::{PlayedPath, Plots, draw};
use crate::program::{Frame, Program, ProgramText};
use crate::program_room::ProgramRoom;

use crate::sinks::SinkError;
use crate::sizes::{bytes_while_assembled, check_room, column_bytes, toolpath_bytes};
use crate::summary::{PAGE, SUMMARY, own_page};

/// The table of the path.
pub const TOOLPATH: &str = "toolpath.csv";

/// A program with more text than this is read back while it is written, bytes: a thread takes less time than
/// the reading of so much.
const LARGE_PROGRAM: u64 = 1 << 20;

/// Takes a folder for one run alone, however often the run makes its path.
///
/// # Errors
/// When another run has it, or something is in the way that would stop this one only at its end.
pub fn open_folder(folder: &Path, job: &Job, dry_run: bool) -> Result<ResultFolder, FolderError> {
    nothing_in_the_way(folder, result_files(job, dry_run))?;
    ResultFolder::open(folder)
}

/// The names of the files that a run writes without being asked for each.
pub fn result_files(job: &Job, dry_run: bool) -> impl Iterator<Item = String> {
    let own = [SUMMARY, PAGE].map(str::to_owned);
    job.file_names(dry_run).into_iter().chain(own)
}

impl Job {
    /// The names of the files of its path.
    pub(crate) fn file_names(&self, dry_run: bool) -> Vec<String> {
        let programs = self.programs.iter().map(|program| program.file.clone());
        let dry_runs = self.programs.iter().filter(|_| dry_run);
        let table = std::iter::once(self.toolpath_file());
        let columns = self.column_files().into_iter().map(|(_, name)| name);
        let programs = programs.chain(dry_runs.map(Program::dry_run_file));
        programs.chain(table).chain(columns).collect()
    }

    /// The files of its path's columns, with their names.
    fn column_files(&self) -> Vec<(ColumnFormat, String)> {
        let table = self.toolpath_file();
        let stem = table.trim_end_matches(".csv");
        let formats = self.recipe.output.data.iter();
        let file = |format: &DataFormat| match format {
            DataFormat::Csv => None,
            DataFormat::Columns(format) => {
                Some((*format, format!("{stem}.{}", format.extension())))
            }
        };
        formats.filter_map(file).collect()
    }

    /// The name of the table of its path.
    fn toolpath_file(&self) -> String {
        match self.recipe.rough_name() {
            Some(rough) => rough_toolpath(rough),
            None => TOOLPATH.to_owned(),
        }
    }
}

/// The name of the table of a rough path.
pub fn rough_toolpath(rough: &str) -> String {
    format!("toolpath-{rough}.csv")
}

/// The files of a path, in the making. A path that fails leaves none of them.
pub struct FolderSink<'a> {
    files: Option<Files>,
    folder: &'a ResultFolder,
    writes_toolpath: bool,
    /// The files of columns, with their names.
    column_files: Vec<(ColumnFormat, String)>,
    /// The name of the table of the path.
    toolpath: String,
    programs: &'a [Program],
    /// The outer end of the range of ρ, mm.
    radius: f64,
    rows: u64,
    /// What the programs take.
    room: ProgramRoom,
}

/// The files that the first control points begin.
#[derive(Default)]
struct Files {
    toolpath: Option<PathWriter>,
    /// Behind a lock since threads share the sink; only one of them writes.
    columns: Mutex<Vec<Box<dyn WriteColumns>>>,
    programs: Vec<ProgramWriter>,
    /// The programs that are written to their ends, and the pictures of the path, still without their
    /// names.
    drafts: Vec<Draft>,
    pictures: Vec<Draft>,
    /// The table of the path, read back.
    whole_table: Option<WholeFile>,
}

/// The files of a run, whole and on the disk, and still without their names.
pub struct WholeResult {
    // Dropped before the folder in which they lie.
    files: Vec<WholeFile>,
    folder: ResultFolder,
}

/// A block in the form of each file.
pub struct FileBlock {
    rows: Option<Vec<u8>>,
    columns: Option<Columns>,
    lines: Vec<Lines>,
    /// Whether it is of the cut.
    is_cut: bool,
}

impl<'a> FolderSink<'a> {
    /// Files in a folder that a run has taken.
    pub fn new(folder: &'a ResultFolder, job: &'a Job) -> Self {
        Self {
            folder,
            writes_toolpath: job.recipe.output.data.contains(&DataFormat::Csv),
            column_files: job.column_files(),
            toolpath: job.toolpath_file(),
            programs: &job.programs,
            radius: job.preparation.task.range.outer,
            files: None,
            rows: 0,
            room: ProgramRoom::default(),
        }
    }

    /// Control points so far.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    fn begin(&self) -> Result<Files, FileError> {
        let mut files = Files::default();
        if self.writes_toolpath {
            files.toolpath = Some(PathWriter::begin(self.draft(&self.toolpath)?)?);
        }
        let mut columns = Vec::new();
        for (format, name) in &self.column_files {
            columns.extend(format.begin(self.draft(name)?)?);
        }
        files.columns = Mutex::new(columns);
        for program in self.programs {
            let draft = self.draft(&program.file)?;
            let writer = ProgramWriter::begin(draft, program.layout)?;
            files.programs.push(writer);
        }
        Ok(files)
    }

    fn draft(&self, name: &str) -> Result<Draft, FileError> {
        self.folder.draft(&self.folder.path().join(name))
    }

    /// Draws maps, profiles, circles and spectra of `toolpath.csv` as it stands, before it is read back.
    pub fn plot(
        &mut self,
        job: &Job,
        plots: &Plots,
        outcome: &Outcome,
        observer: &dyn Observer,
    ) -> Result<(), Error> {
        let Some(files) = self.files.as_mut().filter(|_| !plots.is_empty()) else {
            return Ok(());
        };
        if let Some(toolpath) = &mut files.toolpath {
            let name = self.folder.path().join(&self.toolpath);
            let reader = PathReader::open(toolpath.readable()?);
            let mut reader = reader.map_err(|error| error.named(&name))?;
            let played = PlayedPath {
                recipe: &job.recipe,
                touch: &job.preparation.touch,
                shape: job.shape(),
                largest_error: outcome.figures.playback.max(),
                points: self.rows,
            };
            let begin = |file: &Path| self.folder.draft(file);
            let drawn = draw(plots, &played, &mut reader, &begin, observer)?;
            files.pictures.extend(drawn);
        }
        Ok(())
    }

    /// Measures each program on the text of its path, puts it together with its figures in the header, and
    /// proves that the whole is read as this text. The table of the path is read back meanwhile.
    pub fn read_back(
        &mut self,
        job: &Job,
        outcome: &Outcome,
        dry_run: bool,
        observer: &dyn Observer,
    ) -> Result<Vec<ProgramReport>, Error> {
        let Some(mut files) = self.files.take() else {
            return Ok(Vec::new());
        };
        let (toolpath, writers) = (files.toolpath.take(), std::mem::take(&mut files.programs));
        let read_programs = || {
            let each = self.programs.iter().zip(writers);
            let read =
                each.map(|program| self.read_program(job, program, outcome, dry_run, observer));
            read.collect::<Result<Vec<_>, Error>>()
        };
        let read_table = || toolpath.map(|table| table.whole().finish()).transpose();
        let (programs, table) = rayon::join(read_programs, read_table);
        let (reports, drafts): (Vec<_>, Vec<_>) = programs?.into_iter().unzip();
        files.drafts.extend(drafts.into_iter().flatten());
        files.whole_table = table?;
        self.files = Some(files);
        Ok(reports)
    }

    /// The report of one program, and its files.
    fn read_program(
        &self,
        job: &Job,
        (program, writer): (&Program, ProgramWriter),
        outcome: &Outcome,
        dry_run: bool,
        observer: &dyn Observer,
    ) -> Result<(ProgramReport, Vec<Draft>), Error> {
        let mut path = writer.close()?;
        let (points, name) = (path.points(), path.file().to_owned());
        let mut reader = program.layout.read(path.text()?, &name);
        let text = ProgramText {
            reader: &mut reader,
            name: &name,
            points,
        };
        let touch = job.preparation.touch.clone();
        let carried = job.carried_path(outcome);
        let report = program.measure(text, (&job.recipe, touch), carried, observer)?;
        drop(reader);
        let frame = program.frame(&job.recipe, outcome, points, &report);
        let mut drafts = Vec::new();
        if let Some(extent) = path.extent().filter(|_| dry_run) {
            let text = job.dry_run(program, &frame, &extent)?;
            let file = self.folder.path().join(program.dry_run_file());
            let mut draft = self.folder.draft(&file)?;
            draft.write_all(&text).map_err(FileError::of(&file))?;
            drafts.push(draft);
        }
        drafts.extend(whole_program((job, program), path, &frame, self.folder)?);
        Ok((report, drafts))
    }

    /// Brings all files to the disk, and reads them back by their hashes.
    pub fn finish(self) -> Result<Vec<WholeFile>, FileError> {
        let Files {
            toolpath,
            columns,
            programs: _,
            mut drafts,
            pictures,
            whole_table,
        } = self.files.unwrap_or_default();
        drafts.extend(pictures);
        let columns = columns.into_inner().unwrap_or_else(PoisonError::into_inner);
        for columns in columns {
            drafts.push(columns.whole()?);
        }
        let drafts = drafts.into_iter().chain(toolpath.map(PathWriter::whole));
        let drafts: Vec<Draft> = drafts.collect();
        let files: Vec<_> = drafts.into_par_iter().map(Draft::finish).collect();
        files.into_iter().chain(whole_table.map(Ok)).collect()
    }
}

/// Puts a program together, in one file or with its parts; gives its files.
fn whole_program(
    (job, program): (&Job, &Program),
    mut path: ProgramPath,
    frame: &Frame,
    folder: &ResultFolder,
) -> Result<Vec<Draft>, Error> {
    let around = [frame.header.as_str(), &frame.footer];
    let size = path.size(&frame.header, &frame.footer);
    let fits = program.refuse_large(size);
    fits.map_err(|error| not_carried(&job.recipe, error))?;
    let Some(limits) = program.limits_of(size) else {
        if size.bytes > LARGE_PROGRAM && rayon::current_num_threads() > 1 {
            path.read_while_written();
        }
        return Ok(vec![path.assemble(around)?.prove()?]);
    };
    let (points, file) = (path.points(), path.file().to_owned());
    let mut names = Vec::new();
    let assembled = path.assemble_parts(around, (&program.file, limits), &mut |name| {
        names.push(name.to_owned());
        folder.draft(&folder.path().join(name))
    });
    let divided = assembled.map_err(|error| program.not_divided(&job.recipe, error));
    let (main, parts) = divided?;
    let parts = names.into_iter().zip(parts).collect();
    read_files(program, (main, parts), &file, points)
}

/// Reads a program of several files to its end; gives its files.
fn read_files(
    program: &Program,
    (mut main, parts): (Draft, Vec<(String, Draft)>),
    name: &Path,
    points: u64,
) -> Result<Vec<Draft>, Error> {
    let (mut drafts, mut places) = (Vec::new(), BTreeMap::new());
    for (name, mut draft) in parts {
        places.insert(name, draft.readable()?.to_owned());
        drafts.push(draft);
    }
    let place = move |name: &str| places.get(name).cloned().unwrap_or_else(|| name.into());
    let mut whole = program
        .layout
        .open_as(name, main.readable()?, Box::new(place))?;
    program.read_whole(&mut whole, name, points)?;
    drafts.insert(0, main);
    Ok(drafts)
}

impl WholeResult {
    /// All files of a path, and the folder in which they lie.
    pub fn new(files: Vec<WholeFile>, folder: ResultFolder) -> Self {
        Self { files, folder }
    }

    /// The files that lie in the folder, for the summary.
    pub fn listed(&self) -> Vec<ResultFile> {
        let member = |file: &WholeFile| {
            let Contents { bytes, sha256 } = file.contents().clone();
            let file = file.member()?.to_owned();
            Some(ResultFile {
                file,
                bytes,
                sha256,
            })
        };
        self.files.iter().filter_map(member).collect()
    }

    /// Makes these files, the page and the summary the result of the folder; gives their paths, the
    /// summary last. The summary does not list the page, and without one that of an earlier run is
    /// removed: it would show another result.
    pub fn commit(
        mut self,
        summary: &str,
        page: Option<&str>,
    ) -> Result<Vec<PathBuf>, FolderError> {
        match page {
            Some(page) => self.files.push(self.whole(PAGE, page)?),
            None => own_page(self.folder.path())?
                .into_iter()
                .for_each(|page| self.folder.outdates(page)),
        }
        let summary = self.whole(SUMMARY, summary)?;
        let paths = self.files.iter().chain([&summary]);
        let paths = paths.map(|file| file.path().to_owned()).collect();
        self.folder.commit(self.files, summary)?;
        Ok(paths)
    }

    fn whole(&self, name: &str, text: &str) -> Result<WholeFile, FileError> {
        let path = self.folder.path().join(name);
        let mut draft = self.folder.draft(&path)?;
        let written = draft.write_all(text.as_bytes());
        written.map_err(FileError::of(&path))?;
        draft.finish()
    }
}

/// A file where a folder must be, or anything but a file where one must be, is refused before the
/// work.
fn nothing_in_the_way(
    folder: &Path,
    files: impl Iterator<Item = String>,
) -> Result<(), FolderError> {
    let nearest = folder.ancestors().find(|part| part.exists());
    if let Some(file) = nearest.filter(|part| !part.is_dir()) {
        let cause = format!("{} is a file, not a folder", file.display());
        let error = io::Error::new(io::ErrorKind::NotADirectory, cause);
        return Err(FileError::of(folder)(error).into());
    }
    for name in files {
        ResultFolder::can_have(folder, &name)?;
    }
    Ok(())
}

impl Sink for FolderSink<'_> {
    type Block = FileBlock;
    type Error = SinkError;

    fn expect(&mut self, expected: &Estimate) -> Result<(), SinkError> {
        let programs = self.programs.iter();
        let programs = programs.map(|program| program.expected_bytes(self.radius, expected));
        let programs = bytes_while_assembled(programs);
        let toolpath = if self.writes_toolpath {
            toolpath_bytes(expected)
        } else {
            0.0
        };
        let columns = column_bytes(expected) * self.column_files.len() as f64;
        check_room(self.folder.path(), toolpath + columns + programs)?;
        self.room = ProgramRoom::new(expected, self.programs.len());
        Ok(())
    }

    fn encode(&self, block: &SectionBlock<'_>) -> Result<FileBlock, SinkError> {
        let rows = self
            .writes_toolpath
            .then(|| PathWriter::rows(block.section, block.points));
        let has_columns = !self.column_files.is_empty();
        let lines = self.programs.iter().map(|program| program.lines(block));
        Ok(FileBlock {
            rows,
            columns: has_columns.then(|| Columns::of(block.section, block.points)),
            is_cut: block.section == Section::Cutting,
            lines: lines.collect::<Result<_, _>>()?,
        })
    }

    fn take(&mut self, points: usize, block: FileBlock) -> Result<(), SinkError> {
        if self.files.is_none() {
            self.files = Some(self.begin()?);
        }
        self.rows += points as u64;
        if block.is_cut {
            let bytes = block.lines.iter().map(|lines| lines.text.len());
            if let Some(needed) = self.room.pass(points, bytes) {
                check_room(self.folder.path(), needed)?;
            }
        }
        let Some(files) = &mut self.files else {
            return Ok(());
        };
        let not_written = |name: &str, error| FileError {
            path: self.folder.path().join(name),
            error,
        };
        if let Some((toolpath, rows)) = files.toolpath.as_mut().zip(block.rows) {
            let appended = toolpath.append(&rows);
            appended.map_err(|error| not_written(&self.toolpath, error))?;
        }
        let writers = files.columns.get_mut();
        let writers = writers.unwrap_or_else(PoisonError::into_inner);
        let column_files = self.column_files.iter().zip(writers);
        for ((_, name), writer) in column_files {
            let appended = block.columns.as_ref().map_or(Ok(()), |c| writer.append(c));
            appended.map_err(|error| not_written(name, error))?;
        }
        let programs = self.programs.iter().zip(&mut files.programs);
        for ((program, writer), lines) in programs.zip(&block.lines) {
            let appended = writer.append(lines);
            appended.map_err(|error| not_written(&program.file, error))?;
        }
        Ok(())
    }
}

impl DraftSink for FolderSink<'_> {
    fn drop_draft(&mut self) {
        // Files in the making that are dropped are removed.
        self.files = None;
        self.rows = 0;
        self.room.begin_again();
    }
}
