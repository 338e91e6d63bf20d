//! A body with three axes on its way, from one change of what acts on it to the next.

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

/// A mode is seen by a sensor that it turns by at least such a part of what the mode does that turns it most.
const VISIBLE: f64 = 0.1;

/// A motion under what is constant begins anew after so long (fs): looking at it is then soon done.
const LONGEST: i64 = 20_000_000_000_000_000;

/// The body, and what pushes it.
#[derive(Clone, Debug)]
pub struct SpatialPlant {
    rigid: Rigid,
    /// What is around it, and the disturbance of its own.
    around: Option<Around>,
    disturbance: Option<Periodic>,
    elastic: Elastic,
    /// The modes, where their frequencies drift.
    drifting: Option<DriftingModes>,
    /// Rotations of the modes at the first sensor, and where torques act.
    sensed: Vec<Vector>,
    hub: Vec<Vector>,
    /// By how much the rotations of the modes at all other sensors differ from those at the first.
    elsewhere: Vec<Vec<Vector>>,
    /// Whether the sensor sees each mode.
    visible: Vec<bool>,
    /// The state when the motion began.
    departed: Instant,
    origin: SpatialState,
    /// Torque about the centre of mass (N m), and modal forces (N/sqrt(kg)).
    torque: Vector,
    forces: Vec<f64>,
    /// Momentum of rotors (N m s), since when, and its rate (N m); none if there are none.
    rotors: Option<(Instant, Vector, Vector)>,
    /// The motion, where modes act back on the rotation: `state` then is what it looks like from the mean axes.
    two_way: Option<Box<TwoWay>>,
    /// The state at the instant seen last, and what there is to measure, once it was asked for.
    seen: Instant,
    state: SpatialState,
    truth: Truth,
    is_viewed: bool,
    /// Rigid rates, and their elastic part at the sensor (rad/s), of the same instant as `truth`.
    rates: (Vector, Vector),
}

impl SpatialPlant {
    /// The body of a study at the start, which nothing pushes; if it is `flexible`, its modes act back on its rotation.
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

    /// Brings the body to an instant, as long as the record lets it, or to one before at which a wheel comes to rest or lets go,
    /// which it tells. What is seen on the way does not change the motion.
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

    /// How wheels in bearings slip.
    pub fn slips(&self) -> &[Slip] {
        self.two_way.as_deref().map_or(&[], TwoWay::slips)
    }

    /// Heat of the friction of wheels since the start (J); not a number without bearings.
    pub fn friction_heat(&self) -> f64 {
        self.two_way.as_deref().and_then(TwoWay::friction_heat).unwrap_or(f64::NAN)
    }

    /// Wheels in bearings at the instant seen last; none without friction, imbalance and tachometer.
    pub fn borne(&self) -> Vec<SlippedRotor> {
        let began = self.departed.seconds();
        self.two_way.as_deref().map_or_else(Vec::new, |two_way| two_way.turned(began))
    }

    /// What there is to measure at the instant reached; none if the state is no longer finite.
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

    /// What there was to measure when that was asked last.
    pub fn viewed(&self) -> &Truth {
        &self.truth
    }

    /// What there was to measure then at another sensor than the first.
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

    /// Rotation of a point by all modes (rad).
    fn turned(&self, shapes: &[Vector]) -> Vector {
        let displacements = self.state.modes.iter().map(|phase| phase.displacement);
        displacements.zip(shapes).fold(Vector::zeros(), |sum, (q, shape)| sum + shape * q)
    }

    /// Views a body whose modes do not act back.
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

    /// Begins a new motion at the instant seen last, under what acts from now on.
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
        // What turns rotors one way turns the body the other.
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

    /// Momentum of the rotors of a body whose modes do not act back (N m s), and its rate (N m).
    fn rotors(&self, now: Instant) -> Option<(Vector, Vector)> {
        self.rotors.map(|(since, momentum, rate)| (momentum + rate * now.since(since).seconds(), rate))
    }

    /// The specific force at a place of a spacecraft at the instant seen last (m/s²), under what acts from then on.
    pub fn specific_force(&self, place: &Mount) -> Vector {
        let began = self.departed.seconds();
        self.two_way.as_deref().map_or_else(Vector::zeros, |two_way| two_way.specific_force(place, began))
    }

    /// Whether the scenario has an environment.
    pub fn is_surrounded(&self) -> bool {
        self.around.is_some()
    }

    /// The torque of the surroundings at the instant seen last, in the body's axes (N m), without that of torquers; none if there
    /// is nothing around.
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

    /// The torque of the moment that torquers hold at the instant seen last, in the body's axes (N m).
    pub fn magnetic(&self) -> Vector {
        let held = |around: &Around| around.held_torque(self.seen.seconds(), self.attitude());
        self.around.as_ref().map_or_else(Vector::zeros, held)
    }

    /// The attitude of the hub at the instant seen last.
    pub fn attitude(&self) -> &Quaternion<f64> {
        self.two_way.as_deref().map_or(&self.state.turn.attitude, TwoWay::attitude)
    }

    /// The motion about an axis beyond a target, as if that axis were alone: the modes by the angles that they make at the
    /// sensor.
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

    /// The state at the instant seen last, in axes that no mode turns.
    pub fn state(&self) -> &SpatialState {
        &self.state
    }

    /// Rigid rates, and their elastic part at the sensor (rad/s), at the instant viewed last.
    pub fn rates(&self) -> (Vector, Vector) {
        self.rates
    }

    /// Rates of the modes (m sqrt(kg)/s) at the instant seen last.
    pub fn mode_rates(&self) -> impl Iterator<Item = f64> {
        self.elastic.rates(&self.state.modes)
    }

    /// Energy of the elastic modes at the instant seen last (J), and of those that the sensor sees: the slow ones that it
    /// hardly sees keep theirs whatever the law does.
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

    /// The energy of each mode at the instant seen last (J).
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
