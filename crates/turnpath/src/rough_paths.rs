//! The paths before the finishing one: each is a job of its own whose surface is lifted.

use std::path::PathBuf;

use turnpath_files::{FolderError, ResultFolder, WholeFile};
use turnpath_pipeline::Observer;
use turnpath_recipe::RoughPath;
use turnpath_report::{Left, RoughPathEstimate, RoughPathReport, RunReport};

use crate::data_files::DataFiles;
use crate::error::Error;
use crate::folder::FolderSink;
use crate::form::{FormPath, search_split};
use crate::job::Job;

/// A rough path that can be made.
pub struct RoughJob {
    rough: RoughPath,
    job: Job,
}

impl Job {
    /// The jobs of the recipe's rough paths, in their order. The strategies are made and the tool is checked
    /// for each.
    pub(crate) fn rough_jobs(&self) -> Result<Vec<RoughJob>, Error> {
        let files = DataFiles::default();
        let mut jobs = Vec::new();
        let paths = self.recipe.rough_paths().map_err(Error::refused)?;
        for rough in paths {
            let job = Job::with_files(rough.recipe.clone(), &self.catalogue, &files)?;
            jobs.push(RoughJob { rough, job });
        }
        Ok(jobs)
    }
}

impl RoughJob {
    /// The names of its files.
    pub fn files(&self, dry_run: bool) -> Vec<String> {
        self.job.file_names(dry_run)
    }

    /// The data files that its recipe names, and the recipe.
    pub fn inputs(&self) -> Vec<PathBuf> {
        self.job.inputs()
    }

    /// What the path and its files will be.
    pub fn expected(&self, observer: &dyn Observer) -> Result<RoughPathEstimate, Error> {
        Ok(RoughPathEstimate {
            name: self.rough.name.clone(),
            allowance: self.rough.allowance,
            expected: self.job.expected(observer)?,
        })
    }

    /// Makes the path and its files in the folder of a result.
    pub fn run(
        &self,
        folder: &ResultFolder,
        dry_run: bool,
        observer: &dyn Observer,
    ) -> Result<(RoughPathReport, Vec<WholeFile>), Error> {
        let path = search_split(&self.job, observer, |job| {
            let mut sink = FolderSink::new(folder, &self.job);
            let outcome = job.run_into(&mut sink, observer)?;
            Ok((sink, outcome))
        })?;
        let FormPath {
            mut sink,
            outcome,
            split,
        } = path;
        let programs = sink.read_back(&self.job, &outcome, dry_run, observer)?;
        let report = self.job.report(sink.rows(), &outcome, split, programs)?;
        Ok((self.figures(report), sink.finish()?))
    }
}

impl RoughJob {
    /// The figures of the path from the report on it.
    fn figures(&self, report: RunReport) -> RoughPathReport {
        let RoughPath {
            name, allowance, ..
        } = &self.rough;
        let left = report.path.surface_error.map(|error| Left {
            least: allowance + error.lowest.error,
            mean: allowance + error.mean,
            most: allowance + error.highest.error,
        });
        RoughPathReport {
            name: name.clone(),
            allowance: *allowance,
            left,
            control_points: report.control_points,
            rows: report.rows,
            revolutions: report.revolutions,
            cutting_time: report.cutting_time,
            interpolation_error: report.path.interpolation_error.max,
            residual: report.path.residual.max,
            programs: report.programs,
            within: report.within,
        }
    }
}

/// Refuses files of rough paths that could not be part of a result.
pub fn can_be_in_result(
    folder: &std::path::Path,
    rough_paths: &[RoughJob],
    dry_run: bool,
) -> Result<(), FolderError> {
    for name in rough_paths.iter().flat_map(|rough| rough.files(dry_run)) {
        ResultFolder::can_have(folder, &name)?;
    }
    Ok(())
}
