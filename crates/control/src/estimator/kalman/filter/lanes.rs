//! Extended Kalman filters of several runs in SIMD lanes: the matrix operations, each in the order of a single filter.

use flexsc_numerics::exponential::multiply;
use flexsc_numerics::lanes::LaneFloat;

use super::{KalmanFilter, Prediction};
use crate::estimator::kalman::Ranking;

/// The filters in the lanes: mean and covariance of each in its lane, in column-major order.
#[derive(Clone, Debug)]
pub struct FilterLanes<R> {
    pub(super) order: usize,
    pub(super) motion: usize,
    period: f64,
    substeps: u32,
    bounds: [f64; 2],
    pub(super) mean: Vec<R>,
    pub(super) covariance: Vec<R>,
    noise: Vec<R>,
    /// Derivative of the flow, transposed, and a buffer for a product.
    pub(super) tangent: Vec<R>,
    pub(super) room: Vec<R>,
    frequency: Vec<R>,
    gain: Vec<R>,
    drag: Vec<R>,
    /// Index of each mode's ratio in the state, if it has one.
    ratio: Vec<Option<usize>>,
    /// Rate factor subtracted by back-EMF in a substep, and the number of modes whose rate it opposes, if there is
    /// back-EMF.
    brake: Option<(R, usize)>,
    pub(super) angle_noise: R,
    /// Transitions of all modes.
    turns: Vec<[R; 4]>,
}

impl<R: LaneFloat> FilterLanes<R> {
    /// Creates the lanes from filters before their first sample; `None` unless all have the same structure.
    pub fn new(kind: R, filters: &mut [&mut KalmanFilter]) -> Option<Self> {
        let first = filters.first()?.tuning.clone();
        let model = &first.model;
        let alike = |filter: &&mut KalmanFilter| {
            let (tuning, other) = (&filter.tuning, &filter.tuning.model);
            matches!(tuning.prediction, Prediction::Extended)
                && tuning.rate_noise.is_none()
                && tuning.ranking == Ranking::Excitability
                && tuning.period == first.period
                && other.bounds == model.bounds
                && other.substeps == model.substeps
                && other.back_emf.1 == model.back_emf.1
                && (other.back_emf.0 > 0.0) == (model.back_emf.0 > 0.0)
                && (other.modes.len(), other.order()) == (model.modes.len(), model.order())
        };
        if !filters.iter().all(alike) {
            return None;
        }
        let (order, modes) = (model.order(), model.modes.len());
        let gathered = |value_of: &dyn Fn(&KalmanFilter) -> f64| {
            let mut each = [0.0; 16];
            for lane in 0..R::LANES {
                each[lane] = value_of(&*filters[lane.min(filters.len() - 1)]);
            }
            kind.load(&each)
        };
        let list = |count: usize, value_of: &dyn Fn(&KalmanFilter, usize) -> f64| -> Vec<R> {
            (0..count).map(|index| gathered(&|filter| value_of(filter, index))).collect()
        };
        let step = first.period / f64::from(model.substeps);
        let zero = kind.splat(0.0);
        let all = Self {
            order,
            motion: model.motion_states(),
            period: first.period,
            substeps: model.substeps,
            bounds: model.bounds,
            mean: list(order, &|filter, index| filter.mean[index]),
            covariance: list(order * order, &|filter, index| filter.covariance.as_slice()[index]),
            noise: list(order * order, &|filter, index| filter.noise.as_slice()[index]),
            tangent: vec![zero; order * order],
            room: vec![zero; order * order],
            frequency: list(modes, &|filter, index| filter.tuning.model.modes[index].frequency),
            gain: list(modes, &|filter, index| filter.tuning.model.modes[index].gain),
            drag: list(modes, &|filter, index| filter.tuning.model.modes[index].drag),
            ratio: (0..modes).map(|mode| model.ratio_of(mode)).collect(),
            brake: (model.back_emf.0 > 0.0).then(|| {
                (gathered(&|filter| filter.tuning.model.back_emf_fraction(step)), model.set_back_emf_modes())
            }),
            angle_noise: gathered(&|filter| filter.tuning.angle_noise),
            turns: vec![[zero; 4]; modes],
        };
        for filter in filters {
            filter.lane_step.in_lanes = true;
        }
        Some(all)
    }

