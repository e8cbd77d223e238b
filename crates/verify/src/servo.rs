//! Servo: how far axes of the second order lag behind the played path, and the error that this
//! leaves on the surface.
//!
//! Each axis responds to its command r with y: y″ + 2ζω₀y′ + ω₀²y = ω₀²r + 2ζω₀k_v r′ + k_a r″. Its
//! position is y(t − τ). The lag e = y − r then follows e″ + 2ζω₀e′ + ω₀²e = −2ζω₀(1 − k_v)r′ −
//! (1 − k_a)r″. Between two control points the right side is a polynomial of degree 2 in time, so e
//! is the sum of such a polynomial and a decay. This is exact for any duration of the segments, and
//! zero if both feed-forwards are 1. The lag is integrated from segment to segment, in order.

use std::collections::VecDeque;

use turnpath_core::toolpath::{Cubic, PathBlock, Segment};
use turnpath_core::{AxisServo, Result, Scalar, Servo, within_turn};

use crate::instants::{BATCH, INSTANTS};
use crate::touch::FirstTouch;

/// The lag of one axis at an instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Lag {
    e: f64,
    rate: f64,
}

/// The response of one axis to its command.
#[derive(Debug, Clone, Copy)]
struct AxisResponse(AxisServo);

impl AxisResponse {
    /// 2ζ/ω₀: the time by which the axis follows a ramp late without feed-forward, s.
    fn lateness(&self) -> f64 {
        2.0 * self.0.damping / self.0.frequency
    }

    /// The forced part of the lag, Σ p_i t^i, for the command r = Σ r_i t^i.
    fn forced(&self, r: [f64; 4]) -> [f64; 3] {
        let (late, slack) = (
            self.lateness(),
            (self.0.frequency * self.0.frequency).recip(),
        );
        let missing = (
            (1.0 - self.0.velocity_forward) * late,
            (1.0 - self.0.acceleration_forward) * slack,
        );
        let f0 = -missing.0 * r[1] - missing.1 * 2.0 * r[2];
        let f1 = -missing.0 * 2.0 * r[2] - missing.1 * 6.0 * r[3];
        let p2 = -missing.0 * 3.0 * r[3];
        let p1 = f1 - 2.0 * late * p2;
        [f0 - late * p1 - 2.0 * slack * p2, p1, p2]
    }

    /// The lag after `time`, s, without a command that forces it.
    fn decay(&self, from: Lag, time: f64) -> Lag {
        let (w, zeta) = (self.0.frequency, self.0.damping);
        let s = zeta * w;
        let d = w * (zeta * zeta - 1.0).abs().sqrt();
        // cosh and sinh/d of d·t, or cos and sin/d, each times exp(−s t).
        let (even, odd) = if d * time < 1e-9 {
            let fall = Scalar::exp(-s * time);
            (fall, fall * time)
        } else if zeta < 1.0 {
            let fall = Scalar::exp(-s * time);
            let (sin, cos) = Scalar::sin_cos(d * time);
            (fall * cos, fall * sin / d)
        } else {
            let (slow, fast) = (Scalar::exp((d - s) * time), Scalar::exp((-d - s) * time));
            (0.5 * (slow + fast), 0.5 * (slow - fast) / d)
        };
        Lag {
            e: from.e * (even + s * odd) + from.rate * odd,
            rate: from.rate * (even - s * odd) - w * w * from.e * odd,
        }
    }
}

/// The command of one axis between two control points.
#[derive(Debug, Clone, Copy)]
struct CommandPiece {
    start: f64,
    duration: f64,
    /// Coefficients of r = Σ r_i t^i, with t from the start on.
    r: [f64; 4],
}

impl CommandPiece {
    fn new(segment: &Segment, cubic: &Cubic) -> Self {
        let h = segment.duration;
        let [a, b, c, d] = cubic.0;
        Self {
            start: segment.start,
            duration: h,
            r: [a, b / h, c / (h * h), d / (h * h * h)],
        }
    }

    fn end(&self) -> f64 {
        self.start + self.duration
    }

    fn rate(&self, t: f64) -> f64 {
        self.r[1] + t * (2.0 * self.r[2] + t * 3.0 * self.r[3])
    }

    fn position(&self, t: f64) -> f64 {
        self.r[0] + t * (self.r[1] + t * (self.r[2] + t * self.r[3]))
    }

