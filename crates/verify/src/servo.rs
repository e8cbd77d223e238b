//! Servo: how far axes of the second order lag behind the played path, and what that leaves on
//! the surface.
//!
//! Each axis answers its command r with y, y″ + 2ζω₀y′ + ω₀²y = ω₀²r + 2ζω₀k_v r′ + k_a r″, and
//! gives y(t − τ). For the lag e = y − r that is e″ + 2ζω₀e′ + ω₀²e = −2ζω₀(1 − k_v)r′ −
//! (1 − k_a)r″. Between two control points the right side is a polynomial of degree 2 in time, so
//! e is one too, and a decay: exact, whatever the segments' durations, and nought with both
//! feed-forwards whole. Integrated piece by piece, states handed on in order.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use turnpath_core::toolpath::{Cubic, PathBlock, Segment};
use turnpath_core::{AxisServo, Result, Scalar, Servo};

use crate::playback::{BATCH, INSTANTS};
use crate::touch::FirstTouch;

/// The lag of one axis at an instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Lag {
    e: f64,
    rate: f64,
}

/// How one axis answers.
#[derive(Debug, Clone, Copy)]
struct Answer(AxisServo);

impl Answer {
    /// 2ζ/ω₀: the time by which a ramp is followed late without feed-forward, s.
    fn lateness(&self) -> f64 {
        2.0 * self.0.damping / self.0.frequency
    }

    /// The part of the lag that follows the command, Σ p_i t^i, from r = Σ r_i t^i.
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

    /// How a lag dies away in `time` where nothing forces it.
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

/// What an axis is told between two control points.
#[derive(Debug, Clone, Copy)]
struct Piece {
    start: f64,
    duration: f64,
    /// Σ r_i t^i from the start on.
    r: [f64; 4],
}

impl Piece {
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

    fn place(&self, t: f64) -> f64 {
        self.r[0] + t * (self.r[1] + t * (self.r[2] + t * self.r[3]))
    }

    /// The lag `t` after the start.
    fn lag(&self, servo: Answer, from: Lag, t: f64) -> Lag {
        let [p0, p1, p2] = servo.forced(self.r);
        let free = Lag {
            e: from.e - p0,
            rate: from.rate - p1,
        };
        let free = servo.decay(free, t);
        Lag {
            e: free.e + p0 + t * (p1 + t * p2),
            rate: free.rate + p1 + 2.0 * t * p2,
        }
    }
}

/// An axis on its way: the pieces that its delay has not passed yet, and its lag where the first
/// of them begins.
#[derive(Debug, Clone)]
struct Follower {
    servo: Answer,
    pieces: VecDeque<Piece>,
    lag: Lag,
    begun: bool,
}

impl Follower {
    fn new(servo: AxisServo) -> Self {
        Self {
            servo: Answer(servo),
            pieces: VecDeque::new(),
            lag: Lag::default(),
            begun: false,
        }
    }

    fn push(&mut self, piece: Piece) {
        if !self.begun {
            self.begun = true;
            // As if velocity and acceleration had been these for long; nothing at rest.
            let [p0, p1, _] = self.servo.forced([piece.r[0], piece.r[1], piece.r[2], 0.0]);
            self.lag = Lag { e: p0, rate: p1 };
        }
        self.pieces.push_back(piece);
    }

    /// Leaves behind what the axis has done `time` before.
    fn pass(&mut self, time: f64) {
        let until = time - self.servo.0.delay;
        while let [Some(piece), Some(next)] = [self.pieces.front(), self.pieces.get(1)] {
            if piece.end() > until {
                break;
            }
            self.lag = piece.lag(self.servo, self.lag, piece.duration);
            // Straight segments change their rate at once, and y' only by what is fed forward.
            let jump = next.rate(0.0) - piece.rate(piece.duration);
            self.lag.rate -= (1.0 - self.servo.0.acceleration_forward) * jump;
            self.pieces.pop_front();
        }
    }

    /// Where the axis is at `time`; times do not decrease. Before the path it stands, or moves,
    /// as the path begins.
    fn at(&mut self, time: f64) -> f64 {
        self.pass(time);
        let Some(piece) = self.pieces.front() else {
            return f64::NAN;
        };
        let t = time - self.servo.0.delay - piece.start;
        if t < 0.0 {
            return piece.place(0.0) + piece.rate(0.0) * t + self.lag.e + self.lag.rate * t;
        }
        piece.place(t) + piece.lag(self.servo, self.lag, t).e
    }
}

/// Where the axes are when a stretch begins.
#[derive(Debug, Clone)]
pub struct ServoStart([Follower; 3]);

/// The following error of one axis, what it does − what it is told.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Following {
    /// Largest amount, mm or rad.
    pub max: f64,
    square: f64,
    time: f64,
}

