//! Estimation: from sensor samples to state estimates, with angles counted from the current target, and the monitor of
//! the envelope.

use flexsc_control::actuator::PulsedActuator;
use flexsc_control::estimator::kalman::KalmanFilter;
use flexsc_control::estimator::{
    self, AdaptationRun, EnvelopeWindow, Estimator, SampleContext, WindowedEnvelope,
};
use flexsc_control::sensor::Orientation;
use flexsc_control::state_estimate::StateEstimate;
use flexsc_flight_precision::Precision;
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::Instant;

use super::controllers::ControlLaws;
use super::guidance::Guidance;
use super::loads::Loads;
use super::plant::Plant;
use super::sensors::Sensors;
use flexsc_scenario::Scenario;

/// Estimator of a run, its estimates and their origin, and the monitor of the envelope.
#[derive(Clone, Debug)]
pub struct Estimation {
    pub estimator: Box<dyn Estimator>,
    /// True if the scenario has an estimator.
    pub has_estimator: bool,
    /// Instant up to which the estimator knows the impulse of the waveform.
    inputs_known_until: Instant,
    /// State estimate about each axis, which the laws read.
    pub estimates: Vec<StateEstimate>,
    /// Attitude or angle from which the angles are counted, and (`next_origin_change`) the instant at which it changes
    /// next.
    origin: Orientation,
    next_origin_change: Option<Instant>,
    pub monitor: Option<WindowedEnvelope>,
    /// Shift of the angles (rad) by the last change of their origin, until it is taken.
    pub last_shift: Option<[f64; 3]>,
    precision: Precision,
}

impl Estimation {
    /// Creates the estimation of a scenario's run, before its start.
    pub fn new(scenario: &Scenario, guidance: &Guidance, seed: Seed) -> Self {
        Self {
            estimator: estimator::start(&scenario.estimator_context(), seed),
            has_estimator: scenario.estimator.is_some(),
            inputs_known_until: Instant::START,
            estimates: vec![StateEstimate::default(); scenario.study.axes.len()],
            origin: guidance.origin(Instant::START),
            next_origin_change: guidance.next_change(Instant::START),
            monitor: scenario.monitor(seed),
            last_shift: None,
            precision: scenario.flight_precision,
        }
    }

    /// Returns the number of axes.
    #[inline]
    pub fn axis_count(&self) -> usize {
        self.estimates.len()
    }

    /// Returns the attitude or angle from which the angles are counted.
    #[inline]
    pub fn origin(&self) -> &Orientation {
        &self.origin
    }

    /// Returns true if the origin never changes any more.
    pub fn origin_is_fixed(&self) -> bool {
        self.next_origin_change.is_none()
    }

    /// Returns the instant at which the window of the envelope closes next.
    #[inline]
    pub fn window_closes(&self) -> Option<Instant> {
        self.monitor.as_ref().map(|monitor| monitor.closes)
    }

    /// Moves the origin of the angles to the target at `now`, and shifts the estimates accordingly.
    #[inline]
    pub fn update_angle_origin(&mut self, now: Instant, guidance: &mut Guidance) {
        if self.next_origin_change.is_some_and(|begins| now >= begins) {
            self.move_origin(now, guidance);
        }
    }

    /// Moves the origin of the angles to the target at `now`, even if it was not known before when it would change.
    pub fn move_origin(&mut self, now: Instant, guidance: &mut Guidance) {
        guidance.compute_reference(now);
        let origin = guidance.origin(now);
        let by = origin.angles_to(&self.origin, self.precision);
        self.estimator.shift_origin(by);
        for (axis, estimate) in self.estimates.iter_mut().enumerate() {
            estimate.angle = self.precision.rounded(estimate.angle + by[axis]);
        }
        self.origin = origin;
        self.last_shift = Some(by);
        self.next_origin_change = guidance.next_change(now);
    }

    /// Updates the estimates with the sample at `now`, in which the sensors have `measured` anything or nothing.
    pub fn update(
        &mut self,
        now: Instant,
        measured: bool,
        sensors: &Sensors,
        plant: &Plant,
        loads: &Loads,
        lead_time: f64,
    ) {
        let abilities = loads.actuator.capabilities();
        let mut waveform_impulse = 0.0;
        if !sensors.is_continuous() {
            let (from, to) = (self.inputs_known_until.seconds(), now.seconds());
            waveform_impulse = abilities.waveform.map_or(0.0, |of| of.waveform_impulse(from, to));
            self.inputs_known_until = now;
        }
        let origin = &self.origin;
        let taken = SampleContext {
            now,
            measured: measured.then_some(&sensors.measured[..]),
            readings: &sensors.new_readings,
            origin,
            truth: &|axis| plant.about_axis(axis, origin),
            held_torque: &|axis| loads.actuator.effort(axis).held,
            pulses: abilities.pulses,
            waveform_impulse,
            ahead: lead_time,
        };
        self.estimator.update(&taken, &mut self.estimates);
        if let Some(change) = sensors.last_field_rate() {
            let each = self.estimates.iter_mut().zip([change.x, change.y, change.z]);
            each.for_each(|(estimate, change)| estimate.field_rate = change);
        }
        let queued = abilities.pulses.map_or([0.0; 3], PulsedActuator::queued_rate_change);
        for (estimate, queued) in self.estimates.iter_mut().zip(queued) {
            estimate.queued_rate = queued;
        }
    }