    /// The lag at `t` after the start, from the lag at the start.
    fn lag(&self, response: AxisResponse, from: Lag, t: f64) -> Lag {
        let [p0, p1, p2] = response.forced(self.r);
        let free = Lag {
            e: from.e - p0,
            rate: from.rate - p1,
        };
        let free = response.decay(free, t);
        Lag {
            e: free.e + p0 + t * (p1 + t * p2),
            rate: free.rate + p1 + 2.0 * t * p2,
        }
    }
}

/// An axis that follows its command: the pieces that its delayed time has not passed yet, and its
/// lag at the start of the first of them.
#[derive(Debug, Clone)]
struct Follower {
    response: AxisResponse,
    pieces: VecDeque<CommandPiece>,
    lag: Lag,
    begun: bool,
}

impl Follower {
    fn new(servo: AxisServo) -> Self {
        Self {
            response: AxisResponse(servo),
            pieces: VecDeque::new(),
            lag: Lag::default(),
            begun: false,
        }
    }

    fn push(&mut self, piece: CommandPiece) {
        if !self.begun {
            self.begun = true;
            // The lag after a long time at this velocity and acceleration; zero at rest.
            let [p0, p1, _] = self
                .response
                .forced([piece.r[0], piece.r[1], piece.r[2], 0.0]);
            self.lag = Lag { e: p0, rate: p1 };
        }
        self.pieces.push_back(piece);
    }

    /// Drops the pieces that the axis, with its delay, has finished at `time`, and carries its lag
    /// over to the next piece.
    fn advance(&mut self, time: f64) {
        let until = time - self.response.0.delay;
        while let [Some(piece), Some(next)] = [self.pieces.front(), self.pieces.get(1)] {
            if piece.end() > until {
                break;
            }
            self.lag = piece.lag(self.response, self.lag, piece.duration);
            // Between straight segments r' jumps. y' jumps by the part that is fed forward.
            let jump = next.rate(0.0) - piece.rate(piece.duration);
            self.lag.rate -= (1.0 - self.response.0.acceleration_forward) * jump;
            self.pieces.pop_front();
        }
    }

    /// The position of the axis at `time`. Times must not decrease. Before the path begins, the
    /// axis moves at the rate with which the path begins.
    fn at(&mut self, time: f64) -> f64 {
        self.advance(time);
        let Some(piece) = self.pieces.front() else {
            return f64::NAN;
        };
        let t = time - self.response.0.delay - piece.start;
        if t < 0.0 {
            return piece.position(0.0) + piece.rate(0.0) * t + self.lag.e + self.lag.rate * t;
        }
        piece.position(t) + piece.lag(self.response, self.lag, t).e
    }
}

/// The state of the axes at the start of a block.
#[derive(Debug, Clone)]
pub struct ServoStart([Follower; 3]);

/// The following error of one axis, actual − commanded position.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FollowingError {
    /// Largest amount, mm or rad.
    pub max: f64,
    square: f64,
    time: f64,
}

impl FollowingError {
    /// Root of the mean square over time, mm or rad.
    pub fn rms(&self) -> f64 {
        if self.time > 0.0 {
            (self.square / self.time).sqrt()
        } else {
            0.0
        }
    }

    fn include(&mut self, error: f64, time: f64) {
        self.max = self.max.max(error.abs());
        self.square += error * error * time;
        self.time += time;
    }

    fn append(&mut self, next: &Self) {
        self.max = self.max.max(next.max);
        self.square += next.square;
        self.time += next.time;
    }
}

/// The effect of the servo on the cut.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ServoFigures {
    /// Following error of C, rad.
    pub c: FollowingError,
    /// Following error of X, mm.
    pub x: FollowingError,
    /// Following error of Z, mm.
    pub z: FollowingError,
    /// The predicted error with the largest amount, signed, mm: actual Z − the true Z of the tool
    /// at the actual C and X. NaN if the axes bring the tool to a position where the surface has no
    /// height.
    pub extreme: f64,
    /// Actual C at that error, unwrapped, rad.
    pub at_c: f64,
    /// Actual X at that error, mm.
    pub at_x: f64,
    error: FollowingError,
}

impl ServoFigures {
    /// The largest predicted error, mm; infinite if an error is NaN.
    pub fn max(&self) -> f64 {
        match self.extreme.is_nan() {
            true => f64::INFINITY,
            false => self.extreme.abs(),
        }
    }

    /// Root of the mean square over time, mm.
    pub fn rms(&self) -> f64 {
        self.error.rms()
    }

