//! Laws that decide at their period: estimates and references in, torques about the axes and of wheels out.

use flexsc_core::Scenario;
use flexsc_core::control::flight_quantity::FlightQuantity;
use flexsc_core::control::law::LawKind;
use flexsc_core::numerics::flight_types::to_matrix3;
use flexsc_core::numerics::time::Span;
use flexsc_flight::active_damping::ElasticRateEstimate;
use flexsc_flight::axis_motion::{AxisMotion, AxisReference, total_angle};
use flexsc_flight::compensator::CompensatorQuantity;
use flexsc_flight::matrix3::Matrix3;
use flexsc_flight::phase_plane::PhasePlaneLaw;
use flexsc_flight::ticks::Ticks;
use flexsc_flight::torque_distribution;
use flexsc_flight::vector3::Vector3;

use super::actuation::Actuation;
use super::attitude_unit::{AttitudeUnit, quaternion};
use super::kalman_unit::KalmanUnit;
use super::laws_of_axes::{LawsOfAxes, compensator_commands, laws_of_axes};
use super::rate_unit::RateUnit;
use super::{CallLayout, Channel, NotExportable, NumberKind, StoredMomentum, WordReader};

/// Laws of a scenario that decide at their period.
#[derive(Clone, Debug)]
pub struct SampledLaws {
    /// Period (s).
    pub period: f64,
    /// Laws about the axes.
    pub laws: LawsOfAxes,
    /// Inertia tensor by which commanded accelerations become torques (kg m²).
    pub inertia: Matrix3,
    /// Momentum stored in the rotors.
    pub stored: StoredMomentum,
    /// Actuators that give the commands.
    pub actuation: Actuation,
    /// Attitude filter that the laws read; without one the estimates are inputs.
    pub estimator: Option<AttitudeUnit>,
    /// Kalman filters that the laws read; without them and an attitude filter the estimates are inputs.
    pub filter: Option<KalmanUnit>,
    /// Filters of the rigid rates that the laws read.
    pub rate_filter: Option<RateUnit>,
}

impl SampledLaws {
    /// Returns the laws of a scenario.
    pub(super) fn new(scenario: &Scenario, laws: &[&LawKind]) -> Result<Self, NotExportable> {
        let authorities = &scenario.study.authorities;
        let of_axes = laws_of_axes(laws, authorities, scenario)?;
        let periods: Vec<Span> = laws.iter().filter_map(|law| law.period()).collect();
        let Some(cycle) = periods.first().copied() else {
            return Err(NotExportable::new("law", "has no period"));
        };
        if periods.iter().any(|other| *other != cycle) {
            let reason = "has laws with different periods: give them one period";
            return Err(NotExportable::new("law.per_axis", reason));
        }
        let inertia = to_matrix3(scenario.study.distribution(scenario).inertia());
        let estimator = AttitudeUnit::new(scenario).filter(|_| laws.len() == 3);
        let (actuation, rate_filter) = (Actuation::new(scenario), RateUnit::new(scenario, laws.len()));
        let (period, stored) = (cycle.seconds(), StoredMomentum::new(scenario));
        let mut laws =
            Self { period, laws: of_axes, inertia, stored, actuation, estimator, filter: None, rate_filter };
        laws.filter = KalmanUnit::new(scenario, laws.reads_mode());
        Ok(laws)
    }

    /// Removes the estimator, the on-times of jets and the unloading of wheels: the laws read estimates, and only command.
    pub(super) fn read_estimates(&mut self) {
        (self.estimator, self.filter, self.rate_filter) = (None, None, None);
        self.actuation.keep_wheels();
    }

    /// Removes the actuators, which serve the laws of all modes.
    pub(super) fn only_command(&mut self) {
        self.actuation = Actuation::default();
    }

    /// Returns the number of axes.
    pub fn axis_count(&self) -> usize {
        match &self.laws {
            LawsOfAxes::Pd(laws) => laws.len(),
            LawsOfAxes::PhasePlane(laws, _) => laws.len(),
            LawsOfAxes::Attitude(laws) => laws.len(),
            LawsOfAxes::StateSpace(laws) => {
                laws.first().map_or(0, |law| if law.sources.is_empty() { laws.len() } else { 3 })
            }
        }
    }

