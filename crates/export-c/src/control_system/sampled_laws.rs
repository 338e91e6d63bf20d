//! Laws that decide at their period: estimates and references in, torques about the axes and of wheels out.

use flexsc_core::Scenario;
use flexsc_core::control::actuator::ActuatorKind;
use flexsc_core::control::law::{Authority, LawKind};
use flexsc_core::numerics::flight_types::to_matrix3;
use flexsc_core::numerics::quantity::Positive;
use flexsc_core::numerics::time::Span;
use flexsc_flight::active_damping::ElasticRateEstimate;
use flexsc_flight::attitude_law::AttitudeFeedback;
use flexsc_flight::axis_motion::{AxisMotion, AxisReference, total_angle};
use flexsc_flight::biquad::BiquadFilter;
use flexsc_flight::gain_schedule::SchedulePoint;
use flexsc_flight::matrix3::Matrix3;
use flexsc_flight::pd::PdLaw;
use flexsc_flight::phase_plane::PhasePlaneLaw;
use flexsc_flight::ticks::Ticks;
use flexsc_flight::torque_distribution;
use flexsc_flight::vector3::Vector3;
use flexsc_flight::wheel_allocation::{AllocatedWheel, allocate, limit_torques};

use super::attitude_unit::{AttitudeUnit, quaternion};
use super::{CallLayout, Channel, NotExportable, WordReader, all_of_kind};

/// Laws about the axes, all of one kind.
#[derive(Clone, Debug)]
pub enum LawsOfAxes {
    /// PD laws, each with the points of the gain of its extra loop.
    Pd(Vec<(PdLaw, Vec<SchedulePoint>)>),
    /// Phase-plane laws, and the largest number of modes that active damping reads about an axis.
    PhasePlane(Vec<PhasePlaneLaw>, usize),
    /// Attitude laws, each with its filters.
    Attitude(Vec<(AttitudeFeedback, Vec<BiquadFilter>)>),
}

/// WheelDistribution of torques to reaction wheels.
#[derive(Clone, Debug)]
pub struct WheelDistribution {
    /// Wheels.
    pub wheels: Vec<AllocatedWheel>,
    /// Largest torque of a wheel (N m).
    pub limit: f64,
    /// True if the largest torque is minimised.
    pub is_least_largest: bool,
}

/// Laws of a scenario that decide at their period.
#[derive(Clone, Debug)]
pub struct SampledLaws {
    /// Period (s).
    pub period: f64,
    /// Laws about the axes.
    pub laws: LawsOfAxes,
    /// Inertia tensor by which commanded accelerations become torques (kg m²).
    pub inertia: Matrix3,
    /// Wheels that give the torque about three axes, if the actuator consists of them.
    pub wheels: Option<WheelDistribution>,
    /// Attitude filter that the laws read; without one the estimates are inputs.
    pub estimator: Option<AttitudeUnit>,
}

impl SampledLaws {
    /// Returns the laws of a scenario.
    pub(super) fn new(scenario: &Scenario, laws: &[&LawKind]) -> Result<Self, NotExportable> {
        let authorities = &scenario.study.authorities;
        let of_axes = laws_of_axes(laws, authorities, scenario)?;
        let periods: Vec<f64> = laws.iter().filter_map(|law| law.period()).map(Span::seconds).collect();
        let Some(period) = periods.first().copied() else {
            return Err(NotExportable::new("law", "has no period"));
        };
        if periods.iter().any(|other| *other != period) {
            let reason = "has laws with different periods: give them one period";
            return Err(NotExportable::new("law.per_axis", reason));
        }
        let inertia = to_matrix3(scenario.study.distribution(scenario).inertia());
        let estimator = AttitudeUnit::new(scenario).filter(|_| laws.len() == 3);
        Ok(Self { period, laws: of_axes, inertia, wheels: wheels(scenario), estimator })
    }

    /// Returns the number of axes.
    pub fn axis_count(&self) -> usize {
        match &self.laws {
            LawsOfAxes::Pd(laws) => laws.len(),
            LawsOfAxes::PhasePlane(laws, _) => laws.len(),
            LawsOfAxes::Attitude(laws) => laws.len(),
        }
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
        estimator.chain([self.layout()]).collect()
    }

    /// Returns the index of the step among the functions.
    pub fn step_index(&self) -> usize {
        if self.estimator.is_some() { 2 } else { 0 }
    }

