//! Answers that cannot be used are errors that name the strategy and the place.

use std::sync::Arc;

use crate::common::solvers::{Broken, Greedy};
use crate::common::{BrokenBeyond90, Feed, Nodes, RIM, Task, feed_of, straight};
use turnpath_core::{
    Continuation, FeedPiece, FeedPlan, FeedStrategy, Path, Result, Revolutions, Setup, Slot,
    StrategyError,
};
use turnpath_pipeline::PipelineError;

/// The slot that is to blame for a bad answer, and what is wrong with the answer.
fn bad_answer(task: &Task) -> (Slot, String) {
    match task.run().map_err(|error| *error) {
        Err(PipelineError::BadAnswer { slot, what, .. }) => (slot, what),
        Err(other) => panic!("{other:?}"),
        Ok((path, _)) => panic!("a path of {} points", path.len()),
    }
}

fn assert_says(task: &Task, slot: Slot, text: &str) {
    let (blamed, what) = bad_answer(task);
    assert!(blamed == slot && what.contains(text), "{blamed:?}: {what}");
}

fn assert_feed_says(feed: Arc<dyn FeedStrategy>, text: &str) {
    let task = Task {
        feed,
        ..Task::default()
    };
    assert_says(&task, Slot::Feed, text);
}

fn assert_nodes_say(
    nodes: impl Fn(Revolutions) -> Vec<f64> + Clone + Send + Sync + 'static,
    text: &str,
) {
    let task = Task {
        sampler: Arc::new(Nodes(move |_: &Path<'_>, block: Revolutions| nodes(block))),
        ..Task::default()
    };
    assert_says(&task, Slot::Sampler, text);
}

#[test]
fn nodes_must_be_numbers_in_order_within_their_block() {
    let place = "in revolutions 0 to 64";
    assert_nodes_say(|block| vec![block.start, f64::NAN], "node 1 is NaN");
    assert_nodes_say(
        |block| vec![block.start, block.end],
        "node 1 at 64 lies outside",
    );
    assert_nodes_say(|_| vec![-0.5], "node 0 at -0.5 lies outside");
    assert_nodes_say(|_| vec![0.0, 2.0, 1.0], "node 2 at 1 does not lie beyond 2");
    assert_nodes_say(|_| vec![0.0, 1.0, 1.0], place);
    assert_nodes_say(|_| Vec::new(), "no node in revolutions 0 to 64");
    let second = |block: Revolutions| match block.start {
        0.0 => vec![0.0, 1.0],
        start => vec![start, f64::INFINITY],
    };
    assert_nodes_say(second, "node 1 is inf, in revolutions 64 to 128");
}

#[test]
fn velocities_must_be_numbers() {
    let task = Task {
        velocity: Arc::new(Broken),
        ..Task::default()
    };
    assert_says(&task, Slot::Velocity, "is not finite");
}

#[test]
fn tool_centres_must_be_numbers() {
    for value in [f64::NAN, f64::INFINITY] {
        let task = Task {
            compensator: Arc::new(BrokenBeyond90(value)),
            ..Task::default()
        };
        assert_says(
            &task,
            Slot::Compensator,
            "no number for the tool centre at C = 100.000",
        );
    }
}

#[test]
fn a_law_must_have_pieces_that_are_numbers() {
    let with = |k: usize, value: f64| {
        let mut piece = straight(200.0, RIM, -0.01);
        piece.coefficients[k] = value;
        feed_of(vec![piece])
    };
    assert_feed_says(with(0, f64::NAN), "after 0.000 revolutions");
    assert_feed_says(with(5, f64::INFINITY), "after 0.000 revolutions");
    for length in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let pieces = vec![
            straight(10.0, RIM, -0.01),
            straight(length, RIM - 0.1, -0.01),
        ];
        assert_feed_says(feed_of(pieces), "after 10.000 revolutions");
    }
    assert_feed_says(feed_of(Vec::new()), "without pieces");
    let silent = Feed(|_| (Vec::new(), Continuation::More));
    assert_feed_says(Arc::new(silent), "no piece, after 0.000 revolutions");
}

#[test]
fn every_turn_of_a_law_must_lie_beyond_the_one_before() {
    let back = vec![straight(10.5, RIM, -0.1), straight(100.0, RIM - 1.05, 0.01)];
    assert_feed_says(feed_of(back), "not beyond the one before");
    let halt = vec![straight(10.0, RIM, -0.1), straight(50.0, RIM - 1.0, 0.0)];
    assert_feed_says(feed_of(halt), "not beyond the one before");
    // A law in the wrong direction.
    let outward = feed_of(vec![straight(200.0, 0.0, RIM / 200.0)]);
    assert_feed_says(outward, "not beyond the one before");
}

#[test]
fn a_law_must_cover_the_part_and_be_continuous() {
    let short = feed_of(vec![straight(100.0, RIM, -0.01)]);
    assert_feed_says(short, "leaves some of the part uncut");
    let late = feed_of(vec![straight(100.0, 1.0, -0.01)]);
    assert_feed_says(late, "leaves some of the part uncut");
    let less_than_a_turn = feed_of(vec![straight(0.5, 0.0, 2.0 * RIM)]);
    assert_feed_says(less_than_a_turn, "leaves some of the part uncut");
    let jump = vec![straight(100.0, RIM, -0.01), straight(90.0, 0.9, -0.01)];
    assert_feed_says(feed_of(jump), "a jump from ρ = 1 mm to 0.9 mm");
}

#[test]
fn a_law_must_end() {
    let onward = |rate: f64| {
        let piece = move |call: usize| straight(10.0, RIM - 10.0 * rate * call as f64, -rate);
        Feed(move |call| (vec![piece(call)], Continuation::More))
    };
    assert_feed_says(Arc::new(onward(0.01)), "lies far off the part");
    assert_feed_says(Arc::new(onward(0.0)), "not beyond the one before");
    let eternal = Feed(|_| (vec![straight(1e9, RIM, -1e-9)], Continuation::End));
    assert_feed_says(Arc::new(eternal), "more than 1e7 revolutions");
}

#[test]
fn a_law_of_too_many_short_pieces_is_refused() {
    let short_pieces = |call: usize| {
        let length = 1e-9;
        let start = RIM - 0.01 * length * 1e6 * call as f64;
        let piece = move |i: usize| straight(length, start - 0.01 * length * i as f64, -0.01);
        ((0..1_000_000).map(piece).collect(), Continuation::More)
    };
    assert_feed_says(Arc::new(Feed(short_pieces)), "pieces, after");
}

#[test]
fn a_solver_may_not_require_all_nodes() {
    let task = Task {
        velocity: Arc::new(Greedy),
        ..Task::default()
    };
    assert_says(
        &task,
        Slot::Velocity,
        "an overlap of 18446744073709551615 nodes; it must be below 10000",
    );
}

/// A feed that gives up at once, or after its first piece.
struct GivesUp {
    at_once: bool,
}

impl FeedStrategy for GivesUp {
    fn plan(&self, _: Setup<'_>) -> Result<Box<dyn FeedPlan>> {
        match self.at_once {
            true => Err(StrategyError::failed("no idea")),
            false => Ok(Box::new(OnePiece { begun: false })),
        }
    }
}

struct OnePiece {
    begun: bool,
}

impl FeedPlan for OnePiece {
    fn extend(&mut self, _: Setup<'_>, pieces: &mut Vec<FeedPiece>) -> Result<Continuation> {
        if self.begun {
            return Err(StrategyError::failed("no idea"));
        }
        self.begun = true;
        pieces.push(straight(12.5, RIM, -0.01));
        Ok(Continuation::More)
    }
}

#[test]
fn a_strategy_that_gives_up_is_named_with_what_it_was_doing() {
    for (at_once, expected) in [
        (true, "while planning the law"),
        (false, "after 12.500 revolutions"),
    ] {
        let task = Task {
            feed: Arc::new(GivesUp { at_once }),
            ..Task::default()
        };
        let Err(error) = task.run() else {
            panic!("a path");
        };
        let message = error.to_string();
        let named = format!("the feed strategy `mine` of a test failed {expected}: no idea");
        assert_eq!(message, named);
    }
}
