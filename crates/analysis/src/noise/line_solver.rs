//! Solutions for the lines of a loop: exact, by solves with the body and with the loop over a period.
//!
//! The body moves as p exp(j w t) under the load alone, p = (j w - A)^-1 load. What the law does about it is found by going through a
//! period from p, and z = exp(j w P) times the states at its start are those at its end: (z - a) d = F - z p with the states p + d at
//! the start and F at the end of that period. The torques repeat but for z, so that each of their lines U at w_n moves the body by
//! (j w_n - A)^-1 B U.

use std::f64::consts::{PI, TAU};

use flexsc_formats::document::ConfigError;
use flexsc_formats::reader_units::number;
use nalgebra::{Complex, DMatrix};

use super::motion::OutputRow;
use super::period_rows::{ForcedMotion, PeriodRows, Piece, joined};
use super::spectral_line::LoadColumn;
use crate::margins::frequency_response::{FrequencyResponse, real_product, unit_circle};
use crate::open_loop::attitude_rows::seconds;
use crate::open_loop::sampling::held;
use crate::open_loop::{BodyMatrices, LoopParts, TransferMatrices};

/// Turns over a period below which the frequency of a line is next to 0.
const SLOW: f64 = 3e-6;
/// Number of integrals of a motion whose frequency is next to 0: the next is 1e-14 of the first.
const INTEGRALS: usize = 3;

/// Complex amplitudes: a row for each output, axis or state, and a column for each load.
pub type Amplitudes = DMatrix<Complex<f64>>;

/// Solver of a loop.
pub struct LineSolver {
    period_rows: PeriodRows,
    body: FrequencyResponse,
    loop_over_period: FrequencyResponse,
}

/// Frequencies (rad/s, with a sign) of the lines over a period (s), the last that of the load.
pub struct LineFrequencies {
    pub frequencies: Vec<f64>,
    pub period: f64,
}

/// Motion of a loop over a period under loads of one frequency, each alone.
pub struct LoadedMotion {
    /// Motion of the body under the loads alone.
    alone: ForcedMotion,
    /// Difference that the law makes to the states at the start of a period.
    change: Amplitudes,
    /// Pieces of the period from the states under the loads alone.
    pieces: Vec<Piece>,
}

impl LineSolver {
    /// Prepares the solver of a loop.
    ///
    /// # Errors
    /// Periods of the loop without a common multiple that is short enough.
    pub fn new(parts: &LoopParts<'_>) -> Result<Self, ConfigError> {
        let drivers: Vec<usize> = (0..parts.body.a.nrows()).collect();
        let period_rows = PeriodRows::driven(parts, &[], &drivers)?;
        let (body, whole) = (response(&parts.body.a), response(&period_rows.a));
        Ok(Self { period_rows, body, loop_over_period: whole })
    }

    /// Returns the frequencies of the lines below the Nyquist frequency of the law, and last that of the load (rad/s).
    pub fn turns(&self, frequency: f64) -> LineFrequencies {
        let (period, nyquist) = (seconds(self.period_rows.period), PI / seconds(self.period_rows.step));
        let first = libm::ceil((-nyquist - frequency) * period / TAU - 1e-9) as i64;
        let last = libm::floor((nyquist - frequency) * period / TAU + 1e-9) as i64;
        let turns = (first..=last).filter(|turn| *turn != 0).chain([0]);
        let frequencies = turns.map(|turn| frequency + TAU * turn as f64 / period).collect();
        LineFrequencies { frequencies, period }
    }

