//! Sine functions of time, as parts of a torque.

use flexsc_dynamics::waveform::{Term, TermShape};
use flexsc_numerics::quantity::{Finite, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// amplitude sin(frequency t + phase), t from the start of the run.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sine {
    /// Amplitude (N m).
    pub amplitude: Finite,
    /// Frequency (rad/s).
    pub frequency: Positive,
    /// Phase at the start of the run (rad); pi/2 makes a cosine.
    #[serde(default)]
    pub phase: Finite,
}

impl Sine {
    /// Returns the value at a time since the start of the run (s).
    pub fn at(&self, t: f64) -> f64 {
        self.amplitude.get() * libm::sin(self.frequency.get() * t + self.phase.get())
    }

    /// Returns the sine as a term of a waveform between two times (s).
    pub fn term(&self, from: f64, to: f64) -> Term {
        let (amplitude, frequency) = (self.amplitude.get(), self.frequency.get());
        let (sin, cos) = libm::sincos(frequency * from + self.phase.get());
        let shape = TermShape::Harmonic { frequency, cosine: amplitude * sin, sine: amplitude * cos };
        Term { from, to, shape }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexsc_dynamics::waveform::Waveform;

    #[test]
    fn a_term_has_its_values() {
        let sine: Sine = toml::from_str("amplitude = 0.3\nfrequency = 1.7\nphase = -0.4").unwrap();
        let waveform = Waveform { terms: vec![sine.term(12.5, 80.0)] };
        for t in [12.5, 13.0, 40.25, 79.9] {
            assert!((waveform.at(t) - sine.at(t)).abs() < 1e-14);
            assert!((sine.at(t) - 0.3 * libm::sin(1.7 * t - 0.4)).abs() < 1e-15);
        }
        assert!(waveform.at(12.0) == 0.0 && waveform.at(80.0) == 0.0);
    }
}
