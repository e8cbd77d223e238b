//! Where a run puts its path, its programs and its report.

use std::path::PathBuf;

use crate::drawings::DrawingRequest;
use crate::plots::PlotRequest;

/// Where a run puts what it makes.
#[derive(Debug, Clone, PartialEq)]
pub struct Outputs {
    pub(crate) destination: Destination,
    pub(crate) plots: PlotRequest,
    pub(crate) drawings: Vec<DrawingRequest>,
    /// Whether each program has its dry run beside it.
    pub(crate) dry_run: bool,
    /// Whether the result has its page, `report.html`.
    pub(crate) page: bool,
}

/// The kinds of outputs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Destination {
    /// The report alone.
    Nowhere,
    /// The tool path and the programs, beside the report.
    Memory,
    /// The files that the recipe asks for, and the report as `summary.json`.
    Folder(PathBuf),
}

impl Outputs {
    /// The report alone; programs are neither made nor measured.
    pub fn nowhere() -> Self {
        Self::to(Destination::Nowhere)
    }

    /// The tool path as columns and the programs as bytes, beside the report.
    pub fn in_memory() -> Self {
        Self::to(Destination::Memory)
    }

    /// The files that the recipe asks for, and the report as `summary.json`. The folder is made if
    /// it is not there.
    pub fn in_folder(folder: impl Into<PathBuf>) -> Self {
        Self::to(Destination::Folder(folder.into()))
    }

    /// With maps, profiles, circles and spectra. They are measured on `toolpath.csv`, so they need a
    /// folder.
    #[must_use]
    pub fn with_plots(self, plots: PlotRequest) -> Self {
        Self { plots, ..self }
    }

    /// With figures for papers. They are files, so they need a folder.
    #[must_use]
    pub fn with_drawings(self, drawings: Vec<DrawingRequest>) -> Self {
        Self { drawings, ..self }
    }

    /// With a dry run beside each program. It needs a folder.
    #[must_use]
    pub fn with_dry_run(self, dry_run: bool) -> Self {
        Self { dry_run, ..self }
    }

    /// With the page of the result, `report.html`. It needs a folder.
    #[must_use]
    pub fn with_page(self, page: bool) -> Self {
        Self { page, ..self }
    }

    fn to(destination: Destination) -> Self {
        Self {
            destination,
            plots: PlotRequest::default(),
            drawings: Vec::new(),
            dry_run: false,
            page: false,
        }
    }
}
