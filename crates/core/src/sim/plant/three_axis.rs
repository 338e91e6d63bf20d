//! Plant of a three-axis body, advanced from one change of the loads to the next.

use flexsc_control::sensor::{Orientation, Truth};
use flexsc_dynamics::three_axis::{FlexibleBody, Rotor, RotorObservation, SlipDirection, Surroundings};
use flexsc_dynamics::{AxisState, ModeState};
use flexsc_numerics::attitude::{Vector, rotation_vector};
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{Record, RecordError};
use flexsc_spacecraft::body::spatial::PeriodicTorque;
use flexsc_spacecraft::environment::SurroundingsState;
use flexsc_spacecraft::flow::{DriftingModes, ElasticModes, RigidBody, ThreeAxisState};
use flexsc_spacecraft::wrench::Wrench;
use nalgebra::Quaternion;

use super::INITIAL_TRUTH;
use super::coupled::{AccelerometerMount, CoupledMotion};
use crate::scenario::ResolvedScenario;

mod fastest_frequency;
mod free_modes;
mod rows;

/// A mode is visible to a sensor if it rotates the sensor by at least this fraction of the largest modal rotation
/// there.
const VISIBLE: f64 = 0.1;

/// Longest motion segment under constant loads (fs); then another begins, so that evaluating the motion stays cheap.
const LONGEST: i64 = 20_000_000_000_000_000;

/// Three-axis body with its loads.
#[derive(Clone, Debug)]
pub struct ThreeAxisPlant {
    rigid: RigidBody,
    /// Environment, and (`disturbance`) the periodic disturbance torque of the body itself.
    surroundings: Option<SurroundingsState>,
    disturbance: Option<PeriodicTorque>,
    elastic: ElasticModes,
    /// Modes with drifting frequencies, if they drift.
    drifting: Option<DriftingModes>,
    /// Modal rotations at the first sensor, and (`hub`) at the point where torques act.
    sensor_rotations: Vec<Vector>,
    torque_rotations: Vec<Vector>,
    /// Differences of the modal rotations at each other sensor from those at the first.
    rotation_offsets: Vec<Vec<Vector>>,
    /// True for modes that are visible to the first sensor.
    visible: Vec<bool>,
    /// Start of the motion segment, and (`origin`) the state there.
    segment_start: Instant,
    origin: ThreeAxisState,
    /// Torque about the centre of mass (N m), and (`forces`) modal forces (N/sqrt(kg)).
    torque: Vector,
    forces: Vec<f64>,
    /// Instant, momentum of the rotors then (N m s) and its rate (N m); `None` without rotors.
    rotors: Option<(Instant, Vector, Vector)>,
    /// Motion with modes that act back on the rotation; `state` is then the motion seen from the mean axes.
    coupled: Option<Box<CoupledMotion>>,
    /// Current instant, (`state`) the state there, and (`truth`) the true state at the last evaluation.
    evaluated_at: Instant,
    state: ThreeAxisState,
    truth: Truth,
    is_viewed: bool,
    /// Rigid rates, and elastic part of the rates at the first sensor (rad/s), of the same instant as `truth`.
    rates: (Vector, Vector),
}

impl ThreeAxisPlant {
    /// Creates the plant at the start, without loads; with `flexible`, the modes act back on the rotation.
    pub fn new(
        body: &flexsc_spacecraft::body::Spatial,
        flexible: Option<&FlexibleBody>,
        study: &ResolvedScenario,
    ) -> Self {
        let rigid = RigidBody::new(body);
        let origin = ThreeAxisState::start(body, &rigid);
        let rotations = |point: &str| -> Vec<Vector> {
            body.shapes(point).into_iter().map(|(_, rotation)| rotation).collect()
        };
        let (first, others) =
            study.sensor_points.split_first().map_or(("", &[][..]), |(first, others)| (first, others));
        let sensed = rotations(first);
        let beyond_first = |point: &String| -> Vec<Vector> {
            rotations(point).iter().zip(&sensed).map(|(there, first)| there - first).collect()
        };
        let elsewhere = others.iter().map(beyond_first).collect();
        let hub = rotations(&study.torque_point);
        let around = study.surroundings.clone();
        let two_way = flexible.map(|of| {
            let shapes = [&sensed[..], &hub];
            let two_way = CoupledMotion::new(
                body,
                of,
                around.clone(),
                study.translation.clone(),
                shapes,
                (&study.bearings, &study.shared_steps),
            );
            Box::new(two_way.with_appendages(study.drives.as_ref()))
        });
        let most = sensed.iter().map(Vector::norm).fold(0.0, f64::max);
        Self {
            rigid,
            surroundings: around,
            disturbance: body.disturbance.clone(),
            elastic: ElasticModes::new(body, study.assessment_period.seconds()),
            drifting: None,
            visible: sensed.iter().map(|rotation| rotation.norm() >= VISIBLE * most).collect(),
            sensor_rotations: sensed,
            torque_rotations: hub,
            rotation_offsets: elsewhere,
            segment_start: Instant::START,
            torque: Vector::zeros(),
            forces: Vec::new(),
            rotors: None,
            coupled: two_way,
            evaluated_at: Instant::START,
            state: origin.clone(),
            truth: INITIAL_TRUTH,
            is_viewed: false,
            rates: (Vector::zeros(), Vector::zeros()),
            origin,
        }
    }

