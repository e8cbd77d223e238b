//! Coverage: the material that no pass has cut at the rim, at the hole and around the axis.
//!
//! The figure of an edge of the part is that of module `part_edge`.
//!
//! Around the axis the figure is the highest cusp on one line through the axis, between the passes
//! of θ and of θ + π together, where the two sides meet. A path that ends at the axis has these
//! passes in its last three turns, a path that runs on beyond the axis in five turns.

use std::collections::VecDeque;

use turnpath_core::toolpath::{Cubic, PathBlock};
use turnpath_core::{Result, Scalar};

use crate::part_edge::{PartEdge, UncutHeight};
use crate::residual::{Pass, Passes, ResidualFigures, SECTIONS, angle_of, highest};
use crate::touch::FirstTouch;

/// Sections of half a revolution.
const HALF_TURN: usize = SECTIONS as usize / 2;
/// Passes of a line, two per turn, that are kept up to the point where its two sides meet. A spiral
/// that ends at the axis has its widest gap between the second and the third pass of a line. A
/// spiral whose feed runs out at the axis has it somewhat further out. A search looks at as many passes
/// before each smallest sum. It looks at as many at the end of each block, since the path may end there.
const INNERMOST: usize = 6;
/// Passes of a line that are kept after that point, if the path goes on so far.
const BEYOND: usize = 4;
/// Passes of a line in a block from which it is known before which of them are kept. To look at fewer of them
/// twice takes longer than to keep each until the next ones come.
const MANY: usize = 2 * (INNERMOST + BEYOND);

/// The uncut heights that a path leaves, and how far it goes beyond the axis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CoverageFigures {
    /// At the rim of the aperture.
    pub rim: Option<UncutHeight>,
    /// At the hole; `None` on a part without a hole.
    pub hole: Option<UncutHeight>,
    /// Between the passes of the two sides of the axis; `None` on a part with a hole.
    pub centre: Option<UncutHeight>,
    /// How far X as played goes below 0, mm.
    pub x_beyond_axis: f64,
    /// How far the contact goes beyond the axis, mm.
    pub contact_beyond_axis: f64,
}

/// What stays uncut at the edges of the part, section by section, mm. Infinite where no pass reaches.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct EdgeHeights {
    /// At the rim, from C = 0 on.
    pub rim: Vec<f64>,
    /// At the hole; empty on a part without one.
    pub hole: Vec<f64>,
}

/// The coverage of a path so far. Its memory is bounded, however long the path is.
#[derive(Debug, Clone, Default)]
pub(crate) struct Coverage {
    rim: PartEdge,
    hole: PartEdge,
    around_axis: AxisPasses,
    x_beyond_axis: f64,
    contact_beyond_axis: f64,
}

impl Coverage {
    /// The coverage of one block. The passes around the axis are added by [`Self::append`].
    pub fn of(touch: &FirstTouch, points: &PathBlock, passes: &Passes) -> Result<Self> {
        let part = touch.subject().part;
        let hole = match part.inner_radius > 0.0 {
            true => PartEdge::of(touch, part.inner_radius, points, passes)?,
            false => PartEdge::default(),
        };
        let beyond = |least: f64, here: f64| least.max(-here);
        let played = points.segments().map(|segment| lowest(&segment.x));
        let contacts = passes.passes.iter().map(|pass| pass.foot);
        Ok(Self {
            rim: PartEdge::of(touch, part.aperture_radius, points, passes)?,
            hole,
            around_axis: AxisPasses::default(),
            x_beyond_axis: played.fold(0.0, beyond),
            contact_beyond_axis: contacts.fold(0.0, beyond),
        })
    }

    /// Appends the path's next block, which has these passes.
    pub fn append(&mut self, next: &Self, passes: &Passes) {
        self.rim.append(&next.rim);
        self.hole.append(&next.hole);
        self.x_beyond_axis = self.x_beyond_axis.max(next.x_beyond_axis);
        self.contact_beyond_axis = self.contact_beyond_axis.max(next.contact_beyond_axis);
        self.around_axis.append(passes);
    }

    /// The edges of the part on each section.
    pub fn edges(&self, touch: &FirstTouch) -> Result<EdgeHeights> {
        let heights = |edge: &PartEdge| -> Result<Vec<f64>> {
            let sections = edge.on_sections(touch)?;
            Ok(sections.iter().map(|section| section.height).collect())
        };
        let has_hole = touch.subject().part.inner_radius > 0.0;
        Ok(EdgeHeights {
            rim: heights(&self.rim)?,
            hole: match has_hole {
                true => heights(&self.hole)?,
                false => Vec::new(),
            },
        })
    }