    /// Solves for the motion under loads of the frequency of the last of some lines, each alone.
    ///
    /// # Errors
    /// A motion without damping at the frequency of the load.
    pub fn solve(
        &self,
        parts: &LoopParts<'_>,
        loads: &[LoadColumn],
        turns: &LineFrequencies,
    ) -> Result<LoadedMotion, ConfigError> {
        let frequency = turns.load();
        let undamped = || undamped(frequency);
        // A load has no part in states of exposures.
        let entry = |row: usize, load: usize| loads[load].get(row).copied().unwrap_or_default();
        let forcing = DMatrix::from_fn(parts.body.a.nrows(), loads.len(), entry);
        let amplitudes = self.body.states(Complex::new(0.0, frequency), &forcing).ok_or_else(undamped)?;
        let alone = ForcedMotion { amplitudes, frequency };
        let (end, pieces) = self.period_rows.forced(parts, &alone)?;
        let turn = unit_circle(frequency * turns.period);
        let mut change = joined(&end);
        for (place, state) in self.period_rows.kept.iter().enumerate() {
            if *state < alone.amplitudes.nrows() {
                let start = alone.amplitudes.row(*state) * turn;
                let mut row = change.row_mut(place);
                row -= start;
            }
        }
        let change = self.loop_over_period.states(turn, &change).ok_or_else(undamped)?;
        Ok(LoadedMotion { alone, change, pieces })
    }

    /// Returns the amplitudes of outputs at each frequency under each load alone; NaN next to the frequency 0.
    pub fn amplitudes(
        &self,
        parts: &LoopParts<'_>,
        motion: &LoadedMotion,
        (rows, outputs): (&[OutputRow], &[usize]),
        turns: &LineFrequencies,
    ) -> Vec<Amplitudes> {
        let torques = self.held_values(motion, |piece| &piece.torque);
        let has_commands = outputs.iter().any(|output| matches!(rows[*output], OutputRow::Command(_)));
        let commands =
            if has_commands { self.held_values(motion, |piece| &piece.command) } else { Vec::new() };
        let mut found = Vec::with_capacity(turns.frequencies.len());
        for (place, own) in turns.frequencies.iter().enumerate() {
            let torque = turns.held_amplitudes(&motion.pieces, &torques, *own);
            let body = if (own * turns.period).abs() < TAU * SLOW {
                None
            } else {
                self.body.states(Complex::new(0.0, *own), &(parts.body.b.map(Complex::from) * torque))
            };
            let body = match body {
                Some(body) if place + 1 == turns.frequencies.len() => Some(body + &motion.alone.amplitudes),
                body => body,
            };
            let commanded = if has_commands {
                turns.held_amplitudes(&motion.pieces, &commands, *own)
            } else {
                Amplitudes::zeros(0, 0)
            };
            let unknown = Complex::new(f64::NAN, 0.0);
            let amplitude = |output: usize, load: usize| match &rows[outputs[output]] {
                OutputRow::Command(axis) => commanded[(*axis, load)],
                OutputRow::Body(row) => body.as_ref().map_or(unknown, |body| {
                    row.iter().zip(&body.column(load)).map(|(entry, state)| state * *entry).sum()
                }),
            };
            found.push(DMatrix::from_fn(outputs.len(), motion.change.ncols(), amplitude));
        }
        found
    }

    /// Returns the amplitudes of outputs at a frequency next to 0 that is not that of the loads, as the integral over what the law makes
    /// of the motion: there the body is rigid, and its response to a torque loses all digits.
    pub fn slow_amplitudes(
        &self,
        parts: &LoopParts<'_>,
        motion: &LoadedMotion,
        (rows, outputs): (&[OutputRow], &[usize]),
        (own, period): (f64, f64),
    ) -> Amplitudes {
        let BodyMatrices { a, b, .. } = &parts.body;
        let (order, count) = (a.nrows(), outputs.len());
        // Integrals of the outputs as further states, each of the one before.
        let mut whole = a.clone().resize(order + INTEGRALS * count, order + INTEGRALS * count, 0.0);
        for (place, output) in outputs.iter().enumerate() {
            if let OutputRow::Body(row) = &rows[*output] {
                whole.view_mut((order + place, 0), (1, order)).copy_from(&row.columns(0, order));
            }
            for integral in 1..INTEGRALS {
                let row = order + integral * count + place;
                whole[(row, row - count)] = 1.0;
            }
        }
        let inputs = b.clone().resize_vertically(whole.nrows(), 0.0);
        let bodies = self.held_values(motion, |piece| &piece.body);
        let torques = self.held_values(motion, |piece| &piece.torque);
        let mut sum = Amplitudes::zeros(count, motion.change.ncols());
        for ((piece, body), torque) in motion.pieces.iter().zip(bodies).zip(torques) {
            let from = seconds(piece.from);
            let of_law = body - &motion.alone.amplitudes * unit_circle(motion.alone.frequency * from);
            let (flow, forced) = held(&whole, &inputs, seconds(piece.length));
            let of_states = flow.view((order, 0), (INTEGRALS * count, order)).into_owned();
            let of_torques = forced.rows(order, INTEGRALS * count).into_owned();
            let integrals = real_product(&of_states, &of_law) + real_product(&of_torques, &torque);
            // The integral of exp(-j w t) y by parts: w is so small that further integrals are rounding.
            let mut factor = unit_circle(-own * (from + seconds(piece.length))) / period;
            for integral in 0..INTEGRALS {
                sum += integrals.rows(integral * count, count) * factor;
                factor *= Complex::new(0.0, own);
            }
        }
        sum
    }

