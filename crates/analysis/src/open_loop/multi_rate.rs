//! Open loop with an attitude filter: gyro, attitude sensor and law, each with a period of its own.
//!
//! Everything that happens in a period of the whole loop is in the model, in the order of a run. Its inputs and outputs
//! are those of each sample of the law in that period.

use std::collections::{BTreeMap, BTreeSet};

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::AXES;
use nalgebra::DMatrix;

use super::attitude_rows::{AttitudeRows, SensorErrors, seconds, ticks};
use super::block_matrices::stacked;
use super::repeated_instants::repeated;
use super::sampling::held;
use super::{LoopBreak, LoopParts, OpenLoop, TransferMatrices, block_states};
use crate::linear_model::Signal;

/// Largest number of samples of the law in a period: a larger model is of little use.
const MOST_SAMPLES: i64 = 100;

/// Times of a period of the loop (fs).
struct Schedule {
    /// Period of the law.
    step: i64,
    /// Delay of the actuators.
    delay: i64,
    /// Period after which the loop repeats.
    whole: i64,
}

impl Schedule {
    fn new(parts: &LoopParts<'_>, filter: &AttitudeRows) -> Result<Self, ConfigError> {
        let step = parts.law.period.leading_femtoseconds();
        let whole = filter.periods().into_iter().try_fold(step, common_multiple);
        let samples = whole.map(|whole| whole / step);
        match (whole, samples) {
            (Some(whole), Some(samples)) if samples <= MOST_SAMPLES => {
                Ok(Self { step, delay: ticks(parts.actuators.delay), whole })
            }
            _ => {
                let count =
                    samples.map_or_else(String::new, |samples| format!(" {samples} samples of the law:"));
                let why = format!(
                    "repeats with gyro and attitude sensor only after{count} a linear loop has at most {MOST_SAMPLES}"
                );
                Err(ConfigError::new("law", why))
            }
        }
    }

    /// Returns the instants at which something happens, from 0 to the end of the period.
    fn instants(&self, filter: &AttitudeRows) -> Vec<i64> {
        let every = |first: i64| repeated(first, self.step, self.whole);
        let mut all: BTreeSet<i64> = filter.events(self.whole);
        all.extend(every(0).chain(every(self.delay % self.step)).chain([self.whole]));
        all.into_iter().filter(|instant| (0..=self.whole).contains(instant)).collect()
    }
}

/// Returns the least common multiple, if it fits.
pub fn common_multiple(a: i64, b: i64) -> Option<i64> {
    let (mut divisor, mut rest) = (a, b);
    while rest != 0 {
        (divisor, rest) = (rest, divisor % rest);
    }
    if divisor == 0 { None } else { (a / divisor).checked_mul(b) }
}

/// Motion of the loop over a period, as rows over the states at its start and the inputs at the break.
struct LoopRows {
    /// States of the body.
    body: DMatrix<f64>,
    filter: AttitudeRows,
    /// States of the law.
    law: DMatrix<f64>,
    /// Torques that act.
    acting: DMatrix<f64>,
    /// Inputs at the break, from the last to the one that acts next.
    waiting: Vec<DMatrix<f64>>,
    /// Outputs at the break, sample after sample.
    commands: Vec<DMatrix<f64>>,
}

impl LoopRows {
    /// Returns the rows of all states.
    fn state(&self) -> DMatrix<f64> {
        let mut all = vec![&self.body];
        all.extend(self.filter.rows());
        all.push(&self.law);
        all.push(&self.acting);
        all.extend(&self.waiting);
        stacked(&all)
    }

    /// Lets a sample of the law read the estimates, with the input of the break in place of its command.
    fn sample(&mut self, parts: &LoopParts<'_>, now: i64, first_input: usize) {
        let law = &parts.law.block;
        let [angle, rate] = self.filter.estimates(now);
        let read = DMatrix::from_fn(6, angle.ncols(), |row, column| {
            if row % 2 == 0 { angle[(row / 2, column)] } else { rate[(row / 2, column)] }
        });
        self.commands.push(&law.c * &self.law + &law.d * &read);
        self.law = &law.a * &self.law + &law.b * read;
        let mut input = DMatrix::zeros(3, angle.ncols());
        input.view_mut((0, first_input), (3, 3)).fill_with_identity();
        self.waiting.pop();
        self.waiting.insert(0, input);
    }
}

