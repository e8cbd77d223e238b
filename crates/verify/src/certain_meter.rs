//! What is certain of a path, measured block by block: see [`CertainMotion`].

use turnpath_core::toolpath::{PathBlock, Section, Segment, SegmentShape};

use crate::certain_motion::{CertainMotion, OF_DOUBLES, Rounding};

#[cfg(test)]
mod tests;

/// How far, in last digits, a number may lie beside a whole number of them.
const OFF_DIGIT: f64 = 1e-2;

/// Whether X is no whole number of last digits, though it was said to be one.
fn is_off_digits(x: f64, rounding: &Rounding) -> bool {
    rounding.last_digit.is_some_and(|digit| {
        let number = x / digit;
        let held = rounding.part * number.abs();
        (number - number.round()).abs() > OFF_DIGIT + held + OF_DOUBLES * number.abs()
    })
}

/// What is certain of a block.
#[derive(Debug, Clone)]
pub struct CertainBlock {
    section: Section,
    motion: CertainMotion,
    /// Its first and its last segment, if they are straight.
    outer: Option<[Segment; 2]>,
    /// Whether it has more digits than it was said to have.
    has_more_digits: bool,
}

impl CertainBlock {
    /// What is certain of the segments between neighbouring points.
    pub fn of(section: Section, points: &PathBlock, rounding: &Rounding) -> Self {
        let mut block = Self {
            section,
            motion: CertainMotion::default(),
            outer: None,
            has_more_digits: points.x.iter().any(|x| is_off_digits(*x, rounding)),
        };
        for segment in points.segments() {
            match points.shape {
                SegmentShape::Cubic => block.motion.include_cubic(&segment, rounding),
                SegmentShape::Linear => block.follow_line(segment, rounding),
            }
        }
        block
    }

    /// Goes on with a straight segment.
    fn follow_line(&mut self, segment: Segment, rounding: &Rounding) {
        self.motion.include_line(&segment, rounding);
        let first = match &self.outer {
            Some([first, before]) => {
                self.motion.include_blend([before, &segment], rounding);
                *first
            }
            None => segment,
        };
        self.outer = Some([first, segment]);
    }
}

/// Measures what is certain of a path. Blocks can be measured in parallel, and are appended in their order.
#[derive(Debug, Clone, Default)]
pub struct CertainMeter {
    of_cut: Rounding,
    of_leads: Rounding,
    cut: CertainMotion,
    leads: CertainMotion,
    /// The last straight segment so far, and its section.
    last: Option<(Segment, Section)>,
    has_more_digits: bool,
}

impl CertainMeter {
    /// Nothing measured yet. Numbers of the cut and of leads may be rounded otherwise.
    pub fn new(of_cut: Rounding, of_leads: Rounding) -> Self {
        Self {
            of_cut,
            of_leads,
            cut: CertainMotion::default(),
            leads: CertainMotion::default(),
            last: None,
            has_more_digits: false,
        }
    }

    fn rounding(&self, section: Section) -> &Rounding {
        match section {
            Section::Cutting => &self.of_cut,
            Section::LeadIn | Section::LeadOut => &self.of_leads,
        }
    }

    /// Measures a block.
    pub fn measure(&self, section: Section, points: &PathBlock) -> CertainBlock {
        CertainBlock::of(section, points, self.rounding(section))
    }

    /// Appends the next block. The blend from a lead into the cut, or out of it, belongs to the lead.
    pub fn append(&mut self, next: &CertainBlock) {
        self.has_more_digits |= next.has_more_digits;
        if let Some([first, last]) = next.outer {
            if let Some((before, section)) = self.last {
                let of_blend = match next.section {
                    Section::Cutting => section,
                    lead => lead,
                };
                let rounding = *self.rounding(of_blend);
                self.of_section(of_blend)
                    .include_blend([&before, &first], &rounding);
            }
            self.last = Some((last, next.section));
        }
        self.of_section(next.section).append(&next.motion);
    }

    fn of_section(&mut self, section: Section) -> &mut CertainMotion {
        match section {
            Section::Cutting => &mut self.cut,
            Section::LeadIn | Section::LeadOut => &mut self.leads,
        }
    }

    /// What is certain of the cut; `None` if the path has more digits than it was said to have, since then nobody
    /// knows how it was rounded.
    pub fn cut(&self) -> Option<&CertainMotion> {
        (!self.has_more_digits).then_some(&self.cut)
    }

    /// The same of the leads.
    pub fn leads(&self) -> Option<&CertainMotion> {
        (!self.has_more_digits).then_some(&self.leads)
    }
}

impl CertainMotion {
    /// What is certain of the motion between neighbouring control points that are doubles.
    pub fn of(points: &PathBlock) -> Self {
        CertainBlock::of(Section::Cutting, points, &Rounding::default()).motion
    }
}