    /// The coverage of the whole path, and the residual around the axis.
    pub fn figures(&self, touch: &FirstTouch) -> Result<(CoverageFigures, ResidualFigures)> {
        let mut figures = CoverageFigures {
            rim: Some(self.rim.uncut(touch)?),
            x_beyond_axis: self.x_beyond_axis,
            contact_beyond_axis: self.contact_beyond_axis,
            ..CoverageFigures::default()
        };
        if touch.subject().part.inner_radius > 0.0 {
            figures.hole = Some(self.hole.uncut(touch)?);
            return Ok((figures, ResidualFigures::default()));
        }
        let cusps = around_axis(touch, &self.around_axis)?;
        figures.centre = Some(UncutHeight {
            height: cusps.highest().unwrap_or(f64::INFINITY),
            at_theta: cusps.at_theta,
        });
        Ok((figures, cusps))
    }
}

/// The passes around the axis, on each line through it.
#[derive(Debug, Clone)]
struct AxisPasses {
    lines: Vec<AxisLine>,
}

impl Default for AxisPasses {
    fn default() -> Self {
        Self {
            lines: vec![AxisLine::default(); HALF_TURN],
        }
    }
}

impl AxisPasses {
    fn append(&mut self, next: &Passes) {
        match next.passes.len() < MANY * HALF_TURN {
            true => self.append_few(next),
            false => self.append_many(next),
        }
    }

    fn append_few(&mut self, next: &Passes) {
        for (pass, section) in next.passes.iter().zip(next.first..) {
            let line = &mut self.lines[line_of(section)];
            let mut search = line.search();
            search.include(0, pass.centre.x);
            line.least = search.least;
            line.push((is_far(section), *pass), search.at.is_some());
        }
    }

    fn append_many(&mut self, next: &Passes) {
        let begin = line_of(next.first);
        let mut searches: Vec<SumSearch> = self.lines.iter().map(AxisLine::search).collect();
        // Each pass lies on the line behind that of the pass before.
        for (turn, passes) in next.passes.chunks(HALF_TURN).enumerate() {
            let (second, first) = searches.split_at_mut(begin);
            for (search, pass) in first.iter_mut().chain(second).zip(passes) {
                search.include(turn, pass.centre.x);
            }
        }
        for (offset, section) in (0..next.passes.len().min(HALF_TURN)).zip(next.first..) {
            let line = line_of(section);
            let passes = LinePasses {
                all: &next.passes[offset..],
                section,
            };
            self.lines[line].append(&searches[line], &passes);
        }
    }
}

/// The line through the axis on which a section of the path lies.
fn line_of(section: i64) -> usize {
    section.rem_euclid(HALF_TURN as i64) as usize
}

/// Whether a section belongs to θ + π of its line.
fn is_far(section: i64) -> bool {
    section.rem_euclid(SECTIONS) as usize >= HALF_TURN
}

/// The passes of a block on one line.
struct LinePasses<'a> {
    /// Passes of the block on all lines, from the first one on this line on.
    all: &'a [Pass],
    /// The section of that pass.
    section: i64,
}

impl LinePasses<'_> {
    fn count(&self) -> usize {
        self.all.len().div_ceil(HALF_TURN)
    }

    /// A pass, and whether it belongs to θ + π.
    fn get(&self, number: usize) -> Option<(bool, Pass)> {
        let sections_before = number * HALF_TURN;
        let pass = self.all.get(sections_before)?;
        Some((is_far(self.section + sections_before as i64), *pass))
    }
}

/// The search for the smallest sum among the passes of a line.
struct SumSearch {
    /// X of the pass before, mm; infinite before the first one.
    before: f64,
    /// Smallest |sum| so far, mm.
    least: f64,
    /// Which pass of the block has it; `None` if it lies before the block.
    at: Option<usize>,
}

impl SumSearch {
    fn include(&mut self, number: usize, x: f64) {
        let sum = (self.before + x).abs();
        if sum < self.least {
            (self.least, self.at) = (sum, Some(number));
        }
        self.before = x;
    }
}

/// The passes of one line where its two sides meet: where two passes that follow each other in
/// time, one on each side, have X that add up to 0. A tilt does not change this sum, nor does it
/// matter whether ρ is that of the centre or that of the contact. Where X moves within the turn,
/// the sides of each line meet in a turn of their own.
#[derive(Debug, Clone)]
struct AxisLine {
    /// The last passes that were looked at, those of five turns at most, each with whether it belongs to
    /// θ + π.
    recent: VecDeque<(bool, Pass)>,
    /// Smallest |sum| so far, mm.
    least: f64,
    /// The passes around the smallest sum, as soon as all of them have come.
    meeting: Vec<(bool, Pass)>,
    /// Number of passes still to come until `meeting` is taken. It begins anew at each smaller sum.
    missing: usize,
}

