//! Plant of a three-axis body, advanced from one change of the loads to the next.

use nalgebra::Quaternion;

use super::UNSEEN;
use super::two_way::{Mount, TwoWay};
use crate::attitude::{Vector, rotation_vector};
use crate::body::spatial::Periodic;
use crate::environment::Around;
use crate::flow::{DriftingModes, Elastic, Rigid, SpatialState};
use crate::motion::turning::{Flexible, Rotor, Slip, SlippedRotor, Surroundings};
use crate::motion::{Phase, State};
use crate::record::{Record, RecordError};
use crate::scenario::Study;
use crate::sensor::{Orientation, Truth};
use crate::time::{Instant, Span};
use crate::wrench::Wrench;

mod fastest;
mod logged;
mod swinging;

/// A mode is visible to a sensor if it rotates the sensor by at least this fraction of the largest modal rotation
/// there.
const VISIBLE: f64 = 0.1;

/// Longest motion segment under constant loads (fs); then another begins, so that evaluating the motion stays cheap.
const LONGEST: i64 = 20_000_000_000_000_000;

/// Three-axis body with its loads.
#[derive(Clone, Debug)]
pub struct SpatialPlant {
    rigid: Rigid,
    /// Environment, and (`disturbance`) the periodic disturbance torque of the body itself.
    around: Option<Around>,
    disturbance: Option<Periodic>,
    elastic: Elastic,
    /// Modes with drifting frequencies, if they drift.
    drifting: Option<DriftingModes>,
    /// Modal rotations at the first sensor, and (`hub`) at the point where torques act.
    sensed: Vec<Vector>,
    hub: Vec<Vector>,
    /// Differences of the modal rotations at each other sensor from those at the first.
    elsewhere: Vec<Vec<Vector>>,
    /// True for modes that are visible to the first sensor.
    visible: Vec<bool>,
    /// Start of the motion segment, and (`origin`) the state there.
    departed: Instant,
    origin: SpatialState,
    /// Torque about the centre of mass (N m), and (`forces`) modal forces (N/sqrt(kg)).
    torque: Vector,
    forces: Vec<f64>,
    /// Instant, momentum of the rotors then (N m s) and its rate (N m); `None` without rotors.
    rotors: Option<(Instant, Vector, Vector)>,
    /// Motion with modes that act back on the rotation; `state` is then the motion seen from the mean axes.
    two_way: Option<Box<TwoWay>>,
    /// Current instant, (`state`) the state there, and (`truth`) the true state at the last evaluation.
    seen: Instant,
    state: SpatialState,
    truth: Truth,
    is_viewed: bool,
    /// Rigid rates, and elastic part of the rates at the first sensor (rad/s), of the same instant as `truth`.
    rates: (Vector, Vector),
}