impl Following {
    /// Root of the mean square over time, mm or rad.
    pub fn rms(&self) -> f64 {
        if self.time > 0.0 {
            (self.square / self.time).sqrt()
        } else {
            0.0
        }
    }

    fn see(&mut self, error: f64, time: f64) {
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

/// What the servo does to the cut.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ServoFigures {
    /// Of C, rad.
    pub c: Following,
    /// Of X, mm.
    pub x: Following,
    /// Of Z, mm.
    pub z: Following,
    /// Where the axes bring the tool − the true centre, along z at the C and X that they bring it
    /// to, mm: the largest amount where it is, with its sign; no number where the tool is brought
    /// to a place without a surface.
    pub extreme: f64,
    /// C that the axes bring it to, unwrapped, rad.
    pub at_c: f64,
    /// X likewise, mm.
    pub at_x: f64,
    error: Following,
}

impl ServoFigures {
    /// The largest predicted error, mm; infinite where there was no number.
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

    fn see(&mut self, error: f64, c: f64, x: f64) {
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
        self.see(next.extreme, next.at_c, next.at_x);
    }
}

/// One stretch of the cut with its servo.
#[derive(Debug, Clone, Default)]
pub struct ServoStretch(ServoFigures);

/// Leads the axes along a path, leads and all, and gathers what its cut comes to.
#[derive(Debug, Clone)]
pub struct ServoMeter {
    now: ServoStart,
    figures: ServoFigures,
}

impl ServoMeter {
    /// The path has not begun.
    pub fn new(servo: &Servo) -> Self {
        let axes = [servo.c, servo.x, servo.z];
        Self {
            now: ServoStart(axes.map(Follower::new)),
            figures: ServoFigures::default(),
        }
    }

    /// The path's next stretch passes, in order; what it begins with, to measure it.
    pub fn pass(&mut self, points: &PathBlock) -> ServoStart {
        let start = self.now.clone();
        for segment in points.segments() {
            self.now.push(&segment);
            for axis in &mut self.now.0 {
                axis.pass(segment.start);
            }
        }
        start
    }

    /// Measures a stretch that cuts; can run in parallel.
    pub fn measure(
        touch: &FirstTouch,
        start: &ServoStart,
        points: &PathBlock,
    ) -> Result<ServoStretch> {
        let segments: Vec<Segment> = points.segments().collect();
        let (mut figures, mut axes) = (ServoFigures::default(), start.clone());
        let (mut places, mut touches) = (Places::default(), Vec::new());
        for batch in segments.chunks(BATCH) {
            places.clear();
            for segment in batch {
                axes.push(segment);
                axes.play(segment, &mut places, &mut figures);
            }
            touch.find(&places.theta, &places.x, &mut touches)?;
            for (i, touch) in touches.iter().enumerate() {
                let error = places.z[i] - touch.z;
                figures.error.see(error, places.time[i]);
                figures.see(error, places.c[i], places.x[i]);
            }
        }
        Ok(ServoStretch(figures))
    }

    /// Puts a stretch behind those measured so far.
    pub fn append(&mut self, next: &ServoStretch) {
        self.figures.append(&next.0);
    }

    /// The figures so far.
    pub fn figures(&self) -> &ServoFigures {
        &self.figures
    }
}

/// Where the axes bring the tool, at the instants of a batch.
#[derive(Default)]
struct Places {
    c: Vec<f64>,
    theta: Vec<f64>,
    x: Vec<f64>,
    z: Vec<f64>,
    time: Vec<f64>,
}

impl Places {
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
            axis.push(Piece::new(segment, cubic));
        }
    }

    /// The instants of a segment.
    fn play(&mut self, segment: &Segment, places: &mut Places, figures: &mut ServoFigures) {
        let [c_axis, x_axis, z_axis] = &mut self.0;
        let share = segment.duration / INSTANTS as f64;
        for k in 0..INSTANTS {
            let s = k as f64 / INSTANTS as f64;
            let time = segment.start + s * segment.duration;
            let (c, x, z) = (c_axis.at(time), x_axis.at(time), z_axis.at(time));
            figures.c.see(c - segment.c.value(s), share);
            figures.x.see(x - segment.x.value(s), share);
            figures.z.see(z - segment.z.value(s), share);
            places.c.push(c);
            places.theta.push(c.rem_euclid(TAU));
            places.x.push(x);
            places.z.push(z);
            places.time.push(share);
        }
    }
}

#[cfg(test)]
mod tests;
