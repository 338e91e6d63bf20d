//! Responses of a loop to loads of any frequency: the lines of its outputs under a unit of each load, without quadrature.
//!
//! Under a load b exp(j w t) the loop's torques have components u_n at the frequencies w_n = w + 2 pi n/P, and the body has
//! (j w_n - A)^-1 (B u_n + b) there, with b only at w itself. The torques follow from the samples of the body's own response.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use flexsc_formats::document::ConfigError;
use flexsc_formats::reader_units::number;
use nalgebra::{Complex, DMatrix, DVector};

use super::lines::{LineLoop, SineLoad, loop_states};
use super::motion::OutputRow;
use super::period_rows::{PeriodRows, Piece};
use crate::eigenvalues::eigenvalues;
use crate::margins::FrequencyResponse;
use crate::margins::frequency_response::{modulus, unit_circle};
use crate::open_loop::attitude_rows::seconds;
use crate::open_loop::sampling::held;
use crate::open_loop::{BodyMatrices, OpenLoop, TransferMatrices};

/// Least distance of an alias from zero frequency, times the period, at which its response is computed: below it, one is taken
/// that far beside.
const LEAST_ALIAS: f64 = 1e-6;

/// Distance of two resonances, relative to the half width of the narrower one, below which they are one.
const APART: f64 = 0.5;
/// Difference from the frequency of a mode as an alias, relative, below which a resonance of the loop is that mode.
const OF_MODE: f64 = 0.1;
/// Largest number of aliases of resonances.
const MOST_FOLDS: usize = 400;

/// Responses of outputs to loads on the states of the body.
pub struct LoopTransfer<'a> {
    lines: &'a LineLoop<'a>,
    /// Outputs, as indices.
    outputs: &'a [usize],
    /// Loads, as columns of the rates of the body's states.
    loads: DMatrix<f64>,
    body: FrequencyResponse,
    /// Flows of the body over the pieces of a period, by their lengths (fs).
    flows: BTreeMap<i64, (DMatrix<f64>, DMatrix<f64>)>,
    /// Resonances: frequency and half width (rad/s), of the body and then of the loop.
    pub resonances: Vec<[f64; 2]>,
    of_body: usize,
    /// Distance of the frequencies that have the same aliases (rad/s).
    pub turn: f64,
}

/// Lines of each output under a unit of one load.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadResponse {
    /// Frequencies of the lines (rad/s): aliases below the Nyquist frequency of the law, and last that of the load.
    pub frequencies: Vec<f64>,
    /// Complex amplitudes of each output at these frequencies.
    pub amplitudes: Vec<Vec<Complex<f64>>>,
    /// Mean square modulus of each output at the samples of the law.
    pub sampled: Vec<f64>,
}

impl<'a> LoopTransfer<'a> {
    /// Creates the responses of some outputs to loads, each a column of the rates of the body's states.
    ///
    /// # Errors
    /// See [`LineLoop::lines`].
    pub fn new(
        lines: &'a LineLoop<'a>,
        outputs: &'a [usize],
        loads: &[DVector<f64>],
    ) -> Result<Self, ConfigError> {
        let BodyMatrices { a, b, .. } = &lines.parts.body;
        let pieces = PeriodRows::new(&lines.parts, &[])?.pieces;
        let flow = |piece: &Piece| (piece.length, held(a, b, seconds(piece.length)));
        let opened = OpenLoop::from_parts(&lines.parts)?;
        let closed = opened.transfer.sensitivity().and_then(|closed| eigenvalues(&closed.a));
        let of_loop = closed.unwrap_or_default().into_iter().map(|pole| {
            let (angle, size) = (libm::atan2(pole.im, pole.re), modulus(pole).max(f64::MIN_POSITIVE));
            [angle.abs() / opened.period, libm::log(size).abs() / opened.period]
        });
        let is_above = |[frequency, _]: &[f64; 2]| *frequency > 0.0;
        let of_body =
            eigenvalues(a).unwrap_or_default().into_iter().map(|pole| [pole.im.abs(), pole.re.abs()]);
        let of_body: Vec<[f64; 2]> = of_body.filter(is_above).collect();
        let transfer = TransferMatrices {
            a: a.clone(),
            b: DMatrix::zeros(a.nrows(), 0),
            c: DMatrix::zeros(0, a.nrows()),
            d: DMatrix::zeros(0, 0),
        };
        Ok(Self {
            lines,
            outputs,
            loads: DMatrix::from_columns(loads),
            body: FrequencyResponse::new(&transfer),
            flows: pieces.iter().map(flow).collect(),
            of_body: of_body.len(),
            resonances: of_body.into_iter().chain(of_loop.filter(is_above)).collect(),
            turn: TAU / opened.period,
        })
    }

    /// Returns the resonances (frequency, half width, rad/s) that a load up to a frequency meets: of body and loop, and then as aliases of
    /// the loop, each with the multiple of the loop's rate beside which it lies.
    pub fn met(&self, highest: f64) -> (Vec<[f64; 2]>, Vec<([f64; 2], f64)>) {
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
        let direct = self.resonances.iter().copied().filter(|[at, _]| is_below(*at)).collect();
        (direct, aliases.filter(|([at, _], _)| is_below(*at)).collect())
    }