impl Default for AxisLine {
    fn default() -> Self {
        Self {
            recent: VecDeque::new(),
            least: f64::INFINITY,
            meeting: Vec::new(),
            missing: BEYOND,
        }
    }
}

impl AxisLine {
    /// The search that goes on from here.
    fn search(&self) -> SumSearch {
        let last = self.recent.back();
        SumSearch {
            before: last.map_or(f64::INFINITY, |(_, last)| last.centre.x),
            least: self.least,
            at: None,
        }
    }

    /// Appends the passes of a block, which were searched. Only those are looked at that a meeting may have:
    /// those after a smallest sum before the block, those around the smallest sum of the block, and the last
    /// ones.
    fn append(&mut self, search: &SumSearch, passes: &LinePasses<'_>) {
        self.least = search.least;
        let around = search.at.map_or(0..0, |at| {
            (at + 1).saturating_sub(INNERMOST)..at + 1 + BEYOND
        });
        let last = passes.count().saturating_sub(INNERMOST)..passes.count();
        let mut next = 0;
        for range in [0..BEYOND, around, last] {
            for number in range.start.max(next)..range.end {
                let Some(pass) = passes.get(number) else {
                    return;
                };
                self.push(pass, search.at == Some(number));
            }
            next = next.max(range.end);
        }
    }

    /// Adds a pass; `is_least` says whether its sum is the smallest of all.
    fn push(&mut self, pass: (bool, Pass), is_least: bool) {
        if self.recent.len() == INNERMOST + BEYOND {
            self.recent.pop_front();
        }
        self.recent.push_back(pass);
        if is_least {
            self.missing = BEYOND;
        } else if self.missing > 0 {
            self.missing -= 1;
            if self.missing == 0 {
                self.meeting.clear();
                self.meeting.extend(&self.recent);
            }
        }
    }

    /// The passes where the two sides meet, if the path ends here.
    fn meeting(&self) -> Vec<(bool, Pass)> {
        let older = self.recent.len().saturating_sub(INNERMOST);
        match self.missing > 0 {
            true => self.recent.iter().skip(older).copied().collect(),
            false => self.meeting.clone(),
        }
    }
}

/// The highest cusp between neighbours on every line through the axis; infinite where a line has
/// passes on one side of the axis only.
fn around_axis(touch: &FirstTouch, passes: &AxisPasses) -> Result<ResidualFigures> {
    let mut lines: Vec<Vec<Pass>> = vec![Vec::new(); HALF_TURN];
    let mut sides = [[false; 2]; HALF_TURN];
    for ((line, sides), of_line) in lines.iter_mut().zip(&mut sides).zip(&passes.lines) {
        for (far, pass) in of_line.meeting() {
            sides[usize::from(far)] = true;
            line.push(if far { pass.mirrored() } else { pass });
        }
    }
    if let Some(open) = sides.iter().position(|sides| *sides != [true; 2]) {
        return Ok(ResidualFigures {
            max: f64::INFINITY,
            at_theta: angle_of(open as i64),
            at_rho: 0.0,
            cusps: 1,
        });
    }
    let (mut theta, mut cusps) = (Vec::new(), Vec::new());
    for (line, passes) in (0..).zip(&mut lines) {
        passes.sort_by(|a, b| a.foot.total_cmp(&b.foot));
        for pair in passes.windows(2).filter(|p| p[0].centre != p[1].centre) {
            theta.push(angle_of(line));
            cusps.push(pair[0].cusp(&pair[1], &touch.subject().tool));
        }
    }
    highest(touch, &theta, &cusps)
}

