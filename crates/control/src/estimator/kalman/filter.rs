//! Run-time state of the Kalman filters: a normal distribution, predicted over each period and updated by each sample.

mod lane_step;
mod lanes;
mod modes;

use flexsc_flight::filter_lock::FilterLock;
use flexsc_flight::kalman::{self, KalmanSample};
use nalgebra::{DMatrix, DVector};

use super::model::FilterModel;
use super::{Ranking, sigma};
use crate::state_estimate::DominantMode;

pub use lanes::FilterLanes;

/// Standard deviations of an innovation above which a measurement is rejected.
const FARTHEST: f64 = 1e6;

/// Prediction method of the distribution.
#[derive(Clone, Debug)]
pub enum Prediction {
    /// Linear Kalman: the transition over a period, and the state change by a unit moment.
    Linear(DMatrix<f64>, DVector<f64>),
    /// Extended Kalman: the mean by the flow, the covariance by the flow's derivative.
    Extended,
    /// Unscented Kalman: mean and covariance by points around the mean.
    Unscented,
}

/// Parameters of a filter.
#[derive(Clone, Debug)]
pub struct FilterParameters {
    /// Model of the body.
    pub model: FilterModel,
    /// Prediction method.
    pub prediction: Prediction,
    /// Period of the samples (s).
    pub period: f64,
    /// Mean of the state at the start.
    pub mean: DVector<f64>,
    /// Standard deviations of the state at the start.
    pub spread: DVector<f64>,
    /// Spectral density of the moment's white noise ((rad/s²)² s).
    pub moment_noise: f64,
    /// Spectral densities of the white noises that drive a ratio (1/s) and its rate (1/s³).
    pub ratio_noise: [f64; 2],
    /// Standard deviation of the measured angle (rad).
    pub angle_noise: f64,
    /// Standard deviation of the measured rate (rad/s), if there is a gyro.
    pub rate_noise: Option<f64>,
    /// Bounds of the ratios.
    pub bounds: [f64; 2],
    /// Amplitude of the dominant mode (rad) below which the ratios are not updated.
    pub gate: f64,
    /// Criterion for the dominant mode.
    pub ranking: Ranking,
}

/// Kalman filter of the motion about one axis.
#[derive(Clone, Debug)]
pub struct KalmanFilter {
    tuning: FilterParameters,
    mean: DVector<f64>,
    covariance: DMatrix<f64>,
    noise: DMatrix<f64>,
    /// Buffers for the derivative of the flow, transposed, and for a product.
    tangent: DMatrix<f64>,
    room: DMatrix<f64>,
    /// Mean and covariance before the current step.
    before: (DVector<f64>, DMatrix<f64>),
    /// Model of a linear filter in the form of flight code; empty of other filters.
    linear: Vec<f64>,
    /// Buffer of flight code.
    buffer: Vec<f64>,
    lock: FilterLock,
    /// True if the distribution could not be propagated.
    broken: bool,
    mode: usize,
    gated: bool,
    /// Time for which the filter has been gated (s).
    gated_for: f64,
    trusted: DominantMode,
    /// Results of a step in a batch, where the covariance is kept.
    lane_step: lane_step::LaneStep,
}

/// Innovation of a sample.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Innovation {
    /// Measured angle minus the predicted one (rad); 0 if the sample was dropped.
    pub innovation: f64,
    /// Normalised innovation squared, summed over the measurements; `None` if the sample was dropped.
    pub nis: Option<f64>,
}

impl KalmanFilter {
    /// Creates a filter before its first sample.
    pub fn new(tuning: FilterParameters) -> Self {
        let order = tuning.model.order();
        let covariance = DMatrix::from_diagonal(&tuning.spread.map(|sd| sd * sd));
        let mut filter = Self {
            mean: tuning.mean.clone(),
            covariance,
            noise: DMatrix::zeros(order, order),
            tangent: DMatrix::zeros(order, order),
            room: DMatrix::zeros(order, order),
            before: (DVector::zeros(order), DMatrix::zeros(order, order)),
            linear: Vec::new(),
            buffer: vec![0.0; order * (1 + 2 * order)],
            lock: FilterLock::new(1 + u32::from(tuning.rate_noise.is_some())),
            broken: false,
            mode: 0,
            gated: false,
            gated_for: 0.0,
            trusted: DominantMode::default(),
            lane_step: lane_step::LaneStep::default(),
            tuning,
        };
        let input = DVector::from_fn(order, |i, _| filter.tuning.model.input(i));
        filter.noise.ger(filter.tuning.moment_noise * filter.tuning.period, &input, &input, 0.0);
        for index in (filter.tuning.model.motion_states()..order).step_by(2) {
            for (offset, density) in filter.tuning.ratio_noise.iter().enumerate() {
                filter.noise[(index + offset, index + offset)] = density * filter.tuning.period;
            }
        }
        if let Prediction::Linear(transition, input) = &filter.tuning.prediction {
            let parts = [transition.as_slice(), input.as_slice(), filter.noise.as_slice()];
            filter.linear = parts.concat();
        }
        filter.mode = filter.most_excitable_mode();
        filter.trusted.frequency = filter.tuning.model.frequency(filter.mode, filter.mean.as_slice());
        filter
    }

