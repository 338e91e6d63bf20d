//! One elastic mode, x'' + 2 zeta w x' + w² x = k m, as a scenario describes it.

use flexsc_dynamics::ModeState;
use flexsc_numerics::quantity::{Finite, Frequency, NonNegative};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An elastic mode (\[Silaev\], equation (1), with damping added).
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mode {
    /// Natural frequency w (rad/s).
    pub frequency: Frequency,
    /// Modal gain k: modal acceleration per unit of rigid acceleration.
    pub gain: Finite,
    /// Damping ratio zeta: 0 undamped, 1 critical.
    #[serde(default)]
    pub damping: NonNegative,
    /// Displacement at the start (rad).
    #[serde(default)]
    pub displacement: Finite,
    /// Rate at the start (rad/s).
    #[serde(default)]
    pub rate: Finite,
}

impl Mode {
    /// Creates a mode that starts at rest.
    pub fn at_rest(frequency: Frequency, gain: Finite, damping: NonNegative) -> Self {
        Self { frequency, gain, damping, displacement: Finite::default(), rate: Finite::default() }
    }

    /// Returns the excitability k/w²: the static displacement for each unit of reduced moment (s²).
    pub fn excitability(&self) -> f64 {
        self.gain.get() / (self.frequency.get() * self.frequency.get())
    }

    /// Returns the amplitude (rad) of the free vibration from a phase: without damping the largest displacement, else
    /// the absolute value of the phasor x + i (x' + zeta w x)/w_d. NaN at critical damping and above.
    pub fn amplitude(&self, phase: ModeState) -> f64 {
        let zeta = self.damping.get();
        let ModeState { displacement: x, quadrature: y } = phase;
        let imaginary = (y + zeta * x) / f64::sqrt((1.0 - zeta) * (1.0 + zeta));
        f64::sqrt(x * x + imaginary * imaginary)
    }

    /// Returns the kinetic and strain energy (J) of the mode on a body of this inertia (kg m²). 0 for a mode without
    /// gain, which no torque on the hub moves and whose energy is therefore unknown.
    pub fn energy(&self, phase: ModeState, inertia: f64) -> f64 {
        let (w, gain) = (self.frequency.get(), self.gain.get().abs());
        let ModeState { displacement: x, quadrature: y } = phase;
        if gain > 0.0 { 0.5 * inertia / gain * w * w * (x * x + y * y) } else { 0.0 }
    }

    /// Returns the phase at the start of a run.
    pub fn start(&self) -> ModeState {
        ModeState {
            displacement: self.displacement.get(),
            quadrature: self.rate.get() / self.frequency.get(),
        }
    }
}
