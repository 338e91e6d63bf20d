//! Data resolved from all parts of a scenario: one-axis models for laws and estimators, placement, allocation and
//! authority.

use flexsc_control::actuator::{
    Actuator, ActuatorKind, ActuatorSet, ActuatorTask, Allocation, AssignedMember, AxisActuatorContext,
    BackEmfRate, CarriedRotor, GroupEffect, GyroAxes, ThrusterEffect,
};
use flexsc_control::estimator::attitude::FilterSetup;
use flexsc_control::estimator::{EstimatorKind, adaptive, attitude};
use flexsc_control::law::{AttitudeProfile, Authority, ErrorBand, Stage, TorqueDistribution};
use flexsc_dynamics::axis_model::{AxisMode, AxisModel, CommandedQuantity};
use flexsc_dynamics::frequency_drift::FrequencyDrift;
use flexsc_dynamics::three_axis::{Bearing, SharedSteps};
use flexsc_dynamics::three_axis_model::{ThreeAxisMode, ThreeAxisModel};
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{Vector, rotation_vector, tensor};
use flexsc_numerics::quantity::{Finite, Positive};
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::{Instant, Span};
use flexsc_spacecraft::body::craft::{HubRotor, Translation};
use flexsc_spacecraft::body::{BodyAxes, BodyModel};
use flexsc_spacecraft::disturbance::Disturbance;
use flexsc_spacecraft::environment::SurroundingsState;
use nalgebra::{Cholesky, Matrix3};

use super::{
    AppendageDrives, AssessedRequirement, ContrastRequirement, Scenario, ScenarioSpec, plate_mounts,
};

/// Tolerance for rounded shares.
const ROUNDING: f64 = 1e-9;

/// Data resolved from all parts of a scenario together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ResolvedScenario {
    /// One-axis model of the body about each of its axes, as if that axis were alone.
    pub axes: Vec<AxisModel>,
    /// Drift of the natural frequencies.
    pub drift: Option<FrequencyDrift>,
    /// Authority of the actuators about each axis.
    pub authorities: Vec<Authority>,
    /// Authority about each axis in each stage of the law; empty if no stage selects actuators.
    pub stage_authorities: Vec<Vec<Authority>>,
    /// Period of the law, if it has one.
    pub law_period: Option<Span>,
    /// Sampling period; `None` if the angle is measured at every instant.
    pub sample_period: Option<Span>,
    /// Period of the cycles of a three-axis body: that of the law, else of the sensors, else 1 s.
    pub assessment_period: Span,
    /// Point of a three-axis body at which each sensor is mounted.
    pub sensor_points: Vec<String>,
    /// Point of a three-axis body at which torques act.
    pub torque_point: String,
    /// Translation of a spacecraft, if jets or forces can push it.
    pub translation: Option<Translation>,
    /// Environment of a three-axis body.
    pub surroundings: Option<SurroundingsState>,
    /// Drives and hinges of appendages.
    pub drives: Option<AppendageDrives>,
    /// Sequence of targets of a three-axis body.
    pub profile: AttitudeProfile,
    /// Effect of each group of jets that execute the law's commands: about each axis, plus and minus.
    pub groups: Option<[[GroupEffect; 2]; 3]>,
    /// Effect of each thruster of jets, whether they execute commands or unload wheels.
    pub nozzles: Vec<ThrusterEffect>,
    /// True for axes about which jets are the only actuator.
    pub jet_only_axes: [bool; 3],
    /// True if jets are the only actuator.
    pub jets_alone: bool,
    /// Effect of each group of jets that unload wheels: about each axis, plus and minus.
    pub unloading_groups: Option<[[GroupEffect; 2]; 3]>,
    /// Allocation of a torque to wheels with their own axes.
    pub wheels: Option<Allocation>,
    /// Axes of control moment gyros with the gimbals at angle 0.
    pub gimbals: Vec<GyroAxes>,
    /// Bearings of wheels with friction or imbalance.
    pub bearings: Vec<Bearing>,
    /// Rotors of wheels that turn with a point of the structure other than the hub.
    pub carried_rotors: Vec<CarriedRotor>,
    /// Back-EMF torque of a wheel per unit of the rate (N m s), and whether the rate is that of the elastic body.
    pub back_emf: (f64, bool),
    /// Design of the adaptive observers.
    pub adaptive: Option<Box<adaptive::ObserverDesign>>,
    /// Sensor data of an attitude filter.
    pub attitude: Option<attitude::FilterSetup>,
    /// Integration steps shared by all runs.
    pub shared_steps: SharedSteps,
    /// Error band about the target that the law of each axis promises (rad), if it promises one.
    pub expected_bands: Vec<Option<f64>>,
    /// Bands about the target of each mode of operation, for each axis; of a fraction, that of the distance at the start of
    /// the mode.
    pub mode_bands: Vec<Vec<ErrorBand>>,
    /// Requirements that runs are judged by, that of `reference.pointing.rms` first.
    pub requirements: Vec<AssessedRequirement>,
    /// Requirements on the contrast of an image, which linear tools judge.
    pub contrasts: Vec<ContrastRequirement>,
}