    /// Advances the body to `now`, unless the record fails, or to the earlier instant at which a wheel sticks or lets
    /// go, which it returns. Intermediate evaluations do not change the motion.
    pub fn approach(
        &mut self,
        now: Instant,
        record: &mut dyn Record,
    ) -> Result<Option<Instant>, RecordError> {
        record.poll()?;
        if self.coupled.is_some() {
            return self.advance_within_segment(now, record);
        }
        let longest = Span::from_femtoseconds(LONGEST);
        while now > self.segment_start + longest {
            self.advance_within_segment(self.segment_start + longest, record)?;
            self.origin.clone_from(&self.state);
            self.segment_start = self.evaluated_at;
            self.drift_on();
        }
        self.advance_within_segment(now, record)
    }

    fn advance_within_segment(
        &mut self,
        now: Instant,
        record: &mut dyn Record,
    ) -> Result<Option<Instant>, RecordError> {
        let mut met = None;
        if self.evaluated_at != now {
            let h = now.since(self.segment_start).seconds();
            let began = self.segment_start.seconds();
            if let Some(two_way) = &mut self.coupled {
                if let Some(h) = two_way.advance(h, began, || record.poll())? {
                    let at = (self.segment_start + Span::from_seconds(h)).min(now);
                    two_way.stop_at_bearing_event(at.since(self.segment_start).seconds(), began);
                    met = Some(at);
                }
                two_way.write_state(&self.rigid, &mut self.state);
                if let Some((_, rotations)) = two_way.modes() {
                    self.sensor_rotations.copy_from_slice(rotations);
                }
            } else {
                let rotors = self.rotors(self.segment_start);
                let turn = &mut self.state.turn;
                turn.clone_from(&self.origin.turn);
                let around = self.surroundings.as_ref().map(|around| around as &dyn Surroundings);
                self.rigid.advance(turn, &self.torque, rotors, around, (began, h), || record.poll())?;
                if let Some(drifting) = &mut self.drifting {
                    drifting.advance(h, &mut self.state.modes);
                } else {
                    self.state.modes.clone_from(&self.origin.modes);
                    self.elastic.advance(&mut self.state.modes, &self.forces, h);
                }
            }
            self.evaluated_at = met.unwrap_or(now);
            self.is_viewed = false;
        }
        Ok(met)
    }

    /// Returns the slip states of the wheels in bearings.
    pub fn bearing_states(&self) -> &[SlipDirection] {
        self.coupled.as_deref().map_or(&[], CoupledMotion::slips)
    }

    /// Returns the heat of the wheels' friction since the start (J); NaN without bearings.
    pub fn friction_heat(&self) -> f64 {
        self.coupled.as_deref().and_then(CoupledMotion::friction_heat).unwrap_or(f64::NAN)
    }

    /// Returns the states of the wheels in bearings at the current instant; empty without friction, imbalance and
    /// tachometer.
    pub fn wheel_bearings(&self) -> Vec<RotorObservation> {
        let began = self.segment_start.seconds();
        self.coupled.as_deref().map_or_else(Vec::new, |two_way| two_way.rotor_states(began))
    }

