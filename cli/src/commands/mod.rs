//! The commands, a file each: from arguments to a call of the library and a printed answer.

mod ablate;
mod check;
mod explain;
mod import;
mod list;
mod output;
mod plots;
mod report;
mod run;
mod sag;
mod setup;
mod verify;

pub use ablate::ablate;
pub use check::check;
pub use explain::explain;
pub use import::import;
pub use list::list;
pub use report::report;
pub use run::run;
pub use sag::sag;
pub use verify::verify;