    /// Returns the response to each load at a frequency (rad/s).
    ///
    /// # Errors
    /// A frequency at which a motion without damping grows without limit.
    pub fn at(&self, frequency: f64) -> Result<Vec<LoadResponse>, ConfigError> {
        let turns = self.lines.turns(frequency)?;
        let nearest = turns.frequencies.iter().map(|own| own.abs()).fold(f64::INFINITY, f64::min);
        let frequency = if nearest * turns.period < LEAST_ALIAS {
            frequency + LEAST_ALIAS / turns.period
        } else {
            frequency
        };
        let turns = self.lines.turns(frequency)?;
        let count = self.loads.ncols();
        let order = self.loads.nrows();
        let columns = self.loads.map(|entry| Complex::new(entry, 0.0));
        let undamped = || {
            let hertz = number(frequency / TAU);
            ConfigError::new("body", format!("has an undamped motion at {hertz} Hz, the frequency of a load"))
        };
        let own = self.body.states(Complex::new(0.0, frequency), &columns).ok_or_else(undamped)?;
        let zero = DVector::zeros(order);
        let load = |load| SineLoad { cosine: self.loads.column(load).into_owned(), sine: zero.clone() };
        let driven = self.lines.driven(frequency, &(0..count).map(load).collect::<Vec<_>>());
        let oscillators: Vec<usize> = (order..order + 2 * count).collect();
        let flow = |_: &BodyMatrices, length: i64| self.driven_flow(frequency, &own, length);
        let period_rows = PeriodRows::with_flow(&driven, &[], &oscillators, &flow)?;
        let states = loop_states(&period_rows, &oscillators, order..order + 2 * count, frequency)?;
        let b = &self.lines.parts.body.b;
        // Motion of the body at each of the frequencies, a column for each load.
        let mut motions = Vec::with_capacity(turns.frequencies.len());
        for (place, at) in turns.frequencies.iter().enumerate() {
            let mut forced = DMatrix::zeros(order, count);
            for (load, state) in states.iter().enumerate() {
                for axis in 0..b.ncols() {
                    let torque = turns.held_amplitude(
                        (&period_rows.pieces, |piece| &piece.torque),
                        axis,
                        state,
                        place,
                    );
                    for row in 0..order {
                        forced[(row, load)] += torque * b[(row, axis)];
                    }
                }
            }
            if place + 1 == turns.frequencies.len() {
                forced += &columns;
            }
            motions.push(self.body.states(Complex::new(0.0, *at), &forced).ok_or_else(undamped)?);
        }
        let of_load = |(load, state): (usize, &DVector<Complex<f64>>)| {
            let amplitude = |output: &usize, place: usize| match &self.lines.rows[*output] {
                OutputRow::Body(row) => {
                    row.iter().zip(motions[place].column(load).iter()).map(|(c, x)| x * *c).sum()
                }
                OutputRow::Command(axis) => turns.command_amplitude(&period_rows.pieces, *axis, state, place),
            };
            let all = |output: &usize| (0..motions.len()).map(|place| amplitude(output, place)).collect();
            LoadResponse {
                frequencies: turns.frequencies.iter().map(|own| own.abs()).collect(),
                amplitudes: self.outputs.iter().map(all).collect(),
                sampled: self
                    .outputs
                    .iter()
                    .map(|output| self.at_samples(*output, &period_rows, state))
                    .collect(),
            }
        };
        Ok(states.iter().enumerate().map(of_load).collect())
    }

    /// Returns the mean square modulus of an output at the samples of the law.
    fn at_samples(&self, output: usize, rows: &PeriodRows, state: &DVector<Complex<f64>>) -> f64 {
        let sampled: Vec<&Piece> = rows.pieces.iter().filter(|piece| piece.from % rows.step == 0).collect();
        let square = |piece: &&Piece| {
            let row = match &self.lines.rows[output] {
                // The states behind those of the body are of no output.
                OutputRow::Body(row) => row * piece.body.rows(0, row.len()),
                OutputRow::Command(axis) => piece.command.row(*axis).into_owned(),
            };
            row.iter().zip(state).map(|(entry, state)| state * *entry).sum::<Complex<f64>>().norm_sqr()
        };
        sampled.iter().map(square).sum::<f64>() / sampled.len() as f64
    }

    /// Returns the flow over a time (fs) of the body with two oscillators for each load, whose steady motions are known.
    fn driven_flow(
        &self,
        frequency: f64,
        own: &DMatrix<Complex<f64>>,
        length: i64,
    ) -> (DMatrix<f64>, DMatrix<f64>) {
        let known = self.flows.get(&length);
        let body = &self.lines.parts.body;
        let (free, forced) = known.cloned().unwrap_or_else(|| held(&body.a, &body.b, seconds(length)));
        let (order, size) = (free.nrows(), free.nrows() + 2 * own.ncols());
        let (real, imaginary) = (own.map(|entry| entry.re), own.map(|entry| entry.im));
        let turned = unit_circle(frequency * seconds(length));
        let after = own.map(|entry| entry * turned);
        // The oscillators are the real parts of exp(j w t) and -j exp(j w t).
        let cosines = after.map(|entry| entry.re) - &free * real;
        let sines = &free * imaginary - after.map(|entry| entry.im);
        let mut flow = DMatrix::zeros(size, size);
        flow.view_mut((0, 0), (order, order)).copy_from(&free);
        for load in 0..own.ncols() {
            let place = order + 2 * load;
            flow.view_mut((0, place), (order, 1)).copy_from(&cosines.column(load));
            flow.view_mut((0, place + 1), (order, 1)).copy_from(&sines.column(load));
            (flow[(place, place)], flow[(place, place + 1)]) = (turned.re, -turned.im);
            (flow[(place + 1, place)], flow[(place + 1, place + 1)]) = (turned.im, turned.re);
        }
        (flow, forced.resize_vertically(size, 0.0))
    }
}