    /// Evaluates the true state at the current instant; `None` if it is no longer finite.
    pub fn measurable(&mut self) -> Option<&Truth> {
        if !self.is_viewed {
            if !self.state.is_finite() {
                return None;
            }
            if let Some(two_way) = self.coupled.as_deref() {
                let elastic = two_way.write_truth(&self.sensor_rotations, &mut self.truth);
                self.rates = (self.truth.rigid.into(), elastic);
            } else {
                self.evaluate_one_way();
            }
            if let Some(around) = &self.surroundings {
                self.truth.sky = around.observation(self.evaluated_at.seconds());
            }
            self.is_viewed = true;
        }
        Some(&self.truth)
    }

    /// Returns the true state of the last evaluation.
    pub fn viewed(&self) -> &Truth {
        &self.truth
    }

    /// Returns the true state of the last evaluation at a sensor other than the first.
    pub fn at_sensor(&self, sensor: usize) -> Truth {
        let (first, shapes) = (&self.truth, &self.rotation_offsets[sensor - 1]);
        let (angle, rate) = (self.modal_rotation(shapes), self.elastic.rate_at(shapes, &self.state.modes));
        Truth {
            elastic: (Vector::from(first.elastic) + angle).into(),
            rate: (Vector::from(first.rate) + rate).into(),
            turned: (Vector::from(first.turned) + angle).into(),
            ..*first
        }
    }

    /// Returns the rotation of a point by all modes (rad).
    fn modal_rotation(&self, shapes: &[Vector]) -> Vector {
        let displacements = self.state.modes.iter().map(|phase| phase.displacement);
        displacements.zip(shapes).fold(Vector::zeros(), |sum, (q, shape)| sum + shape * q)
    }

    /// Evaluates the true state of a body whose modes do not act back on the rotation.
    fn evaluate_one_way(&mut self) {
        let (turn, modes) = (&self.state.turn, &self.state.modes);
        let (rigid, elastic) = (self.rigid.rate(turn), self.elastic.rate_at(&self.sensor_rotations, modes));
        let angle = self.modal_rotation(&self.sensor_rotations);
        let truth = &mut self.truth;
        truth.orientation = Orientation::Attitude(turn.attitude);
        truth.elastic = angle.into();
        truth.rate = (rigid + elastic).into();
        truth.rigid = rigid.into();
        truth.turned = (RigidBody::rigid_angle(turn) + angle).into();
        self.rates = (rigid, elastic);
    }

    /// Begins a motion segment at the current instant, under the loads from now on.
    pub fn depart(&mut self, wrench: &Wrench) {
        self.segment_start = self.evaluated_at;
        if let Some(around) = &mut self.surroundings {
            around.set_magnetic_moment(wrench.moment);
        }
        if let Some(two_way) = &mut self.coupled {
            two_way.depart(wrench, self.segment_start.seconds());
            two_way.write_state(&self.rigid, &mut self.state);
            return;
        }
        self.origin.clone_from(&self.state);
        let sum = |of: fn(&Rotor) -> f64| -> Vector {
            wrench.rotors.iter().fold(Vector::zeros(), |sum, rotor| sum + rotor.axis * of(rotor))
        };
        let (stored, change) = (sum(|rotor| rotor.momentum), sum(|rotor| rotor.torque));
        self.rotors = (!wrench.rotors.is_empty()).then_some((self.evaluated_at, stored, change));
        // The torque that accelerates the rotors acts on the body with the opposite sign.
        let hub = Vector::from(wrench.hub) - change;
        self.torque = wrench.torque + hub;
        self.forces.clear();
        self.forces.extend_from_slice(&wrench.forces);
        if hub != Vector::zeros() {
            self.forces.resize(self.torque_rotations.len(), 0.0);
            self.forces
                .iter_mut()
                .zip(&self.torque_rotations)
                .for_each(|(force, shape)| *force += shape.dot(&hub));
        }
        self.drift_on();
    }

    /// Returns the momentum of the rotors (N m s) and its rate (N m), for a body whose modes do not act back on the
    /// rotation.
    fn rotors(&self, now: Instant) -> Option<(Vector, Vector)> {
        self.rotors.map(|(since, momentum, rate)| (momentum + rate * now.since(since).seconds(), rate))
    }

