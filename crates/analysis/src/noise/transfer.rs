//! Responses of a loop to loads of any frequency: the lines of its outputs under a unit of each load, and the resonances that a load meets.

use std::f64::consts::TAU;

use flexsc_formats::document::ConfigError;
use nalgebra::{Complex, DMatrix};

use super::lines::LineLoop;
use super::loaded_loop::LoadedLoop;
use super::measured_loads::{MeasuredPart, VibrationLoad};
use super::spectral_line::{ComplexLine, LoadColumn};
use crate::eigenvalues::eigenvalues;
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
    /// Response of the angles and rates of the body alone that sensors measure to the loads.
    sensed: FrequencyResponse,
    /// Loop under the loads.
    pub loaded: LoadedLoop<'a>,
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
    /// See [`LoadedLoop::new`].
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
        let columns: Vec<LoadColumn> = loads.iter().map(VibrationLoad::column).collect();
        let entry = |row: usize, load: usize| columns[load].get(row).map_or(0.0, |entry| entry.re);
        let sensed = FrequencyResponse::new(&TransferMatrices {
            a: body.a.clone(),
            b: DMatrix::from_fn(body.a.nrows(), loads.len(), entry),
            c: body.c.clone(),
            d: DMatrix::zeros(body.c.nrows(), loads.len()),
        });
        Ok(Self {
            lines,
            outputs,
            sensed,
            loaded: LoadedLoop::new(lines, outputs, loads)?,
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
        let direct = self.resonances.iter().copied();
        let direct = direct.chain(self.loaded.measured().iter().flat_map(MeasuredPart::resonances));
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
        let (lines, solved) = self.loaded.before_mirrors(frequency)?;
        let squares = self.lines.sample_squares(&solved, self.outputs);
        let of_load = |(load, lines)| {
            let sampled = squares.column(load).iter().copied().collect();
            LoadResponse { lines, sampled }
        };
        let mut found: Vec<LoadResponse> = lines.into_iter().enumerate().map(of_load).collect();
        for part in self.loaded.measured().iter().filter(|part| part.at(frequency).is_some()) {
            // At the samples of the law all lines have one frequency.
            let LoadResponse { lines, sampled } = &mut found[part.load.0];
            let sum: Complex<f64> = lines[part.output].iter().map(|(_, amplitude)| amplitude).sum();
            sampled[part.output] = sum.norm_sqr();
        }
        Ok(found)
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
