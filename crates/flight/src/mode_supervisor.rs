//! Supervisor of modes of operation: when the conditions of the present mode are tested, and the changes from mode to mode.
//!
//! The caller gives the lists of modes, ends and comparisons, the same at every call.

use crate::mode_condition::{ConditionStep, condition_holds};
use crate::supervised_mode::SupervisedMode;
use crate::ticks::Ticks;

/// Largest number of changes in a second; more are chatter.
pub const MOST_CHANGES: usize = 32;

/// Time in which changes are counted.
const SECOND: Ticks = Ticks { whole: 1, part: 0 };
/// Time that stands for none.
const NEVER: Ticks = Ticks { whole: 0, part: 0 };

/// End of a mode in the list of ends.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SupervisedExit {
    /// Index of the mode that follows.
    pub to: usize,
    /// Index of the first comparison of its condition.
    pub first_step: usize,
    /// Time for which the condition has to hold without a break.
    pub dwell: Ticks,
    /// True if the condition is tested at instants of its own too, and not at the period of the mode alone.
    pub is_exact: bool,
    /// True if one of these instants is known: the time `instant` since the start.
    pub has_instant: bool,
    /// Time since the start at which the condition is tested.
    pub instant: Ticks,
    /// True if the condition held at its last test.
    pub is_held: bool,
    /// Time since which it has held.
    pub since: Ticks,
}

/// Times of the last changes.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ModeChatter {
    /// Times of the last changes, in a ring.
    pub times: [Ticks; 32],
    /// Number of these times.
    pub count: usize,
    /// Index of the oldest one.
    pub oldest: usize,
}

impl ModeChatter {
    /// Before the first change.
    pub const NONE: Self = Self { times: [NEVER; 32], count: 0, oldest: 0 };

    /// Counts a change; returns false, and does not count it, if there were as many in the last second as there may be.
    fn count(&mut self, now: Ticks) -> bool {
        if self.count < MOST_CHANGES {
            self.times[self.count] = now;
            self.count += 1;
            return true;
        }
        if !SECOND.is_before(now.since(self.times[self.oldest])) {
            return false;
        }
        self.times[self.oldest] = now;
        self.oldest = if self.oldest + 1 == MOST_CHANGES { 0 } else { self.oldest + 1 };
        true
    }
}

/// Time of the next test.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ModeDue {
    /// False for a mode without an end that is tested at a known time.
    pub has_time: bool,
    /// Time of the next test.
    pub time: Ticks,
}

impl ModeDue {
    /// Returns the earlier one of this time and another.
    fn earlier(self, time: Ticks) -> Self {
        if self.has_time && !time.is_before(self.time) {
            return self;
        }
        Self { has_time: true, time }
    }
}

/// Result of a test.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ModeTest {
    /// True if the mode has changed: its law starts without a past.
    pub has_changed: bool,
    /// True if an end was met and the mode stays, because it has changed too often in the last second.
    pub is_chattering: bool,
    /// Index of the end that was met, if one was.
    pub exit: usize,
}

/// Supervisor of the modes.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ModeSupervisor {
    /// Index of the present mode.
    pub active: usize,
    /// Time at which it was entered.
    pub entered: Ticks,
    /// Time of the next test at its period.
    pub next: Ticks,
    /// Time of the last test.
    pub tested: Ticks,
    /// Time of the start.
    pub started: Ticks,
    /// Last changes.
    pub chatter: ModeChatter,
}

impl ModeSupervisor {
    /// Returns the supervisor that starts at `now`, in the first mode. The instants of the ends are counted from then on.
    pub fn start(now: Ticks, modes: &mut [SupervisedMode], exits: &mut [SupervisedExit]) -> Self {
        for mode in 0..modes.len() {
            modes[mode].entries = 0;
        }
        for exit in 0..exits.len() {
            exits[exit].instant = exits[exit].instant.plus(now);
        }
        let mut supervisor: Self = Self {
            active: 0,
            entered: now,
            next: now,
            tested: now,
            started: now,
            chatter: ModeChatter::NONE,
        };
        supervisor.enter(now, 0, modes, exits);
        supervisor
    }

