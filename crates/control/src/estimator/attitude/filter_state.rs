//! Run-time state of the attitude filter: from sensor readings to the state estimate about three axes.

use std::mem;

use flexsc_flight::attitude_estimator::{gyro_exposure, observation_exposure};
use flexsc_flight::reading_status::ReadingStatus;
use flexsc_numerics::attitude::{Vector, rotation, rotation_vector};
use flexsc_numerics::flight_types::to_vector3;
use flexsc_numerics::random::Stream;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{
    AttitudeEstimate, AxisEstimate, ElasticEstimate, ElasticEstimates, ReadingOutcome, Refusals,
    RefusedReading, Report,
};
use nalgebra::Quaternion;

use super::elastic_states::ElasticFilterStates;
use super::spec::{AttitudeFilter, FilterSetup, SensorRole};
use super::{AttitudeFilterState, AttitudeMeasurement, Correction, DelayedMeasurement, FilterHistory};
use crate::estimator::kalman::Prior;
use crate::estimator::{Estimator, FilterHealth, SampleContext};
use crate::part::{Occasion, Part, ReportContext};
use crate::sensor::{Orientation, Reading, VectorMeasurement};
use crate::state_estimate::StateEstimate;

/// Run-time state of the attitude filter.
#[derive(Clone, Debug)]
pub struct AttitudeFilterRun {
    spec: AttitudeFilter,
    setting: FilterSetup,
    draws: Stream,
    /// Filter and its recent past; `None` before the first sample.
    history: Option<FilterHistory>,
    /// Last gyro reading (rad/s), and the time at which its interval ended.
    rate: Vector,
    since: Instant,
    /// Time of the last sample and the attitude after it.
    sampled: Option<(Instant, Quaternion<f64>)>,
    /// Angles for the laws (rad) after the last sample, and the origin from which they are counted.
    sampled_angles: Option<(Orientation, [f64; 3])>,
    /// Torque on the body about its axes (N m), which excites the modes.
    torque: Vector,
    /// Correction by the last sample, and true if it had any.
    last_correction: Correction,
    used: bool,
    /// Size of the innovation of the last correction (rad).
    innovation: f64,
    /// Readings of the last sample that were refused, or accepted after refusals.
    refusals: Vec<RefusedReading>,
}

impl AttitudeFilterRun {
    /// Creates the filter before the first sample; `draws` supplies a drawn prior.
    pub fn new(spec: &AttitudeFilter, setting: FilterSetup, draws: Stream) -> Self {
        Self {
            spec: spec.clone(),
            setting,
            draws,
            history: None,
            rate: Vector::zeros(),
            since: Instant::START,
            sampled: None,
            sampled_angles: None,
            torque: Vector::zeros(),
            last_correction: Correction::NONE,
            used: false,
            innovation: 0.0,
            refusals: Vec::new(),
        }
    }

    /// Returns the filter's initial state for the true attitude at the start.
    fn prior(&mut self, attitude: &Quaternion<f64>) -> AttitudeFilterState {
        initial_state(&self.spec, &self.setting, &mut self.draws, attitude)
    }

