//! Responses of a loop to loads of any frequency: the lines of its outputs under a unit of each load, and the resonances that a load meets.

use std::f64::consts::TAU;

use flexsc_formats::document::ConfigError;
use nalgebra::{Complex, DMatrix, DVector};

use super::lines::LineLoop;
use super::measured_loads::{MeasuredPart, VibrationLoad};
use super::spectral_line::{ComplexLine, SineLoad};
use crate::eigenvalues::eigenvalues;
use crate::linear_model::Signal;
use crate::margins::frequency_response::{FrequencyResponse, modulus};
use crate::open_loop::{OpenLoop, TransferMatrices};

/// Frequency and half width of a resonance (rad/s).
pub type LoopResonance = [f64; 2];

/// Distance of two resonances, relative to the half width of the narrower one, below which they are one.
const APART: f64 = 0.5;
/// Difference from the frequency of a mode as an alias, relative, below which a resonance of the loop is that mode.
const OF_MODE: f64 = 0.1;
/// Half width of a pole, relative to its frequency, below which it is not damped.
const UNDAMPED: f64 = 1e-6;
/// Largest number of aliases of resonances.
const MOST_FOLDS: usize = 400;

/// Responses of outputs to loads on the states of the body.
pub struct LoopTransfer<'a> {
    lines: &'a LineLoop<'a>,
    /// Outputs, as indices.
    outputs: &'a [usize],
    loads: Vec<SineLoad>,
    /// Response of the angles and rates of the body alone that sensors measure to the loads.
    sensed: FrequencyResponse,
    /// Components of loads that go by measured paths.
    measured: MeasuredLoads,
    /// Resonances: frequency and half width (rad/s), of the body and then of the loop.
    pub resonances: Vec<[f64; 2]>,
    of_body: usize,
    /// Distance of the frequencies that have the same aliases (rad/s).
    pub turn: f64,
}

/// Lines of each output under a unit of one load.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadResponse {
    /// Lines of each output before its mirror: aliases below the Nyquist frequency of the law, and last that of the load.
    pub lines: Vec<Vec<ComplexLine>>,
    /// Mean square modulus of each output before its mirror at the samples of the law.
    pub sampled: Vec<f64>,
}

impl<'a> LoopTransfer<'a> {
    /// Creates the responses of some outputs to loads.
    ///
    /// # Errors
    /// See [`LineLoop::lines`].
    pub fn new(
        lines: &'a LineLoop<'a>,
        outputs: &'a [usize],
        loads: &[VibrationLoad],
    ) -> Result<Self, ConfigError> {
        let opened = OpenLoop::from_parts(&lines.parts)?;
        let closed = opened.transfer.sensitivity().and_then(|closed| eigenvalues(&closed.a));
        let of_loop = closed.unwrap_or_default().into_iter().map(|pole| {
            let (angle, size) = (libm::atan2(pole.im, pole.re), modulus(pole).max(f64::MIN_POSITIVE));
            [angle.abs() / opened.period, libm::log(size).abs() / opened.period]
        });
        let is_above = |[frequency, _]: &[f64; 2]| *frequency > 0.0;
        let turn = TAU / opened.period;
        // A slow motion that nothing but the law damps, such as a nutation, has no resonance in the loop.
        let is_damped =
            |[frequency, width]: &[f64; 2]| *width > UNDAMPED * frequency || *frequency > 0.5 * turn;
        let of_body = eigenvalues(&lines.parts.body.a)
            .unwrap_or_default()
            .into_iter()
            .map(|pole| [pole.im.abs(), pole.re.abs()]);
        let of_body: Vec<[f64; 2]> = of_body.filter(is_above).filter(is_damped).collect();
        let body = &lines.parts.body;
        let columns: Vec<DVector<f64>> = loads.iter().map(VibrationLoad::column).collect();
        let entry = |row: usize, load: usize| columns[load].get(row).copied().unwrap_or(0.0);
        let sensed = FrequencyResponse::new(&TransferMatrices {
            a: body.a.clone(),
            b: DMatrix::from_fn(body.a.nrows(), loads.len(), entry),
            c: body.c.clone(),
            d: DMatrix::zeros(body.c.nrows(), loads.len()),
        });
        let load = |cosine: DVector<f64>| SineLoad { sine: &cosine * 0.0, cosine };
        Ok(Self {
            lines,
            outputs,
            sensed,
            measured: MeasuredLoads::new(lines, outputs, loads)?,
            loads: columns.into_iter().map(load).collect(),
            of_body: of_body.len(),
            resonances: of_body.into_iter().chain(of_loop.filter(is_above)).collect(),
            turn,
        })
    }

