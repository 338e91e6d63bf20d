//! Response of the planar body to a waveform, in closed form.

use std::sync::Arc as Shared;

use flexsc_numerics::phasor::Phasor;
use flexsc_numerics::polynomial::Series;

use super::mode::ModeFlow;
use crate::waveform::Waveform;

/// Input of a segment of motion from its start on.
#[derive(Clone, Debug, Default)]
pub struct SegmentInput {
    /// Constant part (N m; rad/s² if the hub's motion is commanded).
    pub constant: f64,
    /// Waveform, with the time reached within it at the start of the segment.
    pub waveform: Option<ActiveWaveform>,
}

impl SegmentInput {
    /// Creates an input that is constant (N m).
    pub fn constant(constant: f64) -> Self {
        Self { constant, waveform: None }
    }
}

/// Waveform with the time reached within it.
#[derive(Clone, Debug)]
pub struct ActiveWaveform {
    pub(crate) waveform: Shared<Waveform>,
    since: f64,
}

/// Forced part of a motion: angle (rad), rate (rad/s), acceleration (rad/s²).
#[derive(Copy, Clone, Debug)]
pub struct ForcedResponse {
    pub angle: f64,
    pub rate: f64,
    pub acceleration: f64,
}

impl ForcedResponse {
    /// Returns the response to the command multiplied by `factor`.
    pub fn scaled(self, factor: f64) -> Self {
        let Self { angle, rate, acceleration } = self;
        Self { angle: angle * factor, rate: rate * factor, acceleration: acceleration * factor }
    }
}

impl ActiveWaveform {
    /// Creates the waveform, of which the time `since` (s) is reached.
    pub fn new(waveform: Shared<Waveform>, since: f64) -> Self {
        Self { waveform, since }
    }

    /// Returns the waveform multiplied by `factor`, plus another waveform.
    #[must_use]
    pub fn scaled_and_added(&self, factor: f64, beside: &Waveform) -> Self {
        let mut waveform = self.waveform.shifted(0.0, factor);
        waveform.terms.extend_from_slice(&beside.terms);
        Self { waveform: Shared::new(waveform), since: self.since }
    }

    /// Returns the command at `h` seconds after the start of the segment.
    pub fn at(&self, h: f64) -> f64 {
        self.waveform.at(self.since + h)
    }

    /// Returns the Taylor series of the command at `h` seconds after the start of the segment, on the piece that
    /// contains the time `middle` (s).
    pub fn series(&self, middle: f64, h: f64) -> Series {
        self.waveform.series(self.since + middle, self.since + h)
    }

    /// Returns the largest frequency in the command (rad/s).
    pub fn fastest(&self) -> f64 {
        self.waveform.fastest()
    }

    /// Returns the response of a rigid body of unit inertia after `h` seconds.
    pub fn rigid(&self, h: f64) -> ForcedResponse {
        let to = self.since + h;
        ForcedResponse {
            angle: self.waveform.travel(self.since, to),
            rate: self.waveform.impulse(self.since, to),
            acceleration: self.waveform.at(to),
        }
    }

    /// Returns the response of a mode of a body of unit inertia after `h` seconds.
    pub fn mode(&self, flow: &ModeFlow, h: f64) -> ForcedResponse {
        // Scenarios with a manoeuvre accept only modes with a complex pole.
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
