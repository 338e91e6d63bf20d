//! Run-time state of the gradient observer.

use flexsc_numerics::quantity::Fraction;

use super::super::oscillator::{ModeVector, OscillatorModel};
use super::super::residual::MovingResidual;
use super::super::tracker::{self, Tracker};
use super::super::{AdaptiveObserver, ModeEstimate, Pulse, is_above};
use super::Gradient;
use super::parameter::{ChannelState, Parameter};

/// Largest step of ln w, and of an influence relative to its initial value.
const STEP: f64 = 0.02;
/// Innovation (rad/s) above which a measurement is rejected.
const FARTHEST: f64 = 10.0;
/// Default gain of a single mode, and of one of several.
const ELASTIC_GAIN: [f64; 2] = [0.15, 0.1];

impl Gradient {
    /// Creates the observer of a channel. `rigid` is the change of its rigid rate by each input, per unit of the change
    /// about the input's own axis (1 for the channel's own thrusters). The trackers must be consistent.
    pub fn observer(&self, trackers: &[Tracker], rigid: &[f64], period: f64) -> GradientObserver {
        let (modes, inputs) = (trackers.len(), rigid.len());
        let gain = ELASTIC_GAIN[usize::from(modes > 1)];
        let gate = self.gate.get();
        let rest = || ChannelState { rate: 0.0, phases: vec![[0.0; 2]; modes] };
        let mut parameters = Vec::with_capacity(modes * (1 + inputs));
        for (tracker, bounds) in trackers.iter().zip(tracker::bounds(trackers, self.reach.get(), period)) {
            parameters.push(Parameter {
                value: libm::log(tracker.frequency.get()),
                bounds: bounds.map(libm::log),
                step: STEP,
                floor: gate * gate,
                power: 0.0,
                slope: rest(),
            });
        }
        for influence in trackers.iter().flat_map(|tracker| tracker.influence.iter().map(|i| i.get())) {
            let [a, b] = self.influence_bounds.map(|bound| bound.get() * influence);
            // An influence of 0 stays 0: it has no scale for its identification.
            let size = influence.abs();
            let floor = if size > 0.0 { gate / size } else { f64::INFINITY };
            parameters.push(Parameter {
                value: influence,
                bounds: [a.min(b), a.max(b)],
                step: STEP * size,
                floor: floor * floor,
                power: 0.0,
                slope: rest(),
            });
        }
        GradientObserver {
            damping: self.damping.get(),
            gains: [self.rigid_gain.get(), self.elastic_gain.map_or(gain, Fraction::get)],
            learning: self.rate.get(),
            gate,
            rigid: rigid.to_vec(),
            period,
            motion: rest(),
            frequencies: parameters[..modes].iter().map(|parameter| libm::exp(parameter.value)).collect(),
            transitions: vec![None; modes],
            parameters,
            residual: MovingResidual::default(),
        }
    }
}

/// Run-time state of a gradient observer.
#[derive(Clone, Debug)]
pub struct GradientObserver {
    damping: f64,
    /// Gain of the rigid rate, and that of each elastic rate.
    gains: [f64; 2],
    learning: f64,
    gate: f64,
    /// Change of the rigid rate by each input, per unit of the change about the input's own axis.
    rigid: Vec<f64>,
    period: f64,
    motion: ChannelState,
    /// Natural frequency w of each mode (rad/s).
    frequencies: Vec<f64>,
    /// Transition of each mode over a period; `None` if the frequency has changed since it was last computed.
    transitions: Vec<Option<[ModeVector; 2]>>,
    /// ln w of each mode, then the influences of each input on the first mode, on the second, ...
    parameters: Vec<Parameter>,
    residual: MovingResidual,
}

impl GradientObserver {
    /// Returns the derivatives of the predicted measurement with respect to the parameters (rad/s per unit): ln w of
    /// each mode, then the influences of the inputs on the first mode, and so on.
    pub fn sensitivities(&self) -> Vec<f64> {
        self.parameters.iter().map(|parameter| parameter.slope.measured()).collect()
    }

    fn oscillator(&self, mode: usize) -> OscillatorModel {
        OscillatorModel { frequency: self.frequencies[mode], damping: self.damping }
    }

    /// Returns the index of the first influence on a mode.
    fn influences(&self, mode: usize) -> usize {
        self.motion.phases.len() + mode * self.rigid.len()
    }

