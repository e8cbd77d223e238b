//! Spectrum of the axes: how much X and Z move at each frequency.
//!
//! The method is Welch's (P. D. Welch, IEEE Transactions on Audio and Electroacoustics 15, 1967).
//! The path as played is sampled at an even rate, in windows that overlap by half. From each window
//! its own straight line is subtracted, which takes the feed out of X. A Hann window is applied,
//! and the densities of all windows are averaged.

use std::f64::consts::TAU;

use turnpath_core::toolpath::{PathBlock, Segment};

use crate::periodogram::Periodogram;

/// Samples per revolution. They resolve up to 256 periods a turn.
const SAMPLES_PER_TURN: usize = 512;
/// Revolutions per window. Lines lie a sixteenth of the spindle's frequency apart, and whatever
/// repeats every turn has its frequencies on lines.
const WINDOW_TURNS: usize = 16;
const WINDOW: usize = SAMPLES_PER_TURN * WINDOW_TURNS;
/// A path shorter than a window has a spectrum from this number of samples on.
const FEWEST: usize = 4;

/// One line of the spectrum of the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxesLine {
    /// Hz.
    pub frequency: f64,
    /// One-sided density of X, mm²/Hz. Its integral over the frequency is the mean square about
    /// the straight lines.
    pub x: f64,
    /// One-sided density of Z, mm²/Hz.
    pub z: f64,
}

/// Accumulates the one-sided power spectral density of the played X and Z. It needs memory for one
/// window, however long the path is.
pub struct AxesSpectrum {
    /// Time between samples, s.
    step: f64,
    periodogram: Periodogram,
    /// Time of the first sample of the unbroken path, s, and the number of samples since then.
    since: Option<(f64, u64)>,
    /// Time at the end of the last segment, s.
    end: f64,
    x: Vec<f64>,
    z: Vec<f64>,
    sum: Sums,
}

/// Sums of the densities of all windows.
#[derive(Default)]
struct Sums {
    windows: u32,
    x: Vec<f64>,
    z: Vec<f64>,
}

impl AxesSpectrum {
    /// The spectrum of a path at this speed of the spindle, rad/s. The speed sets the sampling
    /// rate.
    pub fn new(spindle_speed: f64) -> Self {
        Self {
            step: TAU / spindle_speed / SAMPLES_PER_TURN as f64,
            periodogram: Periodogram::new(WINDOW),
            since: None,
            end: f64::NAN,
            x: Vec::with_capacity(WINDOW),
            z: Vec::with_capacity(WINDOW),
            sum: Sums::default(),
        }
    }

    /// Adds the path's next block. A new window begins after a segment that is longer than a
    /// window, and at a segment that does not begin where the one before it ended.
    pub fn append(&mut self, block: &PathBlock) {
        for segment in block.segments() {
            if segment.duration > WINDOW as f64 * self.step {
                self.since = None;
                continue;
            }
            self.sample(&segment);
        }
    }

    fn sample(&mut self, segment: &Segment) {
        let follows = (segment.start - self.end).abs() < 0.5 * self.step;
        let (first, mut count) = match self.since.filter(|_| follows) {
            Some(since) => since,
            None => self.begin(segment.start),
        };
        self.end = segment.start + segment.duration;
        loop {
            let t = first + count as f64 * self.step;
            if t >= self.end {
                break;
            }
            let s = (t - segment.start) / segment.duration;
            self.push(segment.x.value(s), segment.z.value(s));
            count += 1;
        }
        self.since = Some((first, count));
    }

    fn begin(&mut self, start: f64) -> (f64, u64) {
        self.x.clear();
        self.z.clear();
        (start, 0)
    }

    fn push(&mut self, x: f64, z: f64) {
        self.x.push(x);
        self.z.push(z);
        if self.x.len() == WINDOW {
            self.sum.add(&self.periodogram, &self.x, &self.z, self.step);
            self.x.drain(..WINDOW / 2);
            self.z.drain(..WINDOW / 2);
        }
    }

    /// The mean of all windows, without the line at 0 Hz. A path shorter than one window is one
    /// window by itself; a path of fewer than four samples has no lines.
    pub fn lines(&self) -> Vec<AxesLine> {
        let count = self.x.len();
        if self.sum.windows > 0 {
            return self.sum.lines(WINDOW, self.step);
        }
        if count < FEWEST {
            return Vec::new();
        }
        let mut sum = Sums::default();
        sum.add(&Periodogram::new(count), &self.x, &self.z, self.step);
        sum.lines(count, self.step)
    }
}

impl Sums {
    fn add(&mut self, periodogram: &Periodogram, x: &[f64], z: &[f64], step: f64) {
        self.windows += 1;
        for (sum, values) in [(&mut self.x, x), (&mut self.z, z)] {
            let densities = periodogram.densities(values, straight_line(values), step);
            sum.resize(densities.len(), 0.0);
            for (sum, density) in sum.iter_mut().zip(densities) {
                *sum += density;
            }
        }
    }