/// Returns the loop, cut open.
pub fn lifted_loop(parts: &LoopParts<'_>) -> Result<OpenLoop, ConfigError> {
    if parts.opened == LoopBreak::Measurement {
        let why = "reads gyro and attitude sensor: cut its loop open at the command or the torque";
        return Err(ConfigError::new("estimator.attitude", why));
    }
    let Some(filter) = &parts.parts.attitude else {
        return Err(ConfigError::new("estimator", "must be `attitude`"));
    };
    let order = parts.body.a.nrows();
    let filter = AttitudeRows::new(filter, order);
    let schedule = Schedule::new(parts, &filter)?;
    let states = states(parts, &filter, &schedule);
    let size = states.len();
    let count = usize::try_from(schedule.whole / schedule.step).unwrap_or(1);
    let rows = DMatrix::identity(size, size + 3 * count);
    let mut rows = LoopRows::start(&rows, parts, filter);
    rows.run(parts, &schedule, size);
    let end = rows.state();
    let out = if parts.opened == LoopBreak::Torque { parts.actuators.gain } else { 1.0 };
    let outputs = stacked(&rows.commands.iter().collect::<Vec<_>>()) * -out;
    let kept = read_states(&end, &outputs, size);
    Ok(OpenLoop {
        transfer: TransferMatrices {
            a: end.select_columns(&kept).select_rows(&kept),
            b: end.columns(size, 3 * count).select_rows(&kept),
            c: outputs.select_columns(&kept),
            d: outputs.columns(size, 3 * count).into_owned(),
        },
        states: kept.iter().map(|place| states[*place].clone()).collect(),
        signals: parts.signals(),
        opened: parts.opened,
        period: seconds(schedule.whole),
        samples: count,
    })
}

impl LoopRows {
    /// Splits the rows of the initial states.
    fn start(rows: &DMatrix<f64>, parts: &LoopParts<'_>, mut filter: AttitudeRows) -> Self {
        let (order, memory) = (parts.body.a.nrows(), parts.law.block.a.nrows());
        let known = 3 * filter.state_patterns().len();
        filter.start(&rows.rows(order, known).into_owned());
        let first = order + known + memory;
        let waiting = (first + 3..rows.nrows()).step_by(3).map(|row| rows.rows(row, 3).into_owned());
        Self {
            body: rows.rows(0, order).into_owned(),
            filter,
            law: rows.rows(order + known, memory).into_owned(),
            acting: rows.rows(first, 3).into_owned(),
            waiting: waiting.collect(),
            commands: Vec::new(),
        }
    }

    /// Goes through a period; the columns of the inputs begin at `size`.
    fn run(&mut self, parts: &LoopParts<'_>, schedule: &Schedule, size: usize) {
        let scale = if parts.opened == LoopBreak::Torque { 1.0 } else { parts.actuators.gain };
        let mut flows = BTreeMap::new();
        for pair in schedule.instants(&self.filter).windows(2) {
            let (now, span) = (pair[0], pair[1] - pair[0]);
            self.filter.act(now, &mut self.body, &SensorErrors::default());
            if now % schedule.step == 0 {
                let sample = usize::try_from(now / schedule.step).unwrap_or(0);
                self.sample(parts, now, size + 3 * sample);
            }
            if now % schedule.step == schedule.delay % schedule.step
                && let Some(next) = self.waiting.last()
            {
                self.acting = next * scale;
            }
            let (flow, forced) =
                flows.entry(span).or_insert_with(|| held(&parts.body.a, &parts.body.b, seconds(span)));
            self.body = &*flow * &self.body + &*forced * &self.acting;
        }
    }
}

/// Returns the names and units of all states.
fn states(parts: &LoopParts<'_>, filter: &AttitudeRows, schedule: &Schedule) -> Vec<Signal> {
    let of_filter = filter.state_patterns().into_iter().flat_map(|(name, unit)| {
        AXES.map(|axis| Signal { name: name.replace("{}", axis), unit: unit.to_owned() })
    });
    let waiting = schedule.delay / schedule.step + 1;
    let torques = (0..=waiting).flat_map(|age| {
        parts.body.inputs.iter().map(move |input| Signal {
            name: if age == 0 { input.name.clone() } else { format!("{}_{age}_ago", input.name) },
            unit: input.unit.clone(),
        })
    });
    let body = parts.body.states.iter().cloned();
    body.chain(of_filter).chain(block_states(&parts.law.block)).chain(torques).collect()
}

/// Returns the states that something depends on: some are overwritten before they are read.
pub fn read_states(end: &DMatrix<f64>, outputs: &DMatrix<f64>, size: usize) -> Vec<usize> {
    let mut kept: Vec<usize> = (0..size).collect();
    loop {
        let is_read = |place: &usize| {
            kept.iter().any(|row| end[(*row, *place)] != 0.0)
                || outputs.column(*place).iter().any(|entry| *entry != 0.0)
        };
        let still: Vec<usize> = kept.iter().copied().filter(is_read).collect();
        if still.len() == kept.len() {
            return kept;
        }
        kept = still;
    }
}
