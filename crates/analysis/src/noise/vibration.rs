//! Motion of the outputs of a loop under the loads of machines at points of the body: broadband ones, and lines.

use std::collections::BTreeMap;

use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_dynamics::wrench::ForceEffect;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::inverse::inverse_3x3;
use nalgebra::{DVector, Matrix3};

use super::broadband::{BroadbandSource, broadband};
use super::lines::LineLoop;
use super::measured_loads::VibrationLoad;
use super::source_motion::{Measure, SourceMotion};
use super::spectral_line::SpectralLine;
use super::tones::{ToneSource, worst_tones};
use flexsc_scenario::Scenario;

/// Motion of outputs of a loop under the machines of a scenario.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Vibration {
    /// Keys of the sources.
    pub sources: Vec<String>,
    /// Frequencies of the broadband loads (Hz), in increasing order.
    pub frequency_hz: Vec<f64>,
    /// Motion of each output under each source, by the index of the output.
    pub outputs: BTreeMap<usize, Vec<SourceMotion>>,
}

impl Vibration {
    /// Computes the motion of some outputs of a loop; without machines it is empty.
    ///
    /// # Errors
    /// See [`LineLoop::lines`].
    pub fn new(lines: &LineLoop<'_>, outputs: &[usize], measure: Measure<'_>) -> Result<Self, ConfigError> {
        let Machines { keys, broadband: bands, tones, loads } = Machines::new(lines.parts.scenario);
        let mut found = Self { sources: keys, ..Self::default() };
        if found.sources.is_empty() || outputs.is_empty() {
            return Ok(found);
        }
        let (frequency_hz, motions) = broadband(lines, outputs, &loads, bands)?;
        found.frequency_hz = frequency_hz;
        found.outputs = outputs.iter().copied().zip(motions).collect();
        for tone in &tones {
            let motions = worst_tones(lines, outputs, tone, measure)?;
            for (output, motion) in outputs.iter().zip(motions) {
                found.outputs.entry(*output).or_default().push(motion);
            }
        }
        Ok(found)
    }

    /// Computes the motion of some outputs of a loop under its broadband sources alone.
    ///
    /// # Errors
    /// See [`LineLoop::lines`].
    pub fn gaussian(lines: &LineLoop<'_>, outputs: &[usize]) -> Result<Self, ConfigError> {
        let Machines { mut keys, broadband: bands, loads, .. } = Machines::new(lines.parts.scenario);
        keys.truncate(bands.len());
        let (frequency_hz, motions) = broadband(lines, outputs, &loads, bands)?;
        Ok(Self { sources: keys, frequency_hz, outputs: outputs.iter().copied().zip(motions).collect() })
    }

    /// Returns the motion of an output under each of its broadband sources, which are Gaussian, or under each machine with lines.
    pub fn sources_of(
        &self,
        output: usize,
        is_gaussian: bool,
    ) -> impl Iterator<Item = &SourceMotion> + Clone {
        let own = self.outputs.get(&output).map_or(&[][..], |sources| sources);
        own.iter().filter(move |source| source.density.is_some() == is_gaussian)
    }

    /// Returns the lines of an output: those of its broadband sources, or those of machines with lines.
    pub fn lines(&self, output: usize, is_gaussian: bool) -> impl Iterator<Item = &SpectralLine> + Clone {
        self.sources_of(output, is_gaussian).flat_map(|source| &source.lines)
    }
}

/// Machines of a scenario.
struct Machines<'a> {
    /// Keys, of the broadband ones first.
    keys: Vec<String>,
    broadband: Vec<BroadbandSource<'a>>,
    tones: Vec<ToneSource<'a>>,
    /// Broadband loads, each a unit of one component.
    loads: Vec<VibrationLoad>,
}

impl<'a> Machines<'a> {
    fn new(scenario: &'a Scenario) -> Self {
        let (mut keys, mut tone_keys) = (Vec::new(), Vec::new());
        let (mut broadband, mut tones, mut loads) = (Vec::new(), Vec::new(), Vec::new());
        let all = scenario.model.three_axis().map_or(&[][..], |_| &scenario.disturbance[..]);
        for (index, disturbance) in all.iter().enumerate() {
            let Some(body) = scenario.model.three_axis() else { continue };
            let load = |amplitudes: [f64; 6]| {
                let column = |part| load_column(body, &disturbance.unit_effect(body, part));
                VibrationLoad::new(disturbance.place(body), amplitudes, column)
            };
            if let Some(density) = &disturbance.density {
                let sums = density.loads().into_iter().map(|parts| {
                    loads.push(load(std::array::from_fn(|own| if parts.contains(&own) { 1.0 } else { 0.0 })));
                    loads.len() - 1
                });
                broadband.push(BroadbandSource { density, loads: sums.collect() });
                keys.push(format!("disturbance[{index}].density"));
            }
            if let Some(lines) = &disturbance.lines {
                let loads = lines.harmonics.iter().map(|harmonic| load(harmonic.amplitudes())).collect();
                tones.push(ToneSource { lines, loads });
                tone_keys.push(format!("disturbance[{index}].lines"));
            }
        }
        keys.extend(tone_keys);
        Self { keys, broadband, tones, loads }
    }
}

/// Returns the rates of the states of the body, and of its modes, under a load.
fn load_column(body: &ThreeAxisModel, load: &ForceEffect) -> DVector<f64> {
    let inverse = inverse_3x3(body.inertia).unwrap_or_else(Matrix3::identity);
    let mut column = DVector::zeros(6 + 2 * body.modes.len());
    column.rows_mut(3, 3).copy_from(&(inverse * load.torque));
    for mode in 0..body.modes.len() {
        column[7 + 2 * mode] = load.forces.get(mode).copied().unwrap_or(0.0);
    }
    column
}