impl ResolvedScenario {
    /// Resolves the data of a scenario with its model, after the parts have been checked one by one.
    ///
    /// # Errors
    /// Fails with a key that is inconsistent with the others, and the reason.
    pub(super) fn resolve(written: &ScenarioSpec, model: &BodyModel) -> Result<Self, ConfigError> {
        let cycle = written.law.period();
        let mut study = Self {
            law_period: cycle,
            drift: written.drift.as_ref().map(Into::into),
            sample_period: written.sample_period(),
            assessment_period: written.assessment_period(),
            profile: profile(written, model),
            back_emf: written.actuator.flywheel().map_or((0.0, true), |(wheel, _)| {
                (wheel.back_emf.get(), wheel.opposes == BackEmfRate::BodyRate)
            }),
            jets_alone: written.actuator.only_actuator().is_some_and(|kind| kind.offers().has_jets),
            ..Self::default()
        };
        match model.axes() {
            BodyAxes::One(body) => study.axes.push(body.clone()),
            BodyAxes::Three(body) => study.locate_sensors_and_actuators(written, model, body)?,
        }
        let last_stage = written.law.stages().last();
        let axes = 0..study.axes.len();
        study.authorities = axes.clone().map(|axis| study.authority(written, axis, last_stage)).collect();
        if written.law.selects_actuators() || written.law.is_of_modes() {
            let stages = written.law.stages();
            let in_stages =
                |axis| stages.iter().map(|stage| study.authority(written, axis, Some(stage))).collect();
            study.stage_authorities = axes.map(in_stages).collect();
        }
        if let Some(spec) = written.estimator.as_ref().and_then(EstimatorKind::adaptive) {
            let Some(period) = study.sample_period else {
                return Err(ConfigError::new("estimator.adaptive", EstimatorKind::AT_SAMPLES));
            };
            let measured = match model.axes() {
                BodyAxes::One(body) => one_axis_measurement(body),
                BodyAxes::Three(body) => study.measured_rates(body),
            };
            let plan = adaptive::ObserverDesign::new(spec, &measured, period.seconds());
            study.adaptive = Some(Box::new(plan.map_err(|fault| fault.within("estimator.adaptive"))?));
        }
        if let Some(spec) = written.estimator.as_ref().and_then(EstimatorKind::attitude) {
            let jets = study.groups.is_some();
            let mounted = model.three_axis().map(|body| (body, &study.sensor_points[..], jets));
            let setting = spec.setup(&written.sensor, &written.orbit_environment(), cycle, mounted);
            let setting = setting.map_err(|fault| fault.within("estimator.attitude"))?;
            study.attitude = Some(FilterSetup { precision: written.flight_precision, ..setting });
        }
        study.set_damping_thresholds(written)?;
        study.mode_bands = study.mode_bands(written);
        study.expected_bands =
            (0..study.axes.len()).map(|axis| study.error_band(written, model.three_axis(), axis)).collect();
        Ok(study)
    }

