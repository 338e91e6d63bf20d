//! A rate gyro about three axes: at a point of the structure, whose elastic motion it sees.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::{Finite, NonNegative};
use crate::random::{Seed, Stream};

/// A gyro that is read once in each cycle of the law: y = w + sum phi_i(r) q_i' + bias + noise, then rounded (seed paper 4).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gyro {
    /// The point of the structure at which it is.
    pub point: String,
    /// Standard deviation of the white noise about each axis (rad/s).
    #[serde(default)]
    pub noise: [NonNegative; 3],
    /// Constant error about each axis (rad/s).
    #[serde(default)]
    pub bias: [Finite; 3],
    /// Quantum of the output about each axis (rad/s); 0 for none.
    #[serde(default)]
    pub resolution: [NonNegative; 3],
}

/// A gyro at work: each axis has a stream of noise of its own.
#[derive(Clone, Debug)]
pub struct Readout {
    gyro: Gyro,
    noise: [Stream; 3],
}

impl Gyro {
    /// The gyro in a run.
    pub fn readout(&self, seed: Seed) -> Readout {
        let noise = ["gyro roll", "gyro pitch", "gyro yaw"].map(|name| seed.stream(name));
        Readout { gyro: self.clone(), noise }
    }
}

impl Readout {
    /// The measurement of true rates at the gyro's point, elastic part included (rad/s).
    pub fn measure(&mut self, rate: [f64; 3]) -> [f64; 3] {
        let Self { gyro, noise } = self;
        std::array::from_fn(|axis| {
            let mut output = rate[axis] + gyro.bias[axis].get();
            let (sd, quantum) = (gyro.noise[axis].get(), gyro.resolution[axis].get());
            if sd > 0.0 {
                output += sd * noise[axis].normal();
            }
            if quantum > 0.0 { libm::round(output / quantum) * quantum } else { output }
        })
    }
}