impl SpatialPlant {
    /// Creates the plant at the start, without loads; with `flexible`, the modes act back on the rotation.
    pub fn new(body: &crate::body::Spatial, flexible: Option<&Flexible>, study: &Study) -> Self {
        let rigid = Rigid::new(body);
        let origin = SpatialState::start(body, &rigid);
        let rotations = |point: &str| -> Vec<Vector> {
            body.shapes(point).into_iter().map(|(_, rotation)| rotation).collect()
        };
        let (first, others) =
            study.sensed_at.split_first().map_or(("", &[][..]), |(first, others)| (first, others));
        let sensed = rotations(first);
        let beyond_first = |point: &String| -> Vec<Vector> {
            rotations(point).iter().zip(&sensed).map(|(there, first)| there - first).collect()
        };
        let elsewhere = others.iter().map(beyond_first).collect();
        let hub = rotations(&study.acts_at);
        let around = study.around.clone();
        let two_way = flexible.map(|of| {
            let shapes = [&sensed[..], &hub];
            let two_way = TwoWay::new(
                body,
                of,
                around.clone(),
                study.moving.clone(),
                shapes,
                (&study.bearings, &study.common),
            );
            Box::new(two_way.driven(study.drives.as_ref()))
        });
        let most = sensed.iter().map(Vector::norm).fold(0.0, f64::max);
        Self {
            rigid,
            around,
            disturbance: body.disturbance.clone(),
            elastic: Elastic::new(body, study.tick.seconds()),
            drifting: None,
            visible: sensed.iter().map(|rotation| rotation.norm() >= VISIBLE * most).collect(),
            sensed,
            hub,
            elsewhere,
            departed: Instant::START,
            torque: Vector::zeros(),
            forces: Vec::new(),
            rotors: None,
            two_way,
            seen: Instant::START,
            state: origin.clone(),
            truth: UNSEEN,
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
        if self.two_way.is_some() {
            return self.go(now, record);
        }
        let longest = Span::from_femtoseconds(LONGEST);
        while now > self.departed + longest {
            self.go(self.departed + longest, record)?;
            self.origin.clone_from(&self.state);
            self.departed = self.seen;
            self.drift_on();
        }
        self.go(now, record)
    }

    fn go(&mut self, now: Instant, record: &mut dyn Record) -> Result<Option<Instant>, RecordError> {
        let mut met = None;
        if self.seen != now {
            let h = now.since(self.departed).seconds();
            let began = self.departed.seconds();
            if let Some(two_way) = &mut self.two_way {
                if let Some(h) = two_way.advance(h, began, || record.poll())? {
                    let at = (self.departed + Span::from_seconds(h)).min(now);
                    two_way.reach(at.since(self.departed).seconds(), began);
                    met = Some(at);
                }
                two_way.show(&self.rigid, &mut self.state);
                if let Some((_, rotations)) = two_way.modes() {
                    self.sensed.copy_from_slice(rotations);
                }
            } else {
                let rotors = self.rotors(self.departed);
                let turn = &mut self.state.turn;
                turn.clone_from(&self.origin.turn);
                let around = self.around.as_ref().map(|around| around as &dyn Surroundings);
                self.rigid.advance(turn, &self.torque, rotors, around, (began, h), || record.poll())?;
                if let Some(drifting) = &mut self.drifting {
                    drifting.go(h, &mut self.state.modes);
                } else {
                    self.state.modes.clone_from(&self.origin.modes);
                    self.elastic.advance(&mut self.state.modes, &self.forces, h);
                }
            }
            self.seen = met.unwrap_or(now);
            self.is_viewed = false;
        }
        Ok(met)
    }

    /// Returns the slip states of the wheels in bearings.
    pub fn slips(&self) -> &[Slip] {
        self.two_way.as_deref().map_or(&[], TwoWay::slips)
    }

    /// Returns the heat of the wheels' friction since the start (J); NaN without bearings.
    pub fn friction_heat(&self) -> f64 {
        self.two_way.as_deref().and_then(TwoWay::friction_heat).unwrap_or(f64::NAN)
    }

    /// Returns the states of the wheels in bearings at the current instant; empty without friction, imbalance and
    /// tachometer.
    pub fn borne(&self) -> Vec<SlippedRotor> {
        let began = self.departed.seconds();
        self.two_way.as_deref().map_or_else(Vec::new, |two_way| two_way.turned(began))
    }

    /// Evaluates the true state at the current instant; `None` if it is no longer finite.
    pub fn measurable(&mut self) -> Option<&Truth> {
        if !self.is_viewed {
            if !self.state.is_finite() {
                return None;
            }
            if let Some(two_way) = self.two_way.as_deref() {
                let elastic = two_way.measure(&self.sensed, &mut self.truth);
                self.rates = (self.truth.rigid.into(), elastic);
            } else {
                self.view_one_way();
            }
            if let Some(around) = &self.around {
                self.truth.sky = around.seen(self.seen.seconds());
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
        let (first, shapes) = (&self.truth, &self.elsewhere[sensor - 1]);
        let (angle, rate) = (self.turned(shapes), self.elastic.rate_at(shapes, &self.state.modes));
        Truth {
            elastic: (Vector::from(first.elastic) + angle).into(),
            rate: (Vector::from(first.rate) + rate).into(),
            turned: (Vector::from(first.turned) + angle).into(),
            ..*first
        }
    }

    /// Returns the rotation of a point by all modes (rad).
    fn turned(&self, shapes: &[Vector]) -> Vector {
        let displacements = self.state.modes.iter().map(|phase| phase.displacement);
        displacements.zip(shapes).fold(Vector::zeros(), |sum, (q, shape)| sum + shape * q)
    }

    /// Evaluates the true state of a body whose modes do not act back on the rotation.
    fn view_one_way(&mut self) {
        let (turn, modes) = (&self.state.turn, &self.state.modes);
        let (rigid, elastic) = (self.rigid.rate(turn), self.elastic.rate_at(&self.sensed, modes));
        let angle = self.turned(&self.sensed);
        let truth = &mut self.truth;
        truth.orientation = Orientation::Attitude(turn.attitude);
        truth.elastic = angle.into();
        truth.rate = (rigid + elastic).into();
        truth.rigid = rigid.into();
        truth.turned = (Rigid::turned(turn) + angle).into();
        self.rates = (rigid, elastic);
    }

    /// Begins a motion segment at the current instant, under the loads from now on.
    pub fn depart(&mut self, wrench: &Wrench) {
        self.departed = self.seen;
        if let Some(around) = &mut self.around {
            around.hold(wrench.moment);
        }
        if let Some(two_way) = &mut self.two_way {
            two_way.depart(wrench, self.departed.seconds());
            two_way.show(&self.rigid, &mut self.state);
            return;
        }
        self.origin.clone_from(&self.state);
        let sum = |of: fn(&Rotor) -> f64| -> Vector {
            wrench.rotors.iter().fold(Vector::zeros(), |sum, rotor| sum + rotor.axis * of(rotor))
        };
        let (stored, change) = (sum(|rotor| rotor.momentum), sum(|rotor| rotor.torque));
        self.rotors = (!wrench.rotors.is_empty()).then_some((self.seen, stored, change));
        // The torque that accelerates the rotors acts on the body with the opposite sign.
        let hub = Vector::from(wrench.hub) - change;
        self.torque = wrench.torque + hub;
        self.forces.clear();
        self.forces.extend_from_slice(&wrench.forces);
        if hub != Vector::zeros() {
            self.forces.resize(self.hub.len(), 0.0);
            self.forces.iter_mut().zip(&self.hub).for_each(|(force, shape)| *force += shape.dot(&hub));
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
    pub fn specific_force(&self, place: &Mount) -> Vector {
        let began = self.departed.seconds();
        self.two_way.as_deref().map_or_else(Vector::zeros, |two_way| two_way.specific_force(place, began))
    }

    /// Returns true if the scenario has an environment.
    pub fn is_surrounded(&self) -> bool {
        self.around.is_some()
    }

    /// Returns the torque of the environment and of the body's own disturbance at the current instant, in body axes (N
    /// m), without that of magnetorquers; `None` if there is neither.
    pub fn surroundings(&self) -> Option<Vector> {
        let t = self.seen.seconds();
        if self.around.is_none() && self.disturbance.is_none() {
            return None;
        }
        let all = self.two_way.as_deref().map_or_else(
            || {
                let own = self.disturbance.as_ref().map_or_else(Vector::zeros, |own| own.at(t));
                let turn = &self.state.turn;
                self.around
                    .as_ref()
                    .map_or(own, |of| own + of.torque(t, &turn.attitude, self.rigid.inertia()))
            },
            |two_way| two_way.exerted(t),
        );
        Some(all - self.magnetic())
    }

    /// Returns the torque on the magnetic moment that magnetorquers hold at the current instant, in body axes (N m).
    pub fn magnetic(&self) -> Vector {
        let held = |around: &Around| around.held_torque(self.seen.seconds(), self.attitude());
        self.around.as_ref().map_or_else(Vector::zeros, held)
    }

    /// Returns the attitude of the hub at the current instant.
    pub fn attitude(&self) -> &Quaternion<f64> {
        self.two_way.as_deref().map_or(&self.state.turn.attitude, TwoWay::attitude)
    }

    /// Returns the motion about an axis as if that axis were alone, with the angle counted from `target` and the modes
    /// by their angles at the first sensor.
    pub fn about(&self, axis: usize, target: &Orientation) -> State {
        let Orientation::Attitude(goal) = target else { return State::default() };
        let phase = |(phase, shape): (&Phase, &Vector)| Phase {
            displacement: shape[axis] * phase.displacement,
            quadrature: shape[axis] * phase.quadrature,
        };
        State {
            rigid_angle: rotation_vector(goal, &self.state.turn.attitude)[axis],
            rigid_rate: self.rigid.rate(&self.state.turn)[axis],
            modes: self.state.modes.iter().zip(&self.sensed).map(phase).collect(),
        }
    }

    /// Returns the state at the current instant, seen from the mean axes, which no mode rotates.
    pub fn state(&self) -> &SpatialState {
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
        if self.two_way.is_none() && self.drifting.is_none() {
            return self.elastic.energies(&self.state.modes).zip(&self.visible).fold(none, sum);
        }
        self.energies().into_iter().zip(&self.visible).fold(none, sum)
    }

    /// Returns the energy of each mode at the current instant (J).
    fn energies(&self) -> Vec<f64> {
        match self.two_way.as_deref() {
            Some(two_way) if two_way.modes().is_some() => two_way.modal_energies().collect(),
            _ => match &self.drifting {
                Some(drifting) => drifting.energies(self.seen.seconds(), &self.state.modes),
                None => self.elastic.energies(&self.state.modes).collect(),
            },
        }
    }
}