    /// Moves all times back with the clock, which was set from the last test to `now`, an earlier time: the mode goes on as if no
    /// time had passed.
    fn follow_clock(&mut self, now: Ticks, exits: &mut [SupervisedExit]) {
        let back: Ticks = self.tested.since(now);
        self.entered = self.entered.since(back);
        self.started = self.started.since(back);
        self.next = self.next.since(back);
        self.tested = now;
        for exit in 0..exits.len() {
            exits[exit].instant = exits[exit].instant.since(back);
            exits[exit].since = exits[exit].since.since(back);
        }
        for change in 0..MOST_CHANGES {
            self.chatter.times[change] = self.chatter.times[change].since(back);
        }
    }

    /// Enters a mode.
    pub fn enter(
        &mut self,
        now: Ticks,
        to: usize,
        modes: &mut [SupervisedMode],
        exits: &mut [SupervisedExit],
    ) {
        if now.is_before(self.tested) {
            self.follow_clock(now, exits);
        }
        self.active = to;
        self.entered = now;
        self.next = now.plus(modes[to].period);
        modes[to].entries += 1;
        for exit in 0..exits.len() {
            exits[exit].is_held = false;
        }
    }

    /// Returns the next time at which conditions are tested, apart from instants that are not in the tables.
    pub fn due(&self, modes: &[SupervisedMode], exits: &[SupervisedExit]) -> ModeDue {
        let mode: SupervisedMode = modes[self.active];
        let mut due: ModeDue = ModeDue { has_time: false, time: NEVER };
        for place in 0..mode.exit_count {
            let exit: SupervisedExit = exits[mode.first_exit + place];
            if !exit.is_exact {
                due = due.earlier(self.next);
            }
            if exit.is_exact && exit.has_instant && self.tested.is_before(exit.instant) {
                due = due.earlier(exit.instant);
            }
            if exit.is_exact && exit.is_held {
                let dwelt: Ticks = exit.since.plus(exit.dwell);
                if self.tested.is_before(dwelt) {
                    due = due.earlier(dwelt);
                }
            }
        }
        due
    }

    /// Tests the conditions of the present mode that are due, in their order, and changes the mode if one is met.
    pub fn test(
        &mut self,
        now: Ticks,
        readings: &[f64],
        modes: &mut [SupervisedMode],
        exits: &mut [SupervisedExit],
        steps: &[ConditionStep],
    ) -> ModeTest {
        if now.is_before(self.tested) {
            self.follow_clock(now, exits);
        }
        let mode: SupervisedMode = modes[self.active];
        let is_sample: bool = !now.is_before(self.next);
        if is_sample {
            self.next = now.plus(mode.period);
        }
        self.tested = now;
        let mode_time: Ticks = now.since(self.entered);
        let run_time: Ticks = now.since(self.started);
        let mut test: ModeTest = ModeTest { has_changed: false, is_chattering: false, exit: 0 };
        let mut is_met: bool = false;
        for place in 0..mode.exit_count {
            let index: usize = mode.first_exit + place;
            let mut exit: SupervisedExit = exits[index];
            if exit.is_exact || is_sample {
                let holds: bool =
                    condition_holds(steps, exit.first_step, mode_time, run_time, readings, modes);
                if holds && !exit.is_held {
                    exit.since = now;
                }
                exit.is_held = holds;
                if holds && !is_met && !now.since(exit.since).is_before(exit.dwell) {
                    is_met = true;
                    test.exit = index;
                }
                exits[index] = exit;
            }
        }
        if !is_met {
            return test;
        }
        let is_counted: bool = self.chatter.count(now);
        if is_counted {
            let to: usize = exits[test.exit].to;
            self.enter(now, to, modes, exits);
        }
        test.has_changed = is_counted;
        test.is_chattering = !is_counted;
        test
    }
}
