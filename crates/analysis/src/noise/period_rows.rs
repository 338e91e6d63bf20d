//! Motion of a closed loop over its period, as rows over the states at the start and the draws of noise since.

use std::collections::BTreeMap;

use flexsc_control::linear_block::LinearBlock;
use flexsc_formats::document::ConfigError;
use nalgebra::{Complex, DMatrix};

use super::schedule::{Draws, Schedule};
use super::source::{NoiseEntry, NoiseSource};
use crate::margins::frequency_response::unit_circle;
use crate::open_loop::LoopParts;
use crate::open_loop::attitude_rows::{AttitudeRows, SensorErrors, seconds};
use crate::open_loop::block_matrices::stacked;
use crate::open_loop::multi_rate::read_states;
use crate::open_loop::sampling::{HeldMotion, held};
use crate::open_loop::uniform_rate::Controller;

/// Part of a period in which the torques are constant.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Start, and length (fs).
    pub from: i64,
    pub length: i64,
    /// States of the body at the start.
    pub body: DMatrix<f64>,
    /// Torques.
    pub torque: DMatrix<f64>,
    /// Last commands of the law.
    pub command: DMatrix<f64>,
}

/// Motion over a period.
#[derive(Clone, Debug)]
pub struct PeriodRows {
    /// Transition of the states over the period.
    pub a: DMatrix<f64>,
    /// Response of the states to the draws of the period.
    pub g: DMatrix<f64>,
    /// Pieces in the order of time, whose columns are the states, then the draws.
    pub pieces: Vec<Piece>,
    /// Length of the period, and of a sample of the law (fs).
    pub period: i64,
    pub step: i64,
    /// Source of each draw, as an index.
    pub drawn_by: Vec<usize>,
    /// States that are kept, as indices: those of the body are the first.
    pub kept: Vec<usize>,
    /// Motions of the body over lengths of pieces (fs).
    flows: BTreeMap<i64, HeldMotion>,
}

/// Motion of a body under loads of one frequency without torques: amplitudes exp(j w t) of its states, a column for each load. Rows
/// over it have two columns for each, the real and the imaginary part.
pub struct ForcedMotion {
    pub amplitudes: DMatrix<Complex<f64>>,
    /// Frequency (rad/s).
    pub frequency: f64,
}

impl ForcedMotion {
    /// Returns the states at a time (fs).
    fn at(&self, time: i64) -> DMatrix<f64> {
        let turn = unit_circle(self.frequency * seconds(time));
        split(&(&self.amplitudes * turn))
    }
}

/// Returns the real and the imaginary part of each column, side by side.
fn split(matrix: &DMatrix<Complex<f64>>) -> DMatrix<f64> {
    DMatrix::from_fn(matrix.nrows(), 2 * matrix.ncols(), |row, column| {
        let value = matrix[(row, column / 2)];
        if column % 2 == 0 { value.re } else { value.im }
    })
}

/// Returns the columns of which each pair is a real and an imaginary part.
pub fn joined(matrix: &DMatrix<f64>) -> DMatrix<Complex<f64>> {
    DMatrix::from_fn(matrix.nrows(), matrix.ncols() / 2, |row, column| {
        Complex::new(matrix[(row, 2 * column)], matrix[(row, 2 * column + 1)])
    })
}

/// Sensors, estimator and law.
enum ControllerRows {
    /// All at the samples of the law.
    Uniform { controller: Controller, state: DMatrix<f64> },
    /// Attitude filter with sensors of other periods.
    Filter { filter: Box<AttitudeRows>, law: LinearBlock, state: DMatrix<f64> },
}

/// Parts of a loop before its start, and the numbers of its states: of the body, of the controller, of each command, and of all.
struct LoopSetup {
    controller: ControllerRows,
    /// Times (fs) at which something happens.
    instants: Vec<i64>,
    order: usize,
    known: Vec<usize>,
    axes: usize,
    late: usize,
    size: usize,
}

/// State of the loop during a period, as rows.
struct LoopRows {
    body: DMatrix<f64>,
    controller: ControllerRows,
    /// Torque of the commands.
    acting: DMatrix<f64>,
    /// Commands from the last to the one that acts next.
    waiting: Vec<DMatrix<f64>>,
    /// Memory of each source.
    memory: Vec<DMatrix<f64>>,
    command: DMatrix<f64>,
}

impl PeriodRows {
    /// Goes through a period of a closed loop.
    ///
    /// # Errors
    /// Periods without a common multiple that is short enough: a key, and the reason.
    pub fn new(parts: &LoopParts<'_>, sources: &[NoiseSource]) -> Result<Self, ConfigError> {
        Self::driven(parts, sources, &[])
    }