    /// Returns the specific force at an accelerometer of a spacecraft at the current instant (m/s²), under the loads
    /// from then on.
    pub fn specific_force(&self, place: &AccelerometerMount) -> Vector {
        let began = self.segment_start.seconds();
        self.coupled.as_deref().map_or_else(Vector::zeros, |two_way| two_way.specific_force(place, began))
    }

    /// Returns true if the scenario has an environment.
    pub fn has_environment(&self) -> bool {
        self.surroundings.is_some()
    }

    /// Returns the torque of the environment and of the body's own disturbance at the current instant, in body axes (N
    /// m), without that of magnetorquers; `None` if there is neither.
    pub fn environment_torque(&self) -> Option<Vector> {
        let t = self.evaluated_at.seconds();
        if self.surroundings.is_none() && self.disturbance.is_none() {
            return None;
        }
        let all = self.coupled.as_deref().map_or_else(
            || {
                let own = self.disturbance.as_ref().map_or_else(Vector::zeros, |own| own.at(t));
                let turn = &self.state.turn;
                self.surroundings
                    .as_ref()
                    .map_or(own, |of| own + of.torque(t, &turn.attitude, self.rigid.inertia()))
            },
            |two_way| two_way.environment_torque(t),
        );
        Some(all - self.magnetic_torque())
    }

    /// Returns the torque on the magnetic moment that magnetorquers hold at the current instant, in body axes (N m).
    pub fn magnetic_torque(&self) -> Vector {
        let held =
            |around: &SurroundingsState| around.magnetic_torque(self.evaluated_at.seconds(), self.attitude());
        self.surroundings.as_ref().map_or_else(Vector::zeros, held)
    }

    /// Returns the attitude of the hub at the current instant.
    pub fn attitude(&self) -> &Quaternion<f64> {
        self.coupled.as_deref().map_or(&self.state.turn.attitude, CoupledMotion::attitude)
    }

    /// Returns the motion about an axis as if that axis were alone, with the angle counted from `target` and the modes
    /// by their angles at the first sensor.
    pub fn about(&self, axis: usize, target: &Orientation) -> AxisState {
        let Orientation::Attitude(goal) = target else { return AxisState::default() };
        let phase = |(phase, shape): (&ModeState, &Vector)| ModeState {
            displacement: shape[axis] * phase.displacement,
            quadrature: shape[axis] * phase.quadrature,
        };
        AxisState {
            rigid_angle: rotation_vector(goal, &self.state.turn.attitude)[axis],
            rigid_rate: self.rigid.rate(&self.state.turn)[axis],
            modes: self.state.modes.iter().zip(&self.sensor_rotations).map(phase).collect(),
        }
    }

    /// Returns the state at the current instant, seen from the mean axes, which no mode rotates.
    pub fn state(&self) -> &ThreeAxisState {
        &self.state
    }

    /// Returns the rigid rates, and the elastic part of the rates at the first sensor (rad/s), of the last evaluation.
    pub fn rates(&self) -> (Vector, Vector) {
        self.rates
    }

    /// Returns the rates of the modes (m sqrt(kg)/s) at the current instant.
    pub fn mode_rates(&self) -> impl Iterator<Item = f64> {
        self.elastic.rates(&self.state.modes)
    }

    /// Returns the elastic energy (J) at the current instant: total, and of the modes visible to the first sensor. Slow
    /// modes with little rotation there are excluded, because no law can damp them.
    pub fn elastic_energies(&self) -> (f64, f64) {
        let sum = |(all, visible): (f64, f64), (energy, seen): (f64, &bool)| {
            (all + energy, if *seen { visible + energy } else { visible })
        };
        let none = (-0.0, -0.0);
        if self.coupled.is_none() && self.drifting.is_none() {
            return self.elastic.energies(&self.state.modes).zip(&self.visible).fold(none, sum);
        }
        self.energies().into_iter().zip(&self.visible).fold(none, sum)
    }

    /// Returns the energy of each mode at the current instant (J).
    fn energies(&self) -> Vec<f64> {
        match self.coupled.as_deref() {
            Some(two_way) if two_way.modes().is_some() => two_way.modal_energies().collect(),
            _ => match &self.drifting {
                Some(drifting) => drifting.energies(self.evaluated_at.seconds(), &self.state.modes),
                None => self.elastic.energies(&self.state.modes).collect(),
            },
        }
    }
}
