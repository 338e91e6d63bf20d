//! Motions of bodies in lanes, from the start of one segment to the next: with drifting or with constant frequencies.

use flexsc_dynamics::flow::{CoupledMatrices, DriftingEquations, RatioSeries, TransitionFlow};
use flexsc_dynamics::frequency_drift::SERIES;
use flexsc_dynamics::polynomial_piece::REACH;
use flexsc_numerics::lanes::LaneFloat;
use flexsc_numerics::polynomial::TERMS;

use super::BatchedRun;

/// Number of sets of transitions that are kept, the newest last.
const KEPT: usize = 8;

/// Motions in lanes as Taylor series of all coordinates, ordered by terms. The first two terms are the state at the
/// segment's start.
#[derive(Debug)]
pub struct LaneMotions<R> {
    /// Number of coordinates of each body.
    pub count: usize,
    /// Coefficients of the Taylor series.
    pub series: Vec<R>,
    flow: LaneFlow<R>,
}

#[derive(Debug)]
enum LaneFlow<R> {
    /// Springs, with the frequency ratios of each run and of all lanes.
    Drifting(DriftingEquations<R>, Vec<Vec<RatioSeries<f64>>>, Vec<RatioSeries<R>>),
    Constant(Box<LinearFlows<R>>),
}

/// Linear systems z' = A z + g m.
#[derive(Debug)]
struct LinearFlows<R> {
    systems: Vec<CoupledMatrices>,
    /// Matrix A row by row, with the columns of each row that are not 0 in all lanes, and the vector g.
    matrix: Vec<R>,
    columns: Vec<Vec<usize>>,
    input: Vec<R>,
    reach: R,
    moment: R,
    /// State z at the start of the segment, and buffers for z at other instants.
    from: Vec<R>,
    room: [Vec<R>; 2],
    /// Transitions over spans (s): the spans, the columns of the matrices, and the response to a unit moment.
    cached: Vec<([f64; 16], Vec<R>, Vec<R>)>,
}

impl<R: LaneFloat> LaneMotions<R> {
    /// Creates the motions of bodies at their start; `None` for bodies that differ in structure.
    pub fn new(kind: R, runs: &[BatchedRun]) -> Option<Self> {
        let count = runs.first()?.motion.start().len() / 2;
        if runs.iter().any(|run| run.motion.start().len() != 2 * count) {
            return None;
        }
        let gathered = |value_of: &dyn Fn(&BatchedRun) -> f64| {
            let mut each = [0.0; 16];
            for lane in 0..R::LANES {
                each[lane] = value_of(&runs[lane.min(runs.len() - 1)]);
            }
            kind.load(&each)
        };
        let drifting: Vec<_> = runs.iter().filter_map(|run| run.motion.drifting()).collect();
        let constant: Vec<_> = runs.iter().filter_map(|run| run.motion.constant()).collect();
        let flow = if drifting.len() == runs.len() {
            let ratios = drifting[0].ratios();
            let springs: Vec<_> = drifting.iter().map(|motion| motion.equations()).collect();
            let springs = DriftingEquations::for_lanes(kind, &springs)?;
            if drifting.iter().any(|motion| motion.ratios() != ratios) {
                return None;
            }
            let series = vec![vec![RatioSeries::new(0.0); ratios]; runs.len()];
            LaneFlow::Drifting(springs, series, vec![RatioSeries::new(kind); ratios])
        } else if constant.len() == runs.len() {
            LaneFlow::Constant(Box::new(LinearFlows::new(kind, &constant)))
        } else {
            return None;
        };
        let mut series = vec![kind.splat(0.0); TERMS * count];
        for index in 0..2 * count {
            series[index] = gathered(&|run| run.motion.start()[index]);
        }
        Some(Self { count, series, flow })
    }

    /// Computes the series of all motions from their first two terms.
    #[inline(always)]
    pub fn expand(&mut self, runs: &[BatchedRun], kind: R) {
        let mut moments = [0.0; 16];
        for (lane, run) in runs.iter().enumerate() {
            moments[lane] = run.moment;
        }
        let moment = kind.load(&moments);
        match &mut self.flow {
            LaneFlow::Drifting(springs, series, lane_series) => {
                for (run, ratios) in runs.iter().zip(series.iter_mut()) {
                    if let Some(motion) = run.motion.drifting() {
                        motion.expand_ratios(run.segment_start.seconds(), ratios);
                    }
                }
                for (index, ratio) in lane_series.iter_mut().enumerate() {
                    ratio.set_lane(series, index);
                }
                springs.expand(lane_series, moment, &mut self.series[..SERIES * self.count]);
            }
            LaneFlow::Constant(flat) => flat.expand(moment, &mut self.series),
        }
    }

    /// Returns the lanes in which a motion over `h` (s) needs a single expansion.
    #[inline(always)]
    pub fn radius(&self, h: R) -> R::Mask {
        match &self.flow {
            LaneFlow::Drifting(springs, ..) => springs.certainly_converges_to(&self.series, h),
            LaneFlow::Constant(flat) => h.le(flat.reach),
        }
    }

