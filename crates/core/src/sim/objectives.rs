//! Inputs of the meter of an adaptation's objective: motion, torque, control cycles, switchings.

use flexsc_control::adaptation::Objective;
use flexsc_control::estimator::{
    AdaptationRun, EnvelopeWindow, MotionSample, ObjectiveMeter, ObjectiveWindow, WindowedEnvelope,
};
use flexsc_control::law::Phase;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::Instant;
use flexsc_record::{Record, RecordError, Sample};

use super::plant::Plant;
use super::recorder::Recorder;
use super::{Simulation, SimulationError};

impl Simulation {
    /// Declares the tuned parameter to the laws, so that its value is logged from the start on.
    pub(super) fn declare_tuned_parameter(&mut self) {
        let monitored = self.monitor.as_ref().and_then(WindowedEnvelope::search);
        if let Some(search) = monitored.or(self.meter.as_ref().map(ObjectiveMeter::search)) {
            let (key, value) = search.parameter();
            self.controllers.tune(key, value);
        }
    }

    /// Returns the value of the tuned parameter, as the monitor of the envelope logs it.
    pub(super) fn tuned_value(&self) -> f64 {
        let search = self.monitor.as_ref().and_then(WindowedEnvelope::search).map(AdaptationRun::parameter);
        search
            .filter(|(key, _)| *key != "k_t")
            .map_or_else(|| self.controllers.about(0).state().tuned, |(_, value)| value)
    }

    /// Adds the one-axis motion up to `now` to the objective.
    pub(super) fn add_motion(&mut self, now: Instant) {
        let (Some(meter), Plant::OneAxis(plant)) = (&mut self.meter, &self.plant) else { return };
        if !meter.integrates() || now <= meter.measured {
            return;
        }
        let speed = |rate: f64| {
            let rotor = self.loads.actuator.response(now, 0, [rate; 2]).rotor;
            rotor.map(|wheel| wheel.speed_rad_s)
        };
        let wheel = speed(0.0).zip(speed(1.0)).map(|(rest, one)| [rest, one - rest]);
        plant.measure([meter.measured, now], &self.applied, |stretch, rigid| {
            meter.add_piece(stretch, &MotionSample { rigid: *rigid, wheel });
        });
        meter.measured = now;
    }

    /// Adds the torques that act from now on to the objective.
    pub(super) fn add_torque(&mut self) {
        let now = self.now;
        let Some(meter) = &mut self.meter else { return };
        let (actuator, axes) = (&self.loads.actuator, self.estimates.len());
        let applied = || {
            let mut torques = [0.0; 3];
            for (axis, torque) in torques.iter_mut().enumerate().take(axes) {
                *torque = actuator.effort(axis).held;
            }
            torques
        };
        match meter.objective {
            Objective::TorqueMean if axes > 1 => meter.set_value(now, Vector::from(applied()).norm()),
            Objective::Firings => {
                let jets = actuator.capabilities().pulses;
                meter.add_pulses(now, jets.map(|jets| jets.cycle().pulses), applied());
            }
            _ => {}
        }
    }

