//! Estimators of single axes that act at each sample: ideal observers and Kalman filters.

use flexsc_dynamics::AxisState;
use flexsc_dynamics::frequency_drift::FrequencyDrift;
use flexsc_flight::kalman::total;
use flexsc_numerics::random::{Seed, Stream};
use flexsc_numerics::time::Instant;
use flexsc_record::{self, Estimates, ModeEstimate, Report};

use super::kalman::{FilterContext, Innovation, KalmanFilter, MeasurementFilter};
use super::pass_through::PassThrough;
use super::{BatchEstimator, EstimateOutputs, Estimator, EstimatorContext, EstimatorKind, SampleContext};
use crate::part::{Occasion, Part, ReportContext};
use crate::state_estimate::{DominantMode, EstimateNeeds, StateEstimate};

/// The estimators of all axes.
#[derive(Clone, Debug)]
pub struct AxisEstimators(Vec<AxisEstimator>);

/// Run-time state of the estimator of one axis.
#[derive(Clone, Debug)]
struct AxisEstimator {
    method: AxisMethod,
    feeds: EstimateOutputs,
    /// Natural frequencies at the start (rad/s); the following fields are the excitabilities and the drift of the
    /// modes.
    frequencies: Vec<f64>,
    excitability: Vec<f64>,
    drift: Option<FrequencyDrift>,
    /// Reduced moment (rad/s²) that acts from `since` on, and its integral (rad/s) from the last sample until `since`.
    moment: f64,
    since: Instant,
    impulse: f64,
    /// Time of the last sample.
    sampled: Option<Instant>,
    innovation: Innovation,
    /// Mean reduced moment over the period before the last sample (rad/s²).
    mean_moment: f64,
}

/// Linear Kalman filter about an axis before its first sample.
#[derive(Clone, Debug)]
pub struct LinearFilter {
    /// Filter.
    pub filter: KalmanFilter,
    /// Estimates that the law reads.
    pub feeds: EstimateOutputs,
}

/// Returns the linear Kalman filters that the laws read, one about each axis; `None` with another estimator, or if the dominant
/// mode of a filter may change.
pub fn linear_filters(known: &EstimatorContext<'_>, seed: Seed) -> Option<Vec<LinearFilter>> {
    let Some(EstimatorKind::Kalman(spec)) = known.estimator else { return None };
    let filter = |axis: AxisEstimator| match axis.method {
        AxisMethod::Filter(filter) if !filter.ranks_by_amplitude() => {
            Some(LinearFilter { filter: *filter, feeds: axis.feeds })
        }
        _ => None,
    };
    let create = |setting: &FilterContext<'_>, draws: &mut Stream| Some(spec.filter(setting, draws));
    let all = (!spec.watch_only).then(|| AxisEstimators::new(known, seed, create)).flatten()?;
    all.0.into_iter().map(filter).collect()
}

/// Estimation method of an axis.
#[derive(Clone, Debug)]
enum AxisMethod {
    /// Ideal observer, which uses the true state.
    Ideal,
    /// Kalman filter.
    Filter(Box<KalmanFilter>),
}

impl AxisEstimators {
    /// Creates the estimators of all axes by `filter`, which returns the Kalman filter of an axis with a drawn prior, or `None`
    /// for an ideal observer; `None` without sampling.
    fn new(
        known: &EstimatorContext<'_>,
        seed: Seed,
        filter: impl Fn(&FilterContext<'_>, &mut Stream) -> Option<KalmanFilter>,
    ) -> Option<Self> {
        let axes = 0..known.axes.len();
        axes.map(|axis| AxisEstimator::new(known, axis, seed, &filter)).collect::<Option<_>>().map(Self)
    }

    /// Returns the run-time state of the estimators of all axes, or a pass-through without sampling; `filter` as in `new`.
    pub fn start(
        known: &EstimatorContext<'_>,
        seed: Seed,
        filter: impl Fn(&FilterContext<'_>, &mut Stream) -> Option<KalmanFilter>,
    ) -> Box<dyn Estimator> {
        Self::new(known, seed, filter).map_or_else(|| Box::new(PassThrough) as _, |all| Box::new(all) as _)
    }
}

impl Part for AxisEstimators {
    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        if at.occasion != Occasion::Sample {
            return;
        }
        let row = |axis: usize| self.0[axis].row(at.now.seconds(), &at.truth.about_axis(axis));
        if self.0.len() == 1 {
            if let Some(row) = row(0) {
                report.add(row);
            }
        } else if let Some(axes) = (0..self.0.len()).map(row).collect() {
            report.add(Estimates { axes });
        }
    }
}

impl BatchEstimator for AxisEstimators {
    fn batch_filter(&mut self, now: Instant) -> Option<(&mut KalmanFilter, Option<f64>)> {
        let [track] = &mut self.0[..] else { return None };
        let impulse = track.impulse + track.moment * now.since(track.since).seconds();
        let AxisMethod::Filter(filter) = &mut track.method else { return None };
        Some((filter, track.sampled.map(|sampled| impulse / now.since(sampled).seconds())))
    }

