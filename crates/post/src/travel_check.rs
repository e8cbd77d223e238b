//! Checks the moves before and after a path, as they stand in a program's text: nothing moves beside the
//! part but Z, each move goes as the recipe says, and the approach ends where the path begins.

use turnpath_core::DEG;
use turnpath_core::toolpath::ControlPoint;

use crate::axes::NAMES;
use crate::fixed_point::ONE;
use crate::program_format::ProgramFormat;
use crate::travel::{C, Motion, Places, Speed, TravelModes, X, Z};

/// By how much a place of the approach and one of the path may differ, mm or deg: doubles have more
/// digits than any program.
const SAME: f64 = 1e-9;
/// By how much a feed or a time may differ from the recipe's, as a part of it: rounding alone.
const SAME_SPEED: f64 = 1e-9;
/// The part of the recipe's approach height that a program must keep. A path whose heights somebody has
/// changed a little is still read and measured, and a hundredth of a few millimetres is no danger.
const KEPT_HEIGHT: f64 = 0.99;
/// Milliseconds of a minute.
const MINUTE_MS: f64 = 60_000.0;

/// What is known of the moves around a path.
#[derive(Debug, Default)]
pub(crate) struct TravelCheck {
    /// The modes of the section that is read.
    pub(crate) modes: TravelModes,
    /// Where the axes are, in 10⁻¹² mm or deg; `None` before they were told.
    at: Places,
    /// The lowest Z at which X or C moved, and its line.
    lowest: Option<(i128, u64)>,
    /// The lowest Z to which Z went by a rapid move, and its line.
    lowest_rapid: Option<(i128, u64)>,
    /// The lowest Z to which Z went by a feed, and its line.
    lowest_fed: Option<(i128, u64)>,
    /// How far above the path X, C and rapid moves of Z stay, mm.
    clearance: f64,
    /// The line of the mark of a retreat, until Z has gone up behind it.
    unfinished_retreat: Option<u64>,
    /// Z of the path's first point, mm.
    begin: Option<f64>,
    /// The highest Z of the path's points, mm.
    highest: Option<f64>,
    /// How far above the path the first of its depths is, mm.
    rise: f64,
    /// Whether the program has an approach: its mark was read.
    approached: bool,
    /// Whether the path has a lead-in: its mark was read.
    leads_in: bool,
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

    /// Begins the approach: behind its mark the path begins where these moves end.
    pub(crate) fn begin_approach(&mut self) {
        self.approached = true;
    }

    /// Begins the lead-in.
    pub(crate) fn begin_lead_in(&mut self) {
        self.leads_in = true;
    }

    /// Takes the places that a line gives. Only one axis may move, Z must have moved first, and each move is a
    /// rapid one but that of Z down to the path.
    pub(crate) fn go_to(
        &mut self,
        places: &Places,
        line: u64,
        format: &ProgramFormat,
    ) -> Result<(), String> {
        let moved: Vec<usize> = (0..3).filter(|k| places[*k].is_some()).collect();
        let [axis] = moved[..] else {
            return match moved.is_empty() {
                true => Ok(()),
                false => Err("more than one axis moves outside the path".to_owned()),
            };
        };
        self.check_speed(axis, places[axis], format)?;
        match (axis, self.at[Z]) {
            (Z, _) => {
                self.unfinished_retreat = None;
                let lowest = match self.modes.motion {
                    Some(Motion::Fed) => &mut self.lowest_fed,
                    Some(Motion::Rapid) | None => &mut self.lowest_rapid,
                };
                lower(lowest, places[Z], line);
            }
            (axis, None) => return Err(format!("{} moves before Z has gone up", NAMES[axis])),
            (_, z) => lower(&mut self.lowest, z, line),
        }
        self.at[axis] = places[axis];
        Ok(())
    }

    /// Holds a move against what the recipe says of it.
    fn check_speed(
        &self,
        axis: usize,
        to: Option<i128>,
        format: &ProgramFormat,
    ) -> Result<(), String> {
        let name = NAMES[axis];
        let motion = self.modes.motion;
        let motion = motion.ok_or("nothing says whether this move is a rapid one")?;
        let way = self.at[Z].zip(to).map(|(from, to)| from - to);
        let way = way.filter(|way| axis == Z && *way > 0 && !self.retreats);
        match (motion, way) {
            (Motion::Rapid, _) => Ok(()),
            (Motion::Fed, None) => Err(format!(
                "{name} goes by a feed: only Z does, on its way down to the path"
            )),
            (Motion::Fed, Some(way)) => {
                let speed = self.modes.speed;
                let speed = speed.ok_or("Z goes down by a feed that nothing says")?;
                let expected = format.approach_feed;
                let way = way as f64 / ONE as f64;
                if is_feed(speed, way, expected) {
                    return Ok(());
                }
                let said = match speed {
                    Speed::Feed(feed) => format!("{feed} mm/min"),
                    Speed::Milliseconds(ms) => format!("{way} mm in {ms} ms"),
                };
                Err(format!(
                    "Z goes down at {said}; `approach_feed` of the recipe is {expected} mm/min"
                ))
            }
        }
    }

