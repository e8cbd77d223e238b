//! The figures with their files, checked before the work.

use std::io::Write;
use std::path::{Path, PathBuf};

use turnpath_drawing::{Dots, Figure, Size, draw};
use turnpath_files::{Draft, FileError, FolderError, ResultFolder};
use turnpath_report::{PathSketch, RunReport};

use super::request::{DrawingFileError, DrawingRequest};
use crate::error::Error;
use crate::plots::{can_be_made, place_of};
use crate::summary::lists;

/// The figures that are asked for.
#[derive(Debug)]
pub struct Drawings(Vec<DrawingFile>);

/// A figure and its file.
#[derive(Debug)]
struct DrawingFile {
    figure: Figure,
    file: PathBuf,
    size: Size,
    form: Form,
}

#[derive(Debug, Clone, Copy)]
enum Form {
    Svg,
    Png(Dots),
}

impl Drawings {
    /// The figures that are asked for; files without a folder of their own go to `folder`.
    ///
    /// # Errors
    /// When one cannot be drawn so, or its file cannot be made.
    pub fn new(requests: &[DrawingRequest], folder: &Path) -> Result<Self, Error> {
        let files = requests.iter().map(|request| drawing_file(request, folder));
        let drawings = Self(files.collect::<Result<_, _>>()?);
        let mut files: Vec<&Path> = drawings.files().collect();
        files.sort_unstable();
        if let Some(pair) = files.windows(2).find(|pair| pair[0] == pair[1]) {
            let file = pair[0].to_owned();
            return Err(DrawingFileError::SameFile { file }.into());
        }
        for file in drawings.files() {
            can_be_made(file, folder)?;
        }
        Ok(drawings)
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Refuses files of a result that could not be part of it.
    pub fn can_be_in_result(&self, folder: &Path) -> Result<(), FolderError> {
        let members = self
            .files()
            .filter_map(|file| ResultFolder::member(folder, file));
        for name in members {
            ResultFolder::can_have(folder, &name)?;
        }
        Ok(())
    }

    /// Refuses files that the result lists.
    pub fn leave_result(&self, folder: &Path, report: &RunReport) -> Result<(), DrawingFileError> {
        match self.files().find(|file| lists(report, folder, file)) {
            Some(file) => Err(DrawingFileError::InResult {
                file: file.to_owned(),
            }),
            None => Ok(()),
        }
    }

    /// Draws them: files that are whole, and still without their names.
    pub fn draw(
        &self,
        report: &RunReport,
        sketch: &PathSketch,
        begin: &dyn Fn(&Path) -> Result<Draft, FileError>,
    ) -> Result<Vec<Draft>, Error> {
        let mut drafts = Vec::new();
        for file in &self.0 {
            let drawing = draw(file.figure, (report, sketch), file.size);
            let drawing = drawing.map_err(DrawingFileError::from)?;
            let bytes = match file.form {
                Form::Svg => drawing.svg().into_bytes(),
                Form::Png(dots) => drawing.png(dots).map_err(DrawingFileError::from)?,
            };
            let mut draft = begin(&file.file)?;
            let written = draft.write_all(&bytes);
            written.map_err(FileError::of(&file.file))?;
            drafts.push(draft);
        }
        Ok(drafts)
    }

    /// The files that will be written.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.0.iter().map(|drawing| drawing.file.as_path())
    }
}

fn drawing_file(request: &DrawingRequest, folder: &Path) -> Result<DrawingFile, DrawingFileError> {
    let size = request.size.unwrap_or(request.figure.size());
    request.figure.allows(size)?;
    let ending = request.file.extension().unwrap_or_default();
    let form = match ending.to_string_lossy().to_ascii_lowercase().as_str() {
        "svg" => Form::Svg,
        "png" => {
            size.pixels(request.dots)?;
            Form::Png(request.dots)
        }
        _ => {
            let file = request.file.clone();
            return Err(DrawingFileError::Form { file });
        }
    };
    Ok(DrawingFile {
        figure: request.figure,
        file: place_of(&request.file, folder),
        size,
        form,
    })
}