    /// Propagates and corrects the filter with the readings of this sample.
    fn read(&mut self, now: Instant, readings: &[Option<Reading>]) {
        let Some(history) = &mut self.history else { return };
        let mut last: Option<Correction> = None;
        self.refusals.clear();
        // The gyro comes first: then the filter has reached the time of any other measurement of this sample.
        for (role, (sensor, reading)) in
            self.setting.readings_of_role(readings, &|role| matches!(role, SensorRole::Gyro { .. }))
        {
            if let (Some(rate), SensorRole::Gyro { latency }) = (reading.rate, role) {
                let exposed =
                    Instant::from_ticks(gyro_exposure(now.ticks(), latency.ticks(), Instant::START.ticks()));
                let status = history.judge_gyro(exposed, rate.into());
                self.refusals.extend(refusal(sensor, &Correction::unused(status)));
                if !status.is_refusal() {
                    self.rate = rate.into();
                    for (sensor, result) in history.add_gyro(exposed, self.rate) {
                        self.refusals.extend(refusal(sensor, &result));
                        last = Some(result).filter(|result| result.status.has_corrected()).or(last);
                    }
                    self.since = exposed;
                }
            }
        }
        for (role, (sensor, reading)) in
            self.setting.readings_of_role(readings, &|role| matches!(role, SensorRole::Corrects { .. }))
        {
            let SensorRole::Corrects { latency, noise, gain } = role else { continue };
            let exposed = exposure(now, *latency);
            let measured = match (reading.sight, reading.at) {
                (Some(measurement), _) => {
                    AttitudeMeasurement::Vector(self.setting.with_reference(measurement, exposed))
                }
                (None, Orientation::Attitude(attitude)) => AttitudeMeasurement::Attitude(attitude),
                (None, Orientation::Angle(_)) => continue,
            };
            let gain = gain.as_deref().copied();
            let measurement = DelayedMeasurement { exposed, measured, noise: *noise, gain, sensor };
            let result = history.add_measurement(&measurement);
            self.refusals.extend(result.and_then(|result| refusal(sensor, &result)));
            last = result.filter(|result| result.status.has_corrected()).or(last);
        }
        self.used = last.is_some();
        self.last_correction = last.unwrap_or(Correction::NONE);
        self.innovation = last.map_or(self.innovation, |correction| correction.innovation.norm());
    }

    /// Returns the attitude at `now`, propagated with the last gyro reading.
    fn attitude(&self, now: Instant) -> Option<Quaternion<f64>> {
        if let Some((_, attitude)) = self.sampled.filter(|(sampled, _)| *sampled == now) {
            return Some(attitude);
        }
        Some(self.history.as_ref()?.attitude_after(&self.rate, now.since(self.since).seconds()))
    }

    /// Returns the elastic part of the last gyro reading (rad/s) that is removed from the rate for the laws.
    fn elastic_rate(&self) -> Vector {
        let elastic = self.history.as_ref().and_then(FilterHistory::modes);
        elastic.map_or_else(Vector::zeros, |elastic| {
            let [hub, mount] = elastic.rates();
            if elastic.known.rigid { hub + mount } else { mount }
        })
    }

    /// Returns the attitude that laws read, from that of the hub: without the rotation by known modes if laws read the
    /// rigid motion.
    fn attitude_for_laws(&self, hub: Quaternion<f64>) -> Quaternion<f64> {
        let elastic = self.history.as_ref().and_then(FilterHistory::modes);
        match elastic.filter(|elastic| elastic.known.rigid) {
            Some(elastic) => hub * rotation(&-elastic.hub_rotation()),
            None => hub,
        }
    }
}

/// Returns the exposure of an observation that becomes available at an instant.
fn exposure(at: Instant, latency: Span) -> Instant {
    Instant::from_ticks(observation_exposure(at.ticks(), latency.ticks(), Instant::START.ticks()))
}

/// Returns the log row of a reading with this result that was refused, or accepted after refusals; `None` of other readings.
fn refusal(sensor: usize, result: &Correction) -> Option<RefusedReading> {
    let outcome = match result.status {
        ReadingStatus::Unsound => ReadingOutcome::Unsound,
        ReadingStatus::Improbable => ReadingOutcome::Improbable,
        ReadingStatus::Untimely => ReadingOutcome::Untimely,
        ReadingStatus::Reaccepted => ReadingOutcome::Reaccepted,
        ReadingStatus::None | ReadingStatus::Accepted | ReadingStatus::Waiting => return None,
    };
    // A reading that was refused before it was compared with the filter has no components.
    let nis = if result.components == 0 { f64::NAN } else { result.nis / AttitudeEstimate::MEASUREMENTS };
    Some(RefusedReading { sensor: sensor as u64, outcome, nis })
}

/// Returns the initial state of a filter for the true attitude at the start; `draws` supplies a drawn prior.
pub fn initial_state(
    spec: &AttitudeFilter,
    setting: &FilterSetup,
    draws: &mut Stream,
    attitude: &Quaternion<f64>,
) -> AttitudeFilterState {
    let deviations = [spec.initial.angle.get(), spec.initial.bias.get()];
    let mut off = [Vector::zeros(); 2];
    if spec.prior == Prior::Drawn {
        for (off, deviation) in off.iter_mut().zip(deviations) {
            *off = Vector::from_fn(|_, _| deviation * draws.normal());
        }
    }
    AttitudeFilterState::new(attitude * rotation(&off[0]), setting.bias + off[1], deviations)
}