    /// Predicts all states over one period with the mean reduced moments `moment` (rad/s²).
    #[inline(always)]
    pub fn predict(&mut self, filters: &[&mut KalmanFilter], moment: R) {
        let order = self.order;
        let zero = moment.splat(0.0);
        for index in 0..order * order {
            self.tangent[index] = zero;
        }
        for index in 0..order {
            self.tangent[index * order + index] = zero.splat(1.0);
        }
        let step = self.period / f64::from(self.substeps);
        for substep in 0..self.substeps {
            let middle = (f64::from(substep) + 0.5) * step;
            if let Some((part, mode_count)) = self.brake {
                self.turn(filters, 0.5 * step, middle);
                self.coast(0.5 * step, middle, moment);
                self.brake(part, mode_count);
                self.coast(0.5 * step, middle, moment);
            } else {
                self.turn(filters, step, middle);
                self.coast(step, middle, moment);
            }
        }
        for index in (self.motion..order).step_by(2) {
            self.mean[index] = self.mean[index] + self.mean[index + 1] * self.period;
            self.add_column(index, index + 1, zero.splat(self.period));
        }
        self.carry();
        let mut gated = [0.0; 16];
        for (lane, filter) in filters.iter().enumerate() {
            gated[lane] = f64::from(u8::from(filter.gated));
        }
        let gated = zero.lt(zero.load(&gated));
        for index in self.motion..order {
            let diagonal = index * order + index;
            let without = self.covariance[diagonal] - self.noise[diagonal];
            self.covariance[diagonal] = R::select(gated, without, self.covariance[diagonal]);
        }
    }

    /// Propagates the covariance and adds the noise of a period; computes the upper triangle and mirrors it.
    #[inline(always)]
    fn carry(&mut self) {
        let order = self.order;
        let Self { covariance, tangent, room, noise, .. } = self;
        multiply(covariance, tangent, order, room);
        for column in 0..order {
            let product = &room[column * order..(column + 1) * order];
            for (row, derivatives) in tangent.chunks_exact(order).enumerate().take(column + 1) {
                let value = dot(tangent[0].splat(0.0), derivatives, product) + noise[column * order + row];
                covariance[column * order + row] = value;
                covariance[row * order + column] = value;
            }
        }
    }

    /// Computes the free transitions of all modes over `h` (s), at the ratios that the states have `middle` (s) after
    /// the start of the period.
    #[inline(always)]
    fn turn(&mut self, filters: &[&mut KalmanFilter], h: f64, middle: f64) {
        for mode in 0..self.frequency.len() {
            let ratio = self.ratio_at(mode, middle);
            let mut times = [0.0; 16];
            ratio.store(&mut times);
            let mut each = [[0.0; 16]; 4];
            for (lane, filter) in filters.iter().enumerate() {
                let transition = filter.tuning.model.modes[mode].flow.transition(times[lane] * h);
                for part in 0..4 {
                    each[part][lane] = transition[part];
                }
            }
            let w = ratio * self.frequency[mode];
            let [a, b, c, d] =
                [ratio.load(&each[0]), ratio.load(&each[1]), ratio.load(&each[2]), ratio.load(&each[3])];
            self.turns[mode] = [a, b / w, c * w, d];
        }
    }

    #[inline(always)]
    fn ratio_at(&self, mode: usize, middle: f64) -> R {
        let one = self.angle_noise.splat(1.0);
        let Some(index) = self.ratio[mode] else { return one };
        let ratio = self.mean[index] + self.mean[index + 1] * middle;
        let [low, high] = self.bounds;
        ratio.max(one.splat(low)).min(one.splat(high))
    }

