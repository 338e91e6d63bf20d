//! Sampled loop at constant frequencies: body, wheel and PD law as one linear system from sample to sample.
//!
//! The law is u_k = shape(-(k_p y_k + k_d D_k)), held over [k T0, (k + 1) T0), later by the delay of the wheel; y = x +
//! gain x_d with the displacement x_d of the dominant mode (\[Wheel11, Sukhanov\], equations (5), (7) and (8)). The
//! reduced moment is m = b u - a x' with b > 0: the papers print k'_u with the sign that feeds back positively.

mod closed;
mod discrete_plant;
mod from_scenario;
mod gain_region;
mod map;
mod nonlinear_command;
mod robust_gain;
mod settling;
mod spectrum;

use flexsc_control::actuator::Wheel;
use flexsc_control::law::Differentiation;
use flexsc_dynamics::axis_model::{AxisMode, AxisModel};

pub use closed::ClosedLoop;
pub use discrete_plant::DiscretePlant;
pub use gain_region::{GainRegion, Gains, Scaling, midpoints, region, regions};
pub use map::{MapCell, map, spectral_radii};
pub use robust_gain::{ModelUncertainty, RobustGain, RobustGoal, RobustSearch, optimize};
pub use settling::{Settling, SettlingWindow};
pub use spectrum::SlowestMode;

/// Body under a sampled PD law, with or without a wheel.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledLoop {
    /// Body with its natural frequencies, which each point of an analysis multiplies by ratios.
    pub body: AxisModel,
    /// Back-EMF a, k'_omega of the papers (1/s); 0 without a wheel.
    pub back_emf: f64,
    /// True if the back-EMF opposes the total rate, elastic part included; false if it opposes the rigid rate alone.
    pub total: bool,
    /// Reduced moment for each unit of the command, b, k'_u of the papers (rad/s²).
    pub authority: f64,
    /// Proportional gain (units of the command for each rad).
    pub k_p: f64,
    /// Derivative gain (units of the command for each rad/s; for each rad where the difference is raw).
    pub k_d: f64,
    /// Differentiation method of the law.
    pub differentiation: Differentiation,
    /// Index of the dominant mode, whose displacement the extra loop feeds back.
    pub dominant: usize,
    /// Sampling period T0 (s).
    pub period: f64,
    /// Time from a sample to the start of the command that is computed from it (s).
    pub delay: f64,
    /// Nonlinear path of the command; none where all of it is executed.
    pub shape: Option<CommandPath>,
}

/// Path of a command to its execution: the law's limit, then the wheel's dead zone, quantum and limit.
#[derive(Clone, Debug, PartialEq)]
pub struct CommandPath {
    /// Limit of the law (units of the command).
    pub limit: f64,
    /// Wheel that executes the command; none without a wheel.
    pub wheel: Option<Wheel>,
}

impl CommandPath {
    /// Returns the command that is executed.
    pub fn execute(&self, command: f64) -> f64 {
        let command = command.clamp(-self.limit, self.limit);
        self.wheel.as_ref().map_or(command, |wheel| wheel.execute_command(command))
    }
}

impl SampledLoop {
    /// Returns the index of the mode with the greatest static response to a moment, |k|/w²: the papers' criterion of
    /// dominance.
    pub fn dominant_mode(modes: &[AxisMode]) -> usize {
        let pull = |mode: &AxisMode| mode.excitability().abs();
        (1..modes.len()).fold(0, |best, i| if pull(&modes[i]) > pull(&modes[best]) { i } else { best })
    }

    /// Returns the natural frequency of the dominant mode (rad/s); NaN for a body without modes.
    pub fn frequency(&self) -> f64 {
        self.body.modes.get(self.dominant).map_or(f64::NAN, |mode| mode.frequency.get())
    }

    /// Returns the ratios of the natural frequencies at which the dominant mode has the frequency `frequency` (rad/s).
    pub fn ratios(&self, frequency: f64, scaling: Scaling) -> Vec<f64> {
        let ratio = frequency / self.frequency();
        let scaled_mode = |index: usize| match scaling {
            Scaling::First if index != self.dominant => 1.0,
            Scaling::All | Scaling::First => ratio,
        };
        (0..self.body.modes.len()).map(scaled_mode).collect()
    }
}
