//! Data resolved from all parts of a scenario: one-axis models for laws and estimators, placement, allocation and
//! authority.

use nalgebra::{Cholesky, Matrix3};

use super::{Drives, Scenario, Written};
use crate::actuator::{
    Actuate, Actuator, ActuatorMember, ActuatorTask, Allocation, Firing, FiringGroup, GyroAxes, OpenThruster,
    Opposes, Several, TorquerSetting, Torquers,
};
use crate::attitude::{Vector, rotation_vector, tensor};
use crate::body::craft::{HubRotor, Moving};
use crate::body::{Axes, Drive, Mode, Model, Planar, Spatial};
use crate::document::Fault;
use crate::environment::Around;
use crate::estimator::{Estimator, adaptive, attitude};
use crate::law::{Authority, Itinerary, TorqueDistribution};
use crate::motion::turning::{Bearing, CommonSteps};
use crate::quantity::{Finite, Positive};
use crate::random::Seed;
use crate::time::{Instant, Span};

/// Assessment period of a run without a period of its own (s).
const TICK: f64 = 1.0;
/// Tolerance for rounded shares.
const ROUNDING: f64 = 1e-9;

/// Data resolved from all parts of a scenario together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Study {
    /// One-axis model of the body about each of its axes, as if that axis were alone.
    pub axes: Vec<Planar>,
    /// Authority of the actuators about each axis.
    pub authorities: Vec<Authority>,
    /// Period of the law, if it has one.
    pub cycle: Option<Span>,
    /// Sampling period; `None` if the angle is measured at every instant.
    pub sampling: Option<Span>,
    /// Assessment period of a three-axis body.
    pub tick: Span,
    /// Point of a three-axis body at which each sensor is mounted.
    pub sensed_at: Vec<String>,
    /// Point of a three-axis body at which torques act.
    pub acts_at: String,
    /// Translation of a spacecraft, if jets or forces can push it.
    pub moving: Option<Moving>,
    /// Environment of a three-axis body.
    pub around: Option<Around>,
    /// Drives and hinges of appendages.
    pub drives: Option<Drives>,
    /// Sequence of targets of a three-axis body.
    pub way: Itinerary,
    /// Effect of each group of jets that execute the law's commands: about each axis, plus and minus.
    pub groups: Option<[[FiringGroup; 2]; 3]>,
    /// Effect of each thruster of jets, whether they execute commands or unload wheels.
    pub nozzles: Vec<OpenThruster>,
    /// True for axes about which jets are the only actuator.
    pub fired: [bool; 3],
    /// True if jets are the only actuator.
    pub jets_alone: bool,
    /// Effect of each group of jets that unload wheels: about each axis, plus and minus.
    pub unloading: Option<[[FiringGroup; 2]; 3]>,
    /// Allocation of a torque to wheels with their own axes.
    pub wheels: Option<Allocation>,
    /// Axes of control moment gyros with the gimbals at angle 0.
    pub gimbals: Vec<GyroAxes>,
    /// Bearings of wheels with friction or imbalance.
    pub bearings: Vec<Bearing>,
    /// Back-EMF torque of a wheel per unit of the rate (N m s), and whether the rate is that of the elastic body.
    pub back_emf: (f64, bool),
    /// Design of the adaptive observers.
    pub adaptive: Option<Box<adaptive::ObserverDesign>>,
    /// Sensor data of an attitude filter.
    pub attitude: Option<attitude::AttitudeSetting>,
    /// Integration steps shared by all runs.
    pub common: CommonSteps,
    /// Error band about the target that the law of each axis promises (rad), if it promises one.
    pub bands: Vec<Option<f64>>,
}

