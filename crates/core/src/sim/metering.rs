//! Inputs of the meter of an adaptation's objective: motion, torque, control cycles, switchings.

use super::plant::Plant;
use super::telling::Telling;
use super::{Simulation, SimulationError};
use crate::adaptation::Objective;
use crate::attitude::Vector;
use crate::estimator::{Beside, Meter, Monitor, Searching, WindowEnd, WindowMeans};
use crate::law::Phase;
use crate::record::{Record, RecordError, Sample};
use crate::time::Instant;

impl Simulation {
    /// Declares the tuned parameter to the laws, so that its value is logged from the start on.
    pub(super) fn name_tuned(&mut self) {
        let monitored = self.monitor.as_ref().and_then(Monitor::search);
        if let Some(search) = monitored.or(self.meter.as_ref().map(Meter::search)) {
            let (key, value) = search.tunes();
            self.laws.tune(key, value);
        }
    }

    /// Returns the value of the tuned parameter, as the monitor of the envelope logs it.
    pub(super) fn tuned(&self) -> f64 {
        let search = self.monitor.as_ref().and_then(Monitor::search).map(Searching::tunes);
        search.filter(|(key, _)| *key != "k_t").map_or_else(|| self.laws.about(0).tuned(), |(_, value)| value)
    }

    /// Adds the one-axis motion up to `now` to the objective.
    pub(super) fn measure_course(&mut self, now: Instant) {
        let (Some(meter), Plant::Planar(plant)) = (&mut self.meter, &self.plant) else { return };
        if !meter.integrates() || now <= meter.measured {
            return;
        }
        let speed = |rate: f64| self.drive.actuator.wheel(0, rate).map(|wheel| wheel.speed_rad_s);
        let wheel = speed(0.0).zip(speed(1.0)).map(|(rest, one)| [rest, one - rest]);
        plant.measure([meter.measured, now], &self.exerted, |stretch, rigid| {
            meter.stretch(stretch, &Beside { rigid: *rigid, wheel });
        });
        meter.measured = now;
    }

    /// Adds the torques that act from now on to the objective.
    pub(super) fn measure_torque(&mut self) {
        let now = self.now;
        let Some(meter) = &mut self.meter else { return };
        let (actuator, axes) = (&self.drive.actuator, self.beliefs.len());
        let applied = || {
            let mut torques = [0.0; 3];
            for (axis, torque) in torques.iter_mut().enumerate().take(axes) {
                *torque = actuator.torque(axis);
            }
            torques
        };
        match meter.objective {
            Objective::TorqueMean if axes > 1 => meter.hold(now, Vector::from(applied()).norm()),
            Objective::Firings => meter.fired(now, actuator.cycle().map(|cycle| cycle.pulses), applied()),
            _ => {}
        }
    }

    /// Adds the three-axis motion at the start of a control cycle to the objective and to the envelope.
    pub(super) fn measure_cycle(&mut self) {
        if let (Some(monitor), Plant::Spatial(plant)) = (&mut self.monitor, &self.plant) {
            monitor.see(self.now, || plant.swings());
        }
        let Some(meter) = &mut self.meter else { return };
        if self.beliefs.len() == 1 {
            return;
        }
        let truth = self.plant.viewed();
        let error = || truth.orientation.beyond(&self.origin);
        let norm = |v: [f64; 3]| Vector::from(v).norm();
        let value = match meter.objective {
            Objective::PointingErrorMean | Objective::PointingErrorRms | Objective::PointingErrorPeak => {
                norm(error())
            }
            Objective::RateErrorRms => {
                let goal = self.reference.led(self.now, &self.beliefs);
                let goal = goal.map_or([0.0; 3], |goals| goals.map(|goal| goal.rate));
                norm([0, 1, 2].map(|axis| truth.rate[axis] - goal[axis]))
            }
            Objective::ElasticRms => norm(truth.elastic),
            Objective::WheelPowerMean => {
                let (actuator, now) = (&self.drive.actuator, self.now);
                let all = actuator.wheels(now, truth.rate);
                let wheels = all.iter().map(|wheel| wheel.torque_nm * wheel.speed_rad_s);
                let about = |axis: usize| {
                    let wheel = actuator.wheel(axis, truth.rigid[axis])?;
                    Some(actuator.torque(axis) * wheel.speed_rad_s)
                };
                let alone = if all.is_empty() { 0..3 } else { 0..0 };
                wheels.chain(alone.filter_map(about)).map(f64::abs).sum()
            }
            Objective::EnvelopeMean | Objective::TorqueMean | Objective::Switchings | Objective::Firings => {
                return;
            }
        };
        meter.sample(value);
    }

    /// Returns the states of the laws if the objective counts their switchings; otherwise empty.
    pub(super) fn states(&self) -> Vec<Phase> {
        if self.meter.as_ref().is_none_or(|meter| meter.objective != Objective::Switchings) {
            return Vec::new();
        }
        (0..self.beliefs.len()).map(|axis| self.laws.about(axis).state()).collect()
    }

    /// Adds the number of laws whose state differs from `before` to the objective.
    pub(super) fn count_switchings(&mut self, before: Vec<Phase>) {
        let Some(meter) = self.meter.as_mut().filter(|_| !before.is_empty()) else { return };
        let switched = before.into_iter().enumerate();
        let count = switched.filter(|(axis, before)| self.laws.about(*axis).state() != *before).count();
        meter.switched(self.now, u32::try_from(count).unwrap_or(u32::MAX));
    }

    /// Closes the envelope's window that ends now, and sets the law's parameter to the value that the adaptation chose.
    pub(super) fn close_window(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.plant.view(self.now)?;
        let gain = self.tuned();
        let Some(monitor) = &mut self.monitor else { return Ok(()) };
        let closed = monitor.close(self.now, &self.plant.swings(), gain);
        if let (Some((row, _)), Some(search)) = (&closed.step, monitor.search()) {
            self.laws.tune(search.tunes().0, row.gain);
        }
        Ok(self.telling.window(self.now, &closed, record)?)
    }

    /// Closes the objective's window, if it ends now, and sets the law's parameter to the value that the adaptation
    /// chose.
    pub(super) fn close_objective(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        if self.meter.as_ref().is_none_or(|meter| meter.closes != now) {
            return Ok(());
        }
        self.plant.view(now)?;
        self.measure_course(now);
        let Some(meter) = &mut self.meter else { return Ok(()) };
        let measured = meter.close(now);
        if let Some((row, _)) = &measured.step {
            self.laws.tune(meter.search().tunes().0, row.gain);
        }
        Ok(self.telling.objective(now, &measured, record)?)
    }
}

impl Telling {
    /// Records a closed window of the envelope and the step of the adaptation.
    pub fn window(
        &self,
        now: Instant,
        closed: &WindowEnd,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        record.record(now, Sample::Window(&closed.mean))?;
        let Some((row, before)) = &closed.step else { return Ok(()) };
        record.record(now, Sample::Adaptation(row))?;
        self.events.adapted(now, row, *before, record)
    }

    /// Records a closed window of the objective and the step of the adaptation.
    pub fn objective(
        &self,
        now: Instant,
        measured: &WindowMeans,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        record.record(now, Sample::Objective(&measured.row))?;
        let Some((row, before)) = &measured.step else { return Ok(()) };
        record.record(now, Sample::Adaptation(row))?;
        self.events.adapted(now, row, *before, record)
    }
}
