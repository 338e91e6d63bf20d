//! Motion of the outputs of a loop under the loads of machines at points of the body: broadband ones, and lines.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use flexsc_formats::document::ConfigError;
use nalgebra::Complex;

use super::broadband::{BroadbandSource, broadband};
use super::line_source::LineSource;
use super::lines::LineLoop;
use super::measured_loads::VibrationLoad;
use super::source_motion::{Measure, SourceMotion};
use super::spectral_line::SpectralLine;
use super::worst_lines::worst_lines;
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
    /// See [`LineSource::at`].
    pub fn new(
        lines: &LineLoop<'_>,
        outputs: &[usize],
        measure: Measure<'_>,
        others: &[f64],
    ) -> Result<Self, ConfigError> {
        let machines = Machines::new(lines.parts.scenario);
        let mut found = Self { sources: machines.keys(), ..Self::default() };
        if found.sources.is_empty() || outputs.is_empty() {
            return Ok(found);
        }
        let worst = |source: &LineSource| {
            worst_lines(source, lines, outputs, (&source.examined_speeds(lines, outputs)?, measure))
        };
        let tones = machines.lines.iter().map(worst).collect::<Result<Vec<Vec<SourceMotion>>, _>>()?;
        if !others.is_empty() {
            found.frequency_hz = others.to_vec();
            found.frequency_hz.extend(tones.iter().flatten().flat_map(large_lines));
            found.frequency_hz.sort_by(f64::total_cmp);
            found.frequency_hz.dedup();
        }
        let Machines { broadband: bands, loads, .. } = machines;
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
    /// See [`LineSource::at`].
    pub fn gaussian(lines: &LineLoop<'_>, outputs: &[usize]) -> Result<Self, ConfigError> {
        let machines = Machines { lines: Vec::new(), ..Machines::new(lines.parts.scenario) };
        let keys = machines.keys();
        let Machines { broadband: bands, loads, .. } = machines;
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
#[derive(Default)]
struct Machines<'a> {
    broadband: Vec<BroadbandSource<'a>>,
    lines: Vec<LineSource>,
    /// Broadband loads, each a unit of some components.
    loads: Vec<VibrationLoad>,
}

impl<'a> Machines<'a> {
    fn new(scenario: &'a Scenario) -> Self {
        let mut found = Self::default();
        let Some(body) = scenario.model.three_axis() else { return found };
        for (index, disturbance) in scenario.disturbance.iter().enumerate() {
            let point = disturbance.place(body);
            if let Some(density) = &disturbance.density {
                let sums = density.loads().into_iter().map(|parts| {
                    let unit = |own| Complex::from(if parts.contains(&own) { 1.0 } else { 0.0 });
                    found.loads.push(VibrationLoad::new(body, point, std::array::from_fn(unit)));
                    found.loads.len() - 1
                });
                let (key, loads) = (format!("disturbance[{index}].density"), sums.collect());
                found.broadband.push(BroadbandSource { key, density, loads });
            }
            if let Some(lines) = &disturbance.lines {
                let key = format!("disturbance[{index}].lines");
                found.lines.push(LineSource::of_machine(key, lines, (body, point)));
            }
        }
        found
    }

    /// Returns the keys, of the broadband ones first.
    fn keys(&self) -> Vec<String> {
        let broadband = self.broadband.iter().map(|own| own.key.clone());
        broadband.chain(self.lines.iter().map(|own| own.key.clone())).collect()
    }
}
