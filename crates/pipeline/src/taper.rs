//! The taper: at both ends of a law the feed runs out, so that the spiral closes.
//!
//! Without a taper the last pass lies up to a feed inside of the end of the spiral, and at the axis
//! up to 1.5 feeds lie between the passes of both sides. A law that runs out from its feed f to rest
//! over n turns, ρ(m) = f n (s³ − s⁴/2) with s = m/n, has its passes within ρ(1) of its end at
//! every angle.

use turnpath_core::{Direction, Piece, SpiralLaw, Task, quintic};

/// Turns n over which the feed runs out. ρ(1) is then 0.38 feeds, so that 0.6 of a cusp stays at a
/// rim, and 0.45 feeds lie between the passes of both sides of the axis. The taper costs n/2 turns;
/// n = 1 would leave a whole cusp at the rim.
const TURNS: f64 = 1.25;
/// A law closes by itself where its outermost passes lie no further inside of the range's end than
/// this part of the distance to the next pass. A law that follows the angle until every angle has
/// passed the rim does so. It gets no taper, since a taper turns the rest of the law by a part of a
/// turn.
pub const LARGEST_END_GAP: f64 = 0.41;
/// A law that moves at its end by less than this part of its pitch a turn is at rest there.
const REST: f64 = 0.01;
/// Turns for which a law that begins at rest stays there before it begins: a whole turn, so that every
/// part of the law keeps its angle. A law that follows the angle leaves the residual at its own angles
/// alone.
const HOLD_BEFORE: f64 = 1.0;
/// Turns for which a law that ends at rest stays there. With the C² end of the turn before, the passes
/// lie within 0.32 feeds of the end.
const HOLD_AFTER: f64 = 0.6;
/// A law of fewer turns has no room for a taper at either end.
const SHORT: f64 = 2.0;
/// Fewest turns of the law that replaces so short a law. Within its first and its last turn it moves
/// by a fifth of its whole distance, which is 0.42 feeds at the most.
const AROUND: f64 = 3.0;
/// The largest rate of a quintic from rest to rest, as a multiple of its mean rate.
const FASTEST: f64 = 1.875;
/// Least part of its mean rate that is used as a short law's slowest rate. A law that rests somewhere
/// would otherwise take for ever.
const SLOWEST: f64 = 0.25;
/// Angles of a turn at which passes are compared with the end.
const ANGLES: usize = 72;
/// Halvings of the interval in which the taper begins: down to rounding.
const HALVINGS: usize = 60;

/// The law that is cut, and the part of it that is the feed strategy's own.
#[derive(Debug, Clone)]
pub struct CutLaw {
    /// The whole law.
    pub law: SpiralLaw,
    /// Between which revolutions it is the strategy's; `None` where another law replaced that one.
    pub own: Option<[f64; 2]>,
}

impl CutLaw {
    /// A law as its strategy planned it.
    pub fn without_taper(law: SpiralLaw) -> Self {
        let own = Some([0.0, law.end()]);
        Self { law, own }
    }
}

/// The law, with a feed that runs out at those ends that do not close by themselves.
pub fn taper(law: &SpiralLaw, task: &Task) -> CutLaw {
    if law.end() < SHORT {
        let law = replacement(law);
        return CutLaw { law, own: None };
    }
    let (start, end) = (End::of(law, task, false), End::of(law, task, true));
    let mut pieces = Vec::new();
    let mut at = 0.0;
    let mut put = |length: f64, coefficients: [f64; 6]| {
        pieces.push(Piece {
            start: at,
            coefficients,
        });
        at += length;
    };
    let (from, to) = (start.replaced(), law.end() - end.replaced());
    let (start, end) = (start.piece(law), end.piece(law));
    if let Some((length, coefficients)) = start {
        put(length, coefficients);
    }
    for (i, piece) in law.pieces().iter().enumerate() {
        let next = law.pieces().get(i + 1).map_or(law.end(), |next| next.start);
        let (first, last) = (piece.start.max(from), next.min(to));
        if first < last {
            put(last - first, piece.shifted(first));
        }
    }
    if let Some((length, coefficients)) = end {
        put(length, coefficients);
    }
    let length = |piece: Option<(f64, [f64; 6])>| piece.map_or(0.0, |piece| piece.0);
    CutLaw {
        law: SpiralLaw::from_pieces(pieces, at),
        own: Some([length(start), at - length(end)]),
    }
}

