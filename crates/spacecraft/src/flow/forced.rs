//! What a waveform adds to the motion of the planar body, in closed form.

use std::sync::Arc as Shared;

use super::mode::ModeFlow;
use crate::numerics::phasor::Phasor;
use crate::numerics::polynomial::Series;
use crate::waveform::Waveform;

/// What drives a body from an instant on.
#[derive(Clone, Debug, Default)]
pub struct ForcedInput {
    /// A constant (N m; rad/s² where the hub's motion is commanded).
    pub constant: f64,
    /// A waveform, and the time on it at that instant (s).
    pub waveform: Option<Forced>,
}

impl ForcedInput {
    /// A constant alone (N m).
    pub fn constant(constant: f64) -> Self {
        Self { constant, waveform: None }
    }
}

/// A waveform under way.
#[derive(Clone, Debug)]
pub struct Forced {
    pub(crate) waveform: Shared<Waveform>,
    since: f64,
}

/// The forced part of a motion: angle (rad), rate (rad/s), acceleration (rad/s²).
#[derive(Copy, Clone, Debug)]
pub struct ForcedResponse {
    pub angle: f64,
    pub rate: f64,
    pub acceleration: f64,
}

impl ForcedResponse {
    /// The same for so many times the command.
    pub fn times(self, factor: f64) -> Self {
        let Self { angle, rate, acceleration } = self;
        Self { angle: angle * factor, rate: rate * factor, acceleration: acceleration * factor }
    }
}

impl Forced {
    /// A waveform from this time on it (s).
    pub fn new(waveform: Shared<Waveform>, since: f64) -> Self {
        Self { waveform, since }
    }

    /// So many times the command, and another waveform beside it.
    #[must_use]
    pub fn changed(&self, factor: f64, beside: &Waveform) -> Self {
        let mut waveform = self.waveform.shifted(0.0, factor);
        waveform.terms.extend_from_slice(&beside.terms);
        Self { waveform: Shared::new(waveform), since: self.since }
    }

    /// The command `h` seconds later.
    pub fn at(&self, h: f64) -> f64 {
        self.waveform.at(self.since + h)
    }

    /// The Taylor series of the command `h` seconds later, on the piece that holds a time `middle` seconds later.
    pub fn series(&self, middle: f64, h: f64) -> Series {
        self.waveform.series(self.since + middle, self.since + h)
    }

    /// The largest frequency in the command (rad/s).
    pub fn fastest(&self) -> f64 {
        self.waveform.fastest()
    }

    /// What it adds to the rigid motion of a body of unit inertia within `h` seconds.
    pub fn rigid(&self, h: f64) -> ForcedResponse {
        let to = self.since + h;
        ForcedResponse {
            angle: self.waveform.travel(self.since, to),
            rate: self.waveform.impulse(self.since, to),
            acceleration: self.waveform.at(to),
        }
    }

    /// What it adds to a mode of a body of unit inertia within `h` seconds.
    pub fn mode(&self, flow: &ModeFlow, h: f64) -> ForcedResponse {
        // A scenario with a manoeuvre has no mode without a pole.
        let Some(pole) = flow.pole() else {
            return ForcedResponse { angle: 0.0, rate: 0.0, acceleration: 0.0 };
        };
        let to = self.since + h;
        let driven: Phasor = self.waveform.response(pole, self.since, to) * (flow.gain / pole.im);
        let (angle, rate) = (driven.im, (pole * driven).im);
        let [_, back] = flow.velocity(angle, rate / flow.frequency);
        ForcedResponse { angle, rate, acceleration: flow.gain * self.waveform.at(to) + flow.frequency * back }
    }
}