impl FilterSetup {
    /// Iterates over the readings of the sensors whose role satisfies `wanted`, with their indices.
    fn readings_of_role<'a>(
        &'a self,
        readings: &'a [Option<Reading>],
        wanted: &'a dyn Fn(&SensorRole) -> bool,
    ) -> impl Iterator<Item = (&'a SensorRole, (usize, &'a Reading))> {
        let all = self.roles.iter().zip(readings).enumerate();
        let wanted = all.filter(move |(_, (role, _))| wanted(role));
        wanted.filter_map(|(sensor, (role, reading))| Some((role, (sensor, reading.as_ref()?))))
    }

    /// Returns a measured vector with the reference of the filter's model at its exposure: a measured magnetic field has
    /// that of the model, other vectors keep theirs.
    pub fn with_reference(&self, measurement: VectorMeasurement, exposed: Instant) -> VectorMeasurement {
        let model = self.field_model.as_ref().filter(|_| !measurement.is_direction);
        let field = model.and_then(|sky| sky.field_at(exposed.seconds()));
        VectorMeasurement { inertial: field.unwrap_or(measurement.inertial), ..measurement }
    }
}

impl AttitudeFilterRun {
    /// Returns the filter's log row, with its errors against the true orientation and the true gyro bias (rad/s); its axes
    /// are in the memory of `axes`.
    fn attitude_row(
        &self,
        now: Instant,
        truth: &Orientation,
        bias: [f64; 3],
        mut axes: Vec<AxisEstimate>,
    ) -> Option<AttitudeEstimate> {
        let (Orientation::Attitude(truth), filter) = (truth, self.history.as_ref()?.latest()) else {
            return None;
        };
        let (estimate, bias) = (AttitudeFilterRun::attitude(self, now)?, Vector::from(bias));
        let [angle_sd, bias_sd] = filter.deviations();
        let error = [rotation_vector(&estimate, truth), bias - filter.bias];
        let [angle_error, bias_error] = error;
        let axis = |axis: usize| AxisEstimate {
            angle_error_rad: -angle_error[axis],
            angle_sd_rad: angle_sd[axis],
            bias_rad_s: filter.bias[axis],
            bias_error_rad_s: -bias_error[axis],
            bias_sd_rad_s: bias_sd[axis],
            innovation_rad: self.last_correction.innovation.component(axis),
        };
        axes.clear();
        axes.extend([0, 1, 2].map(axis));
        Some(AttitudeEstimate {
            q_w: estimate.w,
            q_x: estimate.i,
            q_y: estimate.j,
            q_z: estimate.k,
            axes,
            nees: filter.normalised(&error) / AttitudeEstimate::STATES,
            nis: self.last_correction.nis / AttitudeEstimate::MEASUREMENTS,
            numbers: self.last_correction.components.into(),
            measured: self.used.into(),
        })
    }

    /// Returns the log row of the elastic modes, in the memory of `rows`; `None` if the filter does not estimate any.
    fn elastic_row(&self, mut rows: Vec<ElasticEstimate>) -> Option<ElasticEstimates> {
        let elastic = self.history.as_ref()?.modes()?;
        let each = elastic.known.each.iter().zip(&elastic.state).zip(&elastic.frequencies);
        let modes = each.zip(elastic.deviations()).map(|(((mode, state), frequency), deviation)| {
            let [displacement, rate_over_frequency] = *state;
            ElasticEstimate {
                displacement,
                rate_over_frequency,
                frequency_rad_s: *frequency,
                frequency_sd_rad_s: deviation,
                true_frequency_rad_s: mode.true_frequency,
            }
        });
        rows.clear();
        rows.extend(modes);
        Some(ElasticEstimates { modes: rows })
    }
}

