//! Speed of unbalanced wheels at which an output moves most.

use super::imbalance::WheelImbalance;
use super::lines::LineLoop;
use super::noisy_loop::{NoiseError, stable_loops};
use super::window_rms::WindowRms;
use super::windows::Window;
use flexsc_formats::document::ConfigError;
use flexsc_scenario::Scenario;

/// Speed of the wheels at which the lines of an output are the largest.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct WorstSpeed {
    /// Speed (rad/s).
    pub speed_rad_s: f64,
    /// Rms of the output there, or within the windows.
    pub rms: f64,
}

/// Output of a loop, whose lines are looked at over the speed of the wheels.
#[derive(Clone, Debug, PartialEq)]
pub struct WheelOutput {
    /// Name.
    pub name: String,
    /// Windows within which it moves against its mean, such as exposures; none for all of its motion.
    pub window: Option<Window>,
}

impl WorstSpeed {
    /// Returns the worst speed of a scenario's wheels, up to the largest that it gives, and the unit of the output.
    ///
    /// # Errors
    /// A scenario without unbalanced wheels, without such an output, or whose loop is not linear or not stable.
    pub fn from_scenario(scenario: &Scenario, output: &WheelOutput) -> Result<(Self, String), NoiseError> {
        let missing =
            || ConfigError::new("actuator.wheels.imbalance", "is missing: without it wheels have no lines");
        let imbalance = WheelImbalance::from_scenario(scenario)?.ok_or_else(missing)?;
        let lines = LineLoop::from_scenario(scenario)?;
        stable_loops(&lines.parts)?;
        let place = lines.output(&output.name).map_err(NoiseError::Request)?;
        let found = imbalance.largest_spectrum(&lines, &[place])?.ok_or_else(NoiseError::without_speed)?;
        let values: Vec<f64> = match output.window {
            None => found.rms[0].clone(),
            Some(window) => {
                let within = found.clone().over_windows(window).windows.remove(0);
                within.iter().map(|own: &WindowRms| own.rpe_uniform).collect()
            }
        };
        let worst = values.iter().zip(&found.speed_rad_s).max_by(|a, b| a.0.total_cmp(b.0));
        let (rms, speed_rad_s) = worst.map_or((f64::NAN, f64::NAN), |(rms, speed)| (*rms, *speed));
        Ok((Self { speed_rad_s, rms }, lines.signals[place].unit.clone()))
    }
}
