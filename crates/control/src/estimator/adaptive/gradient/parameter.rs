//! Identified parameter, and the derivative of the state with respect to it.

use super::super::oscillator::ModeVector;

/// Weight of a sample in the mean square of a sensitivity.
const WEIGHT: f64 = 0.01;
/// Fraction of a single sample's square that is the minimum of the mean square.
const PEAK: f64 = 0.05;
/// Limit of valid state values; its square is still finite.
const HUGE: f64 = 1e100;

/// State of the channel, or its derivative with respect to a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelState {
    /// Rigid rate (rad/s).
    pub rate: f64,
    /// Elastic rate and quadrature of each mode (rad/s).
    pub phases: Vec<ModeVector>,
}

impl ChannelState {
    /// Returns the measured rate: rigid and elastic.
    pub fn measured(&self) -> f64 {
        self.rate + self.elastic()
    }

    /// Returns the sum of the elastic rates.
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

    /// Returns true if all values are finite and of a valid size.
    pub fn is_finite(&self) -> bool {
        // Branch-free, because every derivative is checked twice a cycle.
        let tame = |tame: bool, n: &f64| tame & (n.abs() < HUGE);
        self.phases.as_flattened().iter().fold(tame(true, &self.rate), tame)
    }

    /// Resets the state to 0.
    pub fn reset(&mut self) {
        self.rate = 0.0;
        self.phases.fill([0.0; 2]);
    }
}

/// Parameter and the sensitivity of the prediction to it.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Value: ln w, or an influence.
    pub value: f64,
    /// Smallest and largest value.
    pub bounds: [f64; 2],
    /// Largest step per sample.
    pub step: f64,
    /// Constant added to the mean square ((rad/s)²).
    pub floor: f64,
    /// Mean square of the prediction's derivative ((rad/s)²).
    pub power: f64,
    /// Derivative of the state with respect to the parameter.
    pub slope: ChannelState,
}

impl Parameter {
    /// Updates the mean square with a derivative of the prediction.
    pub fn update_scale(&mut self, sensitivity: f64) {
        let square = sensitivity * sensitivity;
        self.power = (self.power + WEIGHT * (square - self.power)).max(PEAK * square);
    }

    /// Performs a gradient step that reduces the innovation.
    pub fn gradient_step(&mut self, sensitivity: f64, innovation: f64, rate: f64) {
        let step = rate * sensitivity * innovation / (self.power + self.floor);
        if step.is_finite() {
            self.value =
                (self.value + step.clamp(-self.step, self.step)).clamp(self.bounds[0], self.bounds[1]);
        }
    }
}