/// The law that replaces one too short to reach its ends at every angle. It goes from rest to rest,
/// nowhere faster than the short law was where it was slowest.
fn replacement(law: &SpiralLaw) -> SpiralLaw {
    let (from, to) = (law.value(0.0), law.value(law.end()));
    let mean = (to - from).abs() / law.end();
    if !mean.is_normal() {
        return law.clone();
    }
    let rate = |i: usize| law.rate(law.end() * i as f64 / ANGLES as f64).abs();
    let slowest = (0..=ANGLES).map(rate).fold(mean, f64::min);
    let gentle = FASTEST * law.end() * mean / slowest.max(SLOWEST * mean);
    let turns = gentle.max(AROUND);
    let mut replacement = SpiralLaw::new();
    replacement.push(turns, quintic([from, 0.0, 0.0], [to, 0.0, 0.0], turns));
    replacement
}

/// What the host does to one end of a law.
#[derive(Debug, Clone, Copy, PartialEq)]
enum EndTreatment {
    /// Nothing: the end closes by itself.
    None,
    /// The law stays where it begins or ends, for [`HOLD_BEFORE`] or [`HOLD_AFTER`] turns.
    Hold,
    /// The feed runs out, from so many turns before the end on.
    Taper(f64),
}

/// One end of a law.
#[derive(Debug, Clone, Copy)]
struct End {
    last: bool,
    treatment: EndTreatment,
}

impl End {
    fn of(law: &SpiralLaw, task: &Task, last: bool) -> Self {
        let side = EndView { law, last };
        let outer = last == (task.direction == Direction::Outward);
        let inside = |rho: f64| match outer {
            true => task.range.outer - rho,
            false => rho - task.range.inner,
        };
        Self {
            last,
            treatment: side.treatment(inside),
        }
    }

    /// Turns of the law that the taper replaces.
    fn replaced(&self) -> f64 {
        match self.treatment {
            EndTreatment::Taper(turns) => turns,
            EndTreatment::None | EndTreatment::Hold => 0.0,
        }
    }

    /// The piece that closes this end, with its length.
    fn piece(&self, law: &SpiralLaw) -> Option<(f64, [f64; 6])> {
        let side = EndView {
            law,
            last: self.last,
        };
        match self.treatment {
            EndTreatment::None => None,
            EndTreatment::Hold => Some((side.hold(), [side.rho(0.0), 0.0, 0.0, 0.0, 0.0, 0.0])),
            EndTreatment::Taper(turns) => Some((TURNS, side.run_out(turns))),
        }
    }
}

/// A law seen from one of its ends: m turns away from it.
#[derive(Clone, Copy)]
struct EndView<'a> {
    law: &'a SpiralLaw,
    last: bool,
}

impl EndView<'_> {
    fn at(&self, m: f64) -> f64 {
        if self.last { self.law.end() - m } else { m }
    }

    /// Turns for which the law stays at this end.
    fn hold(&self) -> f64 {
        match self.last {
            true => HOLD_AFTER,
            false => HOLD_BEFORE,
        }
    }

    fn rho(&self, m: f64) -> f64 {
        self.law.value(self.at(m))
    }

    /// |dρ/dN|.
    fn speed(&self, m: f64) -> f64 {
        self.law.rate(self.at(m)).abs()
    }

    /// What the host does here; `inside` gives how far a pass lies inside of the range's end.
    fn treatment(&self, inside: impl Fn(f64) -> f64) -> EndTreatment {
        // Both ends have half of the law to themselves.
        let half = 0.5 * self.law.end();
        let pitch = (self.rho(1.0) - self.rho(0.0)).abs();
        let closes = |m: f64| {
            let next = (self.rho(m + 1.0) - self.rho(m)).abs();
            inside(self.rho(m)) <= LARGEST_END_GAP * next
        };
        let closed = (0..ANGLES).all(|i| closes(i as f64 / ANGLES as f64));
        if closed || !pitch.is_normal() {
            EndTreatment::None
        } else if self.speed(0.0) <= REST * pitch {
            EndTreatment::Hold
        } else {
            self.taper_begins(half)
                .map_or(EndTreatment::None, EndTreatment::Taper)
        }
    }

    /// The m at which the distance to the end is what the feed there needs to run out: half its
    /// speed for [`TURNS`] turns.
    fn taper_begins(&self, half: f64) -> Option<f64> {
        let left = |m: f64| (self.rho(m) - self.rho(0.0)).abs() - 0.5 * TURNS * self.speed(m);
        let (mut low, mut high) = (0.0, half.min(2.0 * TURNS));
        if left(high) < 0.0 {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if left(middle) < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(high)
    }

    /// The quintic between rest at the end and the law at m, in the order of N.
    fn run_out(&self, m: f64) -> [f64; 6] {
        let series = self.law.series(self.at(m));
        let moving = [series[0], series[1], 2.0 * series[2]];
        let resting = [self.rho(0.0), 0.0, 0.0];
        match self.last {
            true => quintic(moving, resting, TURNS),
            false => quintic(resting, moving, TURNS),
        }
    }
}