    #[inline(always)]
    fn coast(&mut self, h: f64, middle: f64, moment: R) {
        let order = self.order;
        let half = moment.splat(0.5 * h) * moment;
        self.mean[0] = self.mean[0] + (self.mean[1] + half) * h;
        self.mean[1] = self.mean[1] + moment * h;
        self.add_column(0, 1, moment.splat(h));
        for mode in 0..self.frequency.len() {
            let (x, v) = (2 + 2 * mode, 3 + 2 * mode);
            let ratio = self.ratio_at(mode, middle);
            let [a, b, c, d] = self.turns[mode];
            let w = ratio * self.frequency[mode];
            let centre = self.gain[mode] * moment / (w * w);
            let one = moment.splat(1.0);
            let shift = [centre * (one - a), -centre * c];
            let (displacement, velocity) = (self.mean[x], self.mean[v]);
            self.mean[x] = a * displacement + b * velocity + shift[0];
            self.mean[v] = c * displacement + d * velocity + shift[1];
            let (displacements, velocities) = self.tangent[x * order..(x + 2) * order].split_at_mut(order);
            for (displacement, velocity) in displacements.iter_mut().zip(velocities) {
                (*displacement, *velocity) =
                    (a * *displacement + b * *velocity, c * *displacement + d * *velocity);
            }
            if let Some(ratio_index) = self.ratio[mode] {
                let (p, q) =
                    (a * (displacement - centre) + b * velocity, c * (displacement - centre) + d * velocity);
                let first = q * h - b * velocity - centre * 2.0 * (one - a);
                let second = w * -h * (w * p + self.drag[mode] * q) + q - d * velocity + centre * 2.0 * c;
                let (first, second) = (first / ratio, second / ratio);
                self.add_column(x, ratio_index, first);
                self.add_column(x, ratio_index + 1, first * middle);
                self.add_column(v, ratio_index, second);
                self.add_column(v, ratio_index + 1, second * middle);
            }
        }
    }

    #[inline(always)]
    fn brake(&mut self, part: R, mode_count: usize) {
        let order = self.order;
        let mut rate = self.mean[1];
        for index in 1..=mode_count {
            rate = rate + self.mean[1 + 2 * index];
        }
        self.mean[1] = self.mean[1] - part * rate;
        for mode in 0..self.gain.len() {
            self.mean[3 + 2 * mode] = self.mean[3 + 2 * mode] - self.gain[mode] * part * rate;
        }
        let Self { tangent, room, gain, .. } = self;
        let rates = &mut room[..order];
        rates.copy_from_slice(&tangent[order..2 * order]);
        let velocities = tangent.chunks_exact(order).skip(3).step_by(2);
        for entries in velocities.take(mode_count) {
            for (rate, entry) in rates.iter_mut().zip(entries) {
                *rate = *rate + *entry;
            }
        }
        let velocities = tangent.chunks_exact_mut(order).skip(1).step_by(2);
        for (index, entries) in velocities.take(gain.len() + 1).enumerate() {
            let gain = if index == 0 { part.splat(1.0) } else { gain[index - 1] };
            let factor = -gain * part;
            for (entry, rate) in entries.iter_mut().zip(&*rates) {
                *entry = factor * *rate + *entry;
            }
        }
    }

    #[inline(always)]
    fn add_column(&mut self, to: usize, from: usize, factor: R) {
        let order = self.order;
        let (left, right) = self.tangent.split_at_mut(to.max(from) * order);
        let (first, last) = (&mut left[to.min(from) * order..][..order], &mut right[..order]);
        let (to, from) = if to < from { (first, last) } else { (last, first) };
        for (entry, added) in to.iter_mut().zip(&*from) {
            *entry = *entry + factor * *added;
        }
    }

