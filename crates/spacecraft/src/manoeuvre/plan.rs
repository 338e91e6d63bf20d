//! A planned manoeuvre: the command, and what it promises.

use super::extremum::{self, Peak};
use super::history::{ModalHistory, torque};
use super::residual;
use super::series::SeriesCoefficients;
use crate::body::{Drive, Planar};
use crate::waveform::Waveform;

/// A planned manoeuvre of a body whose modes rest at its start.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The command (N m, or rad/s² where the hub's motion is commanded), zero outside 0 to `time`.
    pub waveform: Waveform,
    /// Time of the manoeuvre (s).
    pub time: f64,
    /// The angle by which the rigid body turns meanwhile (rad).
    pub angle: f64,
    /// Rate before (rad/s).
    pub start_rate: f64,
    /// Rate of the rigid body after (rad/s).
    pub end_rate: f64,
    /// The amplitudes, if the command is a series that no shaper changes.
    pub coefficients: Option<SeriesCoefficients>,
}

impl Plan {
    /// How near to its goal a body that is turned so shall be afterwards (rad): a thousandth of the angle, or where the
    /// manoeuvre changes the rate, of the angle that the change alone turns by, if that is more.
    pub fn band(&self) -> f64 {
        let change = 0.5 * self.time * (self.end_rate - self.start_rate).abs();
        1e-3 * self.angle.abs().max(change)
    }

    /// The largest absolute value of the command, and when.
    pub fn peak(&self) -> Peak {
        let command = &self.waveform;
        let step = extremum::sampling(command.fastest());
        extremum::largest(&command.breaks(), step, |middle, t| command.on_piece(middle, t))
    }

    /// The largest torque on the hub (N m), and when: that of the command, or where the hub's motion is commanded, what
    /// makes it move so against the modes (\[Rotation\], equation (17)).
    pub fn peak_torque(&self, body: &Planar) -> Peak {
        match body.drive {
            Drive::Torque => self.peak(),
            Drive::Motion => {
                let history = ModalHistory::new(body, &self.waveform, 1.0);
                let step = extremum::sampling(fastest(body, &self.waveform)).max(self.time / 2e4);
                extremum::largest(&self.waveform.breaks(), step, |middle, t| {
                    torque(body, &history, middle, t)
                })
            }
        }
    }

    /// The torque on the hub (N m) over the manoeuvre: times (s) and values at most `step` seconds apart, with both limits
    /// where it jumps.
    pub fn torque(&self, body: &Planar, step: f64) -> Vec<(f64, f64)> {
        let history = ModalHistory::new(body, &self.waveform, 1.0);
        let mut line = Vec::new();
        for piece in self.waveform.breaks().windows(2) {
            let (from, length) = (piece[0], piece[1] - piece[0]);
            let count = libm::ceil(length / step).max(1.0);
            let time = |i: u32| from + length * (f64::from(i) / count);
            let middle = time(0) + 0.5 * length;
            line.extend((0..=count as u32).map(time).map(|t| (t, torque(body, &history, middle, t))));
        }
        line
    }

    /// What is left in the hub's angle and in each output, as of a [`FinalResidual`](super::FinalResidual), of a body whose
    /// frequencies are all `factor` times its own. Gains and weights stay as they are.
    pub fn left(&self, body: &Planar, factor: f64) -> Vec<f64> {
        residual::left(self, body, &residual::coordinates(body), factor)
    }
}

/// The fastest frequency of a command and a body (rad/s).
pub fn fastest(body: &Planar, command: &Waveform) -> f64 {
    body.modes.iter().map(|mode| mode.frequency.get()).fold(command.fastest(), f64::max)
}
