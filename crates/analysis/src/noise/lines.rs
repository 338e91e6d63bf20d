//! Lines of a closed loop under loads that turn: the line at the load's frequency, and those that sampling makes of it.
//!
//! With a load of frequency w on the body, the loop moves periodically but for a factor exp(j w P) from period to period of
//! length P. An output therefore has lines at w + 2 pi n/P for every n. Those below the Nyquist frequency of the law may
//! excite a mode.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};
use std::ops::Range;

use flexsc_formats::document::ConfigError;
use flexsc_formats::reader_units::number;
use nalgebra::{Complex, DMatrix, DVector, RowDVector};
use serde::Serialize;

use super::motion::{Motion, OutputRow};
use super::output::outputs;
use super::period_rows::{PeriodRows, Piece};
use super::sample_times::SamplePlace;
use super::schedule::PeriodTimes;
use crate::margins::frequency_response::{modulus, unit_circle};
use crate::open_loop::attitude_rows::seconds;
use crate::open_loop::{BodyMatrices, LoopBreak, LoopParts};
use flexsc_scenario::Scenario;

/// Load on the states of the body, cosine cos w t + sine sin w t, as columns of their rate of change.
#[derive(Clone, Debug, PartialEq)]
pub struct SineLoad {
    /// Column of the cosine.
    pub cosine: DVector<f64>,
    /// Column of the sine.
    pub sine: DVector<f64>,
}

/// Sine of an output.
#[derive(Copy, Clone, Debug, Default, PartialEq, Serialize)]
pub struct SpectralLine {
    /// Frequency (rad/s).
    pub frequency_rad_s: f64,
    /// Amplitude, in the unit of the output.
    pub amplitude: f64,
}

impl SpectralLine {
    /// Returns the mean square.
    pub fn mean_square(&self) -> f64 {
        0.5 * self.amplitude * self.amplitude
    }
}

/// Lines of an output under a load.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OutputLines {
    /// Line at the frequency of the load.
    pub direct: SpectralLine,
    /// Lines below the Nyquist frequency of the law that sampling makes of it, the largest first.
    pub aliases: Vec<SpectralLine>,
}

impl OutputLines {
    /// Returns all lines.
    pub fn all(&self) -> impl Iterator<Item = &SpectralLine> {
        self.aliases.iter().chain([&self.direct])
    }

    /// Returns the mean square of all lines.
    pub fn mean_square(&self) -> f64 {
        self.all().map(SpectralLine::mean_square).sum()
    }
}

/// Closed loop to which loads that turn are applied.
pub struct LineLoop<'a> {
    pub(super) parts: LoopParts<'a>,
    /// Outputs as rows over the states of the body.
    pub(super) rows: Vec<OutputRow>,
}

impl<'a> LineLoop<'a> {
    /// Returns the closed loop of a scenario; it must be stable.
    ///
    /// # Errors
    /// A part that is not linear: its key, and the reason.
    pub fn from_scenario(scenario: &'a Scenario) -> Result<Self, ConfigError> {
        Ok(Self::from_parts(LoopParts::from_scenario(scenario, LoopBreak::Command)?))
    }

    /// Returns the closed loop of these parts, which are cut open at the command.
    pub(crate) fn from_parts(parts: LoopParts<'a>) -> Self {
        let rows = outputs(&parts).1;
        Self { parts, rows }
    }

    /// Returns the load of a torque that turns about one axis of the actuators.
    pub fn torque(&self, axis: usize) -> SineLoad {
        let cosine = self.parts.body.b.column(axis).into_owned();
        SineLoad { sine: DVector::zeros(cosine.len()), cosine }
    }

    /// Returns the load of torques amplitude sin(w t + phase) (N m, rad), each with the axis of the actuators about which it
    /// acts.
    pub fn torques(&self, torques: &[(usize, f64, f64)]) -> SineLoad {
        let body = &self.parts.body.b;
        let mut load = SineLoad { cosine: DVector::zeros(body.nrows()), sine: DVector::zeros(body.nrows()) };
        for (axis, amplitude, phase) in torques {
            load.cosine += body.column(*axis) * (amplitude * libm::sin(*phase));
            load.sine += body.column(*axis) * (amplitude * libm::cos(*phase));
        }
        load
    }