    /// Returns true if the laws command accelerations.
    pub fn is_acceleration(&self) -> bool {
        match &self.laws {
            LawsOfAxes::Attitude(_) => true,
            LawsOfAxes::StateSpace(laws) => laws.iter().any(|law| law.is_acceleration),
            LawsOfAxes::Pd(_) | LawsOfAxes::PhasePlane(..) => false,
        }
    }

    /// Returns true if one compensator acts about three axes together.
    pub fn is_together(&self) -> bool {
        matches!(&self.laws, LawsOfAxes::StateSpace(laws) if laws.iter().any(|law| !law.sources.is_empty()))
    }

    /// Returns the number of wheels whose speeds are inputs: of accelerations for their momentum, and as a compensator reads them.
    pub fn speed_count(&self) -> usize {
        let stored = if self.is_acceleration() { self.stored.wheel_count() } else { 0 };
        let LawsOfAxes::StateSpace(laws) = &self.laws else { return stored };
        let sources = laws.iter().flat_map(|law| &law.sources);
        let speeds = sources.filter(|source| source.quantity == CompensatorQuantity::WheelSpeed);
        speeds.map(|source| source.index + 1).fold(stored, usize::max)
    }

    /// Returns true if the extra loop on the dominant mode acts about any axis.
    pub fn reads_mode(&self) -> bool {
        matches!(&self.laws, LawsOfAxes::Pd(laws) if laws.iter().any(|(_, schedule)| !schedule.is_empty()))
    }

    /// Returns the number of modes that active damping reads about an axis; 0 without active damping.
    pub fn mode_count(&self) -> usize {
        if let LawsOfAxes::PhasePlane(_, modes) = &self.laws { *modes } else { 0 }
    }

    /// Returns the functions.
    pub(super) fn calls(&self) -> Vec<CallLayout> {
        let estimator = self.estimator.iter().flat_map(AttitudeUnit::calls);
        let filter = self.filter.iter().flat_map(KalmanUnit::calls);
        let rates = self.rate_filter.iter().map(RateUnit::layout);
        let unload = self.actuation.unload_layout(&self.stored, self.estimator.is_some());
        estimator.chain(filter).chain(rates).chain(unload).chain([self.layout()]).collect()
    }

    /// Returns the number of functions of estimators, which come first.
    pub fn estimator_calls(&self) -> usize {
        let filter = self.filter.as_ref().map_or(0, KalmanUnit::call_count);
        if self.estimator.is_some() { 2 } else { filter + usize::from(self.rate_filter.is_some()) }
    }

    /// Returns the index of the step, which is the last of the functions.
    pub fn step_index(&self) -> usize {
        self.estimator_calls() + usize::from(self.actuation.unloading.is_some())
    }

    /// Calls the function with this index, and returns the words of its outputs.
    pub(super) fn call(&mut self, call: usize, now: Ticks, inputs: &[u64]) -> Vec<u64> {
        let (estimators, step) = (self.estimator_calls(), self.step_index());
        if (estimators..step).contains(&call) {
            let rate = self.estimator.as_ref().map(|unit| unit.estimator.rate(&unit.entries));
            return self.actuation.unload(inputs, &self.stored, rate, None);
        }
        if let Some(filter) = self.filter.as_mut().filter(|_| call < step) {
            return filter.call(call, inputs);
        }
        if let Some(filter) = self.rate_filter.as_mut().filter(|_| call < step) {
            return filter.sample(inputs);
        }
        match (&mut self.estimator, call) {
            (Some(estimator), 0) => estimator.start(now, inputs),
            (Some(estimator), 1) => estimator.sample(now, inputs),
            _ => self.step(now, inputs),
        }
    }

