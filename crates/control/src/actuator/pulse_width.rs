//! The length of pulses: what an actuator that is on or off makes of a wanted one.

use crate::quantity::NonNegative;

/// The shortest pulse, and the quantum of all.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct PulseWidth {
    /// Shortest pulse (s).
    pub minimum: NonNegative,
    /// Quantum of a pulse's length (s); 0 for none.
    pub quantum: NonNegative,
}

impl PulseWidth {
    /// The length of the pulse that comes of a wanted one (s): at most `most`, a multiple of the quantum, nothing of a
    /// short one.
    pub fn on_time(&self, wanted: f64, most: f64) -> f64 {
        let (minimum, quantum) = (self.minimum.get(), self.quantum.get());
        let mut on = wanted.min(most);
        if quantum > 0.0 {
            on = libm::round(on / quantum) * quantum;
        }
        if on > most {
            most
        } else if on < minimum {
            0.0
        } else {
            on
        }
    }

    /// The shortest pulse that is not nothing (s); 0 if there is none.
    pub fn shortest(&self) -> f64 {
        self.minimum.get().max(self.quantum.get())
    }
}