    /// Goes through a period of a closed loop that some states of the body drive, besides the draws.
    ///
    /// # Errors
    /// See [`Self::new`].
    pub fn driven(
        parts: &LoopParts<'_>,
        sources: &[NoiseSource],
        drivers: &[usize],
    ) -> Result<Self, ConfigError> {
        let (schedule, draws, setup) = Self::setup(parts, sources)?;
        let size = setup.size;
        let identity = DMatrix::identity(size, size + draws.count(schedule.period));
        let mut flows = BTreeMap::new();
        for pair in setup.instants.windows(2) {
            let length = pair[1] - pair[0];
            flows.entry(length).or_insert_with(|| held(&parts.body.a, &parts.body.b, seconds(length)));
        }
        let (mut rows, instants) = LoopRows::start(&identity, setup, sources);
        let pieces = rows.run(parts, (&schedule, &instants, &flows), &draws, (size, None));
        let found = Self::trimmed(&rows.state(), pieces, (size, drivers), &schedule, &draws);
        Ok(Self { flows, ..found })
    }

    /// Goes through a period from the states of a forced motion; returns the kept states at the end, and the pieces.
    ///
    /// # Errors
    /// See [`Self::new`].
    pub fn forced(
        &self,
        parts: &LoopParts<'_>,
        motion: &ForcedMotion,
    ) -> Result<(DMatrix<f64>, Vec<Piece>), ConfigError> {
        let (schedule, draws, setup) = Self::setup(parts, &[])?;
        let mut start = motion.at(0);
        let size = setup.size;
        start.resize_vertically_mut(size, 0.0);
        let (mut rows, instants) = LoopRows::start(&start, setup, &[]);
        let pieces = rows.run(parts, (&schedule, &instants, &self.flows), &draws, (size, Some(motion)));
        Ok((rows.state().select_rows(&self.kept), pieces))
    }

    /// Returns the times of a loop, its draws, and its parts before the start.
    fn setup<'s>(
        parts: &LoopParts<'_>,
        sources: &'s [NoiseSource],
    ) -> Result<(Schedule, Draws<'s>, LoopSetup), ConfigError> {
        let order = parts.body.a.nrows();
        let filter = parts.parts.attitude.as_ref().map(|filter| AttitudeRows::new(filter, order));
        let schedule = Schedule::new(parts, filter.as_ref(), sources)?;
        let draws = Draws::new(sources, schedule.period);
        let instants = schedule.instants(filter.as_ref(), sources);
        let mut start = Vec::new();
        let controller = if let Some(filter) = filter {
            start.push(3 * filter.state_patterns().len());
            let law = parts.law.block.clone();
            start.push(law.a.nrows());
            ControllerRows::Filter { filter: Box::new(filter), law, state: DMatrix::zeros(0, 0) }
        } else {
            let controller = Controller::new(parts)?;
            start.push(controller.block.a.nrows());
            ControllerRows::Uniform { controller, state: DMatrix::zeros(0, 0) }
        };
        let known: usize = start.iter().sum();
        let axes = parts.body.inputs.len();
        let late = usize::try_from(schedule.delay / schedule.step).unwrap_or(0) + 1;
        let memory: usize = sources.iter().map(|source| source.entry.memory()).sum();
        let size = order + known + axes * (1 + late) + memory;
        let setup = LoopSetup { controller, instants, order, known: start, axes, late, size };
        Ok((schedule, draws, setup))
    }

    /// Returns the motion without states that nothing depends on, or that no draw reaches.
    fn trimmed(
        end: &DMatrix<f64>,
        mut pieces: Vec<Piece>,
        (size, drivers): (usize, &[usize]),
        schedule: &Schedule,
        draws: &Draws<'_>,
    ) -> Self {
        let outputs: Vec<&DMatrix<f64>> =
            pieces.iter().flat_map(|piece| [&piece.body, &piece.command]).collect();
        let read = read_states(end, &stacked(&outputs), size);
        let is_drawn = |row: usize| (size..end.ncols()).any(|column| end[(row, column)] != 0.0);
        let mut kept: Vec<usize> =
            read.iter().copied().filter(|row| drivers.contains(row) || is_drawn(*row)).collect();
        loop {
            let reached: Vec<usize> = read
                .iter()
                .copied()
                .filter(|row| kept.contains(row) || kept.iter().any(|column| end[(*row, *column)] != 0.0))
                .collect();
            if reached.len() == kept.len() {
                break;
            }
            kept = reached;
        }
        let columns: Vec<usize> = kept.iter().copied().chain(size..end.ncols()).collect();
        for piece in &mut pieces {
            piece.body = piece.body.select_columns(&columns);
            piece.torque = piece.torque.select_columns(&columns);
            piece.command = piece.command.select_columns(&columns);
        }
        let end = end.select_rows(&kept).select_columns(&columns);
        Self {
            a: end.columns(0, kept.len()).into_owned(),
            g: end.columns(kept.len(), end.ncols() - kept.len()).into_owned(),
            pieces,
            period: schedule.period,
            step: schedule.step,
            drawn_by: draws.drawn_by(schedule.period),
            kept,
            flows: BTreeMap::new(),
        }
    }
}

