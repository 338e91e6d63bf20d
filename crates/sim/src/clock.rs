//! Clock of a run: the current instant and the end, the cycles of a three-axis body, and the limits of chatter.

use flexsc_numerics::time::{Instant, Span};

use super::SimulationError;
use crate::relay_setup::{self, SWITCHINGS};
use flexsc_scenario::Scenario;

/// Largest number of decisions at one instant, and of bearing events within a nanosecond; more are chatter, because no
/// scenario needs more than a few.
const MOST_DECISIONS: u32 = 32;

/// Current instant of a run, with counters of decisions, switchings and bearing events, whose excess is chatter.
#[derive(Clone, Debug)]
pub struct Clock {
    now: Instant,
    end: Instant,
    /// Period at which a three-axis run is assessed and logged: that of the law, else of the sensors, else 1 s; `None` for
    /// one axis.
    cycle_period: Option<Span>,
    /// Instant of the next cycle.
    next_cycle: Option<Instant>,
    decisions_at_now: u32,
    /// Number of switchings in the current window of switchings, and the start of that window.
    switchings: (u64, Instant),
    /// Shortest duration of a window of switchings (s) that is not chatter.
    shortest_window: f64,
    /// True if a wheel in bearings has stuck or let go at the current instant.
    bearing_event: bool,
    /// Number of bearing events within a nanosecond, and the instant of the first.
    recent_bearing_events: (u32, Instant),
}

impl Clock {
    /// Creates the clock of a scenario's run, at its start.
    pub fn new(scenario: &Scenario) -> Self {
        Self {
            now: Instant::START,
            end: Instant::START + scenario.duration,
            cycle_period: scenario.model.three_axis().map(|_| scenario.study.assessment_period),
            next_cycle: None,
            decisions_at_now: 0,
            switchings: (0, Instant::START),
            shortest_window: relay_setup::shortest_window(scenario.model.frequencies().fold(0.0, f64::max)),
            bearing_event: false,
            recent_bearing_events: (0, Instant::START),
        }
    }

    /// Returns the current instant.
    #[inline]
    pub fn now(&self) -> Instant {
        self.now
    }

    /// Returns the end of the run.
    #[inline]
    pub fn end(&self) -> Instant {
        self.end
    }

    /// Advances the clock to `now`, unless it is there.
    #[inline]
    pub fn advance_to(&mut self, now: Instant) {
        if now > self.now {
            self.now = now;
            self.decisions_at_now = 0;
        }
    }

    /// Continues a run of the relay kernel at the instant of its last decision, after `count` switchings since `since`.
    pub fn take_over(&mut self, now: Instant, count: u64, since: Instant) {
        (self.now, self.decisions_at_now) = (now, 1);
        self.switchings = (count, since);
    }

    /// Returns true if the run is at its start and no law has decided there again.
    pub fn is_at_start(&self) -> bool {
        self.now == Instant::START && self.decisions_at_now == 0
    }

    /// Begins the cycles of a three-axis body; the first cycle is due at the current instant.
    pub fn begin_cycles(&mut self) {
        self.next_cycle = self.cycle_period.map(|_| self.now);
    }

    /// Returns the instant of the next cycle; `None` for one axis.
    #[inline]
    pub fn next_cycle(&self) -> Option<Instant> {
        self.next_cycle
    }

    /// Returns true if a cycle is due now.
    #[inline]
    pub fn cycle_is_due(&self) -> bool {
        self.next_cycle == Some(self.now)
    }

    /// Schedules the next cycle, after the one that is due now.
    #[inline]
    pub fn end_cycle(&mut self) {
        self.next_cycle = self.cycle_period.map(|cycle| self.now + cycle);
    }

    /// Counts a decision at the current instant; fails if the laws decide there without end.
    #[inline]
    pub fn count_decision(&mut self) -> Result<(), SimulationError> {
        self.decisions_at_now += 1;
        if self.decisions_at_now > MOST_DECISIONS {
            return Err(SimulationError::Chatter { at: self.now, count: self.decisions_at_now });
        }
        Ok(())
    }

    /// Counts a switching; fails if the law switches without end.
    pub fn count_switching(&mut self) -> Result<(), SimulationError> {
        let (count, since) = &mut self.switchings;
        *count += 1;
        if *count < SWITCHINGS {
            return Ok(());
        }
        let lasted = self.now.since(*since).seconds();
        (*count, *since) = (0, self.now);
        if lasted >= self.shortest_window {
            return Ok(());
        }
        Err(SimulationError::LawChatter { at: self.now, count: SWITCHINGS, span: self.shortest_window })
    }

    /// Counts an event at `at` at which a wheel sticks or lets go; fails if such events chatter.
    pub fn count_bearing_event(&mut self, at: Instant) -> Result<(), SimulationError> {
        let (count, since) = &mut self.recent_bearing_events;
        if at.since(*since).seconds() > 1e-9 {
            (*count, *since) = (0, at);
        }
        *count += 1;
        if *count > MOST_DECISIONS {
            return Err(SimulationError::WheelChatter { at, count: *count });
        }
        self.bearing_event = true;
        Ok(())
    }

    /// Returns true if a wheel has stuck or let go at the current instant, and no segment has begun since.
    pub fn has_bearing_event(&self) -> bool {
        self.bearing_event
    }

    /// Returns true once after a wheel has stuck or let go.
    #[inline]
    pub fn take_bearing_event(&mut self) -> bool {
        std::mem::take(&mut self.bearing_event)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clock() -> Clock {
        let text = "duration = 10.0\n[law.open]\n[body.planar]\ninertia = 2.0";
        Clock::new(&Scenario::parse("clock.toml", text).expect("a scenario"))
    }

    fn at(seconds: f64) -> Instant {
        Instant::START + Span::from_seconds(seconds)
    }

    #[test]
    fn decisions_are_limited_at_one_instant_alone() {
        let mut clock = clock();
        for instant in 0..3 {
            clock.advance_to(at(f64::from(instant)));
            for _ in 0..MOST_DECISIONS {
                clock.count_decision().expect("few decisions");
            }
        }
        assert!(matches!(clock.count_decision(), Err(SimulationError::Chatter { count: 33, .. })));
    }

    #[test]
    fn bearing_events_are_limited_within_a_nanosecond() {
        let mut clock = clock();
        for event in 1..100 {
            clock.count_bearing_event(at(f64::from(event) * 1e-6)).expect("far apart");
        }
        for _ in 0..MOST_DECISIONS {
            clock.count_bearing_event(at(1.0)).expect("few events");
        }
        let chatter = clock.count_bearing_event(at(1.0));
        assert!(matches!(chatter, Err(SimulationError::WheelChatter { count: 33, .. })));
        assert!(clock.take_bearing_event() && !clock.has_bearing_event());
    }

    #[test]
    fn switchings_are_limited_within_the_shortest_window() {
        let mut clock = clock();
        clock.advance_to(at(5.0));
        for _ in 0..SWITCHINGS {
            clock.count_switching().expect("five seconds have passed");
        }
        for _ in 1..SWITCHINGS {
            clock.count_switching().expect("the window has not ended");
        }
        assert!(matches!(clock.count_switching(), Err(SimulationError::LawChatter { .. })));
    }
}
