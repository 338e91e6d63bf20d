//! Clock of a live run: it synchronises simulated time with real time.

use std::fmt;
use std::str::FromStr;
use std::time::{Duration, Instant as WallInstant};

use flexsc_core::numerics::time::{Instant, Span};

/// Polling period of a held run.
pub const POLL_PERIOD: Duration = Duration::from_millis(50);
/// Largest lag (s of real time) that a run which was too slow for its speed catches up with.
const LARGEST_LAG: f64 = 0.1;

/// Ratio of simulated time to real time; infinite for a run without any waiting.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Speed(f64);

impl Speed {
    /// Real time.
    pub const REAL: Self = Self(1.0);

    /// Returns the speed of a given factor.
    pub fn factor(factor: f64) -> Result<Self, String> {
        if factor > 0.0 && factor.is_finite() {
            Ok(Self(factor))
        } else {
            Err(format!("must be a factor above 0, or max, got {factor}"))
        }
    }

    /// Returns the factor if it is finite.
    pub fn finite(self) -> Option<f64> {
        self.0.is_finite().then_some(self.0)
    }

    /// Returns this speed multiplied by a factor.
    pub fn times(self, factor: f64) -> Self {
        Self::factor(self.0 * factor).unwrap_or(self)
    }
}

impl FromStr for Speed {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.parse() {
            _ if text == "max" => Ok(Self(f64::INFINITY)),
            Ok(factor) => Self::factor(factor),
            Err(_) => Err(format!("must be a factor above 0, or max, got `{text}`")),
        }
    }
}

impl fmt::Display for Speed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.finite() {
            Some(1.0) => f.write_str("real time"),
            Some(factor) => write!(f, "{factor} times real time"),
            None => f.write_str("as fast as possible"),
        }
    }
}

/// Clock that decides when simulated time may advance.
#[derive(Clone, Debug)]
pub struct Clock {
    has_begun: bool,
    paused: bool,
    speed: Speed,
    /// Period of the log, by which a single step advances.
    period: Span,
    /// Latest instant that the clock has released.
    shown: Instant,
    /// First period of the log after `shown`.
    next: Instant,
    /// Instant up to which a paused run may advance.
    until: Instant,
    /// Simulated time (s) that corresponds to the instant `wall` of real time, unless the run is held.
    position: f64,
    wall: WallInstant,
}

impl Clock {
    /// Returns a clock that has not started.
    pub fn new(speed: Speed, period: Span, wall: WallInstant) -> Self {
        Self {
            has_begun: false,
            paused: false,
            speed,
            period,
            shown: Instant::START,
            next: Instant::START + period,
            until: Instant::START,
            position: 0.0,
            wall,
        }
    }

    /// Starts the clock if it has not started.
    pub fn begin(&mut self, wall: WallInstant) {
        if !self.has_begun {
            self.has_begun = true;
            self.wall = wall;
        }
    }

    /// Returns the time to wait until the instant `at`; if it is due, releases it and returns `None`.
    pub fn wait(&mut self, time: Instant, wall: WallInstant) -> Option<Duration> {
        if !self.has_begun || (self.paused && time > self.until) {
            return Some(POLL_PERIOD);
        }
        if !self.paused && self.speed.finite().is_some() {
            self.advance(wall);
            let ahead = (time.seconds() - self.position) / self.speed.0;
            if ahead > 0.0 {
                return Some(Duration::try_from_secs_f64(ahead).unwrap_or(POLL_PERIOD).min(POLL_PERIOD));
            }
            self.position = self.position.min(time.seconds() + LARGEST_LAG * self.speed.0);
        }
        self.shown = time;
        while self.next <= time {
            self.next += self.period;
        }
        None
    }

    /// Returns true if the run is paused.
    pub fn paused(&self) -> bool {
        self.paused
    }

    /// Returns the speed of the run when it is not paused.
    pub fn speed(&self) -> Speed {
        self.speed
    }

    /// Returns the instant that the run has reached, or at which it is paused.
    pub fn at(&self) -> Instant {
        if self.paused { self.until } else { self.shown }
    }

    /// Pauses the run.
    pub fn pause(&mut self) {
        if !self.paused {
            self.paused = true;
            self.until = self.shown;
        }
    }

