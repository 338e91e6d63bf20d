//! Sine functions of time, as parts of a torque.

use crate::waveform::{Term, TermShape};

/// Torque amplitude sin(frequency t + phase), t from the start of the run.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SineTorque {
    /// Amplitude (N m).
    pub amplitude: f64,
    /// Frequency (rad/s).
    pub frequency: f64,
    /// Phase at the start of the run (rad); pi/2 makes a cosine.
    pub phase: f64,
}

impl SineTorque {
    /// Returns the torque at a time since the start of the run (N m).
    pub fn at(&self, t: f64) -> f64 {
        self.amplitude * libm::sin(self.frequency * t + self.phase)
    }

    /// Returns the torque as a term of a waveform between two times (s).
    pub fn term(&self, from: f64, to: f64) -> Term {
        let Self { amplitude, frequency, phase } = *self;
        let (sin, cos) = libm::sincos(frequency * from + phase);
        let shape = TermShape::Harmonic { frequency, cosine: amplitude * sin, sine: amplitude * cos };
        Term { from, to, shape }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::waveform::Waveform;

    #[test]
    fn a_term_has_its_values() {
        let sine = SineTorque { amplitude: 0.3, frequency: 1.7, phase: -0.4 };
        let waveform = Waveform { terms: vec![sine.term(12.5, 80.0)] };
        for t in [12.5, 13.0, 40.25, 79.9] {
            assert!((waveform.at(t) - sine.at(t)).abs() < 1e-14);
            assert!((sine.at(t) - 0.3 * libm::sin(1.7 * t - 0.4)).abs() < 1e-15);
        }
        assert!(waveform.at(12.0) == 0.0 && waveform.at(80.0) == 0.0);
    }
}
