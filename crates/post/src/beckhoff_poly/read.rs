//! Reads the blocks of a path. This follows the manual's description of polynomials of axes, and shares
//! nothing with the writer.

use turnpath_core::toolpath::ControlPoint;

use super::block::{Block, Polynomial, feed_axes};
use crate::axes::{NAMES, times};
use crate::fixed_point::ONE;
use crate::g_code::split_comment;
use crate::polynomial::{Cubic, CubicAxes};
use crate::post::Grammar;
use crate::program_format::{ProgramFormat, TimeAxis};

/// µm/s in 10⁻¹² mm/min.
const SPEED: i128 = 60 * ONE / 1000;
/// 10⁻¹² mm that an axis goes in a second at 1 µm/s.
const WAY: i128 = ONE / 1000;

/// The blocks of a program, in their order.
pub(super) struct PolyGrammar {
    format: ProgramFormat,
    /// The axes, once the first block said where they stand.
    axes: Option<CubicAxes>,
    modes: Modes,
    /// Where the axis of time stands, in steps.
    time: Option<i64>,
}

/// What the program has said. A controller begins with what the program before has left.
#[derive(Default)]
struct Modes {
    /// `G71`: lengths are in mm.
    metric: bool,
    /// `G90`: positions.
    absolute: bool,
    /// `G40`: no tool's radius is compensated.
    uncompensated: bool,
    /// `G52`: X is a radius.
    radius: bool,
    /// `G359`: the path is not stopped at the ends of blocks.
    goes_on: bool,
    /// What F says.
    feed: Option<Feed>,
    /// F under `G94`, in 10⁻¹² mm/min.
    speed: Option<i128>,
    motion: Option<Motion>,
    /// The axis to which F refers is that of time.
    time_is_path: bool,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Feed {
    /// `G93`: seconds.
    Seconds,
    /// `G94`: mm/min.
    PerMinute,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Motion {
    /// `G0`.
    Rapid,
    /// `G1`.
    Straight,
}

impl PolyGrammar {
    pub(super) fn new(format: &ProgramFormat) -> Self {
        Self {
            format: *format,
            axes: None,
            modes: Modes::default(),
            time: None,
        }
    }

    /// The line to the first point.
    fn straight(&mut self, block: &Block) -> Result<(), String> {
        let is_timed = self.modes.feed == Some(Feed::Seconds) && block.feed.is_some_and(|f| f > 0);
        if self.axes.is_some() {
            return Err("a straight line within the path of polynomials".to_owned());
        }
        if !is_timed || self.modes.motion != Some(Motion::Straight) {
            return Err("the line to the first point is not one of `G1`, `G93` and F".to_owned());
        }
        let missing = block.places.iter().position(Option::is_none);
        if let Some(k) = missing {
            return Err(format!("the first point does not give {}", NAMES[k]));
        }
        let position = block.places.map(Option::unwrap_or_default);
        self.axes = Some(CubicAxes::new(&self.format, position));
        Ok(())
    }

    /// The steps of the block that ends with the axis of time at `place`.
    fn steps_to(&mut self, place: i128, axis: TimeAxis) -> Result<i64, String> {
        let name = axis.name;
        let to = steps_at(place, axis, self.format.steps_per_s);
        let to = to.ok_or_else(|| format!("{name} goes farther than in any path"))?;
        let from = self.time.replace(to);
        let from = from.ok_or_else(|| format!("no `G0 {name}` before the first polynomial"))?;
        let steps = to.checked_sub(from).unwrap_or_default();
        if (1..=self.format.longest).contains(&steps) {
            return Ok(steps);
        }
        let range = times(self.format.steps_per_s, self.format.longest, "s");
        Err(format!(
            "{name} does not go on by the time of a segment, which is {range}"
        ))
    }

    /// Whether the block's speed is that of the axis of time, and of no other.
    fn check_speed(&self, axis: TimeAxis) -> Result<(), String> {
        let modes = &self.modes;
        let name = axis.name;
        if !modes.time_is_path {
            return Err(format!("a polynomial before `#FGROUP [{name}]`"));
        }
        if modes.feed != Some(Feed::PerMinute) || modes.motion != Some(Motion::Straight) {
            return Err("a polynomial before `G94` and `G1`".to_owned());
        }
        let expected = i128::from(axis.speed_um_per_s) * SPEED;
        match modes.speed {
            None => Err("a polynomial before F".to_owned()),
            Some(speed) if speed == expected => Ok(()),
            Some(_) => Err(format!(
                "F is not {} mm/min, the speed of {name} that the recipe says",
                expected as f64 / ONE as f64
            )),
        }
    }

    fn play(
        &mut self,
        found: [Option<Polynomial>; 3],
        steps: i64,
        points: &mut Vec<ControlPoint>,
    ) -> Result<(), String> {
        let axes = self.axes.as_mut();
        let axes = axes.ok_or("a polynomial before the first point")?;
        let position = axes.position();
        let mut cubics = position.map(|to| Cubic {
            to,
            begin: 0,
            end: 0,
        });
        // An axis without a polynomial stays where it is.
        for (k, polynomial) in found.into_iter().enumerate() {
            let Some([start, linear, square, cube]) = polynomial else {
                continue;
            };
            if start != position[k] {
                return Err(format!(
                    "the polynomial of {} does not begin where the one before ends",
                    NAMES[k]
                ));
            }
            // Numbers have 15 digits before the point at the most, so these sums are far from the end of
            // 128 bits.
            cubics[k] = Cubic {
                to: start + linear + square + cube,
                begin: linear,
                end: linear + 2 * square + 3 * cube,
            };
        }
        axes.play(cubics, steps, points)
    }

    fn take_modes(&mut self, block: &Block) -> Result<(), String> {
        let modes = &mut self.modes;
        for mode in &block.modes {
            match mode {
                0 => modes.motion = Some(Motion::Rapid),
                1 => modes.motion = Some(Motion::Straight),
                71 => modes.metric = true,
                90 => modes.absolute = true,
                // F of the other meaning does not count any more.
                93 => (modes.feed, modes.speed) = (Some(Feed::Seconds), None),
                94 => (modes.feed, modes.speed) = (Some(Feed::PerMinute), None),
                40 => modes.uncompensated = true,
                52 => modes.radius = true,
                359 => modes.goes_on = true,
                other => return Err(super::block::not_a_word(&format!("G{other}"))),
            }
        }
        if modes.feed == Some(Feed::PerMinute) {
            modes.speed = block.feed.or(modes.speed);
        }
        Ok(())
    }

    fn go(&mut self, block: &Block, points: &mut Vec<ControlPoint>) -> Result<(), String> {
        let Some(axis) = self.format.time_axis else {
            return Err("this layout has no axis of time".to_owned());
        };
        let modes = &self.modes;
        let needed = [
            (modes.metric, "G71"),
            (modes.absolute, "G90"),
            (modes.uncompensated, "G40"),
            (modes.radius, "G52"),
            (modes.goes_on, "G359"),
        ];
        if let Some((_, word)) = needed.iter().find(|(is_said, _)| !is_said) {
            return Err(format!("a move before `{word}`"));
        }
        match (block.time, block.has_places(), block.has_polynomials()) {
            (None, true, false) => self.straight(block),
            (None, _, true) => Err(format!(
                "polynomials without a way of {}: the controller plays none without an axis that moves",
                axis.name
            )),
            (Some(place), false, false) if self.modes.motion == Some(Motion::Rapid) => {
                if self.axes.as_ref().is_some_and(|axes| !axes.holds_point()) {
                    return Err("`G0` ends the path of polynomials".to_owned());
                }
                let steps = steps_at(place, axis, self.format.steps_per_s);
                self.time = Some(steps.ok_or("this is far from the beginning of a path")?);
                Ok(())
            }
            (Some(place), false, _) => {
                self.check_speed(axis)?;
                let steps = self.steps_to(place, axis)?;
                self.play(block.polynomials, steps, points)
            }
            _ => {
                Err("this block is neither a straight line to the path nor polynomials".to_owned())
            }
        }
    }
}

impl Grammar for PolyGrammar {
    fn split_comment<'a>(&self, line: &'a [u8]) -> (&'a [u8], Option<&'a [u8]>) {
        split_comment(line)
    }

    fn read(&mut self, code: &str, points: &mut Vec<ControlPoint>) -> Result<(), String> {
        let name = self.format.time_axis.map_or('W', |axis| axis.name);
        if let Some(axes) = feed_axes(code) {
            self.modes.time_is_path = axes == name.to_string();
            return match self.modes.time_is_path || axes.is_empty() {
                true => Ok(()),
                false => Err(format!("F refers to {axes}, and not to {name} alone")),
            };
        }
        let block = Block::read(code, name)?;
        self.take_modes(&block)?;
        match block.time.is_some() || block.has_places() || block.has_polynomials() {
            true => self.go(&block, points),
            false => Ok(()),
        }
    }

    fn holds_point(&self) -> bool {
        self.axes.as_ref().is_some_and(CubicAxes::holds_point)
    }

    fn finish(&mut self) -> Option<ControlPoint> {
        self.axes.as_mut().and_then(CubicAxes::finish)
    }
}

/// The steps that the axis of time needs to a place, in 10⁻¹² mm; `None` beyond any path.
fn steps_at(place: i128, axis: TimeAxis, steps_per_s: i64) -> Option<i64> {
    let per_s = i128::from(axis.speed_um_per_s) * WAY;
    let steps = place.checked_mul(i128::from(steps_per_s))?;
    i64::try_from((2 * steps + per_s).div_euclid(2 * per_s)).ok()
}
