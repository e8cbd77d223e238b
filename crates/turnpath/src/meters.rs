//! Measuring a path that is read from a file: its cut, its leads, and what stands out.

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;
use turnpath_core::StrategyError;
use turnpath_core::toolpath::{PathBlock, Section, SegmentShape};
use turnpath_pipeline::Observer;
use turnpath_post::ReadPath;
use turnpath_recipe::Recipe;
use turnpath_report::Overrun;
use turnpath_verify::{
    AnomalyDetector, BlockFigures, CertainBlock, CertainMeter, FirstTouch, LeadBlockFigures,
    LeadMeter, Meter, ProgramBlockFigures, ProgramMeter, Rounding, ServoBlockFigures, ServoMeter,
    ServoStart, in_order,
};

use crate::diagnosis::of_measure;
use crate::error::Error;
use crate::figures::form_scope;
use crate::read_blocks::ReadBlocks;
use crate::segment_rate::SegmentRate;
use crate::speed_steps::SpeedSteps;

/// Blocks that are read at a time, at the most, while those before are measured.
const BLOCKS: usize = 16;
/// Blocks of these for each thread. Fewer take less memory, and are measured while they are in the cache.
const BLOCKS_A_THREAD: usize = 4;

/// What measures a path that is read in blocks.
pub trait Meters: Sync {
    /// What must be known of the path before a block, in the order of the blocks.
    type Start: Send;
    /// The figures of a block.
    type Block: Send;

    /// Goes on over the next block.
    fn advance(&mut self, points: &PathBlock) -> Self::Start;

    /// Measures a block; blocks are measured in parallel.
    fn measure(
        &self,
        section: Section,
        points: PathBlock,
        start: Self::Start,
    ) -> Result<Self::Block, StrategyError>;

    /// Appends the figures of the next block.
    fn append(&mut self, block: Self::Block) -> Result<(), StrategyError>;
}

/// What measures a path.
pub struct PathMeters {
    /// Its cutting section.
    pub cut: Meter,
    /// Its leads.
    pub lead: LeadMeter,
    /// What the servos make of it, where that is asked.
    pub servo: Option<ServoMeter>,
    /// What is certain of the motion of the axes, where the recipe has limits.
    pub certain: Option<CertainMeter>,
    /// Control points that stand out among their neighbours, where that may be asked.
    pub anomalies: Option<AnomalyDetector>,
}

impl PathMeters {
    /// Nothing measured yet.
    pub fn new(recipe: &Recipe, touch: FirstTouch) -> Self {
        let counts_centre = Overrun::from(recipe.overrun).covers_centre();
        Self {
            cut: Meter::new(touch)
                .counting_centre(counts_centre)
                .with_form(form_scope(recipe)),
            lead: LeadMeter::default(),
            servo: None,
            certain: None,
            anomalies: None,
        }
    }

    /// The same with the servos that the recipe asks for.
    pub fn with_servo(mut self, recipe: &Recipe) -> Self {
        self.servo = recipe.servo.as_ref().map(ServoMeter::new);
        self
    }

    /// The same with what is certain of the motion of the axes, if the recipe has limits. The numbers of the cut and
    /// of the leads are rounded so.
    pub fn with_certain(mut self, recipe: &Recipe, [of_cut, of_leads]: [Rounding; 2]) -> Self {
        let has_limits = recipe.machine.has_limits();
        self.certain = has_limits.then(|| CertainMeter::new(of_cut, of_leads));
        self
    }

    /// The same with the control points that stand out: a file may have no path of a recipe to be
    /// compared with, and is not read twice for that.
    pub fn with_anomalies(mut self, recipe: &Recipe) -> Self {
        let (tolerance, rim) = (recipe.tolerance.interpolation, recipe.part.aperture_radius);
        self.anomalies = Some(AnomalyDetector::new(tolerance, rim));
        self
    }

    fn look_for_anomalies(&mut self, points: &PathBlock, heights: &[f64]) {
        if let Some(detector) = &mut self.anomalies {
            detector.append(points, heights);
        }
    }
}

impl Meters for PathMeters {
    type Start = Option<ServoStart>;
    type Block = MeasuredBlock;

    fn advance(&mut self, points: &PathBlock) -> Option<ServoStart> {
        self.servo.as_mut().map(|servo| servo.advance(points))
    }

    fn measure(
        &self,
        section: Section,
        points: PathBlock,
        start: Option<ServoStart>,
    ) -> Result<MeasuredBlock, StrategyError> {
        let certain = self.certain.as_ref();
        Ok(MeasuredBlock {
            certain: certain.map(|meter| meter.measure(section, &points)),
            of_section: SectionFigures::new(self.cut.touch(), section, points, start)?,
        })
    }