    /// Predicts the estimates from the last sample to `now`, at which a law decides; a continuous sensor gives the true
    /// state.
    #[inline]
    pub fn predict(&mut self, now: Instant, plant: &Plant, sensors: &Sensors) {
        let mut estimates = std::mem::take(&mut self.estimates);
        self.predict_into(now, plant, sensors, &mut estimates);
        self.estimates = estimates;
    }

    /// Predicts copies of the estimates to `now`, as [`Self::predict`] does.
    #[inline]
    pub fn predict_into(
        &self,
        now: Instant,
        plant: &Plant,
        sensors: &Sensors,
        estimates: &mut [StateEstimate],
    ) {
        if sensors.field_is_stale(now) {
            for estimate in estimates.iter_mut() {
                estimate.field_rate = 0.0;
            }
        }
        if sensors.is_continuous() {
            let (truth, angles) = (plant.truth(), plant.sensed_angles(&self.origin));
            for (axis, estimate) in estimates.iter_mut().enumerate() {
                (estimate.angle, estimate.rate) = (angles[axis], truth.rate[axis]);
            }
        } else {
            self.estimator.predict(now, &self.origin, estimates);
        }
    }

    /// Informs the estimator and the monitor of the envelope of the loads that act in the segment that begins at `now`.
    #[inline]
    pub fn begin_segment(&mut self, now: Instant, plant: &Plant, loads: &Loads) {
        if self.has_estimator {
            let (actuator, axes) = (&loads.actuator, self.estimates.len());
            let moment = |axis: usize| if axis < axes { actuator.effort(axis).reduced_moment } else { 0.0 };
            let moments = [loads.first_moment, moment(1), moment(2)];
            self.estimator.input_changed(now, moments);
        }
        if let Some(monitor) = &mut self.monitor {
            let commanded = || loads.actuator_wrench(now);
            plant.update_monitor(monitor, now, loads.applied.constant, &commanded);
        }
    }

    /// Adds the three-axis motion at the start of a cycle to the envelope.
    #[inline]
    pub fn add_cycle(&mut self, now: Instant, plant: &Plant) {
        if let Some(monitor) = &mut self.monitor {
            monitor.observe(now, || plant.modal_state().into_owned());
        }
    }

    /// Closes the envelope's window, if it ends at `now`, and sets the laws' parameter to the value that the adaptation
    /// chose.
    #[inline]
    pub fn close_window(
        &mut self,
        now: Instant,
        plant: &Plant,
        laws: &mut ControlLaws,
    ) -> Option<EnvelopeWindow> {
        let monitor = self.monitor.as_mut().filter(|monitor| monitor.closes == now)?;
        let parameter = monitor.search().map(AdaptationRun::parameter).filter(|(key, _)| *key != "k_t");
        let gain = parameter.map_or_else(|| laws.tuned_value(), |(_, value)| value);
        let closed = monitor.close(now, &plant.modal_state(), gain);
        if let (Some((row, _)), Some(search)) = (&closed.step, monitor.search()) {
            laws.tune(search.parameter().0, row.gain);
        }
        Some(closed)
    }

    /// Returns the adaptation that reads the envelope.
    pub fn search(&self) -> Option<&AdaptationRun> {
        self.monitor.as_ref().and_then(WindowedEnvelope::search)
    }

    /// Returns the filter of a one-axis body, and the mean reduced moment since its last sample (rad/s²).
    pub fn batch_filter(&mut self, now: Instant) -> Option<(&mut KalmanFilter, Option<f64>)> {
        self.estimator.batch()?.batch_filter(now)
    }

    /// Returns the true values of the filter's state components.
    pub fn true_filter_state(&mut self, now: Instant, plant: &Plant) -> Vec<f64> {
        let truth = plant.about_axis(0, &self.origin);
        self.estimator.batch().map_or_else(Vec::new, |filter| filter.true_filter_state(now, &truth))
    }
}