    /// Resumes the run.
    pub fn resume(&mut self, wall: WallInstant) {
        if self.paused {
            self.paused = false;
            self.jump_to_displayed(wall);
        }
    }

    /// Advances to the next period of the log, and pauses there.
    pub fn step(&mut self) {
        self.pause();
        self.until = if self.until > self.shown { self.until + self.period } else { self.next };
    }

    /// Sets the speed of the simulated clock; the displayed time does not jump.
    pub fn set_speed(&mut self, speed: Speed, wall: WallInstant) {
        if self.speed.finite().is_some() {
            self.advance(wall);
        } else {
            self.jump_to_displayed(wall);
        }
        self.speed = speed;
    }

    fn advance(&mut self, wall: WallInstant) {
        self.position += wall.saturating_duration_since(self.wall).as_secs_f64() * self.speed.0;
        self.wall = wall;
    }

    fn jump_to_displayed(&mut self, wall: WallInstant) {
        self.position = self.shown.seconds();
        self.wall = wall;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns an instant of simulated time.
    fn at(seconds: f64) -> Instant {
        Instant::START + Span::from_seconds(seconds)
    }

    /// Returns a started clock of the given speed, with a period of 0.1 s.
    fn clock(speed: &str) -> (Clock, WallInstant) {
        let wall = WallInstant::now();
        let speed = speed.parse().expect("a speed");
        let mut clock = Clock::new(speed, Span::from_seconds(0.1), wall);
        assert_eq!(clock.wait(at(0.0), wall), Some(POLL_PERIOD), "it has not begun");
        clock.begin(wall);
        assert_eq!(clock.wait(at(0.0), wall), None);
        (clock, wall)
    }

    /// Returns the milliseconds to wait, rounded.
    fn ms(clock: &mut Clock, seconds: f64, wall: WallInstant) -> Option<u64> {
        clock.wait(at(seconds), wall).map(|time| (time.as_secs_f64() * 1e3).round() as u64)
    }

    #[test]
    fn time_goes_by_the_wall_and_the_speed() {
        let (mut clock, wall) = clock("10");
        let after = |ms| wall + Duration::from_millis(ms);
        assert_eq!(ms(&mut clock, 0.1, after(4)), Some(6));
        assert_eq!(ms(&mut clock, 0.1, after(10)), None);
        clock.set_speed(Speed::REAL, after(10));
        assert_eq!(ms(&mut clock, 0.12, after(20)), Some(10));
        clock.set_speed("max".parse().expect("a speed"), after(20));
        assert_eq!(clock.wait(at(1e3), after(20)), None);
        clock.set_speed(Speed::REAL, after(20));
        assert_eq!(ms(&mut clock, 1e3 + 0.02, after(30)), Some(10));
    }

    #[test]
    fn a_paused_run_goes_on_by_steps() {
        let (mut clock, wall) = clock("max");
        assert_eq!(clock.wait(at(0.15), wall), None);
        clock.pause();
        assert_eq!(clock.wait(at(0.15), wall), None, "the same instant");
        assert_eq!(clock.wait(at(0.16), wall), Some(POLL_PERIOD));
        clock.step();
        assert_eq!(clock.wait(at(0.16), wall), None);
        assert_eq!(clock.wait(at(0.2), wall), None);
        assert_eq!(clock.wait(at(0.21), wall), Some(POLL_PERIOD));
        clock.step();
        clock.step();
        assert_eq!(clock.wait(at(0.4), wall), None);
        assert_eq!(clock.wait(at(0.41), wall), Some(POLL_PERIOD));
        clock.resume(wall);
        assert_eq!(clock.wait(at(9.0), wall), None);
    }

    #[test]
    fn a_pause_takes_no_simulated_time() {
        let (mut clock, wall) = clock("1");
        clock.pause();
        clock.resume(wall + Duration::from_secs(60));
        assert_eq!(ms(&mut clock, 0.01, wall + Duration::from_secs(60)), Some(10));
    }

    #[test]
    fn what_was_missed_is_not_caught_up() {
        let (mut clock, wall) = clock("1");
        let late = wall + Duration::from_secs(60);
        assert_eq!(clock.wait(at(0.1), late), None);
        assert_eq!(clock.wait(at(0.2), late), None);
        assert!(clock.wait(at(0.3), late).is_some());
    }
}
