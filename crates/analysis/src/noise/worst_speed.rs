//! Speed of unbalanced wheels at which an output moves most.

use super::line_source::LineSource;
use super::lines::LineLoop;
use super::noisy_loop::{NoiseError, stable_loops};
use super::spectral_line::SpectralLine;
use super::window_rms::square_within;
use super::windows::Window;
use super::worst_lines::worst_lines;
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
        let source = LineSource::of_wheels(scenario)?.ok_or_else(missing)?;
        let lines = LineLoop::from_scenario(scenario)?;
        stable_loops(&lines.parts)?;
        let place = lines.output(&output.name).map_err(NoiseError::Request)?;
        let speeds = source.examined_speeds(&lines, &[place])?;
        let measure = |_: usize, lines: &[SpectralLine]| square_within(lines, output.window);
        let found = worst_lines(&source, &lines, &[place], (&speeds, &measure))?.swap_remove(0);
        let worst = found.worst.ok_or_else(NoiseError::without_speed)?;
        let (speed_rad_s, rms) = (worst.frequency, square_within(&found.lines, output.window).sqrt());
        Ok((Self { speed_rad_s, rms }, lines.signals[place].unit.clone()))
    }
}
