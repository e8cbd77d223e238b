//! The commands, a file each: from arguments to a call of the library and a printed answer.

mod ablate;
mod check;
mod completions;
mod drawings;
mod explain;
mod import;
mod init;
mod list;
mod man;
mod new_plugin;
mod output;
mod plots;
mod report;
mod run;
mod sag;
mod schema;
mod setup;
mod strategy_list;
mod verify;

pub use ablate::ablate;
pub use check::check;
pub use completions::completions;
pub use explain::explain;
pub use import::import;
pub use init::init;
pub use list::list;
pub use man::man;
pub use new_plugin::new_plugin;
pub use report::report;
pub use run::run;
pub use sag::sag;
pub use schema::schema;
pub use verify::verify;