    /// Calls the function with this index, and returns the words of its outputs.
    pub(super) fn call(&mut self, call: usize, now: Ticks, inputs: &[u64]) -> Vec<u64> {
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
            vec![Channel::real("target_attitude", "Target attitude: quaternion w, x, y, z", 4, 1.0)]
        } else {
            vec![
                Channel::real("angle", "Estimated angle from the target about each axis (rad)", axes, 1e-2),
                Channel::real("rate", "Estimated rate about each axis (rad/s)", axes, 1e-3),
            ]
        };
        if self.reads_mode() {
            inputs.push(Channel::real("displacement", "Displacement of the dominant mode (rad)", axes, 1e-3));
            inputs.push(Channel::real("displacement_rate", "Rate of the displacement (rad/s)", axes, 1e-3));
            inputs.push(Channel::real("frequency", "Frequency of the dominant mode (rad/s)", axes, 2.0));
        }
        if matches!(self.laws, LawsOfAxes::PhasePlane(..)) {
            let about = "Commanded change of the rate that is not yet executed (rad/s)";
            inputs.push(Channel::real("queued_rate", about, axes, 1e-5));
        }
        let modes = self.mode_count();
        if modes > 0 {
            let all = axes * modes;
            inputs.push(Channel::real(
                "mode_rate",
                "Elastic rate of each mode about each axis (rad/s)",
                all,
                1e-4,
            ));
            inputs.push(Channel::real("mode_frequency", "Frequency of each mode (rad/s)", all, 2.0));
            let about = "Jump of the elastic rate per unit jump of the rigid rate; 0 for no mode";
            inputs.push(Channel::real("mode_influence", about, all, 1.0));
            inputs.push(Channel::flag("modes_are_trusted", "True if the law may act on the modes", axes));
        }
        inputs.push(Channel::real("reference_angle", "Reference: angle from the target (rad)", axes, 1e-2));
        inputs.push(Channel::real("reference_rate", "Reference: rate (rad/s)", axes, 1e-3));
        let mut outputs = Vec::new();
        match &self.laws {
            LawsOfAxes::Pd(_) => {}
            LawsOfAxes::PhasePlane(..) => {
                outputs.push(Channel::real(
                    "rate_change",
                    "Change of the rate by pulses about each axis (rad/s)",
                    axes,
                    1.0,
                ));
            }
            LawsOfAxes::Attitude(_) => {
                let about = "Reference: acceleration (rad/s\u{b2})";
                inputs.push(Channel::real("reference_acceleration", about, axes, 1e-4));
                let about = "Momentum stored in the rotors, body axes (N m s)";
                inputs.push(Channel::real("stored_momentum", about, 3, 1.0));
                outputs.push(Channel::real(
                    "acceleration",
                    "Acceleration about each axis (rad/s\u{b2})",
                    axes,
                    1.0,
                ));
            }
        }
        if !matches!(self.laws, LawsOfAxes::PhasePlane(..)) {
            outputs.push(Channel::real("torque", "Torque about each axis (N m)", axes, 1.0));
        }
        if let Some(wheels) = &self.wheels {
            let about = "Torque of the motor of each wheel on its rotor (N m)";
            outputs.push(Channel::real("wheel_torque", about, wheels.wheels.len(), 1.0));
        }
        let about = "Decides on the commands of a period.";
        CallLayout { name: "step", about, is_start: false, inputs, outputs }
    }

    /// Decides on the commands of a period, and returns the words of the outputs.
    fn step(&mut self, now: Ticks, inputs: &[u64]) -> Vec<u64> {
        let axes = self.axis_count();
        let mut words = WordReader::new(inputs);
        let (reads_mode, modes) = (self.reads_mode(), self.mode_count());
        let mut motions = vec![AxisMotion::default(); axes];
        let set = |values: Vec<f64>, motions: &mut [AxisMotion], member: fn(&mut AxisMotion) -> &mut f64| {
            motions.iter_mut().zip(values).for_each(|(motion, value)| *member(motion) = value);
        };
        if let Some(unit) = &self.estimator {
            let target = quaternion(&mut words);
            let angle = target.rotation_to(&unit.estimator.attitude(now, &unit.entries));
            let rate = unit.estimator.rate(&unit.entries);
            set(vec![angle.x, angle.y, angle.z], &mut motions, |motion| &mut motion.angle);
            set(vec![rate.x, rate.y, rate.z], &mut motions, |motion| &mut motion.rate);
        } else {
            set(words.list(axes), &mut motions, |motion| &mut motion.angle);
            set(words.list(axes), &mut motions, |motion| &mut motion.rate);
        }
        if let [roll, pitch, yaw] = &motions[..] {
            let total = total_angle(roll.angle, pitch.angle, yaw.angle);
            for motion in &mut motions {
                motion.total_angle = total;
            }
        }
        if reads_mode {
            set(words.list(axes), &mut motions, |motion| &mut motion.displacement);
            set(words.list(axes), &mut motions, |motion| &mut motion.displacement_rate);
            set(words.list(axes), &mut motions, |motion| &mut motion.frequency);
        }
        if matches!(self.laws, LawsOfAxes::PhasePlane(..)) {
            set(words.list(axes), &mut motions, |motion| &mut motion.queued_rate);
        }
        let elastic = (words.list(axes * modes), words.list(axes * modes), words.list(axes * modes));
        let trusted: Vec<bool> = (0..if modes > 0 { axes } else { 0 }).map(|_| words.flag()).collect();
        let mut references = vec![AxisReference::default(); axes];
        let mut set = |values: Vec<f64>, member: fn(&mut AxisReference) -> &mut f64| {
            references.iter_mut().zip(values).for_each(|(reference, value)| *member(reference) = value);
        };
        set(words.list(axes), |reference| &mut reference.angle);
        set(words.list(axes), |reference| &mut reference.rate);
        let mut outputs = Vec::new();
        let torque = match &mut self.laws {
            LawsOfAxes::Pd(laws) => {
                let laws = laws.iter_mut().zip(&motions).zip(&references);
                laws.map(|(((law, schedule), motion), reference)| law.step(motion, reference, schedule))
                    .collect()
            }
            LawsOfAxes::PhasePlane(laws, _) => {
                for (axis, law) in laws.iter_mut().enumerate() {
                    let mode = |mode: usize| {
                        let index = axis * modes + mode;
                        let (rate, frequency, influence) =
                            (elastic.0[index], elastic.1[index], elastic.2[index]);
                        ElasticRateEstimate { rate, frequency, influence }
                    };
                    let own: Vec<ElasticRateEstimate> = (0..modes).map(mode).collect();
                    let is_trusted = trusted.get(axis).copied().unwrap_or(false);
                    outputs.push(law.step(&motions[axis], &references[axis], &own, is_trusted));
                }
                Vec::new()
            }
            LawsOfAxes::Attitude(laws) => {
                set(words.list(axes), |reference| &mut reference.acceleration);
                let [x, y, z] = words.reals();
                let stored = Vector3 { x, y, z };
                let (mut acceleration, mut rate) = ([0.0; 3], [0.0; 3]);
                for (axis, (law, filters)) in laws.iter_mut().enumerate() {
                    acceleration[axis] = law.step(&motions[axis], &references[axis], filters);
                    rate[axis] = motions[axis].rate;
                }
                outputs.extend_from_slice(&acceleration[..axes]);
                let [acceleration, rate] = [acceleration, rate].map(|[x, y, z]| Vector3 { x, y, z });
                let torque = torque_distribution::torque(&self.inertia, &acceleration, &rate, &stored);
                [torque.x, torque.y, torque.z][..axes].to_vec()
            }
        };
        outputs.extend_from_slice(&torque);
        if let (Some(own), [x, y, z]) = (&mut self.wheels, &torque[..]) {
            let demanded = Vector3::ZERO.minus(&Vector3 { x: *x, y: *y, z: *z });
            allocate(&mut own.wheels, &demanded, own.is_least_largest);
            limit_torques(&mut own.wheels, own.limit);
            outputs.extend(own.wheels.iter().map(|wheel| wheel.torque));
        }
        outputs.into_iter().map(f64::to_bits).collect()
    }
}

