//! Motion of the outputs of a loop under the loads of machines at points of the body: broadband ones, and lines.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::inverse::inverse_3x3;
use nalgebra::{DVector, Matrix3};

use super::broadband::{BroadbandSource, broadband};
use super::lines::LineLoop;
use super::measured_loads::VibrationLoad;
use super::source_motion::{Measure, SourceMotion};
use super::spectral_line::SpectralLine;
use super::tones::{ToneSource, worst_tones};
use flexsc_scenario::Scenario;

/// Part of the variance above which a line is among the frequencies of densities.
const LARGE: f64 = 1e-5;

/// Motion of outputs of a loop under the machines of a scenario.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Vibration {
    /// Keys of the sources.
    pub sources: Vec<String>,
    /// Frequencies of the densities (Hz), in increasing order: those that are asked for, of lines, and of the integral of broadband loads.
    pub frequency_hz: Vec<f64>,
    /// Motion of each output under each source, by the index of the output.
    pub outputs: BTreeMap<usize, Vec<SourceMotion>>,
}

impl Vibration {
    /// Computes the motion of some outputs of a loop; without machines it is empty. Broadband loads have their densities at `others` too
    /// (Hz), if there are any, and at the large lines of machines.
    ///
    /// # Errors
    /// See [`LineLoop::lines`].
    pub fn new(
        lines: &LineLoop<'_>,
        outputs: &[usize],
        measure: Measure<'_>,
        others: &[f64],
    ) -> Result<Self, ConfigError> {
        let Machines { keys, broadband: bands, tones, loads } = Machines::new(lines.parts.scenario);
        let mut found = Self { sources: keys, ..Self::default() };
        if found.sources.is_empty() || outputs.is_empty() {
            return Ok(found);
        }
        let worst = |tone| worst_tones(lines, outputs, tone, measure);
        let tones = tones.iter().map(worst).collect::<Result<Vec<Vec<SourceMotion>>, _>>()?;
        if !others.is_empty() {
            found.frequency_hz = others.to_vec();
            found.frequency_hz.extend(tones.iter().flatten().flat_map(large_lines));
            found.frequency_hz.sort_by(f64::total_cmp);
            found.frequency_hz.dedup();
        }
        if !bands.is_empty() {
            let (frequency_hz, motions) = broadband(lines, outputs, &loads, bands, &found.frequency_hz)?;
            found.frequency_hz = frequency_hz;
            found.outputs = outputs.iter().copied().zip(motions).collect();
        }
        for motions in tones {
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
        let (frequency_hz, motions) = broadband(lines, outputs, &loads, bands, &[])?;
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

/// Returns the frequencies (Hz) of those lines of a motion that carry a part of it.
fn large_lines(motion: &SourceMotion) -> impl Iterator<Item = f64> {
    let least = LARGE * motion.variance();
    motion.lines.iter().filter(move |line| line.mean_square() > least).map(|line| line.frequency_rad_s / TAU)
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
                let column = |part| {
                    let unit = disturbance.unit_effect(body, part);
                    load_column(body, &unit.torque, |mode| unit.forces.get(mode).copied().unwrap_or(0.0))
                };
                VibrationLoad::new(disturbance.place(body), amplitudes, column)
            };
            if let Some(density) = &disturbance.density {
                let sums = density.loads().into_iter().map(|parts| {
                    loads.push(load(std::array::from_fn(|own| if parts.contains(&own) { 1.0 } else { 0.0 })));
                    loads.len() - 1
                });
                let key = format!("disturbance[{index}].density");
                keys.push(key.clone());
                broadband.push(BroadbandSource { key, density, loads: sums.collect() });
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

/// Returns the rates of the states of the body under a load: a torque, and the force on each of its modes.
pub(super) fn load_column(
    body: &ThreeAxisModel,
    torque: &Vector,
    force: impl Fn(usize) -> f64,
) -> DVector<f64> {
    let inverse = inverse_3x3(body.inertia).unwrap_or_else(Matrix3::identity);
    let mut column = DVector::zeros(6 + 2 * body.modes.len());
    column.rows_mut(3, 3).copy_from(&(inverse * torque));
    for mode in 0..body.modes.len() {
        column[7 + 2 * mode] = force(mode);
    }
    column
}
