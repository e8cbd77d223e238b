//! The cutting speed: how fast the part passes under the nose, and how fast the spindle turns.

use turnpath_core::toolpath::PathBlock;

/// Cutting speed and speed of the spindle over the cut.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CuttingSpeed {
    /// The smallest speed at a control point: that of C times |X|, mm/s.
    pub least: f64,
    /// The largest, mm/s.
    pub most: f64,
    /// The way of the part under the nose, mm, from point to point.
    way: f64,
    time: f64,
    /// The lowest speed of the spindle at a control point, rad/s.
    pub spindle_least: f64,
    /// The highest, rad/s.
    pub spindle_most: f64,
}

impl Default for CuttingSpeed {
    fn default() -> Self {
        Self {
            least: f64::INFINITY,
            most: 0.0,
            way: 0.0,
            time: 0.0,
            spindle_least: f64::INFINITY,
            spindle_most: 0.0,
        }
    }
}

impl CuttingSpeed {
    /// The speeds of a block.
    pub(crate) fn of(points: &PathBlock) -> Self {
        let mut speeds = Self::default();
        for (spindle, x) in points.vc.iter().zip(&points.x) {
            let (spindle, cutting) = (spindle.abs(), spindle.abs() * x.abs());
            speeds.least = speeds.least.min(cutting);
            speeds.most = speeds.most.max(cutting);
            speeds.spindle_least = speeds.spindle_least.min(spindle);
            speeds.spindle_most = speeds.spindle_most.max(spindle);
        }
        let pairs = points.c.windows(2).zip(points.x.windows(2));
        for ((c, x), t) in pairs.zip(points.t.windows(2)) {
            speeds.way += 0.5 * (x[0].abs() + x[1].abs()) * (c[1] - c[0]).abs();
            speeds.time += t[1] - t[0];
        }
        speeds
    }

    /// Appends the speeds of the next block.
    pub(crate) fn append(&mut self, next: &Self) {
        *self = Self {
            least: self.least.min(next.least),
            most: self.most.max(next.most),
            way: self.way + next.way,
            time: self.time + next.time,
            spindle_least: self.spindle_least.min(next.spindle_least),
            spindle_most: self.spindle_most.max(next.spindle_most),
        };
    }

    /// The mean over time, mm/s.
    pub fn mean(&self) -> f64 {
        self.way / self.time
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use turnpath_core::toolpath::ControlPoint;

    /// A second at 3 rad/s and 10 mm, a second in which both go down to 1 rad/s and 4 mm.
    #[test]
    fn speeds_of_blocks_are_those_of_the_whole() {
        let point = |t: f64, c: f64, vc: f64, x: f64| ControlPoint {
            t,
            c,
            vc,
            x,
            ..ControlPoint::default()
        };
        let block = |points: &[ControlPoint]| {
            let mut block = PathBlock::default();
            points.iter().for_each(|point| block.push(*point));
            block
        };
        let points = [
            point(0.0, 0.0, 3.0, 10.0),
            point(1.0, 3.0, 3.0, 10.0),
            point(2.0, 5.0, 1.0, -4.0),
        ];
        let whole = CuttingSpeed::of(&block(&points));
        let mut joined = CuttingSpeed::of(&block(&points[..2]));
        joined.append(&CuttingSpeed::of(&block(&points[1..])));
        assert_eq!(joined, whole);
        assert_eq!([whole.least, whole.most], [4.0, 30.0]);
        assert_eq!([whole.spindle_least, whole.spindle_most], [1.0, 3.0]);
        assert_eq!(whole.mean(), (30.0 + 14.0) / 2.0);
    }
}
