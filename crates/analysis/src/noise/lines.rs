//! Lines of a closed loop under loads that turn: the line at the load's frequency, and those that sampling makes of it.
//!
//! With a load of frequency w on the body, the loop moves periodically but for a factor exp(j w P) from period to period of
//! length P. An output therefore has lines at w + 2 pi n/P for every n. Those below the Nyquist frequency of the law may
//! excite a mode.

use std::collections::BTreeMap;

use flexsc_formats::document::ConfigError;
use flexsc_formats::reader_units::ReaderUnits;
use nalgebra::{Complex, DMatrix, DVector};

use super::line_solver::{Amplitudes, LineFrequencies, LineSolver, LoadedMotion, undamped};
use super::measured_loads::VibrationLoad;
use super::mirror_states::{MirrorOutput, with_mirrors};
use super::motion::{Motion, OutputRow};
use super::noisy_loop::{NoiseError, stable_loops};
use super::output::{output_index, outputs};
use super::period_rows::PeriodRows;
use super::sample_times::SamplePlace;
use super::spectral_line::LoadColumn;
use crate::linear_model::Signal;
use crate::margins::frequency_response::unit_circle;
use crate::open_loop::attitude_rows::seconds;
use crate::open_loop::{LoopBreak, LoopParts};
use flexsc_scenario::Scenario;

/// Lines of some outputs before mirrors under loads of one frequency, each alone.
pub(super) struct SolvedLines {
    pub turns: LineFrequencies,
    motion: LoadedMotion,
    /// Complex amplitudes at each frequency: a row for each output, and a column for each load.
    pub amplitudes: Vec<Amplitudes>,
}

/// Closed loop to which loads that turn are applied.
pub struct LineLoop<'a> {
    pub(super) parts: LoopParts<'a>,
    /// Outputs, and their rows over the states of the body, before the mirrors of lines of sight.
    pub(super) signals: Vec<Signal>,
    rows: Vec<OutputRow>,
    /// Mirror behind which an output is.
    mirrors: Vec<Option<MirrorOutput>>,
    solver: LineSolver,
}

impl<'a> LineLoop<'a> {
    /// Returns the closed loop of a scenario; it must be stable.
    ///
    /// # Errors
    /// A part that is not linear: its key, and the reason.
    pub fn from_scenario(scenario: &'a Scenario) -> Result<Self, ConfigError> {
        Self::from_parts(LoopParts::from_scenario(scenario, LoopBreak::Command)?)
    }

    /// Returns the same loop with the wheels that points of the structure carry at a speed (rad/s); `None` if there are none, so that
    /// the loop is the same at all speeds.
    ///
    /// # Errors
    /// See [`Self::from_scenario`].
    pub fn at_wheel_speed(&self, speed: f64) -> Result<Option<Self>, ConfigError> {
        let Some(parts) = self.parts.at_wheel_speed(speed)? else { return Ok(None) };
        let unstable = |fault: NoiseError| match fault {
            NoiseError::Key(fault) => fault,
            other => {
                let at = ReaderUnits::Engineering.quantity(speed, "rad/s");
                ConfigError::new("actuator.wheels.points", format!("wheels at {at}: {other}"))
            }
        };
        stable_loops(&parts).map_err(unstable)?;
        Self::from_parts(parts).map(Some)
    }

    /// Returns the closed loop of these parts, which are cut open at the command.
    ///
    /// # Errors
    /// Periods of the loop without a common multiple that is short enough.
    pub(crate) fn from_parts(parts: LoopParts<'a>) -> Result<Self, ConfigError> {
        let (signals, rows) = outputs(&parts);
        let mirrors = MirrorOutput::all(parts.scenario, &signals);
        Ok(Self { solver: LineSolver::new(&parts)?, parts, signals, rows, mirrors })
    }

    /// Returns the index of an output.
    ///
    /// # Errors
    /// A name that no output has: the names that there are.
    pub fn output(&self, name: &str) -> Result<usize, String> {
        output_index(&self.signals, name)
    }

    /// Returns the largest number of lines of an output under a load.
    pub(super) fn line_count(&self, output: usize) -> usize {
        let before = self.solver.turns(0.0).frequencies.len();
        before * self.mirror(output).map_or(1, |_| MirrorOutput::LINES)
    }

    /// Returns the load of a torque of 1 N m about one axis of the actuators.
    pub fn torque(&self, axis: usize) -> VibrationLoad {
        VibrationLoad::of_torque(axis, self.parts.body.b.column(axis).into_owned())
    }

    /// Solves for the lines of some outputs before mirrors under each load alone, all of one frequency (rad/s).
    ///
    /// # Errors
    /// A frequency at which a motion without damping grows without limit.
    pub(super) fn solved(
        &self,
        frequency: f64,
        loads: &[LoadColumn],
        outputs: &[usize],
    ) -> Result<SolvedLines, ConfigError> {
        let turns = self.solver.turns(frequency);
        let motion = self.solver.solve(&self.parts, loads, &turns)?;
        let mut amplitudes = self.solver.amplitudes(&self.parts, &motion, (&self.rows, outputs), &turns);
        // Next to the frequency 0, at which the body is rigid, by the motion itself.
        let last = turns.frequencies.len() - 1;
        for (turn, own) in amplitudes.iter_mut().enumerate() {
            if turn < last && own.iter().any(|value| value.re.is_nan()) {
                let at = (turns.frequencies[turn], turns.period);
                let slow = self.solver.slow_amplitudes(&self.parts, &motion, (&self.rows, outputs), at);
                own.zip_apply(&slow, |value, slow| {
                    if value.re.is_nan() {
                        *value = slow;
                    }
                });
            }
        }
        for (place, output) in outputs.iter().enumerate() {
            for (load, column) in loads.iter().enumerate() {
                if amplitudes[last][(place, load)].re.is_nan() {
                    amplitudes[last][(place, load)] = self.slow_line(column, *output, &turns)?;
                }
            }
        }
        Ok(SolvedLines { turns, motion, amplitudes })
    }

