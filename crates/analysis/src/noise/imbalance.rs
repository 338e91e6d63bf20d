//! Imbalance of the wheels as loads on the body that turn: lines over the speed of the wheels.

use flexsc_control::actuator::Wheels;
use flexsc_dynamics::three_axis::HarmonicLine;
use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::inverse::inverse_3x3;
use flexsc_numerics::quantity::Positive;
use nalgebra::{DVector, Matrix3};
use rayon::prelude::*;
use serde::Serialize;

use super::lines::{LineLoop, OutputLines, SineLoad};
use flexsc_scenario::Scenario;

/// Lines of the outputs under one harmonic of one wheel at one speed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WheelLines {
    /// Speed of the wheel (rad/s).
    pub speed_rad_s: f64,
    /// Number of the wheel, from 1.
    pub wheel: usize,
    /// Order of the harmonic: periods per turn.
    pub order: f64,
    /// Lines of each output.
    pub outputs: Vec<OutputLines>,
}

/// Lines of the outputs over the speed of the wheels.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WheelSpectrum {
    /// Speeds (rad/s).
    pub speed_rad_s: Vec<f64>,
    /// Rms of each output at each speed, of all lines of all wheels, whose phases are unrelated.
    pub rms: Vec<Vec<f64>>,
    /// Lines of each harmonic of each wheel at each speed.
    pub lines: Vec<WheelLines>,
}

/// Number of speeds up to the largest, and the smallest of them relative to the largest.
const SPEEDS: u32 = 48;
const LOWEST: f64 = 0.05;

/// Harmonic of a wheel: loads per square of the speed.
struct WheelHarmonic {
    wheel: usize,
    order: f64,
    load: SineLoad,
}

/// Imbalance of a scenario's wheels.
pub struct WheelImbalance {
    harmonics: Vec<WheelHarmonic>,
    /// Largest speed that the scenario gives (rad/s), if it gives one.
    pub largest_speed: Option<f64>,
}

impl WheelImbalance {
    /// Returns the imbalance of a scenario's wheels; `None` for wheels without one.
    ///
    /// # Errors
    /// An inconsistent key of the wheels, and the reason.
    pub fn from_scenario(scenario: &Scenario) -> Result<Option<Self>, ConfigError> {
        let Some(body) = scenario.model.three_axis() else { return Ok(None) };
        let members: Vec<_> = scenario.actuator.members().into_iter().collect();
        for member in &members {
            let Some(wheels) = member.kind.unbalanced_wheels() else { continue };
            let bearings = wheels.bearings(body).map_err(|fault| fault.within(&member.key))?;
            let mut harmonics = Vec::new();
            for (wheel, bearing) in bearings.iter().enumerate() {
                for line in &bearing.lines {
                    let load = load(body, line);
                    harmonics.push(WheelHarmonic { wheel: wheel + 1, order: line.order, load });
                }
            }
            harmonics.sort_by(|a, b| a.order.total_cmp(&b.order).then(a.wheel.cmp(&b.wheel)));
            return Ok(Some(Self { harmonics, largest_speed: largest_speed(wheels) }));
        }
        Ok(None)
    }

    /// Returns speeds (rad/s) up to the largest that the scenario gives; `None` if it gives none.
    pub fn speeds(&self) -> Option<Vec<f64>> {
        let largest = self.largest_speed?;
        let part = |k: u32| LOWEST + (1.0 - LOWEST) * f64::from(k) / f64::from(SPEEDS - 1);
        Some((0..SPEEDS).map(|k| largest * part(k)).collect())
    }

    /// Computes the lines of some outputs at speeds of the wheels (rad/s), and their rms.
    ///
    /// # Errors
    /// See [`LineLoop::lines`].
    pub fn spectrum(
        &self,
        lines: &LineLoop<'_>,
        speeds: Vec<f64>,
        outputs: &[usize],
    ) -> Result<WheelSpectrum, ConfigError> {
        let lines = self.lines(lines, &speeds, outputs)?;
        let each = lines.len() / speeds.len().max(1);
        let rms = |output: usize| {
            let at = |own: &[WheelLines]| {
                f64::sqrt(own.iter().map(|lines| lines.outputs[output].mean_square()).sum())
            };
            lines.chunks(each.max(1)).map(at).collect()
        };
        Ok(WheelSpectrum { rms: (0..outputs.len()).map(rms).collect(), speed_rad_s: speeds, lines })
    }

    /// Computes the lines of some outputs at speeds of the wheels (rad/s): each harmonic of each wheel alone.
    ///
    /// # Errors
    /// See [`LineLoop::lines`].
    pub fn lines(
        &self,
        lines: &LineLoop<'_>,
        speeds: &[f64],
        outputs: &[usize],
    ) -> Result<Vec<WheelLines>, ConfigError> {
        let at = |speed: &f64| -> Result<Vec<WheelLines>, ConfigError> {
            let mut found = Vec::new();
            for same in self.harmonics.chunk_by(|a, b| a.order == b.order) {
                let strength = speed * speed;
                let load = |harmonic: &WheelHarmonic| SineLoad {
                    cosine: &harmonic.load.cosine * strength,
                    sine: &harmonic.load.sine * strength,
                };
                let loads: Vec<SineLoad> = same.iter().map(load).collect();
                let all = lines.lines(same[0].order * speed, &loads, outputs)?;
                found.extend(same.iter().zip(all).map(|(harmonic, outputs)| WheelLines {
                    speed_rad_s: *speed,
                    wheel: harmonic.wheel,
                    order: harmonic.order,
                    outputs,
                }));
            }
            Ok(found)
        };
        let found: Vec<Vec<WheelLines>> = speeds.par_iter().map(at).collect::<Result<_, _>>()?;
        Ok(found.into_iter().flatten().collect())
    }
}

/// Returns the largest speed of the wheels (rad/s) that their keys give: their limit, or the largest of their speeds.
fn largest_speed(wheels: &Wheels) -> Option<f64> {
    let by_momentum = wheels.momentum.map(|momentum| momentum.get() / wheels.inertia.get());
    let limit = wheels.speed_limit.map(Positive::get).or(by_momentum);
    limit.or(Some(wheels.largest_initial_speed())).filter(|speed| *speed > 0.0)
}

/// Returns a harmonic as a load on the rates of the body and its modes.
fn load(body: &ThreeAxisModel, line: &HarmonicLine) -> SineLoad {
    let inverse = inverse_3x3(body.inertia).unwrap_or_else(Matrix3::identity);
    let hub = body.coupling.as_ref().map_or(&[][..], |coupling| &coupling.rotations);
    let column = |part: usize| {
        let mut column = DVector::zeros(6 + 2 * body.modes.len());
        column.rows_mut(3, 3).copy_from(&(inverse * line.torque[part]));
        for mode in 0..body.modes.len() {
            let turned = hub.get(mode).copied().unwrap_or_else(Vector::zeros);
            let own = line.forces[part].get(mode).copied().unwrap_or(0.0);
            column[7 + 2 * mode] = turned.dot(&line.torque[part]) + own;
        }
        column
    };
    SineLoad { cosine: column(0), sine: column(1) }
}