    /// Returns the inputs and outputs of a step.
    pub fn layout(&self) -> CallLayout {
        let axes = self.axis_count();
        let mut inputs = if self.estimator.is_some() {
            vec![Channel::from_quantity(FlightQuantity::TargetAttitude, 4, 1.0)]
        } else if self.filter.is_some() {
            Vec::new()
        } else {
            let rate = Some(Channel::from_quantity(FlightQuantity::Rate, axes, 1e-3));
            let rate = rate.filter(|_| self.rate_filter.is_none());
            [Channel::from_quantity(FlightQuantity::Angle, axes, 1e-2)].into_iter().chain(rate).collect()
        };
        if self.reads_mode() && self.filter.is_none() {
            inputs.push(Channel::from_quantity(FlightQuantity::Displacement, axes, 1e-3));
            inputs.push(Channel::from_quantity(FlightQuantity::DisplacementRate, axes, 1e-3));
            inputs.push(Channel::from_quantity(FlightQuantity::Frequency, axes, 2.0));
        }
        if matches!(self.laws, LawsOfAxes::PhasePlane(..)) {
            inputs.push(Channel::from_quantity(FlightQuantity::QueuedRate, axes, 1e-5));
        }
        let modes = self.mode_count();
        if modes > 0 {
            let all = axes * modes;
            inputs.push(Channel::from_quantity(FlightQuantity::ElasticRate, all, 1e-4));
            inputs.push(Channel::from_quantity(FlightQuantity::ElasticFrequency, all, 2.0));
            inputs.push(Channel::from_quantity(FlightQuantity::ElasticInfluence, all, 1.0));
            let trust = Channel::from_quantity(FlightQuantity::ElasticTrust, axes, 1.0);
            inputs.push(Channel { kind: NumberKind::Flag, ..trust });
        }
        inputs.push(Channel::from_quantity(FlightQuantity::ReferenceAngle, axes, 1e-2));
        inputs.push(Channel::from_quantity(FlightQuantity::ReferenceRate, axes, 1e-3));
        let mut outputs = Vec::new();
        if matches!(self.laws, LawsOfAxes::PhasePlane(..)) {
            let about = "Change of the rate by pulses about each axis (rad/s)";
            outputs.push(Channel::real("rate_change", about, axes, 1.0));
        }
        if self.is_acceleration() {
            inputs.push(Channel::from_quantity(FlightQuantity::ReferenceAcceleration, axes, 1e-4));
            inputs.extend(self.stored.channel(1.0).filter(|_| self.stored == StoredMomentum::Input));
            let about = "Acceleration about each axis (rad/s\u{b2})";
            outputs.push(Channel::real("acceleration", about, axes, 1.0));
        }
        if self.speed_count() > 0 {
            inputs.push(Channel::from_quantity(FlightQuantity::WheelSpeed, self.speed_count(), 100.0));
        }
        if !matches!(self.laws, LawsOfAxes::PhasePlane(..)) {
            outputs.push(Channel::from_quantity(FlightQuantity::Torque, axes, 1.0));
        }
        outputs.extend(self.actuation.channels());
        let about = "Decides on the commands of a period.";
        CallLayout { inputs, outputs, ..CallLayout::new("step", about) }
    }

    /// Reads the estimated motion about each axis from the estimator or from the inputs.
    fn motions(&self, now: Ticks, words: &mut WordReader<'_>) -> Vec<AxisMotion> {
        let (axes, reads_mode) = (self.axis_count(), self.reads_mode());
        let mut motions = vec![AxisMotion::default(); axes];
        let set = |values: Vec<f64>, motions: &mut [AxisMotion], member: fn(&mut AxisMotion) -> &mut f64| {
            motions.iter_mut().zip(values).for_each(|(motion, value)| *member(motion) = value);
        };
        if let Some(unit) = &self.estimator {
            let target = quaternion(words);
            let angle = target.rotation_to(&unit.estimator.attitude(now, &unit.entries));
            let rate = unit.estimator.rate(&unit.entries);
            set(vec![angle.x, angle.y, angle.z], &mut motions, |motion| &mut motion.angle);
            set(vec![rate.x, rate.y, rate.z], &mut motions, |motion| &mut motion.rate);
        } else if let Some(unit) = &self.filter {
            for (motion, axis) in motions.iter_mut().zip(&unit.axes) {
                (motion.angle, motion.rate) = (axis.estimate.angle, axis.estimate.rate);
                if reads_mode {
                    let estimate = &axis.estimate;
                    (motion.displacement, motion.displacement_rate) =
                        (estimate.displacement, estimate.displacement_rate);
                    motion.frequency = axis.frequency;
                }
            }
        } else {
            set(words.list(axes), &mut motions, |motion| &mut motion.angle);
            let rates = match &self.rate_filter {
                Some(unit) => unit.axes.iter().map(|filter| filter.rate).collect(),
                None => words.list(axes),
            };
            set(rates, &mut motions, |motion| &mut motion.rate);
        }
        if let [roll, pitch, yaw] = &motions[..] {
            let total = total_angle(roll.angle, pitch.angle, yaw.angle);
            for motion in &mut motions {
                motion.total_angle = total;
            }
        }
        if reads_mode && self.filter.is_none() {
            set(words.list(axes), &mut motions, |motion| &mut motion.displacement);
            set(words.list(axes), &mut motions, |motion| &mut motion.displacement_rate);
            set(words.list(axes), &mut motions, |motion| &mut motion.frequency);
        }
        if matches!(self.laws, LawsOfAxes::PhasePlane(..)) {
            set(words.list(axes), &mut motions, |motion| &mut motion.queued_rate);
        }
        motions
    }

