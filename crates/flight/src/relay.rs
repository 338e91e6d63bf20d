//! The relay law with dead zone, hysteresis and a timed brake (\[Silaev\], equation (2), corrected).
//!
//! Beyond a boundary of the dead zone a strong torque pushes back until the angle has returned by the
//! hysteresis; then a strong brake lasts `braking_gain` times as long as the push; then a weak torque opposes the
//! motion that is left, until a boundary is reached again.

use crate::guard::Guard;
use crate::ticks::Ticks;

/// State of the relay.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum RelayState {
    /// Before the first boundary.
    Start,
    /// Strong torque back from the right boundary.
    PushFromRight,
    /// Brake after the push from the right.
    BrakeFromRight,
    /// Weak torque after the brake from the right.
    WeakRight,
    /// Strong torque back from the left boundary.
    PushFromLeft,
    /// Brake after the push from the left.
    BrakeFromLeft,
    /// Weak torque after the brake from the left.
    WeakLeft,
}

/// Cause of a decision.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum RelayEvent {
    /// Start of the control.
    Start,
    /// Trip of the first guard.
    FirstGuard,
    /// Trip of the second guard.
    SecondGuard,
    /// Time set by the previous decision.
    Timeout,
}

impl RelayEvent {
    /// Returns the event with a number: 0 the start, 1 and 2 the guards, any other the time.
    pub fn from_number(number: i64) -> Self {
        match number {
            0 => Self::Start,
            1 => Self::FirstGuard,
            2 => Self::SecondGuard,
            _ => Self::Timeout,
        }
    }
}

/// Torque from now on, and the conditions of the next decision.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct RelayCommand {
    /// Torque (N m; rad/s² on a body without inertia).
    pub torque: f64,
    /// True if the next decision is at the time `until`.
    pub has_timeout: bool,
    /// Time of the next decision.
    pub until: Ticks,
    /// Number of guards, of which any trip causes the next decision.
    pub guard_count: usize,
    /// Guards on the angle.
    pub guards: [Guard; 2],
}

/// Relay law about an axis.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct RelayLaw {
    /// Half width of the dead zone (rad).
    pub dead_zone: f64,
    /// Hysteresis (rad): how far back inside a boundary the brake begins.
    pub hysteresis: f64,
    /// Strong torque (N m; rad/s² on a body without inertia).
    pub strong: f64,
    /// Weak torque in the dead zone (N m; rad/s² on a body without inertia).
    pub weak: f64,
    /// Braking gain: duration of the brake per second of the push.
    pub braking_gain: f64,
    /// True if both boundaries of the dead zone push back, false if only the right one does.
    pub is_two_sided: bool,
    /// State after the last decision.
    pub state: RelayState,
    /// Time at which the last push began.
    pub pushed_at: Ticks,
}

impl RelayLaw {
    /// Changes the state by an event at an estimated angle (rad), and returns the command of the new state.
    pub fn decide(&mut self, now: Ticks, event: RelayEvent, angle: f64) -> RelayCommand {
        self.state = self.next(event, angle);
        if matches!(self.state, RelayState::PushFromRight | RelayState::PushFromLeft) {
            self.pushed_at = now;
        }
        self.command(now)
    }

    /// Returns the state after an event.
    fn next(&self, event: RelayEvent, angle: f64) -> RelayState {
        if event == RelayEvent::Start {
            if self.right().holds(angle) {
                return RelayState::PushFromRight;
            }
            if self.is_two_sided && self.left().holds(angle) {
                return RelayState::PushFromLeft;
            }
            return RelayState::Start;
        }
        match self.state {
            RelayState::PushFromRight => RelayState::BrakeFromRight,
            RelayState::BrakeFromRight => RelayState::WeakRight,
            RelayState::PushFromLeft => RelayState::BrakeFromLeft,
            RelayState::BrakeFromLeft => RelayState::WeakLeft,
            // The body leaves the dead zone through the right boundary, the first guard, or the left one.
            RelayState::Start | RelayState::WeakRight | RelayState::WeakLeft => {
                if event == RelayEvent::SecondGuard {
                    RelayState::PushFromLeft
                } else {
                    RelayState::PushFromRight
                }
            }
        }
    }

