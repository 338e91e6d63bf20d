//! Actuators that give the commands of laws: wheels, groups of jets, and what unloads the wheels.

use flexsc_core::Scenario;
use flexsc_core::control::actuator::{
    ActuatorKind, ActuatorTask, AssignedMember, FiringMethod, UnloadingTask, jet_pair,
};
use flexsc_core::control::flight_quantity::FlightQuantity;
use flexsc_core::control::law::LawKind;
use flexsc_core::numerics::flight_types::to_vector3;
use flexsc_core::numerics::quantity::Positive;
use flexsc_core::numerics::time::Span;
use flexsc_flight::jet_pulses::{JetPair, JetTorques};
use flexsc_flight::momentum_unloading::MomentumUnloading;
use flexsc_flight::vector3::Vector3;
use flexsc_flight::wheel_allocation::AllocatedWheel;
use flexsc_flight_precision::Precision;

use super::attitude_unit::{vector, vector_words};
use super::b_dot::moment_channel;
use super::{CallLayout, Channel, StoredMomentum, WordReader};

/// Distribution of torques to reaction wheels.
#[derive(Clone, Debug)]
pub struct WheelDistribution {
    /// Wheels.
    pub wheels: Vec<AllocatedWheel>,
    /// Largest torque of a wheel (N m).
    pub limit: f64,
    /// True if the largest torque is minimised.
    pub is_least_largest: bool,
}

/// Actuator that unloads wheels.
#[derive(Clone, Debug)]
pub enum UnloadingDevice {
    /// Magnetorquers, with their largest moment along each axis (A m²).
    Magnetorquers(Vector3),
    /// Groups of jets about each axis, with their torques.
    Jets(Box<[JetPair; 3]>, Box<[JetTorques; 3]>),
}

/// Unloading of wheels.
#[derive(Clone, Debug)]
pub struct UnloadingUnit {
    /// Law.
    pub law: MomentumUnloading,
    /// Actuator that unloads them.
    pub device: UnloadingDevice,
    /// Period (s).
    pub period: f64,
    /// Torque that the wheels counteract (N m).
    pub counter: Vector3,
}

/// Actuators that give the commands of laws about three axes.
#[derive(Clone, Debug, Default)]
pub struct Actuation {
    /// Wheels, with the torques of the last command.
    pub wheels: Option<WheelDistribution>,
    /// Groups of jets.
    pub jets: Option<Vec<JetPair>>,
    /// Unloading of the wheels.
    pub unloading: Option<UnloadingUnit>,
    /// Torque that laws demand of the wheels (N m).
    demanded: Vector3,
    precision: Precision,
}

/// Actuators that execute the commands of a law.
pub(super) struct Executing<'a> {
    pub law: &'a LawKind,
    members: Vec<&'a AssignedMember<'a>>,
}

impl<'a> Executing<'a> {
    /// Returns the actuators for each law, mode or stage of a scenario.
    pub(super) fn all(scenario: &'a Scenario, members: &'a [AssignedMember<'a>]) -> Vec<Self> {
        let stages = scenario.law.stages();
        let executing = || members.iter().filter(|member| member.executes());
        if stages.is_empty() {
            return vec![Self { law: scenario.law.about(0), members: executing().collect() }];
        }
        let of_stage = stages.iter().map(|stage| Self {
            law: &stage.law,
            members: executing().filter(|member| stage.selects(member.kind.kind())).collect(),
        });
        of_stage.collect()
    }

    /// Returns true if an actuator of a kind executes the commands.
    pub(super) fn has(&self, is: fn(&ActuatorKind) -> bool) -> bool {
        self.members.iter().any(|member| is(&member.kind))
    }

    /// Returns true if these commands are not shared with other actuators: moments are for magnetorquers alone, and an open loop
    /// has none.
    fn is_unshared(&self) -> bool {
        match self.law {
            LawKind::BDot(_) | LawKind::Open(_) => true,
            _ => matches!(&self.members[..], [only] if only.task == ActuatorTask::Executes([1.0; 3])),
        }
    }
}

pub(super) fn are_wheels(kind: &ActuatorKind) -> bool {
    matches!(kind, ActuatorKind::Wheels(_))
}

/// Returns the moment of inertia of each of a set of reaction wheels (kg m²); `None` of other actuators.
pub(super) fn wheel_inertia(kind: &ActuatorKind) -> Option<f64> {
    if let ActuatorKind::Wheels(wheels) = kind { Some(wheels.inertia.get()) } else { None }
}

pub(super) fn are_jets(kind: &ActuatorKind) -> bool {
    matches!(kind, ActuatorKind::Jets(_))
}

pub(super) fn are_magnetorquers(kind: &ActuatorKind) -> bool {
    matches!(kind, ActuatorKind::Magnetorquers(_))
}

impl Actuation {
    /// Returns the actuators of a scenario that are exported: those with which no other shares the commands of a law.
    pub(super) fn new(scenario: &Scenario) -> Self {
        let members = scenario.actuator.members();
        let executing = Executing::all(scenario, &members);
        let unloads = members.iter().find_map(|member| match &member.task {
            ActuatorTask::Unloads(task) => Some((task, &*member.kind)),
            ActuatorTask::Executes(_) => None,
        });
        let unloading = unloads.and_then(|(task, kind)| UnloadingUnit::new(scenario, task, kind));
        let is_unloaded = unloads.is_none() || unloading.is_some();
        let wheels = wheels(scenario, &members, &executing).filter(|_| is_unloaded);
        let unloading = unloading.filter(|_| wheels.is_some());
        let (jets, precision) = (jets(scenario, &members, &executing), scenario.flight_precision);
        Self { wheels, jets, unloading, demanded: Vector3::ZERO, precision }
    }

