//! Inputs and outputs of the control system at each of its calls, for replays by flight code.

use flexsc_control::actuator::{MomentumStorage, PulsedActuator};
use flexsc_control::flight_quantity::FlightQuantity;
use flexsc_control::law::AxisDecision;
use flexsc_control::operation::ModeQuantity;
use flexsc_control::sensor::{Orientation, Reading};
use flexsc_control::state_estimate::estimated_rates;
use flexsc_numerics::attitude::{Vector, rotation};
use flexsc_numerics::time::Instant;
use nalgebra::Quaternion;

use super::Simulation;

/// Call of the control system.
#[derive(Clone, Debug)]
pub enum ControlCall {
    /// Sample of the sensors, which the estimator takes.
    Sample(SensorSample),
    /// Test of the conditions of a mode of operation, before the decision of the same instant.
    Mode(ModeTrial),
    /// Decision of the laws, whose commands the actuator takes.
    Decision(ControlDecision),
    /// Cycle of an actuator that unloads wheels, after the decision of the same instant.
    Unloading(UnloadingCall),
}

/// Knowledge of the control system of wheels and control moment gyros.
#[derive(Clone, Debug)]
pub struct KnownRotors {
    /// Speeds of the wheels relative to the body, as available to the drives (rad/s).
    pub wheel_speeds: Vec<f64>,
    /// Estimated rate about each axis (rad/s).
    pub rate: [f64; 3],
    /// Momentum stored in the rotors (N m s).
    pub stored_momentum: [f64; 3],
}

/// Cycle of an actuator that unloads wheels, with what it read.
#[derive(Clone, Debug)]
pub struct UnloadingCall {
    /// Start of the cycle.
    pub now: Instant,
    /// Speeds and momentum of the rotors, as the control system knows them.
    pub rotors: KnownRotors,
    /// Magnetic field in body axes (T), as last measured; `None` without a field.
    pub field: Option<[f64; 3]>,
    /// Torque on the body that the wheels counteract from now on (N m).
    pub counter_torque: [f64; 3],
    /// Torque of the motor of each wheel on its rotor that is commanded from now on (N m).
    pub wheel_torques: Vec<f64>,
}

/// Test of the conditions of a mode of operation, with what the control system knew.
#[derive(Clone, Debug)]
pub struct ModeTrial {
    /// Time of the test.
    pub now: Instant,
    /// Index of the mode after the test.
    pub mode: usize,
    /// Values that conditions of the mode before compare, in the order of the mode tables; NaN of all others.
    pub readings: Vec<f64>,
    /// Knowledge of the control system: the target attitude, and the vectors that conditions read; NaN before a measurement.
    pub known: Vec<(FlightQuantity, Vec<f64>)>,
}

/// Sample of the sensors.
#[derive(Clone, Debug)]
pub struct SensorSample {
    /// Time of the sample.
    pub now: Instant,
    /// Reading of each sensor, in the order of the scenario; `None` of a sensor that is not due or silent.
    pub readings: Vec<Option<Reading>>,
    /// True attitude; `None` of a body with one axis.
    pub attitude: Option<Quaternion<f64>>,
    /// Measured angle (rad) and rate (rad/s) about each axis; `None` without a measurement.
    pub measured: Option<Vec<[f64; 2]>>,
    /// Known inputs about the axes with which filters have predicted the sample: of Kalman filters the mean reduced moments
    /// (rad/s²), of filters of the rigid rate the changes of the rate by pulses (rad/s).
    pub known_inputs: [f64; 3],
    /// Shift of the angles (rad) by a target that began since the last call; `None` without one.
    pub shift: Option<[f64; 3]>,
}

/// Decision of the laws at one instant.
#[derive(Clone, Debug)]
pub struct ControlDecision {
    /// Time of the decision.
    pub now: Instant,
    /// Decisions about the axes whose law has decided.
    pub axes: Vec<AxisDecision>,
    /// Target attitude from which angles are counted.
    pub origin: Orientation,
    /// Speeds and momentum of the rotors, as the control system knows them.
    pub rotors: KnownRotors,
    /// Torque that the actuator is asked for about each axis (N m).
    pub demanded_torque: [f64; 3],
    /// Signed on-times about the axes (s) of jets in groups that fire once in a period of the law; `None` of other actuators.
    pub on_times: Option<[f64; 3]>,
    /// Commanded torque of the motor of each wheel on its rotor, without failures and limits of its momentum (N m); empty without
    /// wheels.
    pub wheel_torques: Vec<f64>,
    /// Shift of the angles (rad) by a target that began since the last call; `None` without one.
    pub shift: Option<[f64; 3]>,
}