#[cfg(test)]
mod tests {
    use turnpath_core::{Machine, Misfit, Part, RadialRange, Tolerance, Tool};

    use super::*;

    /// From 1 mm outward by 0.1 mm a turn, faster with time, in two pieces.
    fn law() -> SpiralLaw {
        let mut law = SpiralLaw::new();
        law.push(6.0, [1.0, 0.1, 1e-3, 0.0, 0.0, 0.0]);
        law.push(4.5, [1.636, 0.112, 1e-3, 0.0, 0.0, 0.0]);
        law
    }

    /// The same law backwards.
    fn inward() -> SpiralLaw {
        let law = law();
        let mut back = SpiralLaw::new();
        let [c0, c1, c2, ..] = law.series(law.end());
        back.push(law.end(), [c0, -c1, c2, 0.0, 0.0, 0.0]);
        back
    }

    /// The task whose range the law runs over.
    fn task(law: &SpiralLaw) -> Task {
        let (start, end) = (law.value(0.0), law.value(law.end()));
        let (direction, inner, outer) = match start < end {
            true => (Direction::Outward, start, end),
            false => (Direction::Inward, end, start),
        };
        Task {
            part: Part {
                aperture_radius: outer,
                inner_radius: inner,
            },
            tool: Tool {
                nose_radius: 1.0,
                included_angle: None,
                clearance_angle: None,
                misfit: Misfit::Refuse,
            },
            tolerance: Tolerance {
                interpolation: 1e-4,
                residual: 1e-4,
            },
            range: RadialRange { inner, outer },
            direction,
            machine: Machine::default(),
            spindle_speed: 52.0,
        }
    }

    #[test]
    fn both_ends_keep_their_values_and_come_to_rest() {
        for law in [law(), inward()] {
            let CutLaw { law: tapered, own } = taper(&law, &task(&law));
            assert_eq!(own, Some([TURNS, tapered.end() - TURNS]));
            for (n, whole) in [(0.0, 0.0), (tapered.end(), law.end())] {
                let [value, rate, second, ..] = tapered.series_before(n);
                assert!((value - law.value(whole)).abs() < 1e-13);
                assert!(
                    rate.abs() < 1e-13 && second.abs() < 1e-12,
                    "{rate} {second}"
                );
            }
            let more = tapered.end() - law.end();
            assert!((1.2..1.35).contains(&more), "{more} turns more");
        }
    }

    #[test]
    fn value_and_two_derivatives_are_continuous() {
        let tapered = taper(&law(), &task(&law())).law;
        let knots: Vec<f64> = tapered.knots(0.0, tapered.end()).collect();
        assert_eq!(knots.len(), 3);
        for knot in knots {
            let (before, after) = (tapered.series_before(knot), tapered.series(knot));
            for k in 0..3 {
                assert!((before[k] - after[k]).abs() < 1e-12, "{before:?} {after:?}");
            }
        }
    }

