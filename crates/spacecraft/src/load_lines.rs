//! Lines of a machine at a point: forces and torques at multiples of a frequency that is known to a tolerance.

use std::f64::consts::TAU;

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{Finite, NonNegative, Positive};
use flexsc_numerics::time::Span;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Steps of a run in a period of the highest harmonic.
const STEPS: f64 = 20.0;
/// Largest number of harmonics.
const MOST: usize = 100;
/// Largest tolerance.
const WIDEST: f64 = 0.5;

/// Sinusoidal forces and torques at a point, at multiples of one frequency: a cooler, the step motor of a drive, a bearing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoadLines {
    /// Frequency of the order 1 (rad/s): of the strokes of a cooler, or the speed of a drive or a bearing.
    pub frequency: Positive,
    /// Part of the frequency by which it may differ: linear tools take the worst frequency in this range, each run draws one.
    #[serde(default)]
    pub tolerance: NonNegative,
    /// Steps, or microsteps, of a motor in a turn, of which the orders are multiples.
    #[serde(default = "one")]
    pub steps: Positive,
    /// Harmonics, whose phases are fixed among them.
    pub harmonics: Vec<LoadHarmonic>,
}

/// Harmonic of a machine: a force and a torque times cos(order steps frequency t + phase).
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoadHarmonic {
    /// Order: periods per period of the machine, or per step of a motor; it need not be whole. Two of one order with different phases
    /// make a load that turns.
    pub order: Positive,
    /// Amplitude of the force along x, y and z (N).
    #[serde(default)]
    pub force: [Finite; 3],
    /// Amplitude of the torque about x, y and z (N m).
    #[serde(default)]
    pub torque: [Finite; 3],
    /// Phase (rad).
    #[serde(default)]
    pub phase: Finite,
}

fn one() -> Positive {
    Positive::ONE
}

impl LoadHarmonic {
    /// Returns the amplitudes of the force along and the torque about x, y and z (N, N m).
    pub fn amplitudes(&self) -> [f64; 6] {
        std::array::from_fn(|place| match place {
            0..3 => self.force[place].get(),
            _ => self.torque[place - 3].get(),
        })
    }
}

impl LoadLines {
    /// Returns the frequency of a harmonic when the machine has one (rad/s).
    pub fn multiple(&self, harmonic: &LoadHarmonic) -> f64 {
        harmonic.order.get() * self.steps.get()
    }

    /// Returns the range of the frequency (rad/s).
    pub fn range(&self) -> [f64; 2] {
        [-1.0, 1.0].map(|side| self.frequency.get() * (1.0 + side * self.tolerance.get()))
    }

    /// Returns the time for which a run holds the load.
    pub fn step(&self) -> Span {
        let highest = self.harmonics.iter().map(|harmonic| self.multiple(harmonic)).fold(0.0, f64::max);
        Span::from_seconds(TAU / (STEPS * highest * self.range()[1]))
    }

    /// Checks the lines; returns the inconsistent key and the reason.
    pub fn validate(&self) -> Option<ConfigError> {
        let count = self.harmonics.len();
        if !(1..=MOST).contains(&count) {
            let why = format!("must have from 1 to {MOST} harmonics, got {count}");
            return Some(ConfigError::new("harmonics", why));
        }
        if self.tolerance.get() > WIDEST {
            let why =
                format!("must be at most {WIDEST}, a part of the frequency, got {}", self.tolerance.get());
            return Some(ConfigError::new("tolerance", why));
        }
        let idle = self.harmonics.iter().position(|harmonic| harmonic.amplitudes() == [0.0; 6]);
        let why = "must have a `force` or a `torque`";
        idle.map(|index| ConfigError::new(format!("harmonics[{index}]"), why))
    }
}