    /// Removes all but wheels that nothing unloads.
    pub(super) fn keep_wheels(&mut self) {
        let wheels = self.wheels.take().filter(|_| self.unloading.is_none());
        *self = Self { wheels, precision: self.precision, ..Self::default() };
    }

    /// Returns the outputs of a step.
    pub(super) fn channels(&self) -> Vec<Channel> {
        let mut outputs: Vec<Channel> = self.wheels.iter().map(wheel_channel).collect();
        outputs.extend(self.jets.as_deref().map(on_time_channel));
        outputs
    }

    /// Demands a torque (N m) of the wheels, and returns the words of their torques; none without wheels.
    pub(super) fn drive(&mut self, torque: Vector3) -> Vec<u64> {
        self.demanded = torque;
        self.drive_wheels()
    }

    fn drive_wheels(&mut self) -> Vec<u64> {
        let counter = self.unloading.as_ref().map_or(Vector3::ZERO, |unit| unit.counter);
        let Some(own) = &mut self.wheels else { return Vec::new() };
        let WheelDistribution { wheels, limit, is_least_largest } = own;
        self.precision.drive(wheels, &self.demanded, &counter, *is_least_largest, *limit);
        own.wheels.iter().map(|wheel| wheel.torque.to_bits()).collect()
    }

    /// Returns the words of the on-times of jets for commands about the axes: torques (N m), or changes of the rate (rad/s).
    pub(super) fn on_times(&self, commands: &[f64], are_changes: bool) -> Vec<u64> {
        let each = self.jets.iter().flatten().zip(commands);
        let on_time = |(pair, command): (&JetPair, &f64)| {
            if are_changes { pair.on_time_of_change(*command) } else { pair.on_time_of_torque(*command) }
        };
        each.map(|own| on_time(own).to_bits()).collect()
    }

    /// Returns true if magnetorquers unload the wheels.
    pub fn unloads_by_magnetorquers(&self) -> bool {
        self.unloading.as_ref().is_some_and(|unit| unit.law.is_magnetic)
    }

    /// Ends the unloading by magnetorquers, because laws command them.
    pub(super) fn release(&mut self) {
        if let Some(unit) = self.unloading.as_mut().filter(|unit| unit.law.is_magnetic) {
            (unit.law.is_active, unit.counter) = (false, Vector3::ZERO);
        }
    }

    /// Begins a cycle of the unloading, and returns the words of the outputs; without an estimated rate (rad/s) it is an input. Laws
    /// that command the magnetorquers have set their moment to `held` (A m²).
    pub(super) fn unload(
        &mut self,
        inputs: &[u64],
        stored: &StoredMomentum,
        rate: Option<Vector3>,
        held: Option<Vector3>,
    ) -> Vec<u64> {
        let Some(unit) = &mut self.unloading else { return Vec::new() };
        let mut words = WordReader::new(inputs);
        let given = words.list(stored.channel(1.0).map_or(0, |channel| channel.count));
        let rate = rate.unwrap_or_else(|| vector(&mut words));
        let mut outputs = unit.begin(&stored.momentum(&given, &rate), &mut words, held, self.precision);
        outputs.extend(self.drive_wheels());
        outputs
    }

