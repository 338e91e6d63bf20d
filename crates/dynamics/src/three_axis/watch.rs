//! Search for the first instant at which a rotor stops or breaks away; no event is missed.
//!
//! Over a grid step the second derivative of a margin (a rotor's speed, or the unused holding torque of its bearing)
//! is bounded by M (`bounds.rs`). Over a part d of the step the margin is therefore at least the smaller of its end
//! values less M d²/8. Where this is not positive the part is halved, until it is, or the margin is monotonic and has
//! one zero. Steps are those of the grid, whatever is observed, so that the event's instant does not depend on
//! observations.

use super::bearing::SlipDirection;
use super::flow::ThreeAxisMotion;
use super::model::Surroundings;
use super::state::NextStep;

/// Offset that separates the initial margin 0 of a rotor that breaks away from rounding (rad/s).
const SPARE: f64 = 1e-12;

/// Shortest part of a step (s): the resolution of an event's instant.
const TICK: f64 = 1e-15;

/// Event function that must stay positive.
#[derive(Copy, Clone, Debug)]
enum EventMargin {
    /// Speed of a rotor (rad/s), in its direction of slip.
    Speed(usize, f64),
    /// Unused holding torque of a rotor's bearing (N m), in one direction.
    Grip(usize, f64),
}

type SearchInterval<'a> = Option<(&'a dyn Surroundings, f64)>;

impl ThreeAxisMotion {
    /// Returns true if any rotor can stick.
    pub(super) fn can_stick(&self) -> bool {
        self.bearings.iter().zip(&self.acting.rotors).any(|(bearing, _)| bearing.can_stick())
    }

    /// Computes the next grid step and searches it for the first stick-slip event, unless this was done before.
    pub(super) fn search_next_step(&mut self, level: usize, around: SearchInterval) {
        if self.ahead.as_ref().is_some_and(|ahead| ahead.from == self.reached) {
            return;
        }
        let from = self.reached;
        let mut to = self.ahead.take().map_or_else(|| self.grid.clone(), |ahead| ahead.to);
        to.copy_from(&self.grid);
        let Some(h) = self.advance_grid(level, &mut to, around) else { return };
        self.here.copy_from(&self.grid);
        self.now = from;
        self.look();
        let margins = self.margins();
        let bounds = self.bounds(h, around);
        let starts: Vec<f64> = margins.iter().map(|margin| self.margin(*margin, around)).collect();
        self.here.copy_from(&to);
        self.now = from + h;
        self.look();
        let ends: Vec<f64> = margins.iter().map(|margin| self.margin(*margin, around)).collect();
        let mut meets: Option<(f64, usize)> = None;
        for ((margin, start), end) in margins.into_iter().zip(starts).zip(ends) {
            let (index, most) = match margin {
                EventMargin::Speed(index, _) => (index, bounds.jerk_of(index)),
                EventMargin::Grip(index, _) => (index, bounds.third * self.bearings[index].inertia),
            };
            // A rotor that has just broken away stops again only if its speed reverses by more than rounding.
            let spare =
                if let (EventMargin::Speed(..), true) = (margin, start < SPARE) { SPARE } else { 0.0 };
            let margin = (margin, spare, most);
            if let Some(t) = self.first(margin, (0.0, start + spare), (h, end + spare), around) {
                let at = from + t;
                if meets.is_none_or(|(before, _)| at < before) {
                    meets = Some((at, index));
                }
            }
        }
        self.ahead = Some(NextStep { from, to, meets });
    }

    fn margins(&self) -> Vec<EventMargin> {
        let gripped = (0..self.acting.rotors.len().min(self.bearings.len()))
            .filter(|of| self.bearings[*of].can_stick());
        let of = |index: usize| match self.slips[index] {
            SlipDirection::Stuck => vec![EventMargin::Grip(index, 1.0), EventMargin::Grip(index, -1.0)],
            slip => vec![EventMargin::Speed(index, slip.sign())],
        };
        gripped.flat_map(of).collect()
    }

    /// Evaluates a margin at the current instant.
    fn margin(&self, margin: EventMargin, around: SearchInterval) -> f64 {
        let bearings_now = self.current_bearings(&self.slips);
        match margin {
            EventMargin::Speed(index, sign) => {
                sign * bearings_now.speed(index, self.here.spins[index].sums.x, &self.seen.rate)
            }
            EventMargin::Grip(index, sign) => {
                let (bearing, rotor) = (&self.bearings[index], &self.acting.rotors[index]);
                let along = rotor.axis.dot(&self.acceleration(&self.slips, around));
                bearing.breakaway - sign * (rotor.torque - bearing.inertia * along)
            }
        }
    }

    /// Returns the first zero of a margin between two instants of the step; `most` bounds its second derivative.
    fn first(
        &mut self,
        (margin, spare, most): (EventMargin, f64, f64),
        low: (f64, f64),
        high: (f64, f64),
        around: SearchInterval,
    ) -> Option<f64> {
        let width = high.0 - low.0;
        if low.1.min(high.1) > most * width * width / 8.0 {
            return None;
        }
        let (slope, bend) = ((high.1 - low.1) / width, most * width);
        if slope > bend || width <= TICK {
            // The margin rises throughout, from 0 where a rotor has just broken away.
            return (slope <= bend && high.1 <= 0.0).then_some(high.0);
        }
        if slope < -bend {
            return (high.1 <= 0.0).then(|| self.zero((margin, spare), low, high, around));
        }
        let middle = low.0 + 0.5 * width;
        let value = self.margin_at((margin, spare), middle, around);
        let before = self.first((margin, spare, most), low, (middle, value), around);
        before.or_else(|| self.first((margin, spare, most), (middle, value), high, around))
    }

    /// Returns the zero of a decreasing margin between two instants, by regula falsi (Illinois).
    fn zero(
        &mut self,
        margin: (EventMargin, f64),
        mut low: (f64, f64),
        mut high: (f64, f64),
        around: SearchInterval,
    ) -> f64 {
        if low.1 <= 0.0 {
            return low.0;
        }
        let mut side = 0;
        for _ in 0..100 {
            let at = low.0 + (high.0 - low.0) * low.1 / (low.1 - high.1);
            if high.0 - low.0 <= TICK || at <= low.0 || at >= high.0 {
                break;
            }
            let value = self.margin_at(margin, at, around);
            if value > 0.0 {
                low = (at, value);
                if side == 1 {
                    high.1 *= 0.5;
                }
                side = 1;
            } else {
                high = (at, value);
                if side == -1 {
                    low.1 *= 0.5;
                }
                side = -1;
                if value == 0.0 {
                    break;
                }
            }
        }
        high.0
    }

    fn margin_at(&mut self, (margin, spare): (EventMargin, f64), t: f64, around: SearchInterval) -> f64 {
        self.step_off_grid(t, around);
        self.margin(margin, around) + spare
    }

    /// Marks the rotor that stops or breaks away at the current instant; `settle` resolves its state.
    pub fn set_event(&mut self) {
        if let Some((_, index)) = self.ahead.take().and_then(|ahead| ahead.meets) {
            self.resting[index] = true;
        }
    }
}