impl Study {
    /// Resolves the data of a scenario with its model, after the parts have been checked one by one.
    ///
    /// # Errors
    /// Fails with a key that is inconsistent with the others, and the reason.
    pub fn of(written: &Written, model: &Model) -> Result<Self, Fault> {
        let cycle = written.law.period();
        let samples = written.estimator.as_ref().is_some_and(|estimator| estimator.envelope().is_none());
        let mut study = Self {
            cycle,
            // With an estimator that works on samples, a continuous sensor is sampled at the law's period.
            sampling: written.sensor.period(cycle).or(cycle.filter(|_| samples)),
            way: Itinerary::new(written.targets(), &written.sky(), &model.free_modes()),
            back_emf: written
                .actuator
                .wheel()
                .map_or((0.0, true), |(wheel, _)| (wheel.back_emf.get(), wheel.opposes == Opposes::BodyRate)),
            jets_alone: matches!(written.actuator.alone(), Some(Actuator::Jets(_))),
            ..Self::default()
        };
        study.tick = study.cycle.or(study.sampling).unwrap_or(Span::from_seconds(TICK));
        match model.axes() {
            Axes::One(body) => study.axes.push(body.clone()),
            Axes::Three(body) => study.place(written, model, body)?,
        }
        study.authorities = (0..study.axes.len()).map(|axis| study.authority(written, axis)).collect();
        if let Some(Estimator::Adaptive(_)) = &written.estimator {
            let at = |why: &str| Err(Fault::new("estimator.adaptive", why));
            let jets = written.actuator.jets();
            if jets.is_some_and(|(jets, _)| jets.allocation == Firing::LeastPropellant) {
                return at("predicts by the pulses of groups: it needs jets with `allocation = \"groups\"`");
            }
            let members = written.actuator.members();
            let part = |share: f64| share > 0.0 && share < 1.0 - ROUNDING;
            let fires = |member: &&ActuatorMember<'_>| matches!(&*member.kind, Actuator::Jets(_));
            if members.iter().filter(fires).any(|member| (0..3).any(|axis| part(member.share(axis)))) {
                return at(
                    "predicts what one actuator about each axis does: it needs jets with all of the demand about theirs",
                );
            }
        }
        if let Some(Estimator::Adaptive(spec)) = &written.estimator {
            let Some(period) = study.sampling else {
                return Err(Fault::new("estimator.adaptive", Estimator::AT_SAMPLES));
            };
            let measured = match model.axes() {
                Axes::One(body) => of_one_angle(body),
                Axes::Three(body) => study.measured(body),
            };
            let plan = adaptive::ObserverDesign::of(spec, &measured, period.seconds());
            study.adaptive = Some(Box::new(plan.map_err(|fault| fault.within("estimator.adaptive"))?));
        }
        if let Some(spec) = written.estimator.as_ref().and_then(Estimator::attitude) {
            let jets = study.groups.is_some();
            let mounted = model.spatial().map(|body| (body, &study.sensed_at[..], jets));
            let setting = spec.setting(&written.sensor, cycle, mounted);
            study.attitude = Some(setting.map_err(|fault| fault.within("estimator.attitude"))?);
        }
        for axis in 0..study.axes.len() {
            study.authorities[axis].threshold = study.threshold(written, axis)?;
        }
        study.bands = (0..study.axes.len()).map(|axis| study.band(written, model.spatial(), axis)).collect();
        Ok(study)
    }

