//! A parameter that is identified, and the derivative of the state by it.

use super::super::oscillator::ModelPhase;

/// What a sample weighs in the mean square of a sensitivity.
const WEIGHT: f64 = 0.01;
/// One sample alone makes the mean square at least this part of its own.
const PEAK: f64 = 0.05;
/// Beyond this no number is a motion; its square is still finite.
const HUGE: f64 = 1e100;

/// A state of the channel, or its derivative by a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelState {
    /// Rigid rate.
    pub rate: f64,
    /// Elastic rate and its quadrature, of each mode.
    pub phases: Vec<ModelPhase>,
}

impl ChannelState {
    /// The measured rate.
    pub fn measured(&self) -> f64 {
        self.rate + self.elastic()
    }

    /// The elastic rates, summed.
    pub fn elastic(&self) -> f64 {
        self.phases.iter().map(|phase| phase[0]).sum()
    }

    /// Adds the gains times an innovation.
    pub fn correct(&mut self, gains: [f64; 2], innovation: f64) {
        self.rate += gains[0] * innovation;
        for phase in &mut self.phases {
            phase[0] += gains[1] * innovation;
        }
    }

    /// Whether it can be carried on.
    pub fn is_sound(&self) -> bool {
        // Without a branch for each number: this is asked of every derivative, twice a cycle.
        let tame = |tame: bool, n: &f64| tame & (n.abs() < HUGE);
        self.phases.as_flattened().iter().fold(tame(true, &self.rate), tame)
    }

    /// Begins again from nothing.
    pub fn rest(&mut self) {
        self.rate = 0.0;
        self.phases.fill([0.0; 2]);
    }
}

/// A parameter, and how the prediction depends on it.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Value: ln w, or an influence.
    pub value: f64,
    /// The least and the greatest value.
    pub bounds: [f64; 2],
    /// The largest step.
    pub step: f64,
    /// What is added to the mean square ((rad/s)²).
    pub floor: f64,
    /// Mean square of the prediction's derivative ((rad/s)²).
    pub power: f64,
    /// Derivative of the state by the parameter.
    pub slope: ChannelState,
}

impl Parameter {
    /// Takes a derivative of the prediction into the mean square.
    pub fn weigh(&mut self, sensitivity: f64) {
        let square = sensitivity * sensitivity;
        self.power = (self.power + WEIGHT * (square - self.power)).max(PEAK * square);
    }

    /// A step along the gradient that makes an innovation smaller.
    pub fn learn(&mut self, sensitivity: f64, innovation: f64, rate: f64) {
        let step = rate * sensitivity * innovation / (self.power + self.floor);
        if step.is_finite() {
            self.value =
                (self.value + step.clamp(-self.step, self.step)).clamp(self.bounds[0], self.bounds[1]);
        }
    }
}