    #[test]
    fn passes_close_at_rim_and_axis() {
        for law in [law(), inward()] {
            let tapered = taper(&law, &task(&law)).law;
            for last in [false, true] {
                let side = EndView {
                    law: &tapered,
                    last,
                };
                let feed = EndView { law: &law, last }.speed(0.5);
                let away = |m: f64| (side.rho(m) - side.rho(0.0)).abs();
                for i in 0..72 {
                    let m = f64::from(i) / 72.0;
                    assert!(away(m) < 0.42 * feed, "{m}: {}", away(m) / feed);
                    let across = away(0.5 * m) + away(0.5 * m + 0.5);
                    assert!(across < 0.55 * feed, "{m}: {}", across / feed);
                    // Every turn lies beyond the one before, by no more than the feed.
                    let step = away(m + 1.0) - away(m);
                    assert!(step > 0.0 && step < 1.05 * feed, "{m}: {}", step / feed);
                }
            }
        }
    }

    #[test]
    fn a_law_at_rest_at_its_start_is_held_for_a_whole_turn() {
        let mut law = SpiralLaw::new();
        law.push(1.0, quintic([1.0, 0.0, 0.0], [1.1, 0.1, 0.0], 1.0));
        law.push(9.0, [1.1, 0.1, 0.0, 0.0, 0.0, 0.0]);
        let CutLaw { law: held, own } = taper(&law, &task(&law));
        assert_eq!(own, Some([1.0, held.end() - TURNS]));
        assert_eq!(held.value(1.0), 1.0);
        assert!((held.value(4.0) - law.value(3.0)).abs() < 1e-15);
    }

    #[test]
    fn a_law_at_rest_at_its_end_is_held_there_until_its_passes_close() {
        let mut law = SpiralLaw::new();
        law.push(9.0, [1.0, 0.1, 0.0, 0.0, 0.0, 0.0]);
        law.push(1.0, quintic([1.9, 0.1, 0.0], [2.0, 0.0, 0.0], 1.0));
        let CutLaw { law: held, own } = taper(&law, &task(&law));
        assert_eq!(own, Some([TURNS, held.end() - HOLD_AFTER]));
        let last_turn = (0..ANGLES).map(|i| held.end() - i as f64 / ANGLES as f64);
        for n in last_turn {
            assert!(2.0 - held.value(n) < 0.032, "{n}");
        }
    }

    /// A law that follows the angle goes on until its slowest angle has passed the rim.
    #[test]
    fn an_end_that_lies_beyond_the_range_at_every_angle_is_left_alone() {
        let law = law();
        let mut task = task(&law);
        task.range.outer = law.value(law.end() - 1.0);
        assert_eq!(End::of(&law, &task, true).treatment, EndTreatment::None);
        task.range.outer = law.value(law.end() - 0.5);
        assert_ne!(End::of(&law, &task, true).treatment, EndTreatment::None);
    }

    #[test]
    fn a_law_that_closes_by_itself_is_left_alone() {
        let mut law = SpiralLaw::new();
        law.push(1.0, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        law.push(1.0, quintic([1.0, 0.0, 0.0], [1.1, 0.1, 0.0], 1.0));
        law.push(7.0, [1.1, 0.1, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(
            End::of(&law, &task(&law), false).treatment,
            EndTreatment::None
        );
    }

    #[test]
    fn a_short_law_reaches_both_ends_at_every_angle_no_faster_than_before() {
        for (turns, pieces) in [
            (1.9, [1.0, 0.1, 0.002]),
            (1.5, [1.0, 0.1, 0.02]),
            (0.3, [2.0, -0.1, 0.05]),
        ] {
            let [start, rate, bend] = pieces;
            let mut short = SpiralLaw::new();
            short.push(turns, [start, rate, bend, 0.0, 0.0, 0.0]);
            let slowest = short.rate(0.0).abs().min(short.rate(turns).abs());
            let round = taper(&short, &task(&short)).law;
            let end = round.end();
            let (from, to) = (short.value(0.0), short.value(turns));
            for i in 0..=100 {
                let n = f64::from(i) / 100.0;
                let away = [round.value(n) - from, round.value(end - n) - to];
                assert!(away.iter().all(|away| away.abs() < 0.42 * slowest));
                assert!(round.rate(n * end).abs() <= 1.0001 * slowest);
            }
            for (n, rho) in [(0.0, from), (end, to)] {
                let [value, rate, bend, ..] = round.series_before(n);
                assert!((value - rho).abs() < 1e-15 && rate.abs() + bend.abs() < 1e-13);
            }
        }
    }
}
