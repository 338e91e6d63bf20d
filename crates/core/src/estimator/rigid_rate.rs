//! The rigid rates of a spatial body: predicted by the jets' pulses, corrected a little by the gyro.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::{Finite, Fraction};

/// w^(n) = w^- + l (y - w^-), w^- = w^(n-1) + du: for what is no pulse a low pass of T/l seconds, so that the elastic part
/// of the gyro's rates is mostly left out. It is the observer of seed paper 4 with its modes left out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigidRate {
    /// Part l of the innovation by which each sample corrects the rate.
    pub correction: Fraction,
    /// What the rates are believed to be before the first sample (rad/s).
    #[serde(default)]
    pub rate: [Finite; 3],
}

/// The estimator at work.
#[derive(Clone, Debug, PartialEq)]
pub struct RateFilter {
    correction: f64,
    rate: [f64; 3],
}

impl RigidRate {
    /// The estimator at the start of a run.
    pub fn filter(&self) -> RateFilter {
        RateFilter { correction: self.correction.get(), rate: self.rate.map(Finite::get) }
    }
}

impl RateFilter {
    /// Takes the measured rates (rad/s), and the changes of the rigid rates that the pulses since the last sample have
    /// made (rad/s); returns the estimated rigid rates.
    pub fn step(&mut self, measured: [f64; 3], pushed: [f64; 3]) -> [f64; 3] {
        for axis in 0..3 {
            let predicted = self.rate[axis] + pushed[axis];
            self.rate[axis] = predicted + self.correction * (measured[axis] - predicted);
        }
        self.rate
    }
}
