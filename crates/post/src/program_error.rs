//! The errors of a path that a program cannot carry.

use turnpath_core::{ParamDefault, ParamInfo};

/// Why a program cannot carry a path, and where.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ProgramError {
    /// A segment is shorter than the controller's time step.
    #[error(
        "the segment that ends at {t:.6} s, C = {c_deg:.3} deg takes less than the \
         controller's time step"
    )]
    Short {
        /// The time of its end, s.
        t: f64,
        /// C at its end, deg.
        c_deg: f64,
    },
    /// A segment is shorter than the shortest one that the recipe says the controller plays.
    #[error(
        "the segment that ends at {t:.6} s, C = {c_deg:.3} deg takes {ms:.4} ms, and \
         shortest_segment = {shortest_ms:.4} ms"
    )]
    ShorterThanSaid {
        /// The time of its end, s.
        t: f64,
        /// C at its end, deg.
        c_deg: f64,
        /// Its time, ms.
        ms: f64,
        /// The shortest time, ms.
        shortest_ms: f64,
    },
    /// A value has more digits than doubles hold.
    #[error("{axis} = {value} at {t:.6} s has too many digits with {decimals} decimals")]
    Digits {
        /// C, X or Z.
        axis: char,
        /// The position or velocity.
        value: f64,
        /// The decimals that the program should have.
        decimals: u32,
        /// The time of the point, s.
        t: f64,
    },
    /// C turns so far that a wrapped position does not show the direction.
    #[error(
        "C turns by half a revolution or more in the segment that ends at {t:.6} s, C = \
         {c_deg:.3} deg: wrapped positions do not show the direction"
    )]
    HalfTurn {
        /// The time of its end, s.
        t: f64,
        /// C at its end, deg.
        c_deg: f64,
    },
    /// The controller does not play a motion as slowly as the path has it.
    #[error(
        "{axes} at {rate:.5} {unit}/min in the line that ends at {t:.6} s, C = {c_deg:.3} deg; with \
         `G93` this controller plays no line below {lowest} {unit}/min, and would come too early"
    )]
    Slow {
        /// What moves.
        axes: &'static str,
        /// Its rate.
        rate: f64,
        /// The lowest rate.
        lowest: f64,
        /// mm or deg.
        unit: &'static str,
        /// The time of the end of the line, s.
        t: f64,
        /// C there, deg.
        c_deg: f64,
    },
    /// The controller plays no line in so short a time.
    #[error(
        "the line that ends at {t:.6} s, C = {c_deg:.3} deg takes {took:.3} ms; this controller plays \
         no line in less than {least} ms, and would come too late"
    )]
    ShortLine {
        /// What it takes, ms.
        took: f64,
        /// The least, ms.
        least: f64,
        /// The time of the end of the line, s.
        t: f64,
        /// C there, deg.
        c_deg: f64,
    },
    /// Straight lines that stand for a cubic would be too many.
    #[error(
        "the segment that ends at {t:.6} s, C = {c_deg:.3} deg takes more than {most} straight lines"
    )]
    ManyChords {
        /// Most lines of a segment.
        most: i64,
        /// The time of its end, s.
        t: f64,
        /// C at its end, deg.
        c_deg: f64,
    },
    /// C goes beyond the end of its axis.
    #[error("C of the program is {c_deg:.3} deg at {t:.6} s, and c_limit is {limit_deg} deg")]
    BeyondC {
        /// C of the program, deg.
        c_deg: f64,
        /// The largest, deg.
        limit_deg: f64,
        /// The time, s.
        t: f64,
    },
    /// The axis of time goes beyond the controller's numbers.
    #[error(
        "{axis}, the axis of time, is at {way:.3} mm at {t:.6} s, and time_axis_limit is {limit} mm"
    )]
    BeyondTimeAxis {
        /// Its name.
        axis: char,
        /// Its place, mm.
        way: f64,
        /// The farthest, mm.
        limit: f64,
        /// The time, s.
        t: f64,
    },
    /// The controller would have to read too many segments in a second.
    #[error(
        "{segments} segments end in the second before {t:.6} s, C = {c_deg:.3} deg, and \
         segments_per_second is {most}"
    )]
    FastSegments {
        /// How many.
        segments: u64,
        /// The most.
        most: f64,
        /// The end of that second, s.
        t: f64,
        /// C there, deg.
        c_deg: f64,
    },
    /// A file of the program is larger than the controller's memory.
    #[error("`{file}` has {size}, and memory is {most}")]
    Large {
        /// The file.
        file: String,
        /// Its size.
        size: String,
        /// The most.
        most: String,
    },
    /// The program would have more parts than controllers can name.
    #[error("the program would have more than {most} parts")]
    ManyParts {
        /// The most.
        most: u32,
    },
    /// The controller calls parts by numbers, and there are none for the parts of this path.
    #[error(
        "with split, a run has at most {most} rough paths: there are program numbers for no more"
    )]
    ManyRoughPaths {
        /// How many rough paths may have parts.
        most: u32,
    },
    /// No document says how the controller calls a part of a program.
    #[error("turnpath knows no call of parts for this controller")]
    NoCalls,
    /// C does not turn within a segment, on a controller that takes its time from C.
    #[error(
        "C stands still in the segment that ends at {t:.6} s, C = {c_deg:.3} deg: this controller \
         takes the time of a segment from C, and would not know it"
    )]
    StillC {
        /// The time of its end, s.
        t: f64,
        /// C there, deg.
        c_deg: f64,
    },
    /// A loop over depths around a path that does not begin and end at rest.
    #[error("the path begins in motion: a loop over depths cannot play it once more")]
    DepthsWithoutLeads,
    /// A loop over depths of which one key is missing.
    #[error("a loop over depths has both keys, `depths` and `depth_step`")]
    HalfOfDepths,
    /// The step of a loop over depths has more digits than the program.
    #[error(
        "`depth_step` is {step} mm, which is no whole number of last digits of the program: {digit} mm"
    )]
    DepthStep {
        /// The step, mm.
        step: f64,
        /// The last digit, mm.
        digit: f64,
    },
    /// The path goes straight from point to point.
    #[error(
        "the path goes straight from point to point, but this program plays cubics: it cannot carry \
         such a path"
    )]
    Straight,
}