    /// Computes the angles of all coordinates, and their rates, `spans` (s) after the start of the segment.
    #[inline(always)]
    pub fn evaluate(&mut self, spans: &[f64; 16], h: R, states: &mut [R]) {
        let (angles, rates) = states.split_at_mut(self.count);
        match &mut self.flow {
            LaneFlow::Drifting(springs, ..) => {
                for index in 0..self.count {
                    let [angle, rate, _] = springs.at(&self.series, index, h);
                    (angles[index], rates[index]) = (angle, rate);
                }
            }
            LaneFlow::Constant(flat) => flat.evaluate(spans, angles, rates),
        }
    }
}

impl<R: LaneFloat> LinearFlows<R> {
    fn new(kind: R, all: &[&TransitionFlow]) -> Self {
        let order = all[0].system().input.len();
        let gathered = |value_of: &dyn Fn(&TransitionFlow) -> f64| {
            let mut each = [0.0; 16];
            for lane in 0..R::LANES {
                each[lane] = value_of(all[lane.min(all.len() - 1)]);
            }
            kind.load(&each)
        };
        let entries = (0..order * order).map(|index| (index / order, index % order));
        let filled =
            |row: usize, column: usize| all.iter().any(|motion| motion.system().system[(row, column)] != 0.0);
        let columns = |row: usize| (0..order).filter(|column| filled(row, *column)).collect();
        let zero = kind.splat(0.0);
        Self {
            systems: all.iter().map(|motion| motion.system().clone()).collect(),
            matrix: entries.map(|index| gathered(&|motion| motion.system().system[index])).collect(),
            columns: (0..order).map(columns).collect(),
            input: (0..order).map(|index| gathered(&|motion| motion.system().input[index])).collect(),
            reach: gathered(&|motion| REACH / motion.fastest()),
            moment: zero,
            from: vec![zero; order],
            room: [vec![zero; order], vec![zero; order]],
            cached: Vec::with_capacity(KEPT),
        }
    }

    #[inline(always)]
    fn expand(&mut self, moment: R, series: &mut [R]) {
        self.moment = moment;
        let (order, count) = (self.from.len(), self.from.len() / 2);
        for index in 0..count {
            (self.from[2 * index], self.from[2 * index + 1]) = (series[index], series[count + index]);
        }
        let [before, after] = &mut self.room;
        before.copy_from_slice(&self.from);
        for n in 1..TERMS {
            let divisor = moment.splat(n as f64);
            for row in 0..order {
                let mut sum = moment.splat(0.0);
                for (place, column) in self.columns[row].iter().enumerate() {
                    let part = self.matrix[row * order + column] * before[*column];
                    sum = if place == 0 { part } else { sum + part };
                }
                if n == 1 {
                    sum = sum + self.input[row] * moment;
                }
                after[row] = sum / divisor;
            }
            for index in 0..count {
                series[n * count + index] = after[2 * index];
            }
            std::mem::swap(before, after);
        }
    }

    #[inline(always)]
    fn evaluate(&mut self, spans: &[f64; 16], angles: &mut [R], rates: &mut [R]) {
        let order = self.from.len();
        let known = self.cached.iter().position(|(stored, ..)| stored == spans);
        let index = known.unwrap_or_else(|| self.keep(spans));
        let (_, transition, input) = &self.cached[index];
        for row in 0..order {
            let mut sum = self.from[0] * transition[row];
            for column in 1..order {
                sum = self.from[column] * transition[column * order + row] + sum;
            }
            let z = self.moment * input[row] + sum;
            if row % 2 == 0 {
                angles[row / 2] = z;
            } else {
                rates[row / 2] = z;
            }
        }
    }

    /// Returns the place of the transitions over `spans` (s), which are computed if they are not kept yet.
    fn keep(&mut self, spans: &[f64; 16]) -> usize {
        let order = self.from.len();
        let mut all = Vec::with_capacity(self.systems.len());
        for (lane, system) in self.systems.iter().enumerate() {
            // Bodies that differ only in their noise share one transition.
            let same =
                (0..lane).find(|other| spans[*other] == spans[lane] && self.systems[*other] == *system);
            let matrices = same.map_or_else(
                || system.discrete(spans[lane]),
                |other: usize| -> (_, _) {
                    let known: &(_, _) = &all[other];
                    known.clone()
                },
            );
            all.push(matrices);
        }
        let kind = self.moment;
        let mut each = [0.0; 16];
        let mut transition = vec![kind; order * order];
        for (index, entry) in transition.iter_mut().enumerate() {
            for (lane, (matrix, _)) in all.iter().enumerate() {
                each[lane] = matrix.as_slice()[index];
            }
            *entry = kind.load(&each);
        }
        let mut input = vec![kind; order];
        for (index, entry) in input.iter_mut().enumerate() {
            for (lane, (_, vector)) in all.iter().enumerate() {
                each[lane] = vector[index];
            }
            *entry = kind.load(&each);
        }
        if self.cached.len() == KEPT {
            self.cached.remove(0);
        }
        self.cached.push((*spans, transition, input));
        self.cached.len() - 1
    }
}