    fn append(&mut self, block: MeasuredBlock) -> Result<(), StrategyError> {
        if let (Some(meter), Some(certain)) = (&mut self.certain, &block.certain) {
            meter.append(certain);
        }
        match block.of_section {
            SectionFigures::Cut(cut) => {
                let CutBlock {
                    figures,
                    servo,
                    points,
                } = *cut;
                self.lead.append_cut(&points);
                self.look_for_anomalies(&points, &figures.per_point);
                if let (Some(meter), Some(block)) = (&mut self.servo, servo) {
                    meter.append(&block);
                }
                self.cut.append(figures)
            }
            SectionFigures::Lead(lead) => {
                let (figures, points) = *lead;
                self.look_for_anomalies(&points, &[]);
                self.lead.append(&figures);
                Ok(())
            }
        }
    }
}

/// What measures a motion program on its own text: the figures that digits and times can change, and what
/// straight lines can change where they stand for cubics.
pub struct ProgramMeters {
    /// Its cutting section.
    pub cut: ProgramMeter,
    /// Its leads.
    pub lead: LeadMeter,
    /// How many of its segments the controller has to read in a second.
    pub rate: SegmentRate,
    /// The steps of the speed of C, where the controller keeps it within a segment.
    pub speed_steps: Option<SpeedSteps>,
    /// What the servos make of it, where that is asked.
    pub servo: Option<ServoMeter>,
    /// Whether a block was begun.
    has_begun: bool,
}

impl ProgramMeters {
    /// Nothing measured yet.
    pub fn new(recipe: &Recipe, touch: FirstTouch) -> Self {
        Self {
            cut: ProgramMeter::new(touch, form_scope(recipe)),
            lead: LeadMeter::default(),
            rate: SegmentRate::default(),
            speed_steps: None,
            servo: None,
            has_begun: false,
        }
    }

    /// The same with the servos, if the recipe holds them to a tolerance.
    pub fn with_servo(mut self, recipe: &Recipe) -> Self {
        let is_held = recipe.tolerances.servo.is_some();
        let servo = recipe.servo.as_ref().filter(|_| is_held);
        self.servo = servo.map(ServoMeter::new);
        self
    }

    /// The same with the steps of the speed of C, if the controller keeps it within a segment.
    pub fn with_speed_steps(mut self, c_is_even: bool) -> Self {
        self.speed_steps = c_is_even.then(SpeedSteps::default);
        self
    }

    /// The same with what the passes leave, for a program whose passes are not those of its path.
    pub fn with_passes(mut self, recipe: &Recipe) -> Self {
        let counts_centre = Overrun::from(recipe.overrun).covers_centre();
        self.cut = self.cut.measuring_passes(counts_centre);
        self
    }
}

/// The figures of a block of a program.
pub enum ProgramBlock {
    /// Of the cut, with what the servos make of it.
    Cut(Box<(ProgramBlockFigures, Option<ServoBlockFigures>)>),
    /// Of a lead.
    Lead(Box<LeadBlockFigures>),
}

impl Meters for ProgramMeters {
    type Start = Option<ServoStart>;
    type Block = ProgramBlock;

    fn advance(&mut self, points: &PathBlock) -> Option<ServoStart> {
        // A block begins with the last point of the one before.
        let known = usize::from(std::mem::replace(&mut self.has_begun, true));
        for point in points.points().skip(known) {
            self.rate.pass(&point);
            if let Some(steps) = &mut self.speed_steps {
                steps.pass(&point);
            }
        }
        self.servo.as_mut().map(|servo| servo.advance(points))
    }

    fn measure(
        &self,
        section: Section,
        points: PathBlock,
        start: Option<ServoStart>,
    ) -> Result<ProgramBlock, StrategyError> {
        let touch = self.cut.touch();
        Ok(match section {
            Section::Cutting => {
                let servo = start.map(|start| ServoMeter::measure(touch, &start, &points));
                let figures = self.cut.measure(&points)?;
                ProgramBlock::Cut(Box::new((figures, servo.transpose()?)))
            }
            Section::LeadIn | Section::LeadOut => {
                let figures = LeadMeter::measure(touch, &points)?;
                ProgramBlock::Lead(Box::new(figures))
            }
        })
    }

    fn append(&mut self, block: ProgramBlock) -> Result<(), StrategyError> {
        match block {
            ProgramBlock::Cut(cut) => {
                let (figures, servo) = *cut;
                if let (Some(meter), Some(block)) = (&mut self.servo, &servo) {
                    meter.append(block);
                }
                self.cut.append(figures)
            }
            ProgramBlock::Lead(figures) => {
                self.lead.append(&figures);
                Ok(())
            }
        }
    }
}

/// A block of a path with its figures.
pub struct MeasuredBlock {
    /// What is certain of its motion, where that is asked.
    certain: Option<CertainBlock>,
    of_section: SectionFigures,
}

/// What was measured on a block of the cut, or of a lead.
enum SectionFigures {
    Cut(Box<CutBlock>),
    Lead(Box<(LeadBlockFigures, PathBlock)>),
}

struct CutBlock {
    figures: BlockFigures,
    servo: Option<ServoBlockFigures>,
    points: PathBlock,
}