/// Returns the laws about the axes.
fn laws_of_axes(
    laws: &[&LawKind],
    authorities: &[Authority],
    scenario: &Scenario,
) -> Result<LawsOfAxes, NotExportable> {
    let about = |axis: usize| &authorities[axis];
    match laws.first() {
        Some(LawKind::Pd(_)) => Ok(LawsOfAxes::Pd(all_of_kind(laws, |law| {
            if let LawKind::Pd(law) = law { Some((law.flight_law(), law.schedule())) } else { None }
        })?)),
        Some(LawKind::PhasePlane(_)) => {
            let all =
                all_of_kind(
                    laws,
                    |law| if let LawKind::PhasePlane(law) = law { Some(law.clone()) } else { None },
                )?;
            let has_damping = all.iter().any(|law| law.damping.is_some());
            let observers = scenario.study.adaptive.as_deref().filter(|_| has_damping);
            let modes = observers
                .and_then(|design| design.axes.iter().map(|axis| axis.start.len()).max())
                .unwrap_or(0);
            let each = all.iter().enumerate().map(|(axis, law)| law.flight_law(about(axis)));
            Ok(LawsOfAxes::PhasePlane(each.collect(), modes))
        }
        Some(LawKind::Attitude(_)) => {
            let all =
                all_of_kind(
                    laws,
                    |law| if let LawKind::Attitude(law) = law { Some(law.clone()) } else { None },
                )?;
            let each =
                all.iter().enumerate().map(|(axis, law)| (law.flight_law(about(axis)), law.flight_filters()));
            Ok(LawsOfAxes::Attitude(each.collect()))
        }
        law => {
            let kind = law.map_or("open", |law| law.kind());
            let reason = "has no code for flight: the laws `relay`, `pd`, `phase_plane` and `attitude` have";
            Err(NotExportable::new(format!("law.{kind}"), reason))
        }
    }
}

/// Returns the distribution of torques to the wheels of a scenario; `None` if other actuators act too, or if the drives add
/// torques of their own.
fn wheels(scenario: &Scenario) -> Option<WheelDistribution> {
    let ActuatorKind::Wheels(wheels) = scenario.actuator.only_actuator()? else { return None };
    let allocation = scenario.study.wheels.as_ref()?;
    if wheels.speed_bias.is_some() || wheels.compensation.is_some() || wheels.unloading.is_some() {
        return None;
    }
    Some(WheelDistribution {
        wheels: allocation.flight_wheels().to_vec(),
        limit: wheels.torque.map_or(f64::INFINITY, Positive::get),
        is_least_largest: allocation.is_least_largest(),
    })
}
