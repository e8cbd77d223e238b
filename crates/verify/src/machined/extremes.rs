//! The highest and the lowest point of a machined surface.

use turnpath_core::{Result, Scalar, StrategyError};

use super::strip::Sample;

/// A point of the part and the surface error there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartPoint {
    /// Machined − wanted along z, mm.
    pub error: f64,
    /// x on the part, mm.
    pub x: f64,
    /// y on the part, mm.
    pub y: f64,
}

impl PartPoint {
    /// The point at signed position `s`, mm, on the line at `angle`, rad.
    pub(super) fn on_line(angle: f64, s: f64, error: f64) -> Self {
        let (sin, cos) = Scalar::sin_cos(angle);
        let (x, y) = (s * cos, s * sin);
        Self { error, x, y }
    }
}

/// The extremes of a machined surface. Their errors are finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceExtremes {
    /// The point where most material is left.
    pub highest: PartPoint,
    /// The point where most material is missing or least is left.
    pub lowest: PartPoint,
}

impl SurfaceExtremes {
    /// Peak to valley, mm.
    pub fn pv(&self) -> f64 {
        self.highest.error - self.lowest.error
    }

    /// The extremes over lines, each given with its angle, rad; `None` if no line has any.
    ///
    /// # Errors
    /// Where an error is not finite. The message names the place.
    pub(super) fn over<'a>(
        lines: impl Iterator<Item = (f64, &'a LineExtremes)>,
    ) -> Result<Option<Self>> {
        let mut over: Option<Self> = None;
        for (angle, line) in lines {
            if let Some(s) = line.unknown {
                return Err(no_height(angle, s));
            }
            let Some([highest, lowest]) = line.known else {
                continue;
            };
            let at = |(error, s): (f64, f64)| PartPoint::on_line(angle, s, error);
            let found = over.get_or_insert(Self {
                highest: at(highest),
                lowest: at(lowest),
            });
            if highest.0 > found.highest.error {
                found.highest = at(highest);
            }
            if lowest.0 < found.lowest.error {
                found.lowest = at(lowest);
            }
        }
        Ok(over)
    }
}

/// The extreme errors of one line. An error that is not finite is kept as well: nothing is known
/// about the surface there, so it holds no tolerance.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct LineExtremes {
    /// The highest and the lowest error, mm, each with its signed position, mm.
    known: Option<[(f64, f64); 2]>,
    /// The first signed position whose error is not finite, mm.
    unknown: Option<f64>,
}

impl LineExtremes {
    /// Includes the error at a signed position, both in mm.
    pub fn include(&mut self, error: f64, s: f64) {
        if !error.is_finite() {
            self.unknown.get_or_insert(s);
            return;
        }
        let [highest, lowest] = self.known.get_or_insert([(error, s); 2]);
        if error > highest.0 {
            *highest = (error, s);
        }
        if error < lowest.0 {
            *lowest = (error, s);
        }
    }

    /// Includes a piece of the machined profile. Its extremes may be finite where an error at a
    /// node is not.
    pub fn include_sample(&mut self, sample: &Sample) {
        let nodes = sample.s.iter().zip(&sample.error);
        let unknown = nodes.filter(|(_, error)| !error.is_finite());
        for (s, error) in unknown {
            self.include(*error, *s);
        }
        for (s, error) in sample.extremes() {
            self.include(error, s);
        }
    }
}

fn no_height(angle: f64, s: f64) -> StrategyError {
    let PartPoint { x, y, .. } = PartPoint::on_line(angle, s, f64::NAN);
    StrategyError::failed(format!(
        "the machined surface has no height over the wanted one at x = {x:.4} mm, y = {y:.4} mm"
    ))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    fn line(errors: &[(f64, f64)]) -> LineExtremes {
        let mut line = LineExtremes::default();
        errors
            .iter()
            .for_each(|(error, s)| line.include(*error, *s));
        line
    }

    fn over(lines: &[LineExtremes]) -> Result<Option<SurfaceExtremes>> {
        SurfaceExtremes::over([0.0, FRAC_PI_2].into_iter().zip(lines))
    }

    #[test]
    fn the_extremes_are_those_of_all_lines_that_have_any() {
        let lines = [line(&[(2.0, 1.0), (-1.0, 3.0)]), line(&[(5.0, -4.0)])];
        let found = over(&lines).unwrap().unwrap();
        assert_eq!((found.highest.error, found.lowest.error), (5.0, -1.0));
        assert_eq!((found.highest.y, found.lowest.x), (-4.0, 3.0));
        let alone = over(&[line(&[]), line(&[(7.0, 2.0)])]).unwrap().unwrap();
        assert_eq!((alone.pv(), alone.lowest.y), (0.0, 2.0));
        assert_eq!(over(&[line(&[]), line(&[])]).unwrap(), None);
    }

    #[test]
    fn an_error_that_is_no_number_is_an_error_that_names_its_place() {
        for unknown in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let lines = [line(&[(2.0, 1.0)]), line(&[(1.0, 1.0), (unknown, -2.5)])];
            let message = over(&lines).unwrap_err().to_string();
            assert!(message.ends_with("y = -2.5000 mm"), "{message}");
        }
    }

    /// An inner node does not reach the ends of a piece, nor the level places of its cubic.
    #[test]
    fn no_node_of_a_piece_is_left_out() {
        for node in 0..4 {
            let mut sample = Sample {
                s: [1.0, 2.0, 3.0, 4.0],
                error: [0.5; 4],
                slope: [0.0; 4],
                weight: [0.0; 4],
            };
            sample.error[node] = f64::NAN;
            let mut line = LineExtremes::default();
            line.include_sample(&sample);
            assert_eq!(line.unknown, Some(sample.s[node]));
        }
    }
}