    /// Returns the resonances (frequency, half width, rad/s) that a load up to a frequency meets: of body and loop, and then as aliases of
    /// the loop, each with the multiple of the loop's rate beside which it lies.
    pub fn resonances_below(&self, highest: f64) -> (Vec<LoopResonance>, Vec<(LoopResonance, f64)>) {
        let (body, looped) = self.resonances.split_at(self.of_body);
        let folded = |frequency: f64| (frequency - self.turn * libm::round(frequency / self.turn)).abs();
        // Those of the modes are narrow, and hardly answer at their aliases.
        let is_mode = |at: f64| body.iter().any(|[own, _]| (folded(*own) / at - 1.0).abs() < OF_MODE);
        let mut own: Vec<[f64; 2]> = looped.iter().copied().filter(|[at, _]| !is_mode(*at)).collect();
        own.sort_by(|a, b| a[0].total_cmp(&b[0]));
        own.dedup_by(|later, kept| later[0] - kept[0] < APART * kept[1].min(later[1]));
        let folds = (libm::ceil(highest / self.turn) as usize).min(MOST_FOLDS / own.len().max(1));
        let aliases = (1..=folds).flat_map(|fold| {
            let turned = fold as f64 * self.turn;
            own.iter().flat_map(move |[at, width]| {
                [([turned - at, *width], turned), ([turned + at, *width], turned)]
            })
        });
        let is_below = |at: f64| at > 0.0 && at <= highest;
        let direct = self.resonances.iter().copied().chain(self.measured.resonances());
        let direct = direct.filter(|[at, _]| is_below(*at)).collect();
        (direct, aliases.filter(|([at, _], _)| is_below(*at)).collect())
    }

    /// Returns the squared magnitudes of the measured angles and rates of the body without its law under each load, one in a column, at a
    /// frequency (rad/s); `None` at a pole.
    pub fn sensed_squares(&self, frequency: f64) -> Option<DMatrix<f64>> {
        Some(self.sensed.scan(Complex::new(0.0, frequency))?.map(|entry| entry.norm_sqr()))
    }

    /// Returns the response to each load at a frequency (rad/s).
    ///
    /// # Errors
    /// A frequency at which a motion without damping grows without limit.
    pub fn at(&self, frequency: f64) -> Result<Vec<LoadResponse>, ConfigError> {
        let solved = self.lines.solved(frequency, &self.loads, self.outputs)?;
        let squares = self.lines.sample_squares(&solved, self.outputs);
        let of_load = |load: usize| {
            let of_output = |place: usize| {
                let each = solved.turns.frequencies.iter().zip(&solved.amplitudes);
                each.map(|(at, amplitudes)| (*at, amplitudes[(place, load)])).collect()
            };
            LoadResponse {
                lines: (0..self.outputs.len()).map(of_output).collect(),
                sampled: squares.column(load).iter().copied().collect(),
            }
        };
        let mut found: Vec<LoadResponse> = (0..self.loads.len()).map(of_load).collect();
        self.measured.replace(self.lines, frequency, &mut found)?;
        Ok(found)
    }

    /// Returns the lines of an output behind its mirror, if it is behind one, for those before it under each of some loads of one
    /// frequency; the last is that of the load.
    pub fn behind_mirror(&self, output: usize, before: Vec<Vec<ComplexLine>>) -> Vec<Vec<ComplexLine>> {
        match self.lines.mirror(self.outputs[output]) {
            Some(mirror) => mirror.all_lines(&before),
            None => before,
        }
    }

    /// Returns the largest number of lines of all outputs under a load.
    pub fn line_count(&self) -> usize {
        self.outputs.iter().map(|output| self.lines.line_count(*output)).sum()
    }

    /// Returns true if an output is behind a mirror.
    pub fn has_mirror(&self, output: usize) -> bool {
        self.lines.mirror(self.outputs[output]).is_some()
    }
}

/// Components of loads that go by measured paths.
struct MeasuredLoads {
    parts: Vec<MeasuredPart>,
    /// Loads of one component each, and outputs, whose model is replaced.
    alone: Vec<SineLoad>,
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
        let load = |(load, part): (usize, usize)| {
            let cosine = loads[load].parts[part].column.clone();
            SineLoad { sine: &cosine * 0.0, cosine }
        };
        Ok(Self { parts, alone: components.into_iter().map(load).collect(), replaced, places })
    }

    /// Returns the ends and the peaks of the paths.
    fn resonances(&self) -> impl Iterator<Item = LoopResonance> {
        self.parts.iter().flat_map(MeasuredPart::resonances)
    }

    /// Puts the measured paths in the place of the model at a frequency (rad/s) that they have.
    fn replace(
        &self,
        lines: &LineLoop<'_>,
        frequency: f64,
        responses: &mut [LoadResponse],
    ) -> Result<(), ConfigError> {
        if self.parts.iter().all(|part| part.at(frequency).is_none()) {
            return Ok(());
        }
        let model = lines.solved(frequency, &self.alone, &self.replaced)?;
        for (part, (alone, output)) in self.parts.iter().zip(&self.places) {
            let (Some(measured), (_, share)) = (part.at(frequency), &part.replaced) else { continue };
            let response = &mut responses[part.load.0];
            let own = &mut response.lines[part.output];
            for ((_, amplitude), modelled) in own.iter_mut().zip(&model.amplitudes) {
                *amplitude -= modelled[(*output, *alone)] * *share;
            }
            if let Some((_, direct)) = own.last_mut() {
                *direct += measured * *share;
            }
            // At the samples of the law all lines have one frequency.
            let sum: Complex<f64> = own.iter().map(|(_, amplitude)| amplitude).sum();
            response.sampled[part.output] = sum.norm_sqr();
        }
        Ok(())
    }
}
