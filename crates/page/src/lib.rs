//! `report.html`: what a run or an ablation gave, as one page that opens from disk, offline.
//!
//! The data of a page are a model ([`RunPage`], [`AblationPage`]) in mm, rad and s. The page holds them
//! as JSON with units in the keys, and its script draws them by plotly.js, which is in the page too.
//! Verdict, tables, chain and recipe are plain HTML, so they show without scripts.
//!
//! The page loads nothing and runs no script but its own two: its policy names them by their hashes.
//! All text from outside is escaped. The same data give the same bytes.

mod ablation;
mod document;
mod html;
mod run;
mod words;

pub use ablation::{AblationPage, ablation_page};
pub use document::is_page;
pub use run::{BestFit, FileAxes, RunPage, StageChoice, SurfaceSketch, run_page};