    fn true_filter_state(&self, now: Instant, truth: &AxisState) -> Vec<f64> {
        let track = &self.0[0];
        if let AxisMethod::Filter(filter) = &track.method {
            track.truth(now.seconds(), truth, filter)
        } else {
            Vec::new()
        }
    }
}

impl Estimator for AxisEstimators {
    fn input_changed(&mut self, now: Instant, moments: [f64; 3]) {
        for (track, moment) in self.0.iter_mut().zip(moments) {
            track.add_impulse(now, moment);
        }
    }

    fn update(&mut self, context: &SampleContext<'_>, state_estimates: &mut [StateEstimate]) {
        self.0[0].impulse += context.waveform_impulse;
        for (axis, (track, state_estimate)) in self.0.iter_mut().zip(state_estimates).enumerate() {
            track.update_axis(axis, context, state_estimate);
        }
    }

    fn shift_origin(&mut self, by: [f64; 3]) {
        for (track, by) in self.0.iter_mut().zip(by) {
            if let AxisMethod::Filter(filter) = &mut track.method {
                filter.shift(by);
            }
        }
    }

    fn known_inputs(&self) -> [f64; 3] {
        let mut moments = [0.0; 3];
        self.0.iter().zip(&mut moments).for_each(|(track, moment)| *moment = track.mean_moment);
        moments
    }

    fn lock_lost(&self) -> [bool; 3] {
        let mut lost = [false; 3];
        for (track, lost) in self.0.iter().zip(&mut lost) {
            *lost = matches!(&track.method, AxisMethod::Filter(filter) if filter.lock_lost());
        }
        lost
    }

    fn batch(&mut self) -> Option<&mut dyn BatchEstimator> {
        Some(self)
    }

