//! A planned manoeuvre: the command, and its nominal result.

use flexsc_dynamics::axis_model::{AxisModel, CommandedQuantity};
use flexsc_dynamics::waveform::Waveform;

use super::modal_response::{ModalResponse, torque};
use super::peak_search::{self, PeakValue};
use super::residual;
use super::series::SeriesCoefficients;

/// Largest part of the peak by which a command differs on both sides of a break without a jump.
const CONTINUOUS: f64 = 1e-9;

/// Sample of a planned command.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct CommandSample {
    /// Time (s).
    pub time: f64,
    /// Command (N m, or rad/s² if the hub's motion is commanded).
    pub command: f64,
    /// Torque on the hub (N m).
    pub torque: f64,
}

/// Planned manoeuvre of a body whose modes rest at its start.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Command (N m, or rad/s² if the hub's motion is commanded), zero outside 0 to `time`.
    pub waveform: Waveform,
    /// Time of the manoeuvre (s).
    pub time: f64,
    /// Angle by which the rigid body turns in that time (rad).
    pub angle: f64,
    /// Rate before the manoeuvre (rad/s).
    pub start_rate: f64,
    /// Rate of the rigid body after the manoeuvre (rad/s).
    pub end_rate: f64,
    /// Amplitudes of the series, if the command is one without a shaper.
    pub coefficients: Option<SeriesCoefficients>,
}

impl Plan {
    /// Returns the band (rad) around the goal within which the body must be afterwards: a thousandth of the larger of
    /// the angle and, for a manoeuvre that changes the rate, the angle turned by that change alone.
    pub fn band(&self) -> f64 {
        let change = 0.5 * self.time * (self.end_rate - self.start_rate).abs();
        1e-3 * self.angle.abs().max(change)
    }

    /// Returns the largest absolute value of the command, with its time.
    pub fn peak(&self) -> PeakValue {
        let command = &self.waveform;
        let step = peak_search::sampling(command.fastest());
        peak_search::largest(&command.breaks(), step, |middle, t| command.value_on_piece(middle, t))
    }

    /// Returns the largest torque on the hub (N m), with its time: that of the command, or if the hub's motion is
    /// commanded, the torque that produces it against the modes (\[Rotation\], equation (17)).
    pub fn peak_torque(&self, body: &AxisModel) -> PeakValue {
        match body.drive {
            CommandedQuantity::Torque => self.peak(),
            CommandedQuantity::Motion => {
                let history = ModalResponse::new(body, &self.waveform, 1.0);
                let step = peak_search::sampling(fastest(body, &self.waveform)).max(self.time / 2e4);
                peak_search::largest(&self.waveform.breaks(), step, |middle, t| {
                    torque(body, &history, middle, t)
                })
            }
        }
    }

    /// Returns the torque on the hub (N m) over the manoeuvre: times (s) and values at most `step` seconds apart, with
    /// both limits where it jumps.
    pub fn torque(&self, body: &AxisModel, step: f64) -> Vec<(f64, f64)> {
        let history = ModalResponse::new(body, &self.waveform, 1.0);
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

    /// Returns samples of the command from its start to a time `end` (s), which may be after the manoeuvre: at most
    /// `step` seconds apart, and two at one time where the command jumps.
    pub fn samples(&self, body: &AxisModel, step: f64, end: f64) -> Vec<CommandSample> {
        let history = ModalResponse::new(body, &self.waveform, 1.0);
        let breaks = self.waveform.breaks();
        let within = breaks.into_iter().filter(|time| 0.0 < *time && *time < end);
        let bounds: Vec<f64> = std::iter::once(0.0).chain(within).chain([end]).collect();
        let small = CONTINUOUS * self.peak().value.abs();
        let mut samples: Vec<CommandSample> = Vec::new();
        for piece in bounds.windows(2) {
            let (from, length) = (piece[0], piece[1] - piece[0]);
            let middle = from + 0.5 * length;
            let count = libm::ceil(length / step).max(1.0);
            let sample = |time: f64| CommandSample {
                time,
                command: self.waveform.value_on_piece(middle, time),
                torque: torque(body, &history, middle, time),
            };
            let first = sample(from);
            if samples.last().is_none_or(|before| (first.command - before.command).abs() > small) {
                samples.push(first);
            }
            samples.extend((1..count as u32).map(|i| sample(from + length * (f64::from(i) / count))));
            samples.push(sample(piece[1]));
        }
        samples
    }

    /// Returns the residual in the hub's angle and in each output, as in a [`FinalResidual`](super::FinalResidual), for
    /// a body with all frequencies multiplied by `factor` and unchanged gains and weights.
    pub fn residual_at(&self, body: &AxisModel, factor: f64) -> Vec<f64> {
        residual::residual_amplitudes(self, body, &residual::coordinates(body), factor)
    }
}

/// Returns the highest frequency of a command and a body (rad/s).
pub fn fastest(body: &AxisModel, command: &Waveform) -> f64 {
    body.modes.iter().map(|mode| mode.frequency.get()).fold(command.fastest(), f64::max)
}