    fn lines(&self, count: usize, step: f64) -> Vec<AxesLine> {
        let spacing = (count as f64 * step).recip();
        let windows = f64::from(self.windows);
        let lines = self.x.iter().zip(&self.z).enumerate().skip(1);
        let line = |(k, (x, z)): (usize, (&f64, &f64))| AxesLine {
            frequency: k as f64 * spacing,
            x: x / windows,
            z: z / windows,
        };
        lines.map(line).collect()
    }
}

/// The least-squares straight line through values at 0, 1, 2, ….
fn straight_line(values: &[f64]) -> impl Fn(usize) -> f64 + use<> {
    let count = values.len() as f64;
    let middle = 0.5 * (count - 1.0);
    let mean = values.iter().sum::<f64>() / count;
    let weighted = values.iter().enumerate();
    let weighted = weighted.map(|(i, value)| (i as f64 - middle) * (value - mean));
    let slope = weighted.sum::<f64>() / (count * (count * count - 1.0) / 12.0);
    move |i| mean + slope * (i as f64 - middle)
}

#[cfg(test)]
mod tests {
    use turnpath_core::Scalar;
    use turnpath_core::toolpath::ControlPoint;

    use super::*;

    /// 600 revolutions a minute.
    const SPEED: f64 = 10.0 * TAU;
    /// The wave's amplitude, mm.
    const AMPLITUDE: f64 = 0.002;

    /// X = feed + A sin 2πft, Z = 3 A cos 2πft, with a control point every 4 degrees.
    fn wave(turns: usize, frequency: f64) -> PathBlock {
        let mut points = PathBlock::default();
        let speed = TAU * frequency;
        for i in 0..=turns * 90 {
            let t = i as f64 / 900.0;
            let (sin, cos) = Scalar::sin_cos(speed * t);
            points.push(ControlPoint {
                t,
                c: SPEED * t,
                x: 30.0 - 0.5 * t + AMPLITUDE * sin,
                z: 3.0 * AMPLITUDE * cos,
                vc: SPEED,
                vx: -0.5 + AMPLITUDE * speed * cos,
                vz: -3.0 * AMPLITUDE * speed * sin,
            });
        }
        points
    }

    fn spectrum(points: &PathBlock) -> Vec<AxesLine> {
        let mut spectrum = AxesSpectrum::new(SPEED);
        spectrum.append(points);
        spectrum.lines()
    }

    fn power(lines: &[AxesLine], density: impl Fn(&AxesLine) -> f64) -> f64 {
        lines.iter().map(density).sum::<f64>() * lines[0].frequency
    }

    fn top(lines: &[AxesLine], density: impl Fn(&AxesLine) -> f64) -> f64 {
        let higher = |a: &&AxesLine, b: &&AxesLine| density(a).total_cmp(&density(b));
        lines.iter().max_by(higher).unwrap().frequency
    }

    /// The frequencies lie on a line and between two lines, over whole windows and less than one.
    #[test]
    fn a_wave_has_its_frequency_and_half_its_amplitudes_square() {
        for (turns, frequency) in [(100, 20.0), (100, 13.4), (16, 30.0), (7, 40.0)] {
            let lines = spectrum(&wave(turns, frequency));
            let expected = 0.5 * AMPLITUDE * AMPLITUDE;
            let (x, z) = (power(&lines, |line| line.x), power(&lines, |line| line.z));
            assert!((x / expected - 1.0).abs() < 0.01, "{frequency}: {x:e}");
            assert!((z / (9.0 * expected) - 1.0).abs() < 0.01, "{z:e}");
            let near = 0.5001 * lines[0].frequency;
            assert!((top(&lines, |line| line.x) - frequency).abs() < near);
            assert!((top(&lines, |line| line.z) - frequency).abs() < near);
        }
    }

    #[test]
    fn a_feed_alone_has_no_power() {
        let mut points = wave(50, 20.0);
        let t = points.t.clone();
        points.x = t.iter().map(|t| 30.0 - 0.5 * t).collect();
        points.vx.fill(-0.5);
        let x = power(&spectrum(&points), |line| line.x);
        assert!(x < 1e-24, "{x:e}");
    }

    #[test]
    fn blocks_give_what_one_piece_gives() {
        let points = wave(60, 20.0);
        let all: Vec<ControlPoint> = points.points().collect();
        let mut pieces = AxesSpectrum::new(SPEED);
        for range in [0..2, 1..1500, 1499..all.len()] {
            let mut block = PathBlock::default();
            all[range].iter().for_each(|point| block.push(*point));
            pieces.append(&block);
        }
        assert_eq!(pieces.lines(), spectrum(&points));
    }

    #[test]
    fn a_gap_in_time_is_not_sampled() {
        let mut points = wave(40, 20.0);
        let middle = points.len() / 2;
        for t in &mut points.t[middle..] {
            *t += 1e12;
        }
        let lines = spectrum(&points);
        assert_eq!(lines.len(), WINDOW / 2);
    }

    #[test]
    fn an_empty_path_has_no_spectrum() {
        assert!(spectrum(&PathBlock::default()).is_empty());
    }
}