    /// Returns the filter's parameters.
    pub(super) fn tuning(&self) -> &FilterParameters {
        &self.tuning
    }

    /// Returns the process noise covariance of a period.
    pub(super) fn noise(&self) -> &DMatrix<f64> {
        &self.noise
    }

    /// Returns the numbers of states and of measurements in a sample.
    pub fn dimensions(&self) -> [f64; 2] {
        [self.mean.len() as f64, 1.0 + f64::from(u8::from(self.tuning.rate_noise.is_some()))]
    }

    /// Returns the model of a linear filter in the form of flight code; empty of other filters.
    pub fn linear_model(&self) -> &[f64] {
        &self.linear
    }

    /// Returns the standard deviations of the measured angle (rad) and, if there is a gyro, of the measured rate (rad/s).
    pub fn measurement_noise(&self) -> (f64, Option<f64>) {
        (self.tuning.angle_noise, self.tuning.rate_noise)
    }

    /// Returns true if the dominant mode may change.
    pub fn ranks_by_amplitude(&self) -> bool {
        self.tuning.ranking == Ranking::Amplitude
    }

    /// Returns the mean of the state.
    pub fn mean(&self) -> &DVector<f64> {
        &self.mean
    }

    /// Returns the covariance of the state.
    pub fn covariance(&self) -> &DMatrix<f64> {
        &self.covariance
    }

    /// Returns the filter's model of the body.
    pub fn model(&self) -> &FilterModel {
        &self.tuning.model
    }

    /// Returns the dominant mode's index.
    pub fn mode(&self) -> usize {
        self.mode
    }

    /// Shifts the angle by `by` (rad) after a change of the target.
    pub fn shift(&mut self, by: f64) {
        self.mean[0] += by;
    }

    /// Returns true if the filter has lost lock: its innovations are improbable, or it cannot be propagated.
    pub fn lock_lost(&self) -> bool {
        self.broken || self.lock.is_lost
    }

    /// Returns true if the dominant mode moves too little for its frequency to be observable.
    pub fn is_gated(&self) -> bool {
        self.gated
    }

    /// Returns frequency and displacement of the dominant mode for the law. While the filter is gated, the frequency is
    /// held; without lock, it is the last one and the displacement is 0, so that the law does not act on it.
    pub fn dominant(&self) -> DominantMode {
        self.trusted
    }

    /// Predicts the state over one period with the mean reduced moment `moment` (rad/s²).
    pub fn predict(&mut self, moment: f64) {
        if !self.linear.is_empty() {
            let Self { linear, mean, covariance, buffer, .. } = self;
            let (mean, covariance) = (mean.as_mut_slice(), covariance.as_mut_slice());
            self.broken |= !kalman::predict(linear, moment, mean, covariance, buffer);
            return;
        }
        let moment = if moment.is_finite() { moment } else { 0.0 };
        self.keep();
        let Self { tuning, mean, covariance, noise, tangent, room, gated, .. } = self;
        let (model, period) = (&tuning.model, tuning.period);
        let carried = match &tuning.prediction {
            // It is predicted by flight code.
            Prediction::Linear(..) => Some(()),
            Prediction::Extended => {
                tangent.fill_with_identity();
                model.propagate(period, moment, mean.as_mut_slice(), Some(tangent));
                covariance.mul_to(tangent, room);
                tangent.tr_mul_to(room, covariance);
                Some(())
            }
            Prediction::Unscented => {
                sigma::transform(mean, covariance, |point| model.propagate(period, moment, point, None))
            }
        };
        *covariance += &*noise;
        if *gated {
            for index in model.motion_states()..model.order() {
                covariance[(index, index)] -= noise[(index, index)];
            }
        }
        for row in 0..covariance.nrows() {
            for column in 0..row {
                covariance[(row, column)] = covariance[(column, row)];
            }
        }
        if carried.is_none() || !self.is_sound() {
            self.restore();
            self.broken = true;
        }
    }

