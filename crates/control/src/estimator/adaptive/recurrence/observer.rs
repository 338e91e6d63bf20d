//! Run-time state of the recurrence observer.

use super::super::oscillator::{ModeVector, OscillatorModel};
use super::super::residual::MovingResidual;
use super::super::tracker::{self, Tracker};
use super::super::{AdaptiveObserver, ModeEstimate, Pulse};
use super::Recurrence;

/// Weight of a sample in the mean square of the elastic rate.
const WEIGHT: f64 = 0.01;
/// Fraction of the largest rate increment from which a jump of the increments counts as a switching.
const SWITCHING: f64 = 0.5;
/// Innovation (rad/s) above which a measurement is rejected.
const FARTHEST: f64 = 10.0;
/// Limit of valid state values; its square is still finite.
const HUGE: f64 = 1e100;

impl Recurrence {
    /// Creates the observer of a channel with one mode and one input, its own thrusters. The tracker must be
    /// consistent.
    pub fn observer(&self, tracker: &Tracker, period: f64) -> RecurrenceObserver {
        let mode = OscillatorModel { frequency: tracker.frequency.get(), damping: self.damping.get() };
        let influence = tracker.influence.first().map_or(0.0, |influence| influence.get());
        let shrink = libm::exp(-mode.damping * mode.frequency * period);
        let root = f64::sqrt((1.0 - mode.damping) * (1.0 + mode.damping));
        let [low, high] = tracker::bounds(std::slice::from_ref(tracker), self.reach.get(), period)[0];
        let [a, b] = self.influence_bounds.map(|bound| bound.get() * influence);
        RecurrenceObserver {
            spec: self.clone(),
            period,
            shrink,
            turn: 2.0 * shrink * libm::cos(mode.frequency * root * period),
            // A decreases with the frequency.
            turn_bounds: [high, low].map(|bound| 2.0 * shrink * libm::cos(bound * period)),
            influence,
            influence_bounds: [a.min(b), a.max(b)],
            motion: RecurrenceState::default(),
            residual: MovingResidual::default(),
        }
    }
}

/// Run-time state of the recurrence observer.
#[derive(Clone, Debug)]
pub struct RecurrenceObserver {
    spec: Recurrence,
    period: f64,
    /// Square root of B.
    shrink: f64,
    /// Coefficient A, and its bounds.
    turn: f64,
    turn_bounds: [f64; 2],
    influence: f64,
    influence_bounds: [f64; 2],
    motion: RecurrenceState,
    residual: MovingResidual,
}

/// State variables apart from the parameters; n is the last sample.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
struct RecurrenceState {
    /// Rigid rate (rad/s), predicted before a sample and corrected after it.
    rate: f64,
    /// Elastic rate g(n), predicted and corrected likewise, and g(n - 1) (rad/s).
    elastic: f64,
    elastic_before: f64,
    /// Change of the rigid rate by the pulses in the cycle before the sample, and in the one before that (rad/s).
    push: f64,
    push_before: f64,
    /// Largest absolute change of the rigid rate in a cycle (rad/s).
    push_largest: f64,
    /// Excitation that multiplies the influence (rad/s).
    driven: f64,
    /// Correction that the weight W3 or W7 subtracts from the next prediction (rad/s).
    correction: f64,
    /// Mean square of the elastic rate ((rad/s)²).
    square: f64,
}

impl RecurrenceState {
    fn is_sound(&self) -> bool {
        let Self { rate, elastic, elastic_before, push, push_before, driven, correction, square, .. } = self;
        [rate, elastic, elastic_before, push, push_before, driven, correction, square]
            .into_iter()
            .all(|n| n.abs() < HUGE)
    }
}

impl RecurrenceObserver {
    fn sound(pulses: &[Pulse]) -> impl Iterator<Item = &Pulse> {
        pulses.iter().filter(|pulse| pulse.input == 0 && pulse.is_valid())
    }

    fn oscillator(&self) -> OscillatorModel {
        let frequency = libm::acos(self.turn / (2.0 * self.shrink)) / self.period;
        OscillatorModel { frequency, damping: self.spec.damping.get() }
    }