    fn sound<'a>(&self, pulses: &'a [Pulse]) -> impl Iterator<Item = &'a Pulse> + use<'a> {
        let inputs = self.rigid.len();
        pulses.iter().filter(move |pulse| pulse.input < inputs && pulse.is_valid())
    }

    /// Propagates one mode and its derivatives over a cycle.
    fn turn(&mut self, mode: usize, pulses: &[Pulse]) {
        let oscillator = self.oscillator(mode);
        let (period, first) = (self.period, self.influences(mode));
        let transition = *self.transitions[mode].get_or_insert_with(|| oscillator.transition(period));
        let (mut phase, mut by_frequency) =
            oscillator.propagate(&transition, period, self.motion.phases[mode]);
        for parameter in &mut self.parameters {
            let slope = &mut parameter.slope.phases[mode];
            *slope = oscillator.propagate(&transition, period, *slope).0;
        }
        for pulse in self.sound(pulses) {
            let (began, ended) = (period - pulse.start, period - pulse.start - pulse.duration);
            let (push, slope) = oscillator.pulse_response(began, ended);
            let parameter = &mut self.parameters[first + pulse.input];
            for axis in 0..2 {
                let pushed = push[axis] * pulse.acceleration;
                parameter.slope.phases[mode][axis] += pushed;
                phase[axis] += parameter.value * pushed;
                by_frequency[axis] += parameter.value * slope[axis] * pulse.acceleration;
            }
        }
        self.motion.phases[mode] = phase;
        for (slope, added) in self.parameters[mode].slope.phases[mode].iter_mut().zip(by_frequency) {
            *slope += added;
        }
    }

    /// Resets a state that is not finite, and keeps the parameters.
    fn stay_finite(&mut self) {
        if !(self.motion.is_finite() && self.parameters.iter().all(|parameter| parameter.slope.is_finite())) {
            self.motion.reset();
            for parameter in &mut self.parameters {
                parameter.slope.reset();
                parameter.power = 0.0;
            }
        }
    }
}

impl AdaptiveObserver for GradientObserver {
    fn update(&mut self, measured: f64) {
        let innovation = measured - self.motion.measured();
        if innovation.is_nan() || innovation.abs() > FARTHEST {
            self.residual.update(None, self.motion.elastic());
            return;
        }
        let modes = self.motion.phases.len();
        for (index, parameter) in self.parameters.iter_mut().enumerate() {
            let sensitivity = parameter.slope.measured();
            parameter.update_scale(sensitivity);
            let phase = self.motion.phases.get(index);
            let excited = phase.is_none_or(|phase| is_above(phase, self.gate));
            if index >= modes || excited {
                let before = parameter.value;
                parameter.gradient_step(sensitivity, innovation, self.learning);
                if index < modes && parameter.value != before {
                    self.frequencies[index] = libm::exp(parameter.value);
                    self.transitions[index] = None;
                }
            }
            parameter.slope.correct(self.gains, -sensitivity);
        }
        // A bounded innovation cannot make the state invalid at once: validity is checked after the cycle.
        self.motion.correct(self.gains, innovation);
        self.residual.update(Some(innovation), self.motion.elastic());
    }

    fn advance(&mut self, pulses: &[Pulse]) {
        for mode in 0..self.motion.phases.len() {
            self.turn(mode, pulses);
        }
        for pulse in self.sound(pulses) {
            self.motion.rate += self.rigid[pulse.input] * pulse.acceleration * pulse.duration;
        }
        self.stay_finite();
    }

    fn predict(&self, ahead: f64, pulses: &[Pulse]) -> Vec<f64> {
        let from_mode = |(mode, phase): (usize, &ModeVector)| {
            let (oscillator, first) = (self.oscillator(mode), self.influences(mode));
            let free = oscillator.propagate(&oscillator.transition(ahead), ahead, *phase).0[0];
            let pushed = self.sound(pulses).map(|pulse| {
                let (began, ended) = (ahead - pulse.start, ahead - pulse.start - pulse.duration);
                self.parameters[first + pulse.input].value
                    * pulse.acceleration
                    * oscillator.pulse_response(began, ended).0[0]
            });
            free + pushed.sum::<f64>()
        };
        self.motion.phases.iter().enumerate().map(from_mode).collect()
    }

    fn rate(&self) -> f64 {
        self.motion.rate
    }

    fn put_modes(&self, modes: &mut Vec<ModeEstimate>) {
        modes.resize_with(self.motion.phases.len(), ModeEstimate::default);
        for (index, (mode, phase)) in modes.iter_mut().zip(&self.motion.phases).enumerate() {
            let first = self.influences(index);
            let influences = &self.parameters[first..first + self.rigid.len()];
            (mode.phase, mode.frequency) = (*phase, self.frequencies[index]);
            mode.influence.clear();
            mode.influence.extend(influences.iter().map(|parameter| parameter.value));
        }
    }

    fn residual(&self) -> MovingResidual {
        self.residual
    }
}
