//! Flow of a three-axis body whose modes do not act back on its rotation.

use std::borrow::Cow;

use flexsc_control::estimator::WindowedEnvelope;
use flexsc_control::sensor::{Orientation, Truth};
use flexsc_dynamics::AxisState;
use flexsc_dynamics::flow::{DriftingModes, RigidBody, ThreeAxisState};
use flexsc_dynamics::frequency_drift::FrequencyDrift;
use flexsc_dynamics::periodic_torque::PeriodicTorque;
use flexsc_dynamics::three_axis::{Rotor, Surroundings};
use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_dynamics::wrench::Wrench;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{Record, RecordError};
use flexsc_spacecraft::environment::SurroundingsState;
use nalgebra::Quaternion;

use super::flow::{Flow, FlowQuantities};
use super::three_axis_body::{ThreeAxisBody, ThreeAxisQuantities};
use flexsc_scenario::ResolvedScenario;

/// Longest motion segment under constant loads (fs); then another begins, so that evaluating the motion stays cheap.
const LONGEST: i64 = 20_000_000_000_000_000;

/// Rotation of a rigid body, and modes that follow it.
#[derive(Clone, Debug)]
pub struct OneWayFlow {
    body: ThreeAxisBody,
    /// Environment, and (`disturbance`) the periodic disturbance torque of the body itself.
    surroundings: Option<SurroundingsState>,
    disturbance: Option<PeriodicTorque>,
    /// Modes with drifting frequencies, if they drift.
    drifting: Option<DriftingModes>,
    /// Start of the motion segment, and (`origin`) the state there.
    segment_start: Instant,
    origin: ThreeAxisState,
    /// Torque about the centre of mass (N m), and (`forces`) modal forces (N/sqrt(kg)).
    torque: Vector,
    forces: Vec<f64>,
    /// Instant, momentum of the rotors then (N m s) and its rate (N m); `None` without rotors.
    rotors: Option<(Instant, Vector, Vector)>,
}

impl OneWayFlow {
    /// Creates the flow at the start, without loads.
    pub fn new(spec: &ThreeAxisModel, study: &ResolvedScenario) -> Self {
        let body = ThreeAxisBody::new(spec, study);
        Self {
            surroundings: study.surroundings.clone(),
            disturbance: spec.disturbance,
            drifting: None,
            segment_start: Instant::START,
            origin: body.state.clone(),
            torque: Vector::zeros(),
            forces: Vec::new(),
            rotors: None,
            body,
        }
    }

    /// Returns the flow with drifting modal frequencies, if `drift` is given.
    #[must_use]
    pub fn with_drift(mut self, spec: &ThreeAxisModel, drift: Option<&FrequencyDrift>) -> Self {
        self.drifting = drift.map(|drift| DriftingModes::new(spec, drift));
        self
    }

    fn advance_within_segment(&mut self, now: Instant, record: &mut dyn Record) -> Result<(), RecordError> {
        if self.body.evaluated_at == now {
            return Ok(());
        }
        let h = now.since(self.segment_start).seconds();
        let began = self.segment_start.seconds();
        let rotors = self.rotors(self.segment_start);
        let body = &mut self.body;
        let turn = &mut body.state.turn;
        turn.clone_from(&self.origin.turn);
        let around = self.surroundings.as_ref().map(|around| around as &dyn Surroundings);
        body.rigid.advance(turn, &self.torque, rotors, around, (began, h), || record.poll())?;
        if let Some(drifting) = &mut self.drifting {
            drifting.advance(h, &mut body.state.modes);
        } else {
            body.state.modes.clone_from(&self.origin.modes);
            body.elastic.advance(&mut body.state.modes, &self.forces, h);
        }
        body.evaluated_at = now;
        body.has_truth = false;
        Ok(())
    }

    /// Begins a motion segment of drifting modes at the current start, under the modal forces from then on.
    fn begin_drift(&mut self) {
        if let Some(drifting) = &mut self.drifting {
            drifting.depart(self.segment_start.seconds(), &self.forces);
        }
    }

    /// Returns the momentum of the rotors (N m s) and its rate (N m).
    fn rotors(&self, now: Instant) -> Option<(Vector, Vector)> {
        self.rotors.map(|(since, momentum, rate)| (momentum + rate * now.since(since).seconds(), rate))
    }
}

impl Flow for OneWayFlow {
    fn begin_segment(&mut self, wrench: &Wrench) {
        self.segment_start = self.body.evaluated_at;
        if let Some(around) = &mut self.surroundings {
            around.set_magnetic_moment(wrench.moment);
        }
        self.origin.clone_from(&self.body.state);
        let sum = |of: fn(&Rotor) -> f64| -> Vector {
            wrench.rotors.iter().fold(Vector::zeros(), |sum, rotor| sum + rotor.axis * of(rotor))
        };
        let (stored, change) = (sum(|rotor| rotor.momentum), sum(|rotor| rotor.torque));
        self.rotors = (!wrench.rotors.is_empty()).then_some((self.body.evaluated_at, stored, change));
        // The torque that accelerates the rotors acts on the body with the opposite sign.
        let hub = Vector::from(wrench.hub) - change;
        self.torque = wrench.torque + hub;
        self.forces.clear();
        self.forces.extend_from_slice(&wrench.forces);
        if hub != Vector::zeros() {
            let rotations = &self.body.torque_rotations;
            self.forces.resize(rotations.len(), 0.0);
            self.forces.iter_mut().zip(rotations).for_each(|(force, shape)| *force += shape.dot(&hub));
        }
        self.begin_drift();
    }