/// Returns rows that are a matrix at a column, and 0 elsewhere.
fn placed(matrix: &DMatrix<f64>, column: usize, columns: usize) -> DMatrix<f64> {
    let mut rows = DMatrix::zeros(matrix.nrows(), columns);
    rows.view_mut((0, column), matrix.shape()).copy_from(matrix);
    rows
}

/// Adds rows to others, if there are any.
fn add(sum: &mut Option<DMatrix<f64>>, rows: DMatrix<f64>) {
    match sum {
        Some(sum) => *sum += rows,
        None => *sum = Some(rows),
    }
}

impl LoopRows {
    /// Splits the rows of the states at the start; returns the times of the period too.
    fn start(rows: &DMatrix<f64>, setup: LoopSetup, sources: &[NoiseSource]) -> (Self, Vec<i64>) {
        let LoopSetup { mut controller, instants, order, known, axes, late, .. } = setup;
        let mut next = 0;
        let mut take = |count: usize| {
            next += count;
            rows.rows(next - count, count).into_owned()
        };
        let body = take(order);
        match &mut controller {
            ControllerRows::Uniform { state, .. } => *state = take(known[0]),
            ControllerRows::Filter { filter, state, .. } => {
                filter.start(&take(known[0]));
                *state = take(known[1]);
            }
        }
        let acting = take(axes);
        let waiting = (0..late).map(|_| take(axes)).collect();
        let memory = sources.iter().map(|source| take(source.entry.memory())).collect();
        let command = DMatrix::zeros(axes, rows.ncols());
        (Self { body, controller, acting, waiting, memory, command }, instants)
    }

    /// Returns the rows of all states.
    fn state(&self) -> DMatrix<f64> {
        let mut all = vec![&self.body];
        match &self.controller {
            ControllerRows::Uniform { state, .. } => all.push(state),
            ControllerRows::Filter { filter, state, .. } => {
                all.extend(filter.rows());
                all.push(state);
            }
        }
        all.push(&self.acting);
        all.extend(&self.waiting);
        all.extend(&self.memory);
        stacked(&all)
    }

    /// Returns the errors of the sensors at a time (fs), and those of the command.
    fn errors(&mut self, now: i64, draws: &Draws<'_>, size: usize) -> (SensorErrors, Option<DMatrix<f64>>) {
        let (mut errors, mut command) = (SensorErrors::default(), None);
        let columns = self.body.ncols();
        for (index, source) in draws.sources.iter().enumerate() {
            let Some(column) = draws.column(index, now) else { continue };
            let drawn = |matrix: &DMatrix<f64>| placed(matrix, size + column, columns);
            match &source.entry {
                NoiseEntry::Angle(matrix) => add(&mut errors.attitude, drawn(matrix)),
                NoiseEntry::Rate(matrix) => add(&mut errors.rate, drawn(matrix)),
                NoiseEntry::Command(matrix) => add(&mut command, drawn(matrix)),
                NoiseEntry::Walk { change, white } => {
                    let change = drawn(change);
                    add(&mut errors.rate, drawn(white) - &change * 0.5);
                    add(&mut errors.walk, change);
                }
                NoiseEntry::Remainder(matrix) => {
                    let remainder = drawn(matrix);
                    add(&mut errors.rate, &self.memory[index] - &remainder);
                    self.memory[index] = remainder;
                }
                NoiseEntry::Wander { decay, change, own_share, white } => {
                    let before = self.memory[index].clone();
                    let after = &before * *decay + drawn(change);
                    let mean =
                        if *own_share < 1.0 { (&before + &after) * (0.5 * own_share) } else { after.clone() };
                    add(&mut errors.rate, mean + drawn(white));
                    self.memory[index] = after;
                }
                NoiseEntry::Torque { deviation, .. } => {
                    self.memory[index] = drawn(&DMatrix::from_element(1, 1, *deviation));
                }
                NoiseEntry::Mirror { .. } => {}
            }
        }
        (errors, command)
    }