    /// Resolves the three-axis data: mounting points, groups of jets, allocation, environment, and one-axis models.
    fn locate_sensors_and_actuators(
        &mut self,
        written: &ScenarioSpec,
        model: &BodyModel,
        body: &ThreeAxisModel,
    ) -> Result<(), ConfigError> {
        let first = body.points.first().map_or("", |point| &point.name);
        let points = written.sensor.iter().map(|sensor| sensor.point().unwrap_or(first).to_owned());
        self.sensor_points = points.collect();
        first.clone_into(&mut self.torque_point);
        for member in written.actuator.members() {
            let Some(jets) = member.kind.jets() else { continue };
            let (acts, groups) = match &member.task {
                ActuatorTask::Executes(shares) => (shares.map(|share| share > 0.0), &mut self.groups),
                ActuatorTask::Unloads(_) => ([true; 3], &mut self.unloading_groups),
            };
            *groups = Some(jets.group_effects(body, acts).map_err(|fault| fault.within(&member.key))?);
            self.nozzles = jets.thruster_effects(body);
            self.jet_only_axes = [0, 1, 2].map(|axis| member.share(axis) > 1.0 - ROUNDING);
        }
        if let Some((wheels, of)) = written.actuator.wheels() {
            let allocation = wheels.allocation().map_err(|fault| fault.within(&of))?;
            self.wheels = Some(allocation.with_precision(written.flight_precision));
            self.carried_rotors = wheels.carried_rotors(body).map_err(|fault| fault.within(&of))?;
            let is_observed = wheels.bearing_key().is_some() || written.sensor.tachometer().is_some();
            if model.is_two_way() && is_observed {
                let bearings = wheels.bearings(body);
                self.bearings = bearings.map_err(|fault| fault.within(&of))?;
            }
        }
        if let Some((gyros, of)) = written.actuator.control_moment_gyros() {
            self.gimbals = gyros.axes().map_err(|fault| fault.within(&of))?;
        }
        self.surroundings = surroundings(written, model, body)?;
        self.drives = written.drives(model)?;
        let pushed = self.fires() || written.disturbance.iter().any(Disturbance::is_force);
        let pushed = pushed || !written.own_disturbances.is_empty();
        let craft = model.spacecraft().filter(|_| pushed);
        self.translation = craft.map(|craft| Translation::new(body, craft.mass));
        let measured = self.measured_rates(body);
        let angles = rotation_vector(&self.profile.target(Instant::START), &body.attitude.get());
        for (axis, (input, seen)) in measured.inputs.iter().zip(&measured.visibilities).enumerate() {
            let mode = |(index, mode): (usize, &ThreeAxisMode)| {
                let shape = seen[index];
                let scaled = |value: Finite| Finite::new(shape * value.get()).unwrap_or_default();
                let gain = shape * input.forces[index] / input.acceleration;
                AxisMode {
                    displacement: scaled(mode.displacement),
                    rate: scaled(mode.rate),
                    ..AxisMode::at_rest(mode.frequency, Finite::new(gain).unwrap_or_default(), mode.damping)
                }
            };
            self.axes.push(AxisModel {
                inertia: Positive::new(body.inertia[(axis, axis)]).unwrap_or(Positive::ONE),
                angle: Finite::new(angles[axis]).unwrap_or_default(),
                rate: body.rate[axis],
                modes: body.modes.iter().enumerate().map(mode).collect(),
                ..AxisModel::default()
            });
        }
        Ok(())
    }

    /// Returns the measured modal rates of a three-axis body, and the effect of its actuators on them.
    pub fn measured_rates(&self, body: &ThreeAxisModel) -> adaptive::RateMeasurement {
        let (seen, hub) = (rotations(body, &self.sensor_points[0]), rotations(body, &self.torque_point));
        let tensor = body.inertia;
        let input = |axis: usize| {
            let jets = self.groups.as_ref().filter(|_| self.jet_only_axes[axis]);
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
        adaptive::RateMeasurement {
            frequencies: body.modes.iter().map(|mode| mode.frequency).collect(),
            visibilities: (0..3).map(|axis| seen.iter().map(|rotation| rotation[axis]).collect()).collect(),
            inputs: (0..3).map(input).collect(),
        }
    }

    /// Returns true if the body has jets.
    pub fn fires(&self) -> bool {
        self.groups.is_some() || self.unloading_groups.is_some()
    }

    /// Returns the conversion of the laws' commands into torques about the axes.
    pub fn distribution(&self, scenario: &Scenario) -> TorqueDistribution {
        let distribution = match scenario.model.axes() {
            BodyAxes::One(body) => TorqueDistribution::for_one_axis(body.commanded_inertia()),
            BodyAxes::Three(body) => TorqueDistribution::for_three_axes(
                scenario.law.inertia().map_or_else(|| body.inertia, tensor),
            ),
        };
        distribution.with_precision(scenario.flight_precision)
    }

    /// Creates the actuators of a run.
    pub fn actuator(&self, scenario: &Scenario, seed: Seed) -> Box<dyn Actuator> {
        let waveform = scenario.plan.as_ref().map(|plan| std::sync::Arc::new(plan.waveform.clone()));
        let manoeuvre = scenario.manoeuvre.as_ref();
        let setting = |(axis, model): (usize, &AxisModel), kind: &str| AxisActuatorContext {
            axis,
            inertia: model.commanded_inertia(),
            planned_inertia: manoeuvre
                .map_or_else(|| model.commanded_inertia(), |of| of.planned_for(model).commanded_inertia()),
            rate: model.rate.get(),
            cycle: scenario.law.cycle(axis, kind),
            waveform: waveform.clone(),
            share: 1.0,
        };
        let settings = |kind: &ActuatorKind| -> Vec<AxisActuatorContext> {
            self.axes.iter().enumerate().map(|of| setting(of, kind.kind())).collect()
        };
        let tachometer = scenario.sensor.tachometer().map(|(_, tachometer)| (tachometer, seed));
        if let Some(kind) = scenario.actuator.only_actuator() {
            return kind.start(&settings(kind), &self.placement(scenario, self.groups.as_ref(), tachometer));
        }
        let members = scenario.actuator.members();
        let start = |member: &AssignedMember<'_>| {
            let (share, groups) = match &member.task {
                ActuatorTask::Executes(shares) => (*shares, self.groups.as_ref()),
                ActuatorTask::Unloads(_) => ([1.0; 3], self.unloading_groups.as_ref()),
            };
            let own = settings(&member.kind).into_iter();
            let own: Vec<_> = own.map(|of| AxisActuatorContext { share: share[of.axis], ..of }).collect();
            member.kind.start(&own, &self.placement(scenario, groups, tachometer))
        };
        let started = members.iter().map(|member| (&*member.kind, &member.task, start(member))).collect();
        let executing = || members.iter().filter(|member| member.executes());
        let in_stage = |stage: &Stage| {
            (stage.begins(), executing().map(|member| stage.selects(member.kind.kind())).collect())
        };
        let stages = scenario.law.stages().iter().filter(|_| scenario.law.selects_actuators());
        let stages: Vec<_> = stages.map(in_stage).collect();
        let several = ActuatorSet::new(self.axes.len(), started, scenario.flight_precision);
        Box::new(if scenario.law.is_of_modes() && !stages.is_empty() {
            several.in_modes(stages.into_iter().map(|(_, executing)| executing).collect())
        } else {
            several.in_stages(stages)
        })
    }
}

