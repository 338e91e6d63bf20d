//! Exact response of a body's modes to a planned command.

use flexsc_dynamics::axis_model::{AxisModel, CommandedQuantity};
use flexsc_dynamics::waveform::Waveform;
use flexsc_numerics::phasor::Phasor;

use super::suppression::Zero;

/// Response of modes that are at rest at the start of a command.
pub struct ModalResponse<'a> {
    command: &'a Waveform,
    inertia: f64,
    modes: Vec<DrivenMode>,
}

/// Mode excited by the command.
struct DrivenMode {
    pole: Phasor,
    zero: Zero,
    /// Displacement per unit of the imaginary part of the command's response.
    gain: f64,
    modal_gain: f64,
}

/// Displacement, rate and acceleration of a mode.
pub type ModeMotion = [f64; 3];

impl<'a> ModalResponse<'a> {
    /// Creates the response of a body's modes, with all frequencies multiplied by `factor`.
    pub fn new(body: &AxisModel, command: &'a Waveform, factor: f64) -> Self {
        let inertia = body.commanded_inertia();
        let driven = |mode| {
            let own = Zero::at_mode(mode);
            let zero = Zero { frequency: factor * own.frequency, ..own };
            let pole = zero.pole();
            DrivenMode {
                pole,
                zero,
                gain: mode.gain.get() / (inertia * pole.im),
                modal_gain: mode.gain.get(),
            }
        };
        Self { command, inertia, modes: body.modes.iter().map(driven).collect() }
    }

    /// Returns displacement (rad), rate and acceleration of each mode at a time (s); the acceleration is that of the
    /// piece of the command around `middle`.
    pub fn at(&self, middle: f64, t: f64) -> Vec<ModeMotion> {
        let moment = self.command.value_on_piece(middle, t) / self.inertia;
        let motion = |mode: &DrivenMode| {
            let z = self.command.response(mode.pole, 0.0, t);
            let (x, rate) = (mode.gain * z.im, mode.gain * (mode.pole * z).im);
            let (w, zeta) = (mode.zero.frequency, mode.zero.damping);
            [x, rate, mode.modal_gain * moment - 2.0 * zeta * w * rate - w * w * x]
        };
        self.modes.iter().map(motion).collect()
    }

    /// Returns the amplitude of each mode's free vibration from a time (s) on: |x + i x'/w| for an undamped mode (rad).
    pub fn amplitudes(&self, t: f64) -> Vec<f64> {
        let amplitude = |mode: &DrivenMode| {
            (mode.gain * flexsc_numerics::phasor::abs(self.command.response(mode.pole, 0.0, t))).abs()
        };
        self.modes.iter().map(amplitude).collect()
    }
}

/// Returns the torque on the hub (N m) at a time: the command itself, or the torque that gives the hub its commanded
/// motion.
pub fn torque(body: &AxisModel, history: &ModalResponse, middle: f64, t: f64) -> f64 {
    let command = history.command.value_on_piece(middle, t);
    match body.drive {
        CommandedQuantity::Torque => command,
        CommandedQuantity::Motion => {
            let elastic: f64 = history.at(middle, t).iter().map(|[_, _, acceleration]| acceleration).sum();
            body.inertia.get() * (command - elastic)
        }
    }
}