    /// Advances the body to `now`; intermediate evaluations do not change the motion.
    fn advance(&mut self, now: Instant, record: &mut dyn Record) -> Result<Option<Instant>, RecordError> {
        record.poll()?;
        let longest = Span::from_femtoseconds(LONGEST);
        while now > self.segment_start + longest {
            self.advance_within_segment(self.segment_start + longest, record)?;
            self.origin.clone_from(&self.body.state);
            self.segment_start = self.body.evaluated_at;
            self.begin_drift();
        }
        self.advance_within_segment(now, record).map(|()| None)
    }

    fn evaluate(&mut self, _now: Instant, truth: &mut Truth) -> bool {
        let body = &mut self.body;
        if body.has_truth {
            return true;
        }
        let (turn, modes) = (&body.state.turn, &body.state.modes);
        let (rigid, elastic) = (body.rigid.rate(turn), body.elastic.rate_at(&body.sensor_rotations, modes));
        let angle = body.modal_rotation(&body.sensor_rotations);
        truth.orientation = Orientation::Attitude(turn.attitude);
        truth.elastic = angle.into();
        truth.rate = (rigid + elastic).into();
        truth.rigid_rate = rigid.into();
        truth.rate_integral = (RigidBody::rigid_angle(turn) + angle).into();
        body.rates = (rigid, elastic);
        if let Some(around) = &self.surroundings {
            truth.environment = around.observation(body.evaluated_at.seconds());
        }
        // A number of the state that is not finite makes one of these infinite or NaN: each mode is part of the sums.
        let sums = truth.rate.iter().chain(&truth.elastic).chain(&truth.rigid_rate);
        body.has_truth = sums.chain(turn.attitude.coords.iter()).all(|number| number.is_finite());
        body.has_truth
    }

    fn about_axis(&self, axis: usize, target: &Orientation) -> Cow<'_, AxisState> {
        Cow::Owned(self.body.about_axis(axis, target))
    }

    fn modal_state(&self) -> Cow<'_, AxisState> {
        Cow::Owned(self.body.modal_state())
    }

    fn update_monitor(
        &self,
        monitor: &mut WindowedEnvelope,
        now: Instant,
        _torque: f64,
        commanded: &dyn Fn() -> Wrench,
    ) {
        monitor.push(now, &self.body.modal_state(), &self.body.modal_forces(&commanded()));
    }

    fn quantities(&self) -> FlowQuantities<'_> {
        FlowQuantities::ThreeAxis(self)
    }

    fn copy(&self) -> Box<dyn Flow> {
        Box::new(self.clone())
    }
}

impl ThreeAxisQuantities for OneWayFlow {
    fn body(&self) -> &ThreeAxisBody {
        &self.body
    }

    fn surroundings(&self) -> Option<&SurroundingsState> {
        self.surroundings.as_ref()
    }

    fn attitude(&self) -> &Quaternion<f64> {
        &self.body.state.turn.attitude
    }

    fn external_torque(&self) -> Option<Vector> {
        if self.surroundings.is_none() && self.disturbance.is_none() {
            return None;
        }
        let t = self.body.evaluated_at.seconds();
        let own = self.disturbance.as_ref().map_or_else(Vector::zeros, |own| own.at(t));
        let inertia = self.body.rigid.inertia();
        Some(
            self.surroundings
                .as_ref()
                .map_or(own, |of| own + of.torque(&of.sky_at(t), self.attitude(), inertia)),
        )
    }

    fn rotational_energy(&self) -> (f64, f64) {
        let turn = &self.body.state.turn;
        let momentum = RigidBody::momentum(turn);
        let whole = self.rotors(self.body.evaluated_at).map_or(momentum, |(rotors, _)| momentum + rotors);
        (self.body.rigid.energy(turn), whole.norm())
    }

    fn modal_energies(&self) -> Vec<f64> {
        let ThreeAxisBody { elastic, state, evaluated_at, .. } = &self.body;
        match &self.drifting {
            Some(drifting) => drifting.energies(evaluated_at.seconds(), &state.modes),
            None => elastic.energies(&state.modes).collect(),
        }
    }

    fn elastic_energies(&self) -> (f64, f64) {
        match &self.drifting {
            Some(_) => self.body.sum_energies(self.modal_energies().into_iter()),
            None => self.body.sum_energies(self.body.elastic.energies(&self.body.state.modes)),
        }
    }

    fn fastest_frequency(&self) -> f64 {
        let ThreeAxisBody { elastic, rigid, state, evaluated_at, .. } = &self.body;
        let t = evaluated_at.seconds();
        let drifted = self.drifting.as_ref().map_or(1.0, |drifting| drifting.ratio(t).max(1.0));
        let own = self.disturbance.as_ref().map_or(0.0, PeriodicTorque::frequency);
        let around = self.surroundings.as_ref().map_or(0.0, Surroundings::frequency);
        let stored = self.rotors(*evaluated_at).map_or(0.0, |(rotors, _)| rotors.norm());
        drifted * elastic.fastest() + own + around + rigid.fastest(&state.turn, stored)
    }
}