    /// Returns torque, time-out and guards of the current state, entered at `now`.
    pub fn command(&self, now: Ticks) -> RelayCommand {
        let back: f64 = self.dead_zone - self.hysteresis;
        match self.state {
            RelayState::WeakLeft => self.between_boundaries(-self.weak),
            RelayState::PushFromRight => Self::until_guard(-self.strong, Guard::at_most(back)),
            RelayState::PushFromLeft => Self::until_guard(self.strong, Guard::at_least(-back)),
            RelayState::BrakeFromRight => self.until_braked(self.strong, now),
            RelayState::BrakeFromLeft => self.until_braked(-self.strong, now),
            RelayState::Start | RelayState::WeakRight => self.between_boundaries(self.weak),
        }
    }

    /// Returns a torque (N m) that acts until the angle reaches a boundary.
    fn between_boundaries(&self, torque: f64) -> RelayCommand {
        let guard_count: usize = if self.is_two_sided { 2 } else { 1 };
        let until: Ticks = Ticks { whole: 0, part: 0 };
        RelayCommand { torque, has_timeout: false, until, guard_count, guards: [self.right(), self.left()] }
    }

    /// Returns a torque (N m) that acts until a guard trips.
    fn until_guard(torque: f64, guard: Guard) -> RelayCommand {
        let until: Ticks = Ticks { whole: 0, part: 0 };
        RelayCommand { torque, has_timeout: false, until, guard_count: 1, guards: [guard, guard] }
    }

    /// Returns a torque (N m) that acts for `braking_gain` times the length of the push.
    fn until_braked(&self, torque: f64, now: Ticks) -> RelayCommand {
        let push_duration: f64 = now.since(self.pushed_at).seconds();
        let until: Ticks = now.plus(Ticks::from_seconds(self.braking_gain * push_duration));
        RelayCommand { torque, has_timeout: true, until, guard_count: 0, guards: [self.right(), self.left()] }
    }

    /// Returns the guard of the right boundary.
    fn right(&self) -> Guard {
        Guard::at_least(self.dead_zone)
    }

    /// Returns the guard of the left boundary.
    fn left(&self) -> Guard {
        Guard::at_most(-self.dead_zone)
    }
}

/// Relay law that is polled: at each sample it tests its guards and its time.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct PolledRelay {
    /// Law.
    pub law: RelayLaw,
    /// True after the first sample.
    pub has_started: bool,
    /// Command of the last decision.
    pub command: RelayCommand,
}

impl PolledRelay {
    /// Decides at an event, for an estimated angle (rad).
    pub fn decide(&mut self, now: Ticks, event: RelayEvent, angle: f64) {
        self.has_started = true;
        self.command = self.law.decide(now, event, angle);
    }

    /// Returns the torque (N m) from this sample on, for a measured angle (rad). A guard counts before the time, and one decision
    /// is made in a sample.
    pub fn step(&mut self, now: Ticks, angle: f64) -> f64 {
        if !self.has_started {
            self.has_started = true;
            self.command = self.law.decide(now, RelayEvent::Start, angle);
            return self.command.torque;
        }
        if self.command.guard_count > 0 && self.command.guards[0].holds(angle) {
            self.command = self.law.decide(now, RelayEvent::FirstGuard, angle);
        } else if self.command.guard_count > 1 && self.command.guards[1].holds(angle) {
            self.command = self.law.decide(now, RelayEvent::SecondGuard, angle);
        } else if self.command.has_timeout && !now.is_before(self.command.until) {
            self.command = self.law.decide(now, RelayEvent::Timeout, angle);
        }
        self.command.torque
    }
}