/// Creates the profile of the targets, or of the guidance of a program.
fn profile(written: &ScenarioSpec, model: &BodyModel) -> AttitudeProfile {
    let sky = written.orbit_environment();
    let mut profile = AttitudeProfile::new(written.targets(), &sky, &model.free_modes());
    if let Some(guidance) = written.first_guidance() {
        profile.follow(guidance.start(Seed { scenario: written.seed, run: 0 }), Instant::START);
    }
    profile
}

/// Creates the environment of a three-axis body, including the wheels' inertia that the body's tensor excludes.
fn surroundings(
    written: &ScenarioSpec,
    model: &BodyModel,
    body: &ThreeAxisModel,
) -> Result<Option<SurroundingsState>, ConfigError> {
    let bendings = model.spacecraft().map_or(&[][..], |craft| &craft.bendings);
    let sunny =
        written.environment.as_ref().is_some_and(|around| around.orbit.is_some() && around.sun.is_some());
    if !bendings.is_empty() && !sunny {
        let index = written.appendage.iter().position(|appendage| appendage.thermal.is_some());
        let why = "depends on sunlight and shadow: it needs `environment.orbit` and `environment.sun`";
        return Err(ConfigError::new(format!("appendage[{}].thermal", index.unwrap_or(0)), why));
    }
    let Some(environment) = &written.environment else { return Ok(None) };
    let rotors = match written.actuator.wheels() {
        Some((wheels, key)) => wheels.rotors().map_err(|fault| fault.within(&key))?,
        None => Vec::new(),
    };
    let spinning: Matrix3<f64> = rotors.iter().map(HubRotor::axial_inertia).sum();
    let centre = model.spacecraft().map_or_else(Vector::zeros, |craft| craft.centre);
    let mounts = plate_mounts::mounts(written, body.articulation.as_deref())
        .map_err(|fault| fault.within("environment"))?;
    let sky = written.orbit_environment();
    let around = SurroundingsState::new(environment, sky, [body.inertia, spinning], &centre, &mounts);
    Ok(Some(around.with_thermal_bending(bendings)))
}

/// Returns the modal rotations at a point (rad/(m sqrt(kg))).
fn rotations(body: &ThreeAxisModel, point: &str) -> Vec<Vector> {
    body.shapes(point).into_iter().map(|(_, rotation)| rotation).collect()
}

/// Returns the measured modal rates of a one-axis body: the modes appear in the angle with weight 1, or not at all.
fn one_axis_measurement(model: &AxisModel) -> adaptive::RateMeasurement {
    let visible = if model.drive == CommandedQuantity::Torque { 1.0 } else { 0.0 };
    adaptive::RateMeasurement {
        frequencies: model.modes.iter().map(|mode| mode.frequency).collect(),
        visibilities: vec![vec![visible; model.modes.len()]],
        inputs: vec![adaptive::ActuatorInput {
            forces: model.modes.iter().map(|mode| mode.gain.get()).collect(),
            acceleration: 1.0,
            turning: vec![1.0],
        }],
    }
}
