//! The limit on the time of one call into a loaded plugin.

use std::collections::HashMap;
use std::str::FromStr;
use std::sync::Once;
use std::thread;
use std::time::Duration;

use turnpath::calls::{self, Call, Callee};
use turnpath_core::Quantity;
use turnpath_files::end_writing;

use super::system;
use crate::background;

/// The limit unless the user gives another. The longest calls plan a whole path: seconds for the
/// strategies that are built in, so ten minutes end only what does not come back.
const USUAL: Duration = Duration::from_secs(600);
/// Looks within the limit: a call may take so much of the limit longer.
const LOOKS: u32 = 50;
/// The longest time between two looks.
const LONGEST_STEP: Duration = Duration::from_millis(500);
/// The shortest limit: below it the watchdog itself would take time from the work.
const SHORTEST: Duration = Duration::from_millis(10);

/// How long a file that gets its name on another thread is waited for: an ablation has several runs.
const PATIENCE: Duration = Duration::from_secs(1);

/// How long a single call into a plugin may take; `None` for as long as it likes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TimeLimit(Option<Duration>);

impl Default for TimeLimit {
    fn default() -> Self {
        Self(Some(USUAL))
    }
}

impl TimeLimit {
    /// The limit as a time.
    pub fn duration(self) -> Option<Duration> {
        self.0
    }
}

impl FromStr for TimeLimit {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.trim() == "none" {
            return Ok(Self(None));
        }
        let seconds = Quantity::Time.parse(text).map_err(|error| {
            format!("{error}: write a limit such as `90 s` or `5 min`; `none` switches it off")
        })?;
        let limit = Duration::try_from_secs_f64(seconds).ok();
        match limit.filter(|limit| *limit >= SHORTEST) {
            Some(limit) => Ok(Self(Some(limit))),
            None => Err(format!(
                "the limit is at least {} ms; `none` switches it off",
                SHORTEST.as_millis()
            )),
        }
    }
}

impl std::fmt::Display for TimeLimit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.0 {
            None => f.write_str("none"),
            Some(limit) => write!(f, "{} s", limit.as_secs_f64()),
        }
    }
}

/// Begins to watch the calls into loaded plugins. Only the first limit of a process counts.
pub fn watch(limit: TimeLimit) {
    static WATCHED: Once = Once::new();
    let Some(limit) = limit.0 else { return };
    WATCHED.call_once(|| {
        // Where no thread can be had, nothing else works either, and the run goes without a limit.
        let _ = background::start("plugin-time-limit", move || look_on(limit));
    });
}

fn look_on(limit: Duration) {
    let step = (limit / LOOKS).min(LONGEST_STEP);
    let most = limit.as_nanos().div_ceil(step.as_nanos().max(1));
    let mut counts = LookCounts::default();
    loop {
        thread::sleep(step);
        if let Some(callee) = counts.look(&calls::on_all_threads(), most) {
            end_writing(PATIENCE);
            system::end([
                "error: ",
                callee.text(),
                " gave no answer within ",
                &TimeLimit(Some(limit)).to_string(),
                "\nhelp: a plugin that needs longer gets it with `--plugin-time-limit`\n",
            ]);
        }
    }
}

/// At how many looks each call was in progress. Looks are counted instead of the clock, so that a
/// process that was stopped for a while blames nobody.
#[derive(Default)]
struct LookCounts(HashMap<(usize, usize, u64), u128>);

impl LookCounts {
    /// Counts a look. If a call was seen more than `most` times, the callee to blame: that of the
    /// innermost call on that thread that was seen at half of these looks, for which those outside
    /// only wait.
    fn look(&mut self, calls: &[Call], most: u128) -> Option<&'static Callee> {
        let before = std::mem::take(&mut self.0);
        let loaded = calls.iter().filter(|call| call.callee.is_loaded());
        let mut counted: Vec<(&Call, u128)> = Vec::new();
        for call in loaded {
            let key = (call.thread, call.depth, call.number);
            let times = before.get(&key).map_or(1, |times| times + 1);
            self.0.insert(key, times);
            counted.push((call, times));
        }
        let (late, _) = counted.iter().find(|(_, times)| *times > most)?;
        let of_thread = counted
            .iter()
            .filter(|(call, _)| call.thread == late.thread);
        let lasting = of_thread.filter(|(_, times)| 2 * times > most);
        let innermost = lasting.max_by_key(|(call, _)| call.depth);
        innermost.map(|(call, _)| call.callee)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_a_time_or_none() {
        let of = |text: &str| text.parse::<TimeLimit>();
        assert_eq!(of("2 min"), Ok(TimeLimit(Some(Duration::from_secs(120)))));
        assert_eq!(of("none"), Ok(TimeLimit(None)));
        for wrong in ["0 s", "-1 s", "2", "2 mm", "1e30 h", "soon"] {
            assert!(of(wrong).is_err(), "{wrong}");
        }
        let usual = TimeLimit::default();
        assert_eq!(usual.to_string().parse(), Ok(usual));
    }

    fn call(callee: &'static Callee, depth: usize, number: u64) -> Call {
        Call {
            callee,
            thread: 0,
            depth,
            number,
        }
    }

    #[test]
    fn the_call_that_does_not_end_is_blamed_and_not_one_that_comes_again() {
        let feed = Callee::new("a patient feed".into(), true);
        let surface = Callee::new("an endless surface".into(), true);
        let mut counts = LookCounts::default();
        let mut ends = None;
        for look in 0..10 {
            // The surface is asked anew at each of the first looks; then it does not come back.
            let asked = call(surface, 1, look.min(5));
            ends = ends.or(counts.look(&[call(feed, 0, 1), asked], 20));
        }
        assert!(ends.is_none());
        for _ in 0..16 {
            ends = ends.or(counts.look(&[call(feed, 0, 1), call(surface, 1, 5)], 20));
        }
        assert!(ends.is_some_and(|callee| std::ptr::eq(callee, surface)));
    }

    #[test]
    fn what_is_built_in_has_no_limit() {
        let callee = Callee::new("a long plan".into(), false);
        let mut counts = LookCounts::default();
        let late = (0..50).find_map(|_| counts.look(&[call(callee, 0, 1)], 2));
        assert!(late.is_none());
    }
}