    /// Returns the mean square modulus of outputs at the samples of the law, under each load alone.
    pub fn sample_squares(
        &self,
        motion: &LoadedMotion,
        (rows, outputs): (&[OutputRow], &[usize]),
    ) -> DMatrix<f64> {
        let bodies = self.held_values(motion, |piece| &piece.body);
        let commands = self.held_values(motion, |piece| &piece.command);
        let is_sample = |place: &usize| motion.pieces[*place].from % self.period_rows.step == 0;
        let sampled: Vec<usize> = (0..motion.pieces.len()).filter(is_sample).collect();
        let square = |output: usize, load: usize| {
            let at = |place: &usize| match &rows[outputs[output]] {
                OutputRow::Command(axis) => commands[*place][(*axis, load)].norm_sqr(),
                OutputRow::Body(row) => {
                    let states = bodies[*place].column(load);
                    row.iter().zip(&states).map(|(c, x)| x * *c).sum::<Complex<f64>>().norm_sqr()
                }
            };
            sampled.iter().map(at).sum::<f64>() / sampled.len() as f64
        };
        DMatrix::from_fn(outputs.len(), motion.change.ncols(), square)
    }

    /// Returns the values that each piece of a motion holds, such as torques: a row for each, and a column for each load.
    fn held_values(&self, motion: &LoadedMotion, of: fn(&Piece) -> &DMatrix<f64>) -> Vec<Amplitudes> {
        let both = self.period_rows.pieces.iter().zip(&motion.pieces);
        both.map(|(own, forced)| of(own).map(Complex::from) * &motion.change + joined(of(forced))).collect()
    }
}

/// Returns the fault of a loop that a load of a frequency (rad/s) excites without limit.
pub fn undamped(frequency: f64) -> ConfigError {
    let hertz = number(frequency / TAU);
    ConfigError::new("body", format!("has an undamped motion at {hertz} Hz, the frequency of a load"))
}

/// Returns the response of states, of which no output is asked for.
fn response(a: &DMatrix<f64>) -> FrequencyResponse {
    let (none, empty) = (DMatrix::zeros(a.nrows(), 0), DMatrix::zeros(0, a.nrows()));
    FrequencyResponse::new(&TransferMatrices { a: a.clone(), b: none, c: empty, d: DMatrix::zeros(0, 0) })
}

impl LineFrequencies {
    /// Returns the frequency of the load (rad/s).
    pub fn load(&self) -> f64 {
        self.frequencies.last().copied().unwrap_or_default()
    }

    /// Returns the amplitudes at a frequency of values that are constant in each piece.
    fn held_amplitudes(&self, pieces: &[Piece], values: &[Amplitudes], frequency: f64) -> Amplitudes {
        let (rows, columns) = values.first().map_or((0, 0), Amplitudes::shape);
        let mut sum = Amplitudes::zeros(rows, columns);
        for (piece, value) in pieces.iter().zip(values) {
            let (from, length) = (seconds(piece.from), seconds(piece.length));
            // The mean of exp(-j w t) over the piece.
            let half = 0.5 * frequency * length;
            let mean = if half.abs() < 1e-8 { 1.0 } else { libm::sin(half) / half };
            sum += value * (unit_circle(-frequency * (from + 0.5 * length)) * (mean * length / self.period));
        }
        sum
    }
}
