//! The two phases of a lead: X and Z go down or up, and the spindle changes its speed at rest
//! height.
//!
//! Both leads are described in the time away from the join with the cut, σ ≥ 0: first the descent,
//! while C turns at the cut's speed, then the spindle's phase. A lead-in plays them backwards.

use std::f64::consts::TAU;

use super::clock::Clock;

/// How long the phases of a lead take, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Phases {
    /// From the part to rest height, with C at the cut's speed.
    pub descent: f64,
    /// At rest height, with C between the cut's speed and rest.
    pub spin: f64,
    /// Speed of C in the cut, rad/s.
    pub speed: f64,
}

impl Phases {
    /// Phases of a lead-out: at least as long as `self`, and together a whole number of the clock's
    /// ticks.
    pub fn on(self, clock: &Clock) -> Self {
        let ticks = clock.at_least(self.descent + self.spin);
        let descent = clock.seconds(ticks) - self.spin;
        Self { descent, ..self }
    }

    /// Phases of a lead-in, and how many revolutions C turns in them. They are at least as long as
    /// `self` and together a whole number of ticks, in which C turns by whole revolutions. With C's
    /// angle ω(descent + spin/2) = 2πk and the time descent + spin = T, both phases follow from k
    /// and T.
    pub fn on_whole_turns(self, clock: &Clock) -> (Self, f64) {
        let angle = self.speed * (self.descent + 0.5 * self.spin);
        let mut turns = (angle / TAU).ceil();
        loop {
            let turning = TAU * turns / self.speed;
            let all = clock.seconds(clock.at_least(turning + 0.5 * self.spin));
            let (descent, spin) = (2.0 * turning - all, 2.0 * (all - turning));
            if descent >= self.descent {
                let speed = self.speed;
                let phases = Self {
                    descent,
                    spin,
                    speed,
                };
                return (phases, turns);
            }
            turns += 1.0;
        }
    }

    /// Both together, s.
    pub fn all(&self) -> f64 {
        self.descent + self.spin
    }

    /// The angle by which C turns within `sigma` of the join, rad. In the spindle's phase the speed
    /// of C falls as 1 − 3s² + 2s³, so its acceleration is continuous, and zero at both ends.
    pub fn turned(&self, sigma: f64) -> f64 {
        if sigma <= self.descent {
            return self.speed * sigma;
        }
        let s = ((sigma - self.descent) / self.spin).min(1.0);
        let spun = s * (1.0 - s * s * (1.0 - 0.5 * s));
        self.speed * (self.descent + self.spin * spun)
    }

    /// How far the lead has gone from the part to rest height: 0 at the join, 1 at rest height, and
    /// 10s³ − 15s⁴ + 6s⁵ between them.
    pub fn lifted(&self, sigma: f64) -> f64 {
        let s = (sigma / self.descent).min(1.0);
        s * s * s * (10.0 + s * (6.0 * s - 15.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEAST: Phases = Phases {
        descent: 0.24,
        spin: 1.6,
        speed: 52.36,
    };

    #[test]
    fn a_lead_in_turns_by_whole_revolutions_in_whole_ticks() {
        for steps in [None, Some(4_096_000.0), Some(1000.0)] {
            let clock = Clock::new(steps);
            let (phases, turns) = LEAST.on_whole_turns(&clock);
            assert!(phases.descent >= LEAST.descent && phases.spin >= LEAST.spin - 1e-12);
            let angle = phases.turned(phases.all());
            assert!((angle - TAU * turns).abs() < 1e-11, "{angle}");
            assert!(angle - TAU < LEAST.turned(LEAST.all()) + 0.2);
            let ticks = phases.all() * steps.unwrap_or(1.0);
            assert!(steps.is_none() || (ticks - ticks.round()).abs() < 1e-6);
        }
    }

    #[test]
    fn c_turns_at_the_speed_of_the_cut_and_ends_at_rest() {
        let rate = |sigma: f64| (LEAST.turned(sigma + 1e-5) - LEAST.turned(sigma - 1e-5)) / 2e-5;
        assert!((rate(0.1) - LEAST.speed).abs() < 1e-6);
        assert!((rate(0.24) - LEAST.speed).abs() < 1e-6);
        assert!((rate(1.04) - 0.5 * LEAST.speed).abs() < 1e-6);
        assert!(rate(1.84).abs() < 1e-6);
        assert!((LEAST.lifted(0.12) - 0.5).abs() < 1e-15);
        assert_eq!((LEAST.lifted(0.0), LEAST.lifted(1.0)), (0.0, 1.0));
    }
}