    /// Computes the lines of some outputs under each load alone, all of one frequency (rad/s).
    ///
    /// # Errors
    /// Periods of the loop without a common multiple that is short enough, or a frequency at which a motion without
    /// damping grows without limit.
    pub fn lines(
        &self,
        frequency: f64,
        loads: &[SineLoad],
        outputs: &[usize],
    ) -> Result<Vec<Vec<OutputLines>>, ConfigError> {
        let order = self.parts.body.a.nrows();
        let meters = order + 2 * loads.len();
        let mut driven = self.driven(frequency, loads);
        let oscillators: Vec<usize> = (order..meters).collect();
        let turns = self.turns(frequency)?;
        for output in outputs {
            if let OutputRow::Body(row) = &self.rows[*output] {
                turns.frequencies.iter().for_each(|frequency| add_meter(&mut driven, row, *frequency));
            }
        }
        let end = driven.body.a.nrows();
        let period_rows = PeriodRows::driven(&driven, &[], &oscillators)?;
        let kept = &period_rows.kept;
        let a = period_rows.a.map(|entry| Complex::new(entry, 0.0));
        let states = loop_states(&period_rows, &oscillators, order..end, frequency)?;
        let mut found = Vec::with_capacity(loads.len());
        for state in states {
            let after = &a * &state;
            // A meter that no load reaches is not kept.
            let metered = |index: usize| {
                kept.iter()
                    .position(|kept| *kept == index)
                    .map_or(Complex::new(0.0, 0.0), |place| after[place])
            };
            let mut next = meters;
            let lines = outputs.iter().map(|output| match &self.rows[*output] {
                OutputRow::Body(_) => turns.lines(|place| {
                    let total = metered(next) + metered(next + 1) * Complex::new(0.0, 1.0);
                    next += 2;
                    total * unit_circle(-turns.frequencies[place] * turns.period) / turns.period
                }),
                OutputRow::Command(axis) => {
                    turns.lines(|place| turns.command_amplitude(&period_rows.pieces, *axis, &state, place))
                }
            });
            found.push(lines.collect());
        }
        Ok(found)
    }

    /// Returns the periodic motion of the loop under a load of a frequency (rad/s).
    ///
    /// # Errors
    /// See [`Self::lines`].
    pub fn motion(&self, frequency: f64, load: &SineLoad) -> Result<TurningMotion, ConfigError> {
        let order = self.parts.body.a.nrows();
        let driven = self.driven(frequency, std::slice::from_ref(load));
        let period_rows = PeriodRows::driven(&driven, &[], &[order, order + 1])?;
        let state = loop_states(&period_rows, &[order, order + 1], order..order + 2, frequency)?.remove(0);
        let whole = |row: &OutputRow| match row {
            OutputRow::Body(row) => OutputRow::Body(row.clone().resize_horizontally(order + 2, 0.0)),
            command @ OutputRow::Command(_) => command.clone(),
        };
        let rows = self.rows.iter().map(whole).collect();
        let motion = Motion::new((&driven.body.a, &driven.body.b), period_rows.pieces, rows);
        Ok(TurningMotion { motion, state, period: period_rows.period, frequency })
    }

    /// Returns the frequencies of the lines below the Nyquist frequency of the law, and last that of the load.
    pub(super) fn turns(&self, frequency: f64) -> Result<LineFrequencies, ConfigError> {
        let PeriodTimes { period, step } = PeriodTimes::new(&self.parts)?;
        let (period, nyquist) = (seconds(period), PI / seconds(step));
        let first = libm::ceil((-nyquist - frequency) * period / TAU - 1e-9) as i64;
        let last = libm::floor((nyquist - frequency) * period / TAU + 1e-9) as i64;
        let turns = (first..=last).filter(|turn| *turn != 0).chain([0]);
        let frequencies = turns.map(|turn| frequency + TAU * turn as f64 / period).collect();
        Ok(LineFrequencies { frequencies, period })
    }

    /// Returns the parts of the loop with oscillators as further states of the body, two for each load.
    pub(super) fn driven(&self, frequency: f64, loads: &[SineLoad]) -> LoopParts<'a> {
        let mut parts = self.parts.clone();
        let body = &mut parts.body;
        let order = body.a.nrows();
        resize(body, order + 2 * loads.len());
        for (load, SineLoad { cosine, sine }) in loads.iter().enumerate() {
            let place = order + 2 * load;
            body.a.view_mut((0, place), (order, 1)).copy_from(cosine);
            body.a.view_mut((0, place + 1), (order, 1)).copy_from(sine);
            (body.a[(place, place + 1)], body.a[(place + 1, place)]) = (-frequency, frequency);
        }
        parts
    }
}

/// Motion of a loop under a load that turns: from period to period it is multiplied by exp(j w P).
pub struct TurningMotion {
    motion: Motion,
    /// States at the start of a period, as complex amplitudes.
    state: DVector<Complex<f64>>,
    /// Length of the period (fs).
    pub period: i64,
    /// Frequency of the load (rad/s).
    frequency: f64,
}

impl TurningMotion {
    /// Returns the complex values of an output at samples, whose real parts are its values under cosine cos w t + sine sin w t
    /// but for the phase at the start of the samples' first period.
    pub fn values(&self, output: usize, places: impl IntoIterator<Item = SamplePlace>) -> Vec<Complex<f64>> {
        let mut known: BTreeMap<i64, Complex<f64>> = BTreeMap::new();
        let turn = self.frequency * seconds(self.period);
        let value = |place: SamplePlace| {
            let own = *known.entry(place.time).or_insert_with(|| {
                let row = self.motion.rows_at_ticks(&[output], place.time);
                row.row(0).iter().zip(&self.state).map(|(entry, state)| state * *entry).sum()
            });
            own * unit_circle(turn * place.period as f64)
        };
        places.into_iter().map(value).collect()
    }
}