    /// Adds the three-axis motion at the start of a control cycle to the objective and to the envelope.
    pub(super) fn add_cycle(&mut self) {
        if let (Some(monitor), Plant::ThreeAxis(plant)) = (&mut self.monitor, &self.plant) {
            monitor.observe(self.now, || plant.swings());
        }
        let Some(meter) = &mut self.meter else { return };
        if self.estimates.len() == 1 {
            return;
        }
        let truth = self.plant.truth();
        let error = || truth.orientation.error_from(&self.angle_origin);
        let norm = |v: [f64; 3]| Vector::from(v).norm();
        let value = match meter.objective {
            Objective::PointingErrorMean | Objective::PointingErrorRms | Objective::PointingErrorPeak => {
                norm(error())
            }
            Objective::RateErrorRms => {
                let goal = self.guidance.reference_motion(self.now, &self.estimates);
                let goal = goal.map_or([0.0; 3], |goals| goals.map(|goal| goal.rate));
                norm([0, 1, 2].map(|axis| truth.rate[axis] - goal[axis]))
            }
            Objective::ElasticRms => norm(truth.elastic),
            Objective::WheelPowerMean => {
                let (actuator, now) = (&self.loads.actuator, self.now);
                let all = actuator.capabilities().wheels(now, truth.rate);
                let wheels = all.iter().map(|wheel| wheel.torque_nm * wheel.speed_rad_s);
                let about = |axis: usize| {
                    let rates = [truth.rate[axis], truth.rigid[axis]];
                    let wheel = actuator.response(now, axis, rates).rotor?;
                    Some(actuator.effort(axis).held * wheel.speed_rad_s)
                };
                let alone = if all.is_empty() { 0..3 } else { 0..0 };
                wheels.chain(alone.filter_map(about)).map(f64::abs).sum()
            }
            Objective::EnvelopeMean | Objective::TorqueMean | Objective::Switchings | Objective::Firings => {
                return;
            }
        };
        meter.add_sample(value);
    }

    /// Returns the states of the laws if the objective counts their switchings; otherwise empty.
    pub(super) fn states(&self) -> Vec<Phase> {
        if self.meter.as_ref().is_none_or(|meter| meter.objective != Objective::Switchings) {
            return Vec::new();
        }
        (0..self.estimates.len()).map(|axis| self.controllers.about(axis).state().phase).collect()
    }

    /// Adds the number of laws whose state differs from `before` to the objective.
    pub(super) fn count_switchings(&mut self, before: Vec<Phase>) {
        let Some(meter) = self.meter.as_mut().filter(|_| !before.is_empty()) else { return };
        let switched = before.into_iter().enumerate();
        let count =
            switched.filter(|(axis, before)| self.controllers.about(*axis).state().phase != *before).count();
        meter.switched(self.now, u32::try_from(count).unwrap_or(u32::MAX));
    }

    /// Closes the envelope's window that ends now, and sets the law's parameter to the value that the adaptation chose.
    pub(super) fn close_envelope_window(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.plant.evaluate(self.now)?;
        let gain = self.tuned_value();
        let Some(monitor) = &mut self.monitor else { return Ok(()) };
        let closed = monitor.close(self.now, &self.plant.modal_state(), gain);
        if let (Some((row, _)), Some(search)) = (&closed.step, monitor.search()) {
            self.controllers.tune(search.parameter().0, row.gain);
        }
        Ok(self.recorder.record_window(self.now, &closed, record)?)
    }

    /// Closes the objective's window, if it ends now, and sets the law's parameter to the value that the adaptation
    /// chose.
    pub(super) fn close_objective_window(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        if self.meter.as_ref().is_none_or(|meter| meter.closes != now) {
            return Ok(());
        }
        self.plant.evaluate(now)?;
        self.add_motion(now);
        let Some(meter) = &mut self.meter else { return Ok(()) };
        let measured = meter.close_window(now);
        if let Some((row, _)) = &measured.step {
            self.controllers.tune(meter.search().parameter().0, row.gain);
        }
        Ok(self.recorder.record_objective(now, &measured, record)?)
    }
}

impl Recorder {
    /// Records a closed window of the envelope and the step of the adaptation.
    pub fn record_window(
        &self,
        now: Instant,
        closed: &EnvelopeWindow,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        record.record(now, Sample::Row(&closed.mean))?;
        let Some((row, before)) = &closed.step else { return Ok(()) };
        record.record(now, Sample::Row(row))?;
        self.events.adaptation_step(now, row, *before, record)
    }

    /// Records a closed window of the objective and the step of the adaptation.
    pub fn record_objective(
        &self,
        now: Instant,
        measured: &ObjectiveWindow,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        record.record(now, Sample::Row(&measured.row))?;
        let Some((row, before)) = &measured.step else { return Ok(()) };
        record.record(now, Sample::Row(row))?;
        self.events.adaptation_step(now, row, *before, record)
    }
}