    fn include(&mut self, error: f64, c: f64, x: f64) {
        let worse = error.is_nan() || error.abs() > self.extreme.abs();
        if !self.extreme.is_nan() && worse {
            (self.extreme, self.at_c, self.at_x) = (error, c, x);
        }
    }

    fn append(&mut self, next: &Self) {
        self.c.append(&next.c);
        self.x.append(&next.x);
        self.z.append(&next.z);
        self.error.append(&next.error);
        self.include(next.extreme, next.at_c, next.at_x);
    }
}

/// The effect of the servo on one block of the cut.
#[derive(Debug, Clone, Default)]
pub struct ServoBlockFigures(ServoFigures);

/// Moves the axes along a whole path, leads included, and collects the figures of its cut.
#[derive(Debug, Clone)]
pub struct ServoMeter {
    now: ServoStart,
    figures: ServoFigures,
}

impl ServoMeter {
    /// A meter at the start of a path.
    pub fn new(servo: &Servo) -> Self {
        let axes = [servo.c, servo.x, servo.z];
        Self {
            now: ServoStart(axes.map(Follower::new)),
            figures: ServoFigures::default(),
        }
    }

    /// Moves the axes over the path's next block, in order. Returns their state at the start of the
    /// block, which [`Self::measure`] needs.
    pub fn advance(&mut self, points: &PathBlock) -> ServoStart {
        let start = self.now.clone();
        for segment in points.segments() {
            self.now.push(&segment);
            for axis in &mut self.now.0 {
                axis.advance(segment.start);
            }
        }
        start
    }

    /// Measures a block that cuts; can run in parallel.
    pub fn measure(
        touch: &FirstTouch,
        start: &ServoStart,
        points: &PathBlock,
    ) -> Result<ServoBlockFigures> {
        let segments: Vec<Segment> = points.segments().collect();
        let (mut figures, mut axes) = (ServoFigures::default(), start.clone());
        let (mut positions, mut touches) = (ActualPositions::default(), Vec::new());
        for batch in segments.chunks(BATCH) {
            positions.clear();
            for segment in batch {
                axes.push(segment);
                axes.play(segment, &mut positions, &mut figures);
            }
            touch.find(&positions.theta, &positions.x, &mut touches)?;
            for (i, touch) in touches.iter().enumerate() {
                let error = positions.z[i] - touch.z;
                figures.error.include(error, positions.time[i]);
                figures.include(error, positions.c[i], positions.x[i]);
            }
        }
        Ok(ServoBlockFigures(figures))
    }

    /// Appends the path's next block that cuts.
    pub fn append(&mut self, next: &ServoBlockFigures) {
        self.figures.append(&next.0);
    }

    /// The figures so far.
    pub fn figures(&self) -> &ServoFigures {
        &self.figures
    }
}

/// The positions to which the axes bring the tool, at the instants of a batch.
#[derive(Default)]
struct ActualPositions {
    c: Vec<f64>,
    theta: Vec<f64>,
    x: Vec<f64>,
    z: Vec<f64>,
    /// The time that each instant stands for, s.
    time: Vec<f64>,
}

impl ActualPositions {
    fn clear(&mut self) {
        for column in [
            &mut self.c,
            &mut self.theta,
            &mut self.x,
            &mut self.z,
            &mut self.time,
        ] {
            column.clear();
        }
    }
}

impl ServoStart {
    fn push(&mut self, segment: &Segment) {
        let cubics = [&segment.c, &segment.x, &segment.z];
        for (axis, cubic) in self.0.iter_mut().zip(cubics) {
            axis.push(CommandPiece::new(segment, cubic));
        }
    }

    /// Plays a segment: adds the positions and the following errors at its instants.
    fn play(
        &mut self,
        segment: &Segment,
        positions: &mut ActualPositions,
        figures: &mut ServoFigures,
    ) {
        let [c_axis, x_axis, z_axis] = &mut self.0;
        let share = segment.duration / INSTANTS as f64;
        for k in 0..INSTANTS {
            let s = k as f64 / INSTANTS as f64;
            let time = segment.start + s * segment.duration;
            let (c, x, z) = (c_axis.at(time), x_axis.at(time), z_axis.at(time));
            figures.c.include(c - segment.c.value(s), share);
            figures.x.include(x - segment.x.value(s), share);
            figures.z.include(z - segment.z.value(s), share);
            positions.c.push(c);
            positions.theta.push(within_turn(c));
            positions.x.push(x);
            positions.z.push(z);
            positions.time.push(share);
        }
    }
}

#[cfg(test)]
mod tests;
