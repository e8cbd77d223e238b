//! Pages can be sent by mail.

use turnpath_page::{AblationPage, ablation_page, run_page};

use crate::support;

/// What a page may take.
const MOST_BYTES: usize = 5_000_000;

#[test]
fn the_page_of_the_longest_path_is_below_five_megabytes() {
    let bytes = run_page(&support::run_page()).len();
    assert!(bytes < MOST_BYTES, "{bytes}");
}

#[test]
fn the_page_of_96_runs_is_below_five_megabytes() {
    let report = support::ablation(96);
    let bytes = ablation_page(&AblationPage { report }).len();
    assert!(bytes < MOST_BYTES, "{bytes}");
}