/// The lowest value of a cubic on 0 … 1.
pub(crate) fn lowest(cubic: &Cubic) -> f64 {
    let [_, b, c, d] = cubic.0;
    // The slope b + 2cs + 3ds² is zero at q/(3d) and b/q.
    let root = Scalar::sqrt(c * c - 3.0 * b * d);
    let q = -(c + root.copysign(c));
    let turning = [q / (3.0 * d), b / q];
    let inside = turning.into_iter().filter(|s| (0.0..1.0).contains(s));
    inside
        .chain([0.0, 1.0])
        .map(|s| cubic.value(s))
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use std::ops::Range;

    use super::*;

    #[test]
    fn the_lowest_value_of_a_cubic_is_that_of_a_fine_table() {
        for coefficients in [
            [1.0, -2.0, 3.0, 0.0],
            [0.5, 1.0, -4.0, 3.5],
            [0.0, 0.3, 0.0, 0.0],
            [0.2, -1.0, 0.0, 1.0],
            [1.0, 0.0, 0.0, 0.0],
            [1.0, 0.0, -3.0, 2.5],
        ] {
            let cubic = Cubic(coefficients);
            let table = (0..=10_000).map(|i| cubic.value(f64::from(i) * 1e-4));
            let found = lowest(&cubic);
            let least = table.fold(f64::INFINITY, f64::min);
            assert!((found - least).abs() < 1e-7 && found <= least + 1e-15);
        }
    }

    fn pass(x: f64) -> Pass {
        let mut pass = Pass::default();
        pass.centre.x = x;
        pass
    }

    /// The numbers of the passes where the two sides meet, found among all passes after the fact.
    fn meeting_among(x: &[f64]) -> Range<usize> {
        let mut least = f64::INFINITY;
        let mut around = 0..BEYOND;
        for (i, pair) in (1..).zip(x.windows(2)) {
            let sum = (pair[0] + pair[1]).abs();
            if sum < least {
                least = sum;
                around = (i + 1_usize).saturating_sub(INNERMOST)..i + 1 + BEYOND;
            }
        }
        match around.end <= x.len() {
            true => around,
            false => x.len().saturating_sub(INNERMOST)..x.len(),
        }
    }

    #[test]
    fn the_passes_of_a_meeting_are_those_around_the_smallest_sum_wherever_a_path_ends() {
        let nan = f64::NAN;
        let paths: [&[f64]; 6] = [
            &[9.0, -8.0, 7.0, -6.0, 5.0, -4.0, 3.0, -2.0, 1.0, 0.0],
            &[3.0, -2.0, 1.5, -1.5, 0.2, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0],
            // A smaller sum comes while one pass is missing.
            &[3.0, -2.5, 4.0, 5.0, 6.0, -6.0, 1.0, 9.0, 8.0, 7.0, 6.0, 5.0],
            &[nan, nan, nan, nan, nan, nan, nan],
            &[nan, nan, nan, nan, nan, 1.0, -1.0, nan, nan, nan, nan, 3.0],
            &[1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0],
        ];
        for path in paths {
            for block in [90, 180, 613, 1620, 4000] {
                assert_meetings(path, block);
            }
        }
        // In blocks of many passes: the sum falls to a smallest one, and falls a little more while passes
        // behind it are missing.
        let falling: Vec<f64> = (0..60).map(|turn| 18.3 - f64::from(turn)).collect();
        let with = |others: [(usize, f64); 2]| {
            let mut path = vec![5.0; 60];
            for (place, x) in others {
                path[place] = x;
            }
            path
        };
        let (far, near) = (with([(8, -4.5), (20, -4.9)]), with([(8, -4.5), (22, -4.9)]));
        for path in [falling, far, near, vec![nan; 60]] {
            for block in [180, 3600, 3780] {
                assert_meetings(&path, block);
            }
        }
        // As a path inward: the sums fall over many turns, and rise behind the axis. Some blocks end just
        // behind the smallest sum.
        let long: Vec<f64> = (0..70).map(|turn| 50.3 - f64::from(turn)).collect();
        for block in [180, 1000, 2777, 3600, 4000, 9180, 9360, 9540, 100_000] {
            assert_meetings(&long, block);
        }
    }

    /// Every line through the axis has the passes of `path`. They come in blocks of so many passes.
    #[track_caller]
    fn assert_meetings(path: &[f64], block: usize) {
        const FIRST: usize = 777;
        let all = (0..path.len() * HALF_TURN).map(|i| pass(path[i / HALF_TURN]));
        let all: Vec<Pass> = all.collect();
        let mut axis = AxisPasses::default();
        let mut count = 0;
        for passes in all.chunks(block) {
            axis.append(&Passes {
                first: (FIRST + count) as i64,
                passes: passes.to_vec(),
            });
            count += passes.len();
            for offset in 0..HALF_TURN {
                let on_line = count.saturating_sub(offset).div_ceil(HALF_TURN);
                let found = axis.lines[(FIRST + offset) % HALF_TURN].meeting();
                let found = found
                    .iter()
                    .map(|(far, pass)| (*far, pass.centre.x.to_bits()));
                let expected = meeting_among(&path[..on_line]).map(|i| {
                    let half_turns = (FIRST + offset) / HALF_TURN + i;
                    (half_turns % 2 == 1, path[i].to_bits())
                });
                assert!(found.eq(expected), "{path:?}: {count} in blocks of {block}");
            }
        }
    }
}
