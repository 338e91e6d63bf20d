//! Quantisation of pulse lengths of an on-off actuator.

use flexsc_flight::pulse_width::PulseQuantum;
use flexsc_numerics::quantity::NonNegative;

/// Shortest pulse, and quantum of the pulse length.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct PulseWidth {
    /// Shortest pulse (s).
    pub minimum: NonNegative,
    /// Quantum of a pulse's length (s); 0 for none.
    pub quantum: NonNegative,
}

impl PulseWidth {
    /// Returns the executed length of a demanded pulse (s): at most `most`, a multiple of the quantum, and 0 if it
    /// would be shorter than the minimum.
    pub fn on_time(&self, on_time_demand: f64, most: f64) -> f64 {
        self.flight().on_time(on_time_demand, most)
    }

    /// Returns the quantisation as flight code has it.
    pub fn flight(&self) -> PulseQuantum {
        PulseQuantum { minimum: self.minimum.get(), quantum: self.quantum.get() }
    }

    /// Returns the shortest executable pulse (s); 0 without a minimum and a quantum.
    pub fn shortest(&self) -> f64 {
        self.minimum.get().max(self.quantum.get())
    }
}
