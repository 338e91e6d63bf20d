//! Search for the first instant at which a rotor stops or breaks away; no event is missed.
//!
//! Over a grid step the second derivative of a margin (a rotor's speed, or the unused holding torque of its bearing)
//! is bounded by M (`error_bounds.rs`). Over a part d of the step the margin is therefore at least the smaller of its end
//! values less M d²/8. Where this is not positive the part is halved, until it is, or the margin is monotonic and has
//! one zero. Steps are those of the grid, whatever is observed, so that the event's instant does not depend on
//! observations.

use super::bearing::SlipDirection;
use crate::three_axis::motion::ThreeAxisMotion;
use crate::three_axis::state::NextStep;
use crate::three_axis::surroundings::TimedSurroundings;

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
    HoldingTorque(usize, f64),
}

impl ThreeAxisMotion {
    /// Returns true if any rotor can stick.
    pub(in crate::three_axis) fn can_stick(&self) -> bool {
        self.bearings.iter().zip(&self.loads.rotors).any(|(bearing, _)| bearing.can_stick())
    }

    /// Computes the next grid step and searches it for the first stick-slip event, unless this was done before.
    pub(in crate::three_axis) fn search_next_step(&mut self, level: usize, surroundings: TimedSurroundings) {
        if self.next_step.as_ref().is_some_and(|next_step| next_step.from == self.grid_time) {
            return;
        }
        let from = self.grid_time;
        let mut to = self.next_step.take().map_or_else(|| self.grid.clone(), |next_step| next_step.to);
        to.copy_from(&self.grid);
        std::mem::swap(&mut self.grid, &mut to);
        let advanced = self.advance_grid(level, surroundings);
        std::mem::swap(&mut self.grid, &mut to);
        let Some(h) = advanced else { return };
        self.current.copy_from(&self.grid);
        self.time = from;
        self.update_view();
        let margins = self.margins();
        let bounds = self.bounds(h, surroundings);
        let starts: Vec<f64> = margins.iter().map(|margin| self.margin(*margin, surroundings)).collect();
        self.current.copy_from(&to);
        self.time = from + h;
        self.update_view();
        let ends: Vec<f64> = margins.iter().map(|margin| self.margin(*margin, surroundings)).collect();
        let mut event: Option<(f64, usize)> = None;
        for ((margin, start), end) in margins.into_iter().zip(starts).zip(ends) {
            let (index, bound) = match margin {
                EventMargin::Speed(index, _) => (index, bounds.jerk_bound(index)),
                EventMargin::HoldingTorque(index, _) => (index, bounds.third * self.bearings[index].inertia),
            };
            // A rotor that has just broken away stops again only if its speed reverses by more than rounding.
            let spare =
                if let (EventMargin::Speed(..), true) = (margin, start < SPARE) { SPARE } else { 0.0 };
            let margin = (margin, spare, bound);
            if let Some(t) = self.first_zero(margin, (0.0, start + spare), (h, end + spare), surroundings) {
                let at = from + t;
                if event.is_none_or(|(earlier, _)| at < earlier) {
                    event = Some((at, index));
                }
            }
        }
        self.next_step = Some(NextStep { from, to, event });
    }

    fn margins(&self) -> Vec<EventMargin> {
        let sticking =
            (0..self.loads.rotors.len().min(self.bearings.len())).filter(|of| self.bearings[*of].can_stick());
        let of = |index: usize| match self.slips[index] {
            SlipDirection::Stuck => {
                vec![EventMargin::HoldingTorque(index, 1.0), EventMargin::HoldingTorque(index, -1.0)]
            }
            slip => vec![EventMargin::Speed(index, slip.sign())],
        };
        sticking.flat_map(of).collect()
    }

    /// Evaluates a margin at the current instant.
    fn margin(&self, margin: EventMargin, surroundings: TimedSurroundings) -> f64 {
        let bearings_now = self.current_bearings(&self.slips);
        match margin {
            EventMargin::Speed(index, sign) => {
                sign * bearings_now.speed(index, self.current.rotor_states[index].values.x, &self.view.rate)
            }
            EventMargin::HoldingTorque(index, sign) => {
                let (bearing, rotor) = (&self.bearings[index], &self.loads.rotors[index]);
                let along = rotor.axis.dot(&self.acceleration(&self.slips, surroundings));
                bearing.breakaway - sign * (rotor.torque - bearing.inertia * along)
            }
        }
    }

    /// Returns the first zero of a margin between two instants of the step; `bound` bounds its second derivative.
    fn first_zero(
        &mut self,
        (margin, spare, bound): (EventMargin, f64, f64),
        low: (f64, f64),
        high: (f64, f64),
        surroundings: TimedSurroundings,
    ) -> Option<f64> {
        let width = high.0 - low.0;
        if low.1.min(high.1) > bound * width * width / 8.0 {
            return None;
        }
        let (slope, curvature) = ((high.1 - low.1) / width, bound * width);
        if slope > curvature || width <= TICK {
            // The margin rises throughout, from 0 where a rotor has just broken away.
            return (slope <= curvature && high.1 <= 0.0).then_some(high.0);
        }
        if slope < -curvature {
            return (high.1 <= 0.0).then(|| self.refine_zero((margin, spare), low, high, surroundings));
        }
        let middle = low.0 + 0.5 * width;
        let value = self.margin_at((margin, spare), middle, surroundings);
        let earlier = self.first_zero((margin, spare, bound), low, (middle, value), surroundings);
        earlier.or_else(|| self.first_zero((margin, spare, bound), (middle, value), high, surroundings))
    }

    /// Returns the zero of a decreasing margin between two instants, by regula falsi (Illinois).
    fn refine_zero(
        &mut self,
        margin: (EventMargin, f64),
        mut low: (f64, f64),
        mut high: (f64, f64),
        surroundings: TimedSurroundings,
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
            let value = self.margin_at(margin, at, surroundings);
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

    fn margin_at(
        &mut self,
        (margin, spare): (EventMargin, f64),
        t: f64,
        surroundings: TimedSurroundings,
    ) -> f64 {
        self.step_off_grid(t, surroundings);
        self.margin(margin, surroundings) + spare
    }

    /// Marks the rotor that stops or breaks away at the current instant; `resolve_stick_slip` resolves its state.
    pub fn set_event(&mut self) {
        if let Some((_, index)) = self.next_step.take().and_then(|next_step| next_step.event) {
            self.at_event[index] = true;
        }
    }
}
