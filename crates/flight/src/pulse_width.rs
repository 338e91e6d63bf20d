//! Quantisation of pulse lengths of an on-off actuator.

use crate::maths::round;

/// Shortest pulse, and quantum of the pulse length.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct PulseQuantum {
    /// Shortest pulse (s).
    pub minimum: f64,
    /// Quantum of a pulse's length (s); 0 for none.
    pub quantum: f64,
}

impl PulseQuantum {
    /// Returns the executed length of a demanded pulse (s): at most `most`, a multiple of the quantum, and 0 if it
    /// would be shorter than the minimum.
    #[inline]
    pub fn on_time(&self, on_time_demand: f64, most: f64) -> f64 {
        let mut on: f64 = if on_time_demand < most { on_time_demand } else { most };
        if self.quantum > 0.0 {
            on = round(on / self.quantum) * self.quantum;
        }
        if on > most {
            most
        } else if on < self.minimum {
            0.0
        } else {
            on
        }
    }
}