impl SectionFigures {
    fn new(
        touch: &FirstTouch,
        section: Section,
        points: PathBlock,
        start: Option<ServoStart>,
    ) -> Result<Self, StrategyError> {
        Ok(match section {
            Section::Cutting => {
                let servo = start.map(|start| ServoMeter::measure(touch, &start, &points));
                let figures = Meter::measure(touch, &points)?;
                let servo = servo.transpose()?;
                Self::Cut(Box::new(CutBlock {
                    figures,
                    servo,
                    points,
                }))
            }
            Section::LeadIn | Section::LeadOut => {
                let figures = LeadMeter::measure(touch, &points)?;
                Self::Lead(Box::new((figures, points)))
            }
        })
    }
}

/// Reads a path and measures it, in blocks, in parallel. While blocks are measured, the next one is read, and more until
/// they are measured.
pub fn measure<M: Meters>(
    recipe: &Recipe,
    mut meters: M,
    shape: SegmentShape,
    reader: &mut (dyn ReadPath + Send),
    observer: &dyn Observer,
) -> Result<M, Error> {
    let failed = |error: StrategyError| of_measure(recipe, error);
    let most = BLOCKS.min(BLOCKS_A_THREAD * rayon::current_num_threads());
    // The first block is read alone, so that measuring begins early.
    let mut next = ReadBlocks::read(reader, shape, most, || true);
    loop {
        if observer.is_cancelled() {
            return Err(Error::Cancelled);
        }
        let ReadBlocks { blocks, failure } = next;
        if blocks.is_empty() {
            return failure.map_or(Ok(meters), Err);
        }
        let count = blocks.len() as u64;
        let starts: Vec<M::Start> = blocks
            .iter()
            .map(|(_, block)| meters.advance(block))
            .collect();
        let (of_block, are_measured) = (&meters, AtomicBool::new(false));
        let measure_all = || -> Result<Vec<M::Block>, StrategyError> {
            let each = blocks.into_par_iter().zip(starts).with_max_len(1);
            let measured = in_order(
                each.map(|((section, block), start)| of_block.measure(section, block, start)),
            );
            are_measured.store(true, Ordering::Relaxed);
            measured
        };
        let read = || match failure {
            None => {
                let is_enough = || are_measured.load(Ordering::Relaxed);
                ReadBlocks::read(reader, shape, most, is_enough)
            }
            failure => ReadBlocks {
                blocks: Vec::new(),
                failure,
            },
        };
        let measured;
        (measured, next) = rayon::join(measure_all, read);
        for block in measured.map_err(failed)? {
            meters.append(block).map_err(failed)?;
        }
        observer.advance(count);
    }
}

#[cfg(test)]
mod tests {
    use turnpath_core::toolpath::ControlPoint;
    use turnpath_pipeline::SilentObserver;
    use turnpath_post::{ReadCount, ReadError};

    use super::*;

    /// Meters that count blocks, and fail at one of them.
    struct Count {
        begun: usize,
        measured: usize,
        fails_at: usize,
    }

    impl Meters for Count {
        type Start = usize;
        type Block = ();

        fn advance(&mut self, _: &PathBlock) -> usize {
            self.begun += 1;
            self.begun
        }

        fn measure(&self, _: Section, _: PathBlock, start: usize) -> Result<(), StrategyError> {
            match start == self.fails_at {
                true => Err(StrategyError::failed("no height")),
                false => Ok(()),
            }
        }

        fn append(&mut self, (): ()) -> Result<(), StrategyError> {
            self.measured += 1;
            Ok(())
        }
    }

    /// So many blocks, behind which the file is damaged.
    struct Damaged(usize, ReadCount);

    impl ReadPath for Damaged {
        fn next_point(&mut self) -> Result<Option<(ControlPoint, Section)>, ReadError> {
            Ok(None)
        }

        fn next_block(&mut self, _: usize) -> Result<Option<(Section, PathBlock)>, ReadError> {
            let left = self.0.checked_sub(1).ok_or_else(|| ReadError::File {
                path: "path.csv".into(),
                error: std::io::Error::other("damaged"),
            })?;
            self.0 = left;
            Ok(Some((Section::Cutting, PathBlock::default())))
        }

        fn read_count(&self) -> &ReadCount {
            &self.1
        }

        fn read_count_mut(&mut self) -> &mut ReadCount {
            &mut self.1
        }
    }

    /// What is said of a file with seven blocks before its damage, where meters fail at one of its blocks.
    fn said(fails_at: usize) -> String {
        let text = include_str!("../../../docs/recipes/astigmatic-5mm.toml");
        let recipe = Recipe::parse(text, "recipe.toml", &[]).unwrap();
        let meters = Count {
            begun: 0,
            measured: 0,
            fails_at,
        };
        let mut reader = Damaged(7, ReadCount::default());
        let measured = measure(
            &recipe,
            meters,
            SegmentShape::Cubic,
            &mut reader,
            &SilentObserver,
        );
        match measured {
            Ok(meters) => format!("{} blocks", meters.measured),
            Err(error) => format!("{error:?}"),
        }
    }

    #[test]
    fn what_is_wrong_with_a_block_is_told_before_damage_behind_it() {
        for threads in [1, 4] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.unwrap().install(|| {
                for block in 1..=7 {
                    assert!(said(block).contains("no height"), "{}", said(block));
                }
                assert!(said(8).contains("damaged"), "{}", said(8));
            });
        }
    }
}