    /// Resolves the three-axis data: mounting points, groups of jets, allocation, environment, and one-axis models.
    fn place(&mut self, written: &Written, model: &Model, body: &Spatial) -> Result<(), Fault> {
        let first = body.points.first().map_or(String::new(), |point| point.name.clone());
        let named = |key: &str, point: Option<&str>| {
            let Some(name) = point else { return Ok(first.clone()) };
            if body.point(name).is_some() {
                return Ok(name.to_owned());
            }
            let points = body.point_names();
            Err(Fault::new(key, format!("must be one of the body's points, {points}, got `{name}`")))
        };
        for (index, sensor) in written.sensor.iter().enumerate() {
            let key = format!("{}.{}.point", written.sensor.key("sensor", index), sensor.kind());
            self.sensed_at.push(named(&key, sensor.point())?);
        }
        self.acts_at.clone_from(&first);
        for member in written.actuator.members() {
            let Actuator::Jets(jets) = &*member.kind else { continue };
            let (acts, groups) = match &member.task {
                ActuatorTask::Executes(shares) => (shares.map(|share| share > 0.0), &mut self.groups),
                ActuatorTask::Unloads(_) => ([true; 3], &mut self.unloading),
            };
            *groups = Some(jets.groups_on(body, acts).map_err(|fault| fault.within(&member.key))?);
            self.nozzles = jets.nozzles_on(body);
            self.fired = [0, 1, 2].map(|axis| member.share(axis) > 1.0 - ROUNDING);
        }
        if let Some((wheels, of)) = written.actuator.wheels() {
            let allocation = wheels.allocation().map_err(|fault| fault.within(&of))?;
            self.wheels = Some(allocation);
            let tachometer = written.sensor.tachometer().map(|(index, _)| written.sensor_key(index));
            let own = wheels.bears().map(|key| format!("{of}.{key}"));
            if let Some(key) = own.or(tachometer) {
                let Some(flexible) = model.flexible() else {
                    let why = "is for wheels on a `[spacecraft]`: the modes of a `[body.spatial]` do not act back on its rotation, \
                               against which wheels turn";
                    return Err(Fault::new(key, why));
                };
                let bearings = wheels.bearings((body, flexible));
                self.bearings = bearings.map_err(|fault| fault.within(&of))?;
            }
        }
        if let Some((gyros, of)) = written.actuator.control_moment_gyros() {
            self.gimbals = gyros.axes().map_err(|fault| fault.within(&of))?;
            if model.flexible().is_none() {
                let why = "are for a `[spacecraft]`, which needs no appendages: the modes of a `[body.spatial]` are pushed by \
                           torques that are constant for a while, and gimbals turn theirs";
                return Err(Fault::new(of, why));
            }
        }
        self.around = surroundings(written, model, body)?;
        self.drives = written.drives(model)?;
        for (index, disturbance) in written.disturbance.iter().enumerate() {
            named(&format!("disturbance[{index}].point"), disturbance.point.as_deref())?;
        }
        let pushed = self.fires() || written.disturbance.iter().any(|of| of.force.is_some());
        let craft = model.craft().filter(|_| pushed);
        self.moving = craft.map(|craft| Moving::new(body, craft.mass));
        let measured = self.measured(body);
        let angles = rotation_vector(&self.way.target(Instant::START), &body.attitude.get());
        for (axis, (input, seen)) in measured.inputs.iter().zip(&measured.seen).enumerate() {
            let mode = |(index, mode): (usize, &crate::body::spatial::SpatialMode)| {
                let shape = seen[index];
                let scaled = |value: Finite| Finite::new(shape * value.get()).unwrap_or_default();
                let gain = shape * input.forces[index] / input.acceleration;
                Mode {
                    displacement: scaled(mode.displacement),
                    rate: scaled(mode.rate),
                    ..Mode::at_rest(mode.frequency, Finite::new(gain).unwrap_or_default(), mode.damping)
                }
            };
            self.axes.push(Planar {
                inertia: Positive::new(body.tensor()[(axis, axis)]).unwrap_or(Positive::ONE),
                angle: Finite::new(angles[axis]).unwrap_or_default(),
                rate: body.rate[axis],
                modes: body.modes.iter().enumerate().map(mode).collect(),
                ..Planar::default()
            });
        }
        Ok(())
    }

    /// Returns the measured modal rates of a three-axis body, and the effect of its actuators on them.
    pub fn measured(&self, body: &Spatial) -> adaptive::MeasuredRates {
        let (seen, hub) = (rotations(body, &self.sensed_at[0]), rotations(body, &self.acts_at));
        let tensor = body.tensor();
        let input = |axis: usize| {
            let jets = self.groups.as_ref().filter(|_| self.fired[axis]);
            let (forces, torque, acceleration) = if let Some(groups) = jets {
                let group = &groups[axis][0];
                (group.push.forces.clone(), group.push.torque, group.acceleration)
            } else {
                let forces = hub.iter().map(|rotation| rotation[axis]).collect();
                let torque = Vector::from_fn(|row, _| if row == axis { 1.0 } else { 0.0 });
                (forces, torque, 1.0 / tensor[(axis, axis)])
            };
            let turned = Cholesky::new(tensor).map_or_else(Vector::zeros, |of| of.solve(&torque));
            let turning = turned.iter().map(|rate| rate / acceleration).collect();
            adaptive::ActuatorInput { forces, acceleration, turning }
        };
        adaptive::MeasuredRates {
            frequencies: body.modes.iter().map(|mode| mode.frequency).collect(),
            seen: (0..3).map(|axis| seen.iter().map(|rotation| rotation[axis]).collect()).collect(),
            inputs: (0..3).map(input).collect(),
        }
    }

    /// Returns true if the body has jets.
    pub fn fires(&self) -> bool {
        self.groups.is_some() || self.unloading.is_some()
    }

    /// Returns the conversion of the laws' commands into torques about the axes.
    pub fn distribution(&self, scenario: &Scenario) -> TorqueDistribution {
        match scenario.model.axes() {
            Axes::One(body) => TorqueDistribution::of_one_angle(body.commanded_inertia()),
            Axes::Three(body) => TorqueDistribution::of_three_axes(
                scenario.law.inertia().map_or_else(|| body.tensor(), tensor),
            ),
        }
    }