    /// Returns the function that unloads the wheels; `has_rate` is true if an estimator in the code gives the rate.
    pub(super) fn unload_layout(&self, stored: &StoredMomentum, has_rate: bool) -> Option<CallLayout> {
        let unit = self.unloading.as_ref()?;
        let wheels = self.wheels.iter().map(wheel_channel);
        let mut inputs: Vec<Channel> = stored.channel(unit.law.above).into_iter().collect();
        if !has_rate {
            inputs.push(Channel::from_quantity(FlightQuantity::Rate, 3, 1e-3));
        }
        let output = match &unit.device {
            UnloadingDevice::Magnetorquers(_) => {
                let about = "Last measured magnetic field, body axes (T); 0 before";
                let field = Channel::from_quantity(FlightQuantity::Field, 3, 3e-5).with_about(about);
                inputs.push(field);
                moment_channel()
            }
            UnloadingDevice::Jets(pairs, _) => on_time_channel(&pairs[..]),
        };
        let about = "Begins a cycle in which the wheels are unloaded, at its period; at one time with the step it may come before or after it.";
        Some(CallLayout {
            period: Some(unit.period),
            inputs,
            outputs: [output].into_iter().chain(wheels).collect(),
            ..CallLayout::new("unload", about)
        })
    }
}

impl UnloadingUnit {
    fn new(scenario: &Scenario, task: &UnloadingTask, kind: &ActuatorKind) -> Option<Self> {
        let period = task.cycle(kind).0?;
        let device = match kind {
            ActuatorKind::Magnetorquers(torquers) => {
                let [x, y, z] = [0, 1, 2].map(|axis| torquers.moment.about(axis).get());
                UnloadingDevice::Magnetorquers(Vector3 { x, y, z })
            }
            ActuatorKind::Jets(jets) if jets.allocation == FiringMethod::Groups => {
                let groups = scenario.study.unloading_groups.as_ref()?;
                let pair = |axis: usize| jet_pair(groups, axis, period, jets.pulse_width());
                let torques = |axis: usize| {
                    let [plus, minus] =
                        [0, 1].map(|group: usize| to_vector3(&groups[axis][group].push.torque));
                    JetTorques { plus, minus }
                };
                UnloadingDevice::Jets(Box::new([0, 1, 2].map(pair)), Box::new([0, 1, 2].map(torques)))
            }
            _ => return None,
        };
        Some(Self { law: task.flight_law(kind), device, period: period.seconds(), counter: Vector3::ZERO })
    }

    /// Begins a cycle, and returns the words of the moments or on-times.
    fn begin(
        &mut self,
        stored: &Vector3,
        words: &mut WordReader<'_>,
        held: Option<Vector3>,
        precision: Precision,
    ) -> Vec<u64> {
        match (&self.device, held) {
            (UnloadingDevice::Magnetorquers(_), Some(held)) => vector_words(&held).to_vec(),
            (UnloadingDevice::Magnetorquers(limits), None) => {
                let (field, mut moment) = (vector(words), Vector3::ZERO);
                self.counter = precision.begin_magnetic(&mut self.law, stored, [&field, limits], &mut moment);
                vector_words(&moment).to_vec()
            }
            (UnloadingDevice::Jets(pairs, torques), _) => {
                let mut on_times = [0.0; 3];
                self.counter = self.law.begin_jets(stored, pairs, torques, &mut on_times);
                on_times.map(f64::to_bits).to_vec()
            }
        }
    }
}

fn wheel_channel(own: &WheelDistribution) -> Channel {
    let about = "Torque of the motor of each wheel on its rotor (N m)";
    Channel::real("wheel_torque", about, own.wheels.len(), 1.0).within(own.limit)
}

fn on_time_channel(pairs: &[JetPair]) -> Channel {
    let about =
        "Time for which the jets about each axis fire (s), negative for those of the negative direction";
    let longest = pairs.first().map_or(f64::INFINITY, |pair| pair.period);
    Channel::real("on_time", about, pairs.len(), 1.0).within(longest)
}

/// Returns the distribution of torques to the wheels of a scenario; `None` if others act beside them, or if the drives add torques
/// of their own.
fn wheels(
    scenario: &Scenario,
    members: &[AssignedMember<'_>],
    executing: &[Executing<'_>],
) -> Option<WheelDistribution> {
    let mut all = members.iter().filter(|member| are_wheels(&member.kind));
    let (Some(only), None) = (all.next(), all.next()) else { return None };
    let ActuatorKind::Wheels(wheels) = &*only.kind else { return None };
    let allocation = scenario.study.wheels.as_ref()?;
    let gives_torque = |own: &Executing<'_>| own.is_unshared() && !matches!(own.law, LawKind::PhasePlane(_));
    let mut with_wheels = executing.iter().filter(|own| own.has(are_wheels));
    if wheels.speed_bias.is_some() || wheels.compensation.is_some() || !with_wheels.all(gives_torque) {
        return None;
    }
    Some(WheelDistribution {
        wheels: allocation.flight_wheels().to_vec(),
        limit: wheels.torque.map_or(f64::INFINITY, Positive::get),
        is_least_largest: allocation.is_least_largest(),
    })
}

/// Returns the groups of jets about the axes of a scenario; `None` if others act beside them, if their thrusters are commanded one
/// by one, or if their period is not the law's.
fn jets(
    scenario: &Scenario,
    members: &[AssignedMember<'_>],
    executing: &[Executing<'_>],
) -> Option<Vec<JetPair>> {
    let mut kinds = members.iter().filter(|member| member.executes()).map(|member| &*member.kind);
    let jets = kinds.find_map(|kind| if let ActuatorKind::Jets(jets) = kind { Some(jets) } else { None })?;
    let groups = scenario.study.groups.as_ref()?;
    let is_own = jets.allocation == FiringMethod::Groups && jets.period.is_none();
    let mut with_jets = executing.iter().filter(|own| own.has(are_jets));
    let period: Span = scenario.law.cycle(0, "jets")?;
    let pair = |axis: usize| jet_pair(groups, axis, period, jets.pulse_width());
    (is_own && with_jets.all(Executing::is_unshared)).then(|| [0, 1, 2].map(pair).to_vec())
}