/// Frequencies (rad/s, with a sign) of the lines over a period (s), the last that of the load.
pub(super) struct LineFrequencies {
    pub frequencies: Vec<f64>,
    pub period: f64,
}

impl LineFrequencies {
    /// Returns the lines whose complex amplitudes a function gives for each frequency.
    fn lines(&self, amplitude: impl FnMut(usize) -> Complex<f64>) -> OutputLines {
        let amplitudes = (0..self.frequencies.len()).map(amplitude);
        let mut all: Vec<SpectralLine> = self
            .frequencies
            .iter()
            .zip(amplitudes)
            .map(|(frequency, value)| SpectralLine {
                frequency_rad_s: frequency.abs(),
                amplitude: modulus(value),
            })
            .collect();
        let direct = all.pop().unwrap_or_default();
        all.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
        OutputLines { direct, aliases: all }
    }

    /// Returns the amplitude of a command, which is constant in each piece.
    pub fn command_amplitude(
        &self,
        pieces: &[Piece],
        axis: usize,
        state: &DVector<Complex<f64>>,
        place: usize,
    ) -> Complex<f64> {
        self.held_amplitude((pieces, |piece| &piece.command), axis, state, place)
    }

    /// Returns the amplitude of a row of what is constant in each piece.
    pub fn held_amplitude(
        &self,
        (pieces, of_piece): (&[Piece], fn(&Piece) -> &DMatrix<f64>),
        row: usize,
        state: &DVector<Complex<f64>>,
        place: usize,
    ) -> Complex<f64> {
        let frequency = self.frequencies[place];
        let part = |piece: &Piece| {
            let value: Complex<f64> = of_piece(piece).row(row).iter().zip(state).map(|(c, s)| s * *c).sum();
            let (from, length) = (seconds(piece.from), seconds(piece.length));
            // The mean of exp(-j w t) over the piece.
            let half = 0.5 * frequency * length;
            let mean = if half.abs() < 1e-8 { 1.0 } else { libm::sin(half) / half };
            value * unit_circle(-frequency * (from + 0.5 * length)) * (mean * length / self.period)
        };
        pieces.iter().map(part).sum()
    }
}

/// Returns the states at the start of a period, as complex amplitudes, of a loop that two oscillators drive for each load:
/// `oscillators` and all indices in `outside` are no states of the loop itself.
pub(super) fn loop_states(
    period_rows: &PeriodRows,
    oscillators: &[usize],
    outside: Range<usize>,
    frequency: f64,
) -> Result<Vec<DVector<Complex<f64>>>, ConfigError> {
    let kept = &period_rows.kept;
    let within: Vec<usize> = (0..kept.len()).filter(|place| !outside.contains(&kept[*place])).collect();
    let turn = unit_circle(frequency * seconds(period_rows.period));
    let a = period_rows.a.map(|entry| Complex::new(entry, 0.0));
    let own = -a.select_rows(&within).select_columns(&within);
    let factors = (own + DMatrix::from_diagonal_element(within.len(), within.len(), turn)).lu();
    let state_under = |pair: &[usize]| {
        // cos w t and sin w t are the real parts of exp(j w t) and -j exp(j w t).
        let mut state = DVector::<Complex<f64>>::zeros(kept.len());
        for (place, index) in kept.iter().enumerate() {
            if *index == pair[0] {
                state[place] = Complex::new(1.0, 0.0);
            } else if *index == pair[1] {
                state[place] = Complex::new(0.0, -1.0);
            }
        }
        let forced = &a * &state;
        let forced = DVector::from_fn(within.len(), |row, _| forced[within[row]]);
        let Some(loop_state) = factors.solve(&forced) else {
            let why =
                format!("has an undamped motion at {} Hz, the frequency of a load", number(frequency / TAU));
            return Err(ConfigError::new("body", why));
        };
        within.iter().zip(&loop_state).for_each(|(place, value)| state[*place] = *value);
        Ok(state)
    };
    oscillators.chunks(2).map(state_under).collect()
}

/// Adds states without effect to a body, up to a number of states.
fn resize(body: &mut BodyMatrices, size: usize) {
    body.a.resize_mut(size, size, 0.0);
    body.b.resize_vertically_mut(size, 0.0);
    body.c.resize_horizontally_mut(size, 0.0);
}

/// Adds two states that meter an output y at a frequency w: q' = j w q + y, so that q exp(-j w t) is the integral of
/// y exp(-j w t).
fn add_meter(parts: &mut LoopParts<'_>, row: &RowDVector<f64>, frequency: f64) {
    let place = parts.body.a.nrows();
    resize(&mut parts.body, place + 2);
    let a = &mut parts.body.a;
    a.view_mut((place, 0), (1, row.len())).copy_from(row);
    (a[(place, place + 1)], a[(place + 1, place)]) = (-frequency, frequency);
}