    fn copy(&self) -> Box<dyn Estimator> {
        Box::new(self.clone())
    }
}

impl AxisEstimator {
    fn new(
        known: &EstimatorContext<'_>,
        axis: usize,
        seed: Seed,
        filter: impl Fn(&FilterContext<'_>, &mut Stream) -> Option<KalmanFilter>,
    ) -> Option<Self> {
        let model = &known.axes[axis];
        let back_emf = known.back_emf;
        let setting = FilterContext {
            body: model,
            back_emf: (back_emf.0 / model.inertia.get(), back_emf.1),
            period: known.sampling?.seconds(),
            angle_noise: known.angle_noise,
            rate_noise: known.rate_noise[axis],
        };
        let stream = match axis {
            0 => "prior".to_owned(),
            axis => format!("prior {axis}"),
        };
        let draws = &mut seed.stream(&stream);
        let method =
            filter(&setting, draws).map_or(AxisMethod::Ideal, |filter| AxisMethod::Filter(Box::new(filter)));
        let estimator = known.estimator?;
        Some(Self {
            method,
            feeds: estimator.feeds(known.reads[axis] == EstimateNeeds::DominantMode),
            frequencies: model.modes.iter().map(|mode| mode.frequency.get()).collect(),
            excitability: model.modes.iter().map(|mode| mode.excitability().abs()).collect(),
            drift: known.drift.cloned(),
            moment: 0.0,
            since: Instant::START,
            impulse: 0.0,
            sampled: None,
            innovation: Innovation::default(),
            mean_moment: 0.0,
        })
    }

    /// Sets the reduced moment (rad/s²) that the actuator applies from `now` on.
    fn add_impulse(&mut self, now: Instant, moment: f64) {
        self.impulse += self.moment * now.since(self.since).seconds();
        (self.moment, self.since) = (moment, now);
    }

    /// Updates the state estimate at a sample, with or without a measurement.
    fn update_axis(&mut self, axis: usize, context: &SampleContext<'_>, state_estimate: &mut StateEstimate) {
        let now = context.now;
        self.add_impulse(now, self.moment);
        let period = self.sampled.replace(now).map(|sampled| now.since(sampled).seconds());
        let impulse = std::mem::take(&mut self.impulse);
        if let Some(measured) = context.measured {
            [state_estimate.angle, state_estimate.rate] = measured[axis];
        }
        match &mut self.method {
            AxisMethod::Ideal => {
                let truth = (context.truth)(axis);
                state_estimate.dominant = self.ideal(now.seconds(), &truth);
                match self.feeds {
                    EstimateOutputs::Modes => {}
                    EstimateOutputs::Hub => {
                        let modes = truth.modes.iter().zip(&self.frequencies);
                        let rate = modes.map(|(mode, frequency)| frequency * mode.quadrature).sum::<f64>();
                        (state_estimate.angle, state_estimate.rate) =
                            (truth.angle(), truth.rigid_rate + rate);
                    }
                    EstimateOutputs::Rigid => {
                        (state_estimate.angle, state_estimate.rate) = (truth.rigid_angle, truth.rigid_rate);
                    }
                }
            }
            AxisMethod::Filter(filter) => {
                self.innovation = filter.lane_innovation().unwrap_or_else(|| {
                    if let Some(period) = period {
                        self.mean_moment = impulse / period;
                        filter.predict(self.mean_moment);
                    }
                    filter.update(context.measured.map(|measured| measured[axis].into()))
                });
                state_estimate.dominant = filter.dominant();
                let mean = filter.mean();
                match self.feeds {
                    EstimateOutputs::Modes => {}
                    EstimateOutputs::Hub => {
                        let motion = 2 + 2 * self.frequencies.len();
                        let sum = |from: usize| total(mean.as_slice(), from, motion);
                        (state_estimate.angle, state_estimate.rate) = (sum(0), sum(1));
                    }
                    EstimateOutputs::Rigid => {
                        (state_estimate.angle, state_estimate.rate) = (mean[0], mean[1]);
                    }
                }
            }
        }
    }

    /// Returns the true dominant mode at time `t` (s).
    fn ideal(&self, t: f64, state: &AxisState) -> DominantMode {
        let all = match &self.drift {
            None => Some(1.0),
            Some(FrequencyDrift::Common(profile)) => Some(profile.ratio(t)),
            Some(FrequencyDrift::Each(_)) => None,
        };
        let own = |mode: usize| self.drift.as_ref().map_or(1.0, |drift| drift.ratio(mode, t));
        let ratio = |mode: usize| all.unwrap_or_else(|| own(mode));
        let value = |mode: usize| self.excitability[mode] / (ratio(mode) * ratio(mode));
        let modes = 1..self.frequencies.len();
        let mode = modes.fold(0, |best, mode| if value(mode) > value(best) { mode } else { best });
        DominantMode {
            displacement: state.modes[mode].displacement,
            rate: self.frequencies[mode] * state.modes[mode].quadrature,
            frequency: self.frequencies[mode] * ratio(mode),
        }
    }

    /// Returns the true values of a filter's state components at time `t` (s).
    fn truth(&self, t: f64, state: &AxisState, filter: &KalmanFilter) -> Vec<f64> {
        let (model, mode, mean) = (filter.model(), filter.mode(), filter.mean());
        let ratio = |mode: usize| self.drift.as_ref().map_or(1.0, |drift| drift.ratio(mode, t));
        let slope = |mode: usize| self.drift.as_ref().map_or(0.0, |drift| drift.slope(mode, t));
        let mut truth = state.to_vector(&self.frequencies).as_slice().to_vec();
        for index in (model.motion_states()..model.order()).step_by(2) {
            // The true value of a ratio common to all modes is that of the dominant one.
            let mut owners = (0..model.modes()).filter(|owner| model.ratio_of(*owner) == Some(index));
            let owner =
                if model.ratio_of(mode) == Some(index) { mode } else { owners.next().unwrap_or(mode) };
            // The ratio is relative to the nominal frequency in the filter's model.
            let own = self.frequencies[owner] * mean[index] / model.frequency(owner, mean.as_slice());
            truth.extend([own * ratio(owner), own * slope(owner)]);
        }
        truth
    }

    /// Returns the filter's log row at time `t` (s).
    fn row(&self, t: f64, state: &AxisState) -> Option<flexsc_record::Estimate> {
        let AxisMethod::Filter(filter) = &self.method else { return None };
        let reported = self.innovation;
        let (model, mode, mean) = (filter.model(), filter.mode(), filter.mean());
        let true_ratio = self.drift.as_ref().map_or(1.0, |drift| drift.ratio(mode, t));
        // In a batch, the covariance is kept there, and only the metrics use this row.
        let in_lanes = filter.is_in_lanes();
        let known = model.ratio_of(mode);
        let value = |offset: usize| known.map_or(1.0 - offset as f64, |index| mean[index + offset]);
        let sd = |offset: usize| {
            known.map_or(0.0, |index| f64::sqrt(filter.covariance()[(index + offset, index + offset)]))
        };
        let modes = (0..model.modes()).map(|index| {
            let (amplitude_rad, amplitude_sd_rad) = filter.amplitude(index);
            ModeEstimate {
                displacement_rad: mean[2 + 2 * index],
                rate_rad_s: mean[3 + 2 * index],
                frequency_rad_s: filter.frequency(index).0,
                amplitude_rad,
                amplitude_sd_rad,
            }
        });
        let [states, measurements] = filter.dimensions();
        let nees = if in_lanes { filter.lane_nees() } else { filter.nees(&self.truth(t, state, filter)) };
        Some(flexsc_record::Estimate {
            dominant: mode as u64,
            frequency_rad_s: filter.dominant().frequency,
            frequency_sd_rad_s: filter.frequency(mode).1,
            true_frequency_rad_s: self.frequencies[mode] * true_ratio,
            displacement_rad: filter.dominant().displacement,
            ratio: value(0),
            ratio_sd: sd(0),
            ratio_rate_1_s: value(1),
            ratio_rate_sd_1_s: sd(1),
            modes: if in_lanes { Vec::new() } else { modes.collect() },
            innovation_rad: reported.innovation,
            nis: reported.nis.unwrap_or(0.0) / measurements,
            measured: reported.nis.is_some().into(),
            nees: nees / states,
            gated: filter.is_gated().into(),
            lock: (!filter.lock_lost()).into(),
        })
    }
}