    /// Updates the state by the measured angle (rad) and, if the filter has a gyro, the measured rate (rad/s); `None`:
    /// no measurement.
    pub fn update(&mut self, measured: Option<(f64, f64)>) -> Innovation {
        let gated = self.is_still();
        let (angle, rate) = measured.unwrap_or_default();
        let sample = KalmanSample {
            is_measured: measured.is_some(),
            angle,
            rate,
            angle_noise: self.tuning.angle_noise,
            has_rate: self.tuning.rate_noise.is_some(),
            rate_noise: self.tuning.rate_noise.unwrap_or(0.0),
            motion: self.tuning.model.motion_states(),
            is_gated: gated,
        };
        let (mean, covariance) = (self.mean.as_mut_slice(), self.covariance.as_mut_slice());
        let found = kalman::update(&sample, mean, covariance, &mut self.buffer);
        self.settle(gated, found.angle, found.is_accepted.then_some(found.square)).0
    }

    /// Completes an update: gate, lock, bounds and dominant mode. Returns true if the ratios' rates were set to 0.
    fn settle(&mut self, gated: bool, innovation: f64, nis: Option<f64>) -> (Innovation, bool) {
        let rests = self.rest(gated);
        self.lock.update(nis.is_some(), nis.unwrap_or(0.0), innovation);
        self.hold_ratios();
        self.choose_mode();
        self.trust();
        (Innovation { innovation: if nis.is_some() { innovation } else { 0.0 }, nis }, rests)
    }

    fn keep(&mut self) {
        self.before.0.copy_from(&self.mean);
        self.before.1.copy_from(&self.covariance);
    }

    fn restore(&mut self) {
        self.mean.copy_from(&self.before.0);
        self.covariance.copy_from(&self.before.1);
    }

    /// Returns true if mean and covariance are finite, and no variance is negative.
    fn is_sound(&self) -> bool {
        kalman::is_sound(self.mean.as_slice(), self.covariance.as_slice())
    }

    fn is_still(&self) -> bool {
        self.tuning.model.order() > self.tuning.model.motion_states()
            && self.amplitude(self.mode).0 < self.tuning.gate
    }

    /// Sets whether the filter is gated from this sample on. After a whole period of the mode the ratios' rates are set
    /// to 0, too, since nothing shows how they continue; their uncertainty stays in the covariance. Returns true when
    /// that happens.
    fn rest(&mut self, gated: bool) -> bool {
        self.gated = gated;
        let before = self.gated_for;
        self.gated_for = if gated { before + self.tuning.period } else { 0.0 };
        let model = &self.tuning.model;
        let whole = std::f64::consts::TAU / model.frequency(self.mode, self.mean.as_slice());
        let rests = before < whole && self.gated_for >= whole;
        if rests {
            for rate in (model.motion_states() + 1..model.order()).step_by(2) {
                self.covariance[(rate, rate)] += self.mean[rate] * self.mean[rate];
                self.mean[rate] = 0.0;
            }
        }
        rests
    }

    /// Clamps the ratios to their bounds; a ratio that reaches them causes the loss of lock.
    fn hold_ratios(&mut self) {
        let [low, high] = self.tuning.bounds;
        let model = &self.tuning.model;
        for index in (model.motion_states()..model.order()).step_by(2) {
            if !(low..=high).contains(&self.mean[index]) {
                self.mean[index] = self.mean[index].clamp(low, high);
                self.mean[index + 1] = 0.0;
                self.lock.lose();
            }
        }
    }

    fn most_excitable_mode(&self) -> usize {
        let value = |mode| self.tuning.model.excitability(mode, self.mean.as_slice()).abs();
        (1..self.tuning.model.modes())
            .fold(0, |best, mode| if value(mode) > value(best) { mode } else { best })
    }

    fn choose_mode(&mut self) {
        match self.tuning.ranking {
            Ranking::Excitability => self.mode = self.most_excitable_mode(),
            Ranking::Amplitude => {
                let (own_amplitude, sd) = self.amplitude(self.mode);
                let clear = |mode: &usize| {
                    let (amplitude, own_sd) = self.amplitude(*mode);
                    amplitude - own_amplitude > sd + own_sd
                };
                if let Some(mode) = (0..self.tuning.model.modes()).find(clear) {
                    self.mode = mode;
                }
            }
        }
    }

    fn trust(&mut self) {
        if self.lock_lost() {
            (self.trusted.displacement, self.trusted.rate) = (0.0, 0.0);
            return;
        }
        self.trusted.displacement = self.mean[2 + 2 * self.mode];
        self.trusted.rate = self.mean[3 + 2 * self.mode];
        if !self.gated {
            self.trusted.frequency = self.tuning.model.frequency(self.mode, self.mean.as_slice());
        }
    }
}