    /// Updates all states by the measured angles (rad), without the ratios in `gated` lanes. Returns the innovations
    /// and their normalised squares.
    #[inline(always)]
    pub fn update(&mut self, measured: R, gated: R::Mask) -> [R; 2] {
        let order = self.order;
        let mut angle = self.mean[0];
        for index in (2..self.motion).step_by(2) {
            angle = angle + self.mean[index];
        }
        let innovation = measured - angle;
        let observation = &mut self.room[..2 * order];
        observation[..order].copy_from_slice(&self.covariance[..order]);
        for entries in self.covariance.chunks_exact(order).take(self.motion).skip(2).step_by(2) {
            for (observed, entry) in observation.iter_mut().zip(entries) {
                *observed = *observed + *entry;
            }
        }
        let mut variance = observation[0];
        for index in (2..self.motion).step_by(2) {
            variance = variance + observation[index];
        }
        let variance = variance + self.angle_noise * self.angle_noise;
        for row in 0..order {
            let gain = observation[row] / variance;
            let none = row >= self.motion;
            observation[order + row] = if none { R::select(gated, gain.splat(0.0), gain) } else { gain };
            self.mean[row] = innovation * observation[order + row] + self.mean[row];
        }
        let (observation, gains) = observation.split_at(order);
        for column in 0..order {
            let (observed, other) = (observation[column], gains[column]);
            for (row, (gain, entry)) in gains.iter().zip(observation).enumerate().take(column + 1) {
                let value = self.covariance[column * order + row] - (*gain * observed + *entry * other)
                    + variance * *gain * other;
                self.covariance[column * order + row] = value;
                self.covariance[row * order + column] = value;
            }
        }
        [innovation, innovation * innovation / variance]
    }

    /// Returns the mask of the lanes in which mean and covariance are finite and no variance is negative.
    #[inline(always)]
    pub fn are_valid(&self) -> R::Mask {
        let zero = self.angle_noise.splat(0.0);
        let (mut sum, mut least) = (zero, zero);
        for index in 0..self.order * self.order {
            sum = sum + self.covariance[index] * 0.0;
        }
        for index in 0..self.order {
            sum = sum + self.mean[index] * 0.0;
            least = self.covariance[index * self.order + index].min(least);
        }
        zero.le(least) & sum.le(zero)
    }

    /// Returns a copy of the covariances.
    pub fn covariances(&self) -> Vec<R> {
        self.covariance.clone()
    }

    /// Restores `covariances` in the lanes outside `others`.
    pub fn restore(&mut self, covariances: &[R], others: R::Mask) {
        for (covariance, before) in self.covariance.iter_mut().zip(covariances) {
            *covariance = R::select(others, *covariance, *before);
        }
    }

    /// Loads the means from the filters.
    #[inline(always)]
    pub fn load_means(&mut self, filters: &[&mut KalmanFilter]) {
        let mut each = [0.0; 16];
        for index in 0..self.order {
            for (lane, filter) in filters.iter().enumerate() {
                each[lane] = filter.mean[index];
            }
            self.mean[index] = self.mean[index].load(&each);
        }
    }

    /// Stores the means in the filters of the selected lanes.
    #[inline(always)]
    pub fn store_means(&self, filters: &mut [&mut KalmanFilter], lanes: &[bool]) {
        let mut each = [0.0; 16];
        for index in 0..self.order {
            self.mean[index].store(&mut each);
            for (lane, filter) in filters.iter_mut().enumerate() {
                if lanes[lane] {
                    filter.mean[index] = each[lane];
                }
            }
        }
    }
}

/// Returns the dot product of two columns in the order of nalgebra: eight sums, and the rest.
#[inline(always)]
pub(super) fn dot<R: LaneFloat>(zero: R, a: &[R], b: &[R]) -> R {
    let mut all = [zero; 8];
    let (groups, rest) = (a.chunks_exact(8).zip(b.chunks_exact(8)), a.len() - a.len() % 8);
    for (a, b) in groups {
        for part in 0..8 {
            all[part] = all[part] + a[part] * b[part];
        }
    }
    let mut sum = zero;
    for part in 0..4 {
        sum = sum + (all[part] + all[part + 4]);
    }
    for (a, b) in a[rest..].iter().zip(&b[rest..]) {
        sum = sum + *a * *b;
    }
    sum
}