impl Part for AttitudeFilterRun {
    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        if at.occasion != Occasion::Sample {
            return;
        }
        let (orientation, bias) = (at.truth.orientation(), at.truth.gyro_bias());
        let axes = report.reuse(|row: &mut AttitudeEstimate| mem::take(&mut row.axes));
        if let Some(row) = self.attitude_row(at.now, &orientation, bias, axes) {
            report.add(row);
            if !self.refusals.is_empty() {
                report.add(Refusals { readings: self.refusals.clone() });
            }
            let modes = report.reuse(|row: &mut ElasticEstimates| mem::take(&mut row.modes));
            self.elastic_row(modes).into_iter().for_each(|row| report.add(row));
        }
    }
}

impl Estimator for AttitudeFilterRun {
    fn input_changed(&mut self, now: Instant, moments: [f64; 3]) {
        let Some(known) = &self.setting.modes else { return };
        self.torque = Vector::from(moments).component_mul(&known.inertia);
        if let Some(history) = &mut self.history {
            history.set_torque(now, self.torque);
        }
    }

    fn update(&mut self, context: &SampleContext<'_>, state_estimates: &mut [StateEstimate]) {
        let now = context.now;
        if self.history.is_none() {
            let Orientation::Attitude(origin) = context.origin else { return };
            let beyond = Vector::from_fn(|axis, _| (context.truth)(axis).rigid_angle);
            let state = self.prior(&(origin * rotation(&beyond)));
            let known = self.setting.modes.clone();
            let modes = known.map(|known| ElasticFilterStates::new(known, &state.covariance));
            let mut history = FilterHistory::new(
                now,
                state,
                modes,
                self.setting.noise,
                self.setting.reach,
                self.setting.gate,
            );
            history.set_torque(now, self.torque);
            self.history = Some(history);
        }
        (self.sampled, self.sampled_angles) = (None, None);
        self.read(now, context.readings);
        self.sampled = self.attitude(now).map(|attitude| (now, attitude));
        let (Some(history), Some((_, attitude))) = (&self.history, self.sampled) else { return };
        let (attitude, elastic) = (self.attitude_for_laws(attitude), self.elastic_rate());
        let bias = history.bias();
        let angles = Orientation::Attitude(attitude).error_from(context.origin);
        self.sampled_angles = Some((*context.origin, angles));
        for (axis, state_estimate) in state_estimates.iter_mut().enumerate() {
            if self.spec.watch_only {
                if let Some(measured) = context.measured {
                    [state_estimate.angle, state_estimate.rate] = measured[axis];
                }
            } else {
                (state_estimate.angle, state_estimate.rate) =
                    (angles[axis], self.rate[axis] - bias[axis] - elastic[axis]);
            }
        }
    }

    fn predict(&self, now: Instant, origin: &Orientation, state_estimates: &mut [StateEstimate]) {
        let Some(attitude) = self.attitude(now).filter(|_| !self.spec.watch_only) else { return };
        let is_sampled = self.sampled.is_some_and(|(sampled, _)| sampled == now);
        let angles =
            match self.sampled_angles.filter(|(counted_from, _)| is_sampled && counted_from == origin) {
                Some((_, angles)) => angles,
                None => Orientation::Attitude(self.attitude_for_laws(attitude)).error_from(origin),
            };
        state_estimates
            .iter_mut()
            .zip(angles)
            .for_each(|(state_estimate, angle)| state_estimate.angle = angle);
    }

    fn with_reference(&self, sensor: usize, measured: VectorMeasurement, at: Instant) -> VectorMeasurement {
        let Some(SensorRole::Corrects { latency, .. }) = self.setting.roles.get(sensor) else {
            return measured;
        };
        self.setting.with_reference(measured, exposure(at, *latency))
    }

    fn filter_health(&self, now: Instant) -> Option<FilterHealth> {
        let history = self.history.as_ref()?;
        let [angle, _] = history.latest().deviations();
        let age = now.since(history.corrected()).seconds();
        Some(FilterHealth { age, innovation: self.innovation, deviation: to_vector3(&angle.into()).norm() })
    }

    fn copy(&self) -> Box<dyn Estimator> {
        Box::new(self.clone())
    }
}
