//! A loop under loads at points of its body: the lines of its outputs under each, with the measured paths in the place of the model.

use flexsc_formats::document::ConfigError;

use super::lines::{LineLoop, SolvedLines};
use super::measured_loads::{MeasuredPart, VibrationLoad};
use super::spectral_line::{ComplexLine, LoadColumn};
use crate::linear_model::Signal;

/// Lines of each output, under each load.
pub type ResponseLines = Vec<Vec<Vec<ComplexLine>>>;

/// Loop under loads of one frequency, each alone.
pub struct LoadedLoop<'a> {
    lines: &'a LineLoop<'a>,
    /// Outputs, as indices.
    outputs: &'a [usize],
    loads: Vec<LoadColumn>,
    /// Components of loads that go by measured paths.
    measured: MeasuredLoads,
}

impl<'a> LoadedLoop<'a> {
    /// Creates the loop for some outputs and loads.
    ///
    /// # Errors
    /// A measured path of a line of sight without an output.
    pub fn new(
        lines: &'a LineLoop<'a>,
        outputs: &'a [usize],
        loads: &[VibrationLoad],
    ) -> Result<Self, ConfigError> {
        let measured = MeasuredLoads::new(lines, outputs, loads)?;
        Ok(Self { lines, outputs, measured, loads: loads.iter().map(VibrationLoad::column).collect() })
    }

    /// Returns the lines of each output before its mirror at a frequency of the loads (rad/s), and what they were solved by: aliases below
    /// the Nyquist frequency of the law, and last that of the load.
    ///
    /// # Errors
    /// A frequency at which a motion without damping grows without limit.
    pub(super) fn before_mirrors(&self, frequency: f64) -> Result<(ResponseLines, SolvedLines), ConfigError> {
        let solved = self.lines.solved(frequency, &self.loads, self.outputs)?;
        let of_load = |load: usize| {
            let of_output = |place: usize| {
                let each = solved.turns.frequencies.iter().zip(&solved.amplitudes);
                each.map(|(at, amplitudes)| (*at, amplitudes[(place, load)])).collect()
            };
            (0..self.outputs.len()).map(of_output).collect()
        };
        let mut found: ResponseLines = (0..self.loads.len()).map(of_load).collect();
        self.measured.replace(self.lines, frequency, &mut found)?;
        Ok((found, solved))
    }

    /// Returns the lines of each output behind its mirror at a frequency of the loads (rad/s); the last is that of the load.
    ///
    /// # Errors
    /// A frequency at which a motion without damping grows without limit.
    pub fn lines(&self, frequency: f64) -> Result<ResponseLines, ConfigError> {
        let (mut found, _) = self.before_mirrors(frequency)?;
        for output in 0..self.outputs.len() {
            let before = found.iter_mut().map(|of_load| std::mem::take(&mut of_load[output])).collect();
            let behind = self.behind_mirror(output, before);
            found.iter_mut().zip(behind).for_each(|(of_load, own)| of_load[output] = own);
        }
        Ok(found)
    }

    /// Returns the lines of an output behind its mirror, if it is behind one, for those before it under each of some loads of one
    /// frequency; the last is that of the load.
    pub fn behind_mirror(&self, output: usize, before: Vec<Vec<ComplexLine>>) -> Vec<Vec<ComplexLine>> {
        match self.lines.mirror(self.outputs[output]) {
            Some(mirror) => mirror.lines(&before),
            None => before,
        }
    }

    /// Returns the components of loads that go by measured paths.
    pub(super) fn measured(&self) -> &[MeasuredPart] {
        &self.measured.parts
    }
}

/// Components of loads that go by measured paths.
struct MeasuredLoads {
    parts: Vec<MeasuredPart>,
    /// Loads of one component each, and outputs, whose model is replaced.
    alone: Vec<LoadColumn>,
    replaced: Vec<usize>,
    /// Of each component, its load and output among these.
    places: Vec<(usize, usize)>,
}

impl MeasuredLoads {
    fn new(lines: &LineLoop<'_>, outputs: &[usize], loads: &[VibrationLoad]) -> Result<Self, ConfigError> {
        let signals: Vec<&Signal> = outputs.iter().map(|output| &lines.signals[*output]).collect();
        let parts = MeasuredPart::all(lines.parts.scenario, &signals, loads);
        let (mut components, mut replaced, mut places) = (Vec::new(), Vec::new(), Vec::new());
        let place = |all: &mut Vec<(usize, usize)>, own: (usize, usize)| {
            all.iter().position(|known| *known == own).unwrap_or_else(|| {
                all.push(own);
                all.len() - 1
            })
        };
        for part in &parts {
            let output =
                lines.output(&part.replaced.0).map_err(|why| ConfigError::new("line_of_sight", why))?;
            let known = replaced.iter().position(|own| *own == output).unwrap_or_else(|| {
                replaced.push(output);
                replaced.len() - 1
            });
            places.push((place(&mut components, part.load), known));
        }
        let load = |(load, part): (usize, usize)| loads[load].parts[part].column();
        Ok(Self { parts, alone: components.into_iter().map(load).collect(), replaced, places })
    }

    /// Puts the measured paths in the place of the model at a frequency (rad/s) that they have.
    fn replace(
        &self,
        lines: &LineLoop<'_>,
        frequency: f64,
        responses: &mut [Vec<Vec<ComplexLine>>],
    ) -> Result<(), ConfigError> {
        if self.parts.iter().all(|part| part.at(frequency).is_none()) {
            return Ok(());
        }
        let model = lines.solved(frequency, &self.alone, &self.replaced)?;
        for (part, (alone, output)) in self.parts.iter().zip(&self.places) {
            let (Some(measured), (_, share)) = (part.at(frequency), &part.replaced) else { continue };
            let own = &mut responses[part.load.0][part.output];
            for ((_, amplitude), modelled) in own.iter_mut().zip(&model.amplitudes) {
                *amplitude -= modelled[(*output, *alone)] * *share;
            }
            if let Some((_, direct)) = own.last_mut() {
                *direct += measured * *share;
            }
        }
        Ok(())
    }
}
