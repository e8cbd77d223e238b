//! Checks the moves before and after a path, as they stand in a program's text: nothing moves beside the
//! part but Z, and the approach ends where the path begins.

use turnpath_core::DEG;
use turnpath_core::toolpath::ControlPoint;

use crate::axes::NAMES;
use crate::fixed_point::ONE;
use crate::program_format::ProgramFormat;
use crate::travel::{C, Places, TravelModes, Z};

/// By how much a place of the approach and one of the path may differ, mm or deg: doubles have more
/// digits than any program.
const SAME: f64 = 1e-9;

/// What is known of the moves around a path.
#[derive(Debug, Default)]
pub(crate) struct TravelCheck {
    /// The modes of the section that is read.
    pub(crate) modes: TravelModes,
    /// Where the axes are, in 10⁻¹² mm or deg; `None` before they were told.
    at: Places,
    /// The lowest Z at which X or C moved, and its line.
    lowest: Option<(i128, u64)>,
    /// The highest Z of the path's points, mm.
    highest: Option<f64>,
    /// How far above the path the first of its depths is, mm.
    rise: f64,
    /// Whether an approach was read.
    approached: bool,
    /// Whether the path is over.
    retreats: bool,
}

impl TravelCheck {
    /// A check of moves alone, none of which goes below `height`, mm.
    pub(crate) fn above(height: f64) -> Self {
        Self {
            highest: Some(height),
            retreats: true,
            ..Self::default()
        }
    }

    /// Takes the places that a line gives. Only one axis may move, and Z must have moved first.
    pub(crate) fn go_to(&mut self, places: &Places, line: u64) -> Result<(), String> {
        let moved: Vec<usize> = (0..3).filter(|k| places[*k].is_some()).collect();
        let [axis] = moved[..] else {
            return match moved.is_empty() {
                true => Ok(()),
                false => Err("more than one axis moves outside the path".to_owned()),
            };
        };
        match (axis, self.at[Z]) {
            (Z, _) => self.refuse_down(places[Z])?,
            (axis, None) => return Err(format!("{} moves before Z has gone up", NAMES[axis])),
            (_, Some(z)) => {
                let here = (z, line);
                self.lowest = Some(self.lowest.map_or(here, |lowest| lowest.min(here)));
            }
        }
        self.at[axis] = places[axis];
        self.approached |= !self.retreats;
        Ok(())
    }

    /// Takes a point of the path. The first one must be where the approach ends, if there is one.
    pub(crate) fn pass(
        &mut self,
        point: &ControlPoint,
        format: &ProgramFormat,
    ) -> Result<(), String> {
        let z = point.z - format.z_above;
        if self.highest.is_none() && self.approached {
            let begin = [format.c_sign() * point.c / DEG, point.x, z];
            for (axis, begin) in begin.into_iter().enumerate() {
                let end = self.at[axis].map(|place| place as f64 / ONE as f64);
                if end.is_none_or(|end| (end - begin).abs() > SAME * (1.0 + begin.abs())) {
                    let name = NAMES[axis];
                    return Err(format!(
                        "the approach does not end at the path's first {name}"
                    ));
                }
            }
        }
        self.highest = Some(self.highest.map_or(z, |highest| highest.max(z)));
        self.rise = format.rise() as f64 / 10u64.pow(format.position_decimals) as f64;
        Ok(())
    }

    /// Begins the retreat: the axes are where the path ends, so Z may move at once, and nothing else.
    pub(crate) fn begin_retreat(&mut self) {
        self.modes = TravelModes::default();
        self.at = Places::default();
        self.retreats = true;
    }

    /// The retreat goes nowhere below the path.
    fn refuse_down(&self, to: Option<i128>) -> Result<(), String> {
        let to = to.map(|to| to as f64 / ONE as f64);
        let below = |highest: f64| to.is_some_and(|to| to < highest + self.rise - SAME);
        match self.retreats && self.highest.is_some_and(below) {
            true => Err("Z goes below the highest place of the path".to_owned()),
            false => Ok(()),
        }
    }

    /// Checks the heights, at the end of the path: the line of the first wrong move, and what is wrong.
    pub(crate) fn finish(&self) -> Result<(), (u64, String)> {
        let (Some((lowest, line)), Some(highest)) = (self.lowest, self.highest) else {
            return Ok(());
        };
        let highest = highest + self.rise;
        let lowest = lowest as f64 / ONE as f64;
        if lowest >= highest - SAME {
            return Ok(());
        }
        let axes = format!("{} or {}", NAMES[C], NAMES[1]);
        Err((
            line,
            format!(
                "{axes} moves at Z = {lowest} mm, below the highest place of the path, {highest} mm"
            ),
        ))
    }
}