    /// Returns the state [g, s] from g(n), g(n - 1) and the impulse at sample n.
    fn phase(&self) -> ModeVector {
        let RecurrenceState { elastic, elastic_before, push, .. } = self.motion;
        let back = self.oscillator().transition(-self.period)[0];
        [elastic, (elastic_before - back[0] * (elastic - self.influence * push)) / back[1]]
    }

    fn learn(&mut self, innovation: f64, active: bool) {
        let RecurrenceState { elastic_before, push, push_before, push_largest, driven, square, .. } =
            self.motion;
        let amplitude = f64::sqrt(2.0 * square);
        if !active && amplitude > self.spec.gate.get() && elastic_before != 0.0 {
            let step = self.spec.frequency_gain.get() / amplitude * elastic_before.signum() * innovation;
            self.turn = stepped(self.turn, step, self.turn_bounds);
        }
        // A long burn resembles a rigid rate: only its start and its end show the influence.
        if (push - push_before).abs() >= SWITCHING * push_largest && driven != 0.0 {
            let step = self.spec.influence_gain.get() / driven * innovation;
            self.influence = stepped(self.influence, step, self.influence_bounds);
        }
    }

    /// Resets a state that is not finite, and keeps the parameters.
    fn stay_finite(&mut self) {
        if !self.motion.is_sound() {
            self.motion = RecurrenceState::default();
        }
    }
}

fn stepped(value: f64, step: f64, [low, high]: [f64; 2]) -> f64 {
    if step.is_finite() { (value + step).clamp(low, high) } else { value }
}

impl AdaptiveObserver for RecurrenceObserver {
    fn update(&mut self, measured: f64) {
        let innovation = measured - self.motion.rate - self.motion.elastic;
        if innovation.is_nan() || innovation.abs() > FARTHEST {
            self.motion.correction = 0.0;
            self.residual.update(None, self.motion.elastic);
            return;
        }
        let active = self.motion.push != 0.0;
        let weights = if active { self.spec.active } else { self.spec.coast };
        self.motion.rate += weights.rigid.get() * innovation;
        self.motion.elastic += weights.elastic.get() * innovation;
        self.motion.correction = weights.next.get() * innovation;
        self.motion.square += WEIGHT * (self.motion.elastic * self.motion.elastic - self.motion.square);
        self.learn(innovation, active);
        self.stay_finite();
        self.residual.update(Some(innovation), self.motion.elastic);
    }

    fn advance(&mut self, pulses: &[Pulse]) {
        let RecurrenceState { elastic, elastic_before, push, .. } = self.motion;
        let next: f64 = Self::sound(pulses).map(|pulse| pulse.acceleration * pulse.duration).sum();
        let driven = next - 0.5 * self.turn * push;
        let motion = &mut self.motion;
        motion.rate += next;
        motion.elastic = self.turn * elastic - self.shrink * self.shrink * elastic_before
            + self.influence * driven
            - motion.correction;
        motion.elastic_before = elastic;
        (motion.push_before, motion.push, motion.driven) = (push, next, driven);
        motion.push_largest = motion.push_largest.max(next.abs());
        self.stay_finite();
    }

    fn predict(&self, ahead: f64, pulses: &[Pulse]) -> Vec<f64> {
        let oscillator = self.oscillator();
        let free = oscillator.propagate(&oscillator.transition(ahead), ahead, self.phase()).0[0];
        let pushed = Self::sound(pulses).map(|pulse| {
            let (began, ended) = (ahead - pulse.start, ahead - pulse.start - pulse.duration);
            self.influence * pulse.acceleration * oscillator.pulse_response(began, ended).0[0]
        });
        vec![free + pushed.sum::<f64>()]
    }

    fn rate(&self) -> f64 {
        self.motion.rate
    }

    fn put_modes(&self, modes: &mut Vec<ModeEstimate>) {
        modes.clear();
        modes.push(ModeEstimate {
            phase: self.phase(),
            frequency: self.oscillator().frequency,
            influence: vec![self.influence],
        });
    }

    fn residual(&self) -> MovingResidual {
        self.residual
    }
}