    /// Returns the mean square modulus of outputs before mirrors at the samples of the law, under each load alone.
    pub(super) fn sample_squares(&self, solved: &SolvedLines, outputs: &[usize]) -> DMatrix<f64> {
        self.solver.sample_squares(&solved.motion, (&self.rows, outputs))
    }

    /// Returns the mirror behind which an output is, if it is behind one.
    pub(super) fn mirror(&self, output: usize) -> Option<&MirrorOutput> {
        self.mirrors[output].as_ref()
    }

    /// Returns the amplitude of an output at the frequency of a load, before a mirror, as the integral over the motion.
    fn slow_line(
        &self,
        load: &LoadColumn,
        output: usize,
        turns: &LineFrequencies,
    ) -> Result<Complex<f64>, ConfigError> {
        let motion = motion(&self.parts, &self.rows, (turns.load(), load))?;
        let (own, mut sum) = (turns.load(), Complex::ZERO);
        motion.motion.integrate(&[output], [0.0, turns.period], own.abs(), |time, weight, rows| {
            let value: Complex<f64> =
                rows.row(0).iter().zip(&motion.state).map(|(row, state)| state * *row).sum();
            sum += value * unit_circle(-own * time) * (weight / turns.period);
        });
        Ok(sum)
    }

    /// Returns the periodic motion of the loop under a load of a frequency (rad/s).
    ///
    /// # Errors
    /// A frequency at which a motion without damping grows without limit.
    pub fn motion(&self, frequency: f64, load: &VibrationLoad) -> Result<TurningMotion, ConfigError> {
        let whole = with_mirrors(&self.parts);
        motion(&whole, &outputs(&whole).1, (frequency, &load.column()))
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

/// Returns the periodic motion of outputs of a loop, as rows over the states of its body, under a load of a frequency (rad/s).
fn motion(
    parts: &LoopParts<'_>,
    rows: &[OutputRow],
    (frequency, load): (f64, &LoadColumn),
) -> Result<TurningMotion, ConfigError> {
    let order = parts.body.a.nrows();
    let driven = driven(parts, frequency, load);
    let period_rows = PeriodRows::driven(&driven, &[], &[order, order + 1])?;
    let state = loop_state(&period_rows, [order, order + 1], frequency)?;
    let whole = |row: &OutputRow| match row {
        OutputRow::Body(row) => OutputRow::Body(row.clone().resize_horizontally(order + 2, 0.0)),
        command @ OutputRow::Command(_) => command.clone(),
    };
    let rows = rows.iter().map(whole).collect();
    let motion = Motion::new((&driven.body.a, &driven.body.b), period_rows.pieces, rows);
    Ok(TurningMotion { motion, state, period: period_rows.period, frequency })
}

/// Returns the parts of a loop with two oscillators as further states of the body.
fn driven<'a>(parts: &LoopParts<'a>, frequency: f64, load: &LoadColumn) -> LoopParts<'a> {
    let mut parts = parts.clone();
    let order = parts.body.a.nrows();
    parts.body.resize(order + 2);
    let a = &mut parts.body.a;
    a.view_mut((0, order), (load.len(), 1)).copy_from(&load.map(|entry| entry.re));
    a.view_mut((0, order + 1), (load.len(), 1)).copy_from(&load.map(|entry| -entry.im));
    (a[(order, order + 1)], a[(order + 1, order)]) = (-frequency, frequency);
    parts
}

/// Returns the states at the start of a period, as complex amplitudes, of a loop that two oscillators drive.
fn loop_state(
    period_rows: &PeriodRows,
    oscillators: [usize; 2],
    frequency: f64,
) -> Result<DVector<Complex<f64>>, ConfigError> {
    let kept = &period_rows.kept;
    let within: Vec<usize> = (0..kept.len()).filter(|place| !oscillators.contains(&kept[*place])).collect();
    let turn = unit_circle(frequency * seconds(period_rows.period));
    let a = period_rows.a.map(Complex::from);
    let own = -a.select_rows(&within).select_columns(&within);
    let factors = (own + DMatrix::from_diagonal_element(within.len(), within.len(), turn)).lu();
    // cos w t and sin w t are the real parts of exp(j w t) and -j exp(j w t).
    let mut state = DVector::<Complex<f64>>::zeros(kept.len());
    for (place, index) in kept.iter().enumerate() {
        if *index == oscillators[0] {
            state[place] = Complex::new(1.0, 0.0);
        } else if *index == oscillators[1] {
            state[place] = Complex::new(0.0, -1.0);
        }
    }
    let forced = &a * &state;
    let forced = DVector::from_fn(within.len(), |row, _| forced[within[row]]);
    let loop_state = factors.solve(&forced).ok_or_else(|| undamped(frequency))?;
    within.iter().zip(&loop_state).for_each(|(place, value)| state[*place] = *value);
    Ok(state)
}