    /// Decides on the commands of a period, and returns the words of the outputs.
    fn step(&mut self, now: Ticks, inputs: &[u64]) -> Vec<u64> {
        let (axes, modes) = (self.axis_count(), self.mode_count());
        let mut words = WordReader::new(inputs);
        let motions = self.motions(now, &mut words);
        let elastic = (words.list(axes * modes), words.list(axes * modes), words.list(axes * modes));
        let trusted: Vec<bool> = (0..if modes > 0 { axes } else { 0 }).map(|_| words.flag()).collect();
        let mut references = vec![AxisReference::default(); axes];
        let mut set = |values: Vec<f64>, member: fn(&mut AxisReference) -> &mut f64| {
            references.iter_mut().zip(values).for_each(|(reference, value)| *member(reference) = value);
        };
        set(words.list(axes), |reference| &mut reference.angle);
        set(words.list(axes), |reference| &mut reference.rate);
        let mut given = Vec::new();
        if self.is_acceleration() {
            set(words.list(axes), |reference| &mut reference.acceleration);
            given = words.list(if self.stored == StoredMomentum::Input { 3 } else { 0 });
        }
        let speeds = words.list(self.speed_count());
        let commands: Vec<f64> = match &mut self.laws {
            LawsOfAxes::Pd(laws) => {
                let laws = laws.iter_mut().zip(&motions).zip(&references);
                laws.map(|(((law, schedule), motion), reference)| law.step(motion, reference, schedule))
                    .collect()
            }
            LawsOfAxes::PhasePlane(laws, _) => {
                let about = |(axis, law): (usize, &mut PhasePlaneLaw)| {
                    let mode = |mode: usize| {
                        let index = axis * modes + mode;
                        let (rate, frequency, influence) =
                            (elastic.0[index], elastic.1[index], elastic.2[index]);
                        ElasticRateEstimate { rate, frequency, influence }
                    };
                    let own: Vec<ElasticRateEstimate> = (0..modes).map(mode).collect();
                    let is_trusted = trusted.get(axis).copied().unwrap_or(false);
                    law.step(&motions[axis], &references[axis], &own, is_trusted)
                };
                laws.iter_mut().enumerate().map(about).collect()
            }
            LawsOfAxes::Attitude(laws) => {
                let laws = laws.iter_mut().zip(&motions).zip(&references);
                laws.map(|(((law, filters), motion), reference)| law.step(motion, reference, filters))
                    .collect()
            }
            LawsOfAxes::StateSpace(laws) => compensator_commands(laws, &motions, &references, &speeds),
        };
        let mut outputs = commands.clone();
        let mut torque = commands;
        if self.is_acceleration() {
            let vector = |component: &dyn Fn(usize) -> f64| {
                let [x, y, z] = [0, 1, 2].map(|axis| if axis < axes { component(axis) } else { 0.0 });
                Vector3 { x, y, z }
            };
            let (acceleration, rate) = (vector(&|axis| torque[axis]), vector(&|axis| motions[axis].rate));
            let stored = self.stored.momentum(if given.is_empty() { &speeds } else { &given }, &rate);
            let of_axes = torque_distribution::torque(&self.inertia, &acceleration, &rate, &stored);
            torque = [of_axes.x, of_axes.y, of_axes.z][..axes].to_vec();
            outputs.extend_from_slice(&torque);
        }
        let mut outputs: Vec<u64> = outputs.into_iter().map(f64::to_bits).collect();
        if let [x, y, z] = torque[..] {
            outputs.extend(self.actuation.drive(Vector3 { x, y, z }));
        }
        outputs.extend(self.actuation.on_times(&torque, self.commands_changes()));
        outputs
    }

    /// Returns true if the laws command changes of the rate by pulses.
    pub fn commands_changes(&self) -> bool {
        matches!(self.laws, LawsOfAxes::PhasePlane(..))
    }
}
