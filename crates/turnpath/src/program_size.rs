//! How large a program will be or is, and whether the controller takes it.

use turnpath_core::toolpath::{Section, SectionBlock};
use turnpath_pipeline::{Estimate, PathSample, SampledBlock};
use turnpath_post::{Amount, PartLimits, PartName, ProgramError, TextSize, text_name};

use crate::posts::NotCarried;
use crate::program::Program;
use crate::sampled_stretches::{SampledStretch, sampled_stretches};
use crate::segment_rate::SegmentRate;

/// What a program will take.
#[derive(Debug, Clone, Copy)]
pub struct SampledSize {
    /// All of its text.
    pub size: TextSize,
    /// The parts that it calls; `None` for one file.
    pub parts: Option<u64>,
}

impl Program {
    /// What the program will take, from a sample of its path: within some percent. What the controller
    /// does not take is refused as a run refuses it, but for the rests of steps at the borders of a run's own
    /// blocks, which a sample does not have.
    pub fn sampled_size(&self, sample: &PathSample) -> Result<SampledSize, NotCarried> {
        let stretches =
            sampled_stretches(sample, |block| Ok(TextSize::of(&self.lines(block)?.text)))?;
        let of_path = |what: fn(TextSize) -> u64| {
            let each = stretches.iter();
            each.map(|lines| lines.of_path(what(lines.measured)))
                .sum::<f64>() as u64
        };
        let lines = TextSize {
            bytes: of_path(|size| size.bytes),
            blocks: of_path(|size| size.blocks),
        };
        let size = lines.and(self.frame_size());
        for block in &sample.blocks {
            let rate = self.sampled_rate(block)?;
            self.carried(rate.within(self.segments_per_second))?;
        }
        self.refuse_large(size)?;
        let limits = self.limits_of(size);
        let parts = limits.map(|limits| limits.part.parts_of(size));
        let most = self.layout.format.part_numbers.most();
        if parts.is_some_and(|parts| parts > u64::from(most)) {
            return self.carried(Err(ProgramError::ManyParts { most }));
        }
        if let Some((limits, parts)) = limits.zip(parts) {
            self.refuse_large_parts(&limits, parts, &stretches)?;
        }
        Ok(SampledSize { size, parts })
    }

    /// A rough estimate of the bytes that the program will take, to see whether a disk has room.
    pub fn expected_bytes(&self, radius: f64, expected: &Estimate) -> f64 {
        let c = std::f64::consts::TAU * expected.revolutions;
        let (time, points) = (expected.cutting_time, expected.control_points);
        self.layout.expected_bytes(radius, time, c, points)
    }

    /// How many segments of a sampled block the controller has to read in a second.
    fn sampled_rate(&self, block: &SampledBlock) -> Result<SegmentRate, NotCarried> {
        let stretch = SectionBlock {
            section: Section::Cutting,
            opens_section: false,
            before: &[],
            points: &block.points,
        };
        let mut rate = SegmentRate::default();
        let carried = self.carried(self.layout.carried(&stretch))?;
        carried.points.points().for_each(|point| rate.pass(&point));
        rate.extrapolate(block.stands_for, block.without_border);
        Ok(rate)
    }

    /// Refuses a program of this size in one file that is larger than the controller's memory. The files of
    /// a program of parts are judged as they are written.
    pub fn refuse_large(&self, size: TextSize) -> Result<(), NotCarried> {
        let limits = PartLimits {
            part: Amount::Bytes(size.bytes),
            memory: self.memory,
        };
        match self.limits_of(size) {
            None => self.carried(limits.refuse_large(text_name(&self.file), size)),
            Some(_) => Ok(()),
        }
    }

    /// Refuses a program of parts whose files are larger than the controller's memory: by the densest of these
    /// blocks, and by the calls of the main program.
    fn refuse_large_parts(
        &self,
        limits: &PartLimits,
        parts: u64,
        sampled: &[SampledStretch<TextSize>],
    ) -> Result<(), NotCarried> {
        let parts = u32::try_from(parts).unwrap_or(u32::MAX);
        let around = self.layout.size_around_parts(&self.file, parts);
        let Some([around, calls]) = around else {
            return Ok(());
        };
        let file = text_name(&self.file);
        let of = |wanted: Section| {
            let wanted = sampled.iter().filter(move |one| one.section == wanted);
            wanted
                .map(|one| one.measured)
                .filter(|lines| lines.blocks > 0)
        };
        // The first part begins with the lead-in; a lead-out may be cut anywhere.
        let cuts = || of(Section::Cutting);
        let with_leads = cuts().flat_map(|cut| of(Section::LeadIn).map(move |lead| (lead, cut)));
        let with_leads = with_leads.map(|(lead, cut)| lead_and_cut(lead, cut, limits.part));
        for lines in cuts().chain(with_leads) {
            let largest = limits.largest_part(lines, around);
            let part = PartName::of(file, parts, &self.layout.format.part_numbers);
            self.carried(limits.refuse_large(&part.file, largest))?;
        }
        self.carried(limits.refuse_large(file, self.frame_size().and(calls)))
    }

    /// The size of header and footer as templates.
    fn frame_size(&self) -> TextSize {
        let bytes = self.header.len() + self.footer.len();
        TextSize {
            bytes: bytes as u64,
            blocks: 0,
        }
    }

    /// The limits of the files of a program of this size that calls parts; `None` if it is one file.
    pub fn limits_of(&self, size: TextSize) -> Option<PartLimits> {
        let part = self.split.filter(|most| !most.holds(size))?;
        Some(PartLimits {
            part,
            memory: self.memory,
        })
    }
}

/// The lines of a lead, and behind them so many lines of the cut that they fill a part.
fn lead_and_cut(lead: TextSize, cut: TextSize, part: Amount) -> TextSize {
    let rest = |own: u64, room: u64, of: u64, by: u64| {
        let rest = room.saturating_sub(own) as f64;
        (rest * of as f64 / by.max(1) as f64).ceil() as u64
    };
    match part {
        Amount::Bytes(room) => TextSize {
            bytes: lead.bytes.max(room),
            blocks: lead.blocks + rest(lead.bytes, room, cut.blocks, cut.bytes),
        },
        Amount::Blocks(room) => TextSize {
            bytes: lead.bytes + rest(lead.blocks, room, cut.bytes, cut.blocks),
            blocks: lead.blocks.max(room),
        },
    }
}