    /// Creates the actuators of a run.
    pub fn actuator(&self, scenario: &Scenario, seed: Seed) -> Box<dyn Actuate> {
        let waveform = scenario.plan.as_ref().map(|plan| std::sync::Arc::new(plan.waveform.clone()));
        let manoeuvre = scenario.manoeuvre.as_ref();
        let setting = |(axis, model): (usize, &Planar)| TorquerSetting {
            axis,
            inertia: model.commanded_inertia(),
            planned_inertia: manoeuvre.map_or(model, |of| of.planned_for(model)).commanded_inertia(),
            rate: model.rate.get(),
            cycle: scenario.law.about(axis).period(),
            waveform: waveform.clone(),
            share: 1.0,
        };
        let settings: Vec<TorquerSetting> = self.axes.iter().enumerate().map(setting).collect();
        if let Some(kind) = scenario.actuator.alone() {
            return self.start(scenario, kind, settings, self.groups.as_ref(), seed);
        }
        let members = scenario.actuator.members();
        let start = |member: &ActuatorMember<'_>| {
            let (share, groups) = match &member.task {
                ActuatorTask::Executes(shares) => (*shares, self.groups.as_ref()),
                ActuatorTask::Unloads(_) => ([1.0; 3], self.unloading.as_ref()),
            };
            let own =
                settings.iter().map(|of| TorquerSetting { share: share[of.axis], ..of.clone() }).collect();
            self.start(scenario, &member.kind, own, groups, seed)
        };
        let started = members.iter().map(|member| (&*member.kind, &member.task, start(member))).collect();
        Box::new(Several::new(settings.len(), started))
    }

    /// Creates one actuator before it first acts.
    fn start(
        &self,
        scenario: &Scenario,
        kind: &Actuator,
        settings: Vec<TorquerSetting>,
        groups: Option<&[[FiringGroup; 2]; 3]>,
        seed: Seed,
    ) -> Box<dyn Actuate> {
        match (kind, groups, &self.wheels) {
            (Actuator::Jets(jets), Some(groups), _) => jets.start((groups, &self.nozzles), self.tick),
            (Actuator::Wheels(wheels), _, Some(allocation)) => {
                let tachometer = scenario.sensor.tachometer().map(|(_, tachometer)| (tachometer, seed));
                Box::new(wheels.start(allocation, &settings).read_by(tachometer))
            }
            (Actuator::ControlMomentGyros(gyros), ..) => Box::new(gyros.start(&self.gimbals, &settings)),
            (Actuator::Magnetorquers(torquers), ..) => Box::new(torquers.start(&settings)),
            (Actuator::Own(own), ..) => own.start(&settings),
            (kind, ..) => Box::new(Torquers::new(kind, settings)),
        }
    }
}

/// Creates the environment of a three-axis body, including the wheels' inertia that the body's tensor excludes.
fn surroundings(written: &Written, model: &Model, body: &Spatial) -> Result<Option<Around>, Fault> {
    let bendings = model.craft().map_or(&[][..], |craft| &craft.bendings);
    let sunny =
        written.environment.as_ref().is_some_and(|around| around.orbit.is_some() && around.sun.is_some());
    if !bendings.is_empty() && !sunny {
        let index = written.appendage.iter().position(|appendage| appendage.thermal.is_some());
        let why = "depends on sunlight and shadow: it needs `environment.orbit` and `environment.sun`";
        return Err(Fault::new(format!("appendage[{}].thermal", index.unwrap_or(0)), why));
    }
    let Some(environment) = &written.environment else { return Ok(None) };
    let rotors = match written.actuator.wheels() {
        Some((wheels, key)) => wheels.rotors().map_err(|fault| fault.within(&key))?,
        None => Vec::new(),
    };
    let spinning: Matrix3<f64> = rotors.iter().map(HubRotor::spinning).sum();
    let centre = model.craft().map_or_else(Vector::zeros, |craft| craft.centre);
    let around = Around::new(environment, written.sky(), [body.tensor(), spinning], &centre);
    Ok(Some(around.warming(bendings)))
}

/// Returns the modal rotations at a point (rad/(m sqrt(kg))).
fn rotations(body: &Spatial, point: &str) -> Vec<Vector> {
    body.shapes(point).into_iter().map(|(_, rotation)| rotation).collect()
}

/// Returns the measured modal rates of a one-axis body: the modes appear in the angle with weight 1, or not at all.
fn of_one_angle(model: &Planar) -> adaptive::MeasuredRates {
    let visible = if model.drive == Drive::Torque { 1.0 } else { 0.0 };
    adaptive::MeasuredRates {
        frequencies: model.modes.iter().map(|mode| mode.frequency).collect(),
        seen: vec![vec![visible; model.modes.len()]],
        inputs: vec![adaptive::ActuatorInput {
            forces: model.modes.iter().map(|mode| mode.gain.get()).collect(),
            acceleration: 1.0,
            turning: vec![1.0],
        }],
    }
}