    /// Ends the exposures of fine mirrors that end at a time (fs).
    fn end_exposures(&mut self, parts: &LoopParts<'_>, now: i64, draws: &Draws<'_>, size: usize) {
        for own in parts.mirrors.iter().filter(|own| now % own.period == 0) {
            let noise = draws.sources.iter().enumerate().find_map(|(index, source)| match source.entry {
                NoiseEntry::Mirror { line, deviation } if line == own.line => {
                    let each = DMatrix::from_diagonal_element(2, 2, deviation);
                    Some(placed(&each, size + draws.column(index, now)?, self.body.ncols()))
                }
                _ => None,
            });
            own.end_exposure(&mut self.body, noise.as_ref());
        }
    }

    /// Returns the torques: those of the commands, and those that are drawn.
    fn torque(&self, sources: &[NoiseSource]) -> DMatrix<f64> {
        let mut torque = self.acting.clone();
        for (source, memory) in sources.iter().zip(&self.memory) {
            if let NoiseEntry::Torque { axis, .. } = source.entry {
                let mut row = torque.row_mut(axis);
                row += memory;
            }
        }
        torque
    }

    /// Lets the law read its estimates, and returns its command.
    fn sample(&mut self, parts: &LoopParts<'_>, now: i64, errors: &SensorErrors) -> DMatrix<f64> {
        match &mut self.controller {
            ControllerRows::Uniform { controller, state } => {
                let mut read = &parts.body.c * &self.body;
                for (first, error) in [(0, &errors.attitude), (1, &errors.rate)] {
                    let Some(error) = error else { continue };
                    for axis in 0..error.nrows() {
                        let mut row = read.row_mut(2 * axis + first);
                        row += error.row(axis);
                    }
                }
                let block = &controller.block;
                let command = &block.c * &*state + &block.d * &read;
                *state = &block.a * &*state + &block.b * read;
                command
            }
            ControllerRows::Filter { filter, law, state } => {
                let [angle, rate] = filter.estimates(now);
                let read = DMatrix::from_fn(6, angle.ncols(), |row, column| {
                    if row % 2 == 0 { angle[(row / 2, column)] } else { rate[(row / 2, column)] }
                });
                let command = &law.c * &*state + &law.d * &read;
                *state = &law.a * &*state + &law.b * read;
                command
            }
        }
    }

    /// Goes through a period; the columns of the draws begin at `size`, or all are those of a forced motion.
    fn run(
        &mut self,
        parts: &LoopParts<'_>,
        (schedule, instants, flows): (&Schedule, &[i64], &BTreeMap<i64, HeldMotion>),
        draws: &Draws<'_>,
        (size, forced_motion): (usize, Option<&ForcedMotion>),
    ) -> Vec<Piece> {
        let gain = parts.actuators.gain;
        let late = schedule.delay % schedule.step;
        let mut pieces = Vec::with_capacity(instants.len());
        for pair in instants.windows(2) {
            let (now, length) = (pair[0], pair[1] - pair[0]);
            let (errors, rounding) = self.errors(now, draws, size);
            self.end_exposures(parts, now, draws, size);
            if let ControllerRows::Filter { filter, .. } = &mut self.controller {
                filter.act(now, &mut self.body, &errors);
            }
            if now % schedule.step == 0 {
                self.command = self.sample(parts, now, &errors);
                if let Some(rounding) = rounding {
                    self.command += rounding;
                }
                self.waiting.pop();
                self.waiting.insert(0, self.command.clone());
                self.predict(gain, seconds(late) / seconds(schedule.step));
            }
            if now % schedule.step == late
                && let Some(next) = self.waiting.last()
            {
                self.acting = next * gain;
            }
            let torque = self.torque(draws.sources);
            let (flow, forced) = &flows[&length];
            let after = match forced_motion {
                None => flow * &self.body + forced * &torque,
                Some(motion) => {
                    let free = &self.body - motion.at(now);
                    flow * free + forced * &torque + motion.at(now + length)
                }
            };
            let body = std::mem::replace(&mut self.body, after);
            pieces.push(Piece { from: now, length, body, torque, command: self.command.clone() });
        }
        pieces
    }

    /// Lets the estimator of a loop with one period know the mean torque over the coming one, of which a part is still
    /// that of the command before.
    fn predict(&mut self, gain: f64, before: f64) {
        let next = self.waiting.last().map(|next| next * gain);
        if let (ControllerRows::Uniform { controller, state }, Some(next)) = (&mut self.controller, next) {
            *state += &controller.torque * (next * (1.0 - before) + &self.acting * before);
        }
    }
}
