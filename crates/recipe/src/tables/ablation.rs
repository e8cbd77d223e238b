//! The fixed key of `[ablation]`. Its other keys are the lists of what varies.

use turnpath_core::Param;
use turnpath_core::kind::Choice;

use crate::read::Section;
use crate::table_info::TableInfo;

const ONE_AT_A_TIME: &str = "one-at-a-time";

const MODE: Param<Choice> = Param::choice(
    "mode",
    &["all-pairs", ONE_AT_A_TIME],
    "all-pairs: the full product; one-at-a-time: each value alone",
)
.default("all-pairs");

pub(super) const ABLATION: TableInfo = TableInfo {
    name: "ablation",
    summary: "what `turnpath ablate` varies",
    required: false,
    keys: &[MODE.info()],
};

/// Whether each value varies alone, not all with all.
pub(crate) fn is_one_at_a_time(section: &mut Section<'_>) -> bool {
    section.values(ABLATION.keys).find(MODE) == Some(ONE_AT_A_TIME)
}