impl Simulation {
    /// Begins to record the calls of the control system. The run then does not use the kernel for relays.
    pub fn trace_control(&mut self) {
        self.kernel_setup = None;
        self.laws.begin_trace();
    }

    /// Returns the calls recorded since the last time.
    pub fn take_control_trace(&mut self) -> Vec<ControlCall> {
        self.laws.trace.as_mut().map(std::mem::take).unwrap_or_default()
    }

    /// Records a sample that was just taken.
    pub(super) fn trace_sample(&mut self, now: Instant, is_measured: bool) {
        let shift = self.estimation.last_shift.take();
        let Some(trace) = &mut self.laws.trace else { return };
        let origin = self.estimation.origin();
        let attitude = if let Orientation::Attitude(target) = origin {
            let beyond = |axis: usize| self.plant.about_axis(axis, origin).rigid_angle;
            Some(target * rotation(&Vector::from([0, 1, 2].map(beyond))))
        } else {
            None
        };
        let readings = self.sensors.new_readings.clone();
        let measured = is_measured.then(|| self.sensors.measured.clone());
        let known_inputs = self.estimation.estimator.known_inputs();
        trace.push(ControlCall::Sample(SensorSample {
            now,
            readings,
            attitude,
            measured,
            known_inputs,
            shift,
        }));
    }

    /// Records a test of the mode's conditions with these readings, and the mode after it, before its target is taken.
    pub(super) fn trace_mode(&mut self, now: Instant, mode: usize, readings: Vec<f64>) {
        if self.laws.trace.is_none() {
            return;
        }
        let run = self.read_view();
        let quantities = ModeQuantity::all_vectors().chain([FlightQuantity::TargetAttitude]);
        let known = quantities.map(|quantity| (quantity, run.known(quantity))).collect();
        let trial = ModeTrial { now, mode, readings, known };
        if let Some(trace) = &mut self.laws.trace {
            trace.push(ControlCall::Mode(trial));
        }
    }

    /// Returns what is known of the rotors.
    fn known_rotors(&self, now: Instant) -> KnownRotors {
        let (rigid, estimates) = (self.plant.truth().rigid_rate, &self.estimation.estimates);
        KnownRotors {
            wheel_speeds: self.loads.wheel_speeds(now, rigid),
            rate: estimated_rates(estimates),
            stored_momentum: self.loads.known_momentum(now, rigid, estimates),
        }
    }

    /// Records the decisions that the actuator has just taken.
    pub(super) fn trace_decision(&mut self, now: Instant) {
        let axes = self.laws.take_decisions();
        if axes.is_empty() {
            return;
        }
        let shift = self.estimation.last_shift.take();
        let actuator = &self.loads.actuator;
        let abilities = actuator.capabilities();
        let mut demanded_torque = [0.0; 3];
        for (axis, torque) in demanded_torque.iter_mut().enumerate().take(self.estimation.axis_count()) {
            *torque = actuator.effort(axis).demanded;
        }
        let decision = ControlDecision {
            now,
            axes,
            origin: *self.estimation.origin(),
            rotors: self.known_rotors(now),
            demanded_torque,
            wheel_torques: abilities.momentum.map(MomentumStorage::commanded_torques).unwrap_or_default(),
            on_times: abilities.pulses.and_then(PulsedActuator::commanded_on_times),
            shift,
        };
        if let Some(trace) = &mut self.laws.trace {
            trace.push(ControlCall::Decision(decision));
        }
    }

    /// Records the cycle of an unloading actuator, if one has begun at this instant.
    pub(super) fn trace_unloading(&mut self, now: Instant) {
        if self.laws.trace.is_none() {
            return;
        }
        let abilities = self.loads.actuator.capabilities();
        let Some(cycle) = abilities.unloading.filter(|cycle| cycle.at == Some(now)) else { return };
        let call = UnloadingCall {
            now,
            rotors: self.known_rotors(now),
            field: self.sensors.magnetic_field(self.plant.truth()).map(Into::into),
            counter_torque: cycle.counter.into(),
            wheel_torques: abilities.momentum.map(MomentumStorage::commanded_torques).unwrap_or_default(),
        };
        if let Some(trace) = &mut self.laws.trace {
            trace.push(ControlCall::Unloading(call));
        }
    }
}