    /// Takes a point of the path. The first one must be where the approach ends, if there is one.
    pub(crate) fn pass(
        &mut self,
        point: &ControlPoint,
        format: &ProgramFormat,
    ) -> Result<(), String> {
        let z = point.z - format.z_above;
        if self.highest.is_none() && self.modes.blends && !self.retreats {
            return Err("the approach does not come to rest before the path".to_owned());
        }
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
        if self.begin.is_none() {
            self.begin = Some(z);
            self.rise = format.rise() as f64 / 10u64.pow(format.position_decimals) as f64;
            self.clearance = format.approach_height;
        }
        self.highest = Some(self.highest.map_or(z, |highest| highest.max(z)));
        Ok(())
    }

    /// Checks, at the end of a path, that one whose approach was read does not end in the part.
    pub(crate) fn check_retreat(&self, ends_at_rest: bool) -> Result<(), String> {
        match self.approached && ends_at_rest && !self.retreats {
            true => Err("there is an approach and no retreat".to_owned()),
            false => Ok(()),
        }
    }

    /// Begins the retreat: the axes are where the path ends, so Z may move at once, and nothing else.
    /// `line` is that of its mark.
    ///
    /// # Errors
    /// When the approach is missing that stands before a path with a lead-in and a retreat.
    pub(crate) fn begin_retreat(&mut self, line: u64) -> Result<(), String> {
        if self.leads_in && !self.approached {
            return Err(
                "the program has a retreat and no approach: the moves before its path are missing"
                    .to_owned(),
            );
        }
        self.modes = TravelModes::default();
        self.at = Places::default();
        self.retreats = true;
        self.unfinished_retreat = Some(line);
        Ok(())
    }

    /// Checks the heights, at the end of the path: the line of the first wrong move, and what is wrong.
    pub(crate) fn finish(&self) -> Result<(), (u64, String)> {
        if let Some(line) = self.unfinished_retreat {
            return Err((line, "Z does not go up behind the path".to_owned()));
        }
        if let Some(begin) = self.begin {
            refuse_below(begin, self.lowest_fed, "Z goes down to", || {
                format!("the path begins at {begin:.4} mm, and nothing before it goes lower")
            })?;
        }
        let Some(highest) = self.highest else {
            return Ok(());
        };
        let plane = highest + self.rise + self.clearance;
        let least = plane - (1.0 - KEPT_HEIGHT) * self.clearance;
        let sideways = format!("{} or {} moves at", NAMES[C], NAMES[X]);
        for (lowest, what) in [
            (self.lowest, sideways.as_str()),
            (self.lowest_rapid, "a rapid move goes to"),
        ] {
            refuse_below(least, lowest, what, || {
                format!("by `approach_height` of the recipe the plane is at Z = {plane:.4} mm")
            })?;
        }
        Ok(())
    }
}

/// Keeps the lower of two places, each with its line.
fn lower(lowest: &mut Option<(i128, u64)>, place: Option<i128>, line: u64) {
    if let Some(z) = place {
        let here = (z, line);
        *lowest = Some(lowest.map_or(here, |lowest| lowest.min(here)));
    }
}

/// Refuses a place below `least`, mm: its line, and why.
fn refuse_below(
    least: f64,
    lowest: Option<(i128, u64)>,
    what: &str,
    why: impl Fn() -> String,
) -> Result<(), (u64, String)> {
    let lowest = lowest.map(|(lowest, line)| (lowest as f64 / ONE as f64, line));
    match lowest.filter(|(lowest, _)| *lowest < least - SAME * (1.0 + least.abs())) {
        None => Ok(()),
        Some((lowest, line)) => Err((line, format!("{what} Z = {lowest} mm; {}", why()))),
    }
}

/// Whether Z goes a way at this feed. A time is a whole number of milliseconds, rounded up.
fn is_feed(speed: Speed, way: f64, feed: f64) -> bool {
    match speed {
        Speed::Feed(said) => (said - feed).abs() <= SAME_SPEED * feed,
        Speed::Milliseconds(said) => {
            let exact = way / feed * MINUTE_MS;
            let most = (exact + 1.0).max(1.0) * (1.0 + SAME_SPEED);
            (exact * (1.0 - SAME_SPEED)..=most).contains(&said)
        }
    }
}