impl ProgramError {
    /// What the user can do with these keys, which a post has.
    pub fn help(&self, keys: &[ParamInfo]) -> &'static str {
        let has = |key: &str| keys.iter().any(|info| info.name == key);
        let has_default = |key: &str| {
            let mut infos = keys.iter().filter(|info| info.name == key);
            infos.any(|info| matches!(info.default, ParamDefault::Number(_)))
        };
        match self {
            Self::ShorterThanSaid { .. } if has("chord_share") => {
                "turn the spindle slower, or give more tolerance of interpolation, so that lines are \
                 longer"
            }
            Self::Short { .. } | Self::ShorterThanSaid { .. } => {
                "place points farther apart, or turn the spindle slower"
            }
            Self::Digits { axis: 'C', .. } if has("c_wrap") => {
                "write a smaller position_decimals, or c_wrap = \"0-360\""
            }
            Self::Digits { .. } if has("velocity_decimals") => {
                "write a smaller position_decimals or velocity_decimals"
            }
            Self::Digits { .. } => "write a smaller position_decimals",
            Self::HalfTurn { .. } => {
                "place points closer together, or write c_wrap = \"unwrapped\""
            }
            Self::Slow { .. } => {
                "feed faster, or turn the spindle faster; LinuxCNC from 2.9.0 on has no lowest rate: \
                 write lowest_rate = \"0 mm/min\" for it"
            }
            Self::ShortLine { .. } => {
                "turn the spindle slower, or give more tolerance of interpolation, so that lines are \
                 longer; the lines of a lead are longer with a smaller machine.c_acceleration; \
                 servo_period says what the machine has"
            }
            Self::ManyChords { .. } => {
                "place points closer together, or give more tolerance of interpolation"
            }
            Self::BeyondC { .. } if has_default("c_limit") && has("c_wrap") => {
                "write c_wrap = \"0-360\" if the axis has a rollover, or feed faster; write your own \
                 c_limit where your controller has other increments"
            }
            Self::BeyondC { .. } if has_default("c_limit") => {
                "feed faster, so that the path has fewer revolutions; write your own c_limit where your \
                 controller has other increments"
            }
            Self::BeyondTimeAxis { .. } => {
                "write a smaller time_axis_speed; write your own time_axis_limit where your controller \
                 has other increments"
            }
            Self::BeyondC { .. } if has("c_wrap") => {
                "write c_wrap = \"0-360\" if the axis has a rollover, or feed faster"
            }
            Self::BeyondC { .. } => "feed faster, so that the path has fewer revolutions",
            Self::FastSegments { .. } => {
                "turn the spindle slower, or give more tolerance of interpolation, so that segments \
                 are longer"
            }
            Self::Large { .. } if has("split") => {
                "write `split`, or a smaller one, so that the program calls parts that fit"
            }
            Self::Large { .. } => {
                "give more tolerance of interpolation, or feed faster, so that the program is shorter"
            }
            Self::ManyParts { .. } => "write a larger split",
            Self::ManyRoughPaths { .. } => "leave out split, or list fewer rough paths in [passes]",
            Self::NoCalls => "leave out split",
            Self::DepthsWithoutLeads => "write lead = true in [path]",
            Self::HalfOfDepths => "write both, or none",
            Self::DepthStep { .. } => {
                "write a depth_step of whole last digits, or a larger position_decimals"
            }
            Self::StillC { .. } => "write a larger position_decimals, or choose another post",
            Self::Straight => "choose a velocity solver that gives cubics, or write posts = []",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::POSTS;

    #[test]
    fn help_on_digits_names_keys_that_the_post_has() {
        let keys = ["position_decimals", "velocity_decimals", "c_wrap"];
        for post in POSTS {
            for axis in ['C', 'X'] {
                let error = ProgramError::Digits {
                    axis,
                    value: 1e9,
                    decimals: 12,
                    t: 0.0,
                };
                let help = error.help(post.keys);
                let has = |key: &&str| post.keys.iter().any(|info| info.name == *key);
                let named = keys.iter().filter(|key| help.contains(**key));
                assert!(named.clone().count() > 0, "{help}");
                assert!(named.clone().all(has), "{}: {help}", post.name);
            }
        }
    }
}
