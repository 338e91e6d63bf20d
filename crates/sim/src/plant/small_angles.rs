//! Flow of a three-axis body that rotates little about a fixed target: linear, in closed form, with certified crossings.
//!
//! The modes are free, so that it does not matter whether the body describes them with or without their action on the
//! rotation: the mean axes rotate by theta'' = J^-1 M alone. The hub's attitude is the target rotated by theta plus the
//! modes' rotations of the hub.

use std::borrow::Cow;

use flexsc_control::estimator::WindowedEnvelope;
use flexsc_control::sensor::{Orientation, Truth};
use flexsc_dynamics::crossing::first_crossing;
use flexsc_dynamics::flow::{SmallAngleGuard, SmallAngleSegment, SmallAngleState};
use flexsc_dynamics::guard::{AxisGuards, GuardCrossing};
use flexsc_dynamics::three_axis::{FlexibleBody, Rotor};
use flexsc_dynamics::three_axis_model::{SmallAngleBounds, ThreeAxisModel};
use flexsc_dynamics::wrench::Wrench;
use flexsc_dynamics::{AngleObservation, AxisState};
use flexsc_numerics::attitude::{Vector, rotation, rotation_vector, vector};
use flexsc_numerics::inverse::inverse_3x3;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{Record, RecordError};
use flexsc_spacecraft::environment::SurroundingsState;
use nalgebra::{Matrix3, Quaternion};

use super::flow::{ExceededLimit, Flow, FlowQuantities};
use super::three_axis_body::{ThreeAxisBody, ThreeAxisQuantities};
use flexsc_scenario::ResolvedScenario;

/// Small rotation of a three-axis body about its target.
#[derive(Clone, Debug)]
pub struct SmallAnglesFlow {
    body: ThreeAxisBody,
    limits: SmallAngleBounds,
    /// Fixed target from which angles are counted, and (`hub`) the attitude of the hub at the current instant.
    target: Quaternion<f64>,
    hub: Quaternion<f64>,
    /// Rotations of the hub by the modes (rad/(m sqrt(kg))); empty if the modes do not rotate it.
    hub_rotations: Vec<Vector>,
    inverse_inertia: Matrix3<f64>,
    /// Constant torque on the body itself (N m); `None` without one.
    disturbance: Option<Vector>,
    surroundings: Option<SurroundingsState>,
    segment: SmallAngleSegment,
    /// Start of the motion segment.
    segment_start: Instant,
    /// Rotation of the mean axes at the start of the run (rad).
    first_angles: Vector,
    /// State, and motion at the first sensor, at the current instant.
    now: SmallAngleMotion,
    /// Motion at the next guard crossing, computed in advance, and its instant.
    next_crossing: (SmallAngleMotion, Instant),
    /// Limit that this segment reaches first.
    limit: Option<ExceededLimit>,
    /// Instant, momentum of the rotors then (N m s) and its rate (N m).
    rotors: (Instant, Vector, Vector),
}

/// State of a small rotation, with the motion at the first sensor about each axis.
#[derive(Clone, Debug)]
struct SmallAngleMotion {
    state: SmallAngleState,
    sensed: [AngleObservation; 3],
}

impl SmallAnglesFlow {
    /// Creates the flow at the start, without loads.
    pub fn new(
        spec: &ThreeAxisModel,
        limits: SmallAngleBounds,
        flexible: Option<&FlexibleBody>,
        study: &ResolvedScenario,
    ) -> Self {
        let body = ThreeAxisBody::new(spec, study);
        let target = study.profile.target(Instant::START);
        let state = SmallAngleState {
            angles: rotation_vector(&target, &spec.attitude.get()),
            rates: vector(&spec.rate),
            modes: body.state.modes.clone(),
        };
        let mut segment = SmallAngleSegment::new(spec, &body.sensor_rotations);
        segment.depart(&state, Vector::zeros(), &vec![0.0; state.modes.len()]);
        let sensed = segment.at(0.0, &mut state.clone());
        let hub_modes = flexible.map_or(&[][..], |flexible| &flexible.modes);
        let inertia = spec.inertia;
        let motion = SmallAngleMotion { state, sensed };
        let mut flow = Self {
            limits,
            target,
            hub: target,
            hub_rotations: hub_modes.iter().map(|mode| mode.rotation).collect(),
            // A validated body has an inverse.
            inverse_inertia: inverse_3x3(inertia).unwrap_or_else(Matrix3::identity),
            disturbance: spec.disturbance.as_ref().map(|of| of.constant),
            surroundings: study.surroundings.clone(),
            segment,
            segment_start: Instant::START,
            first_angles: motion.state.angles,
            next_crossing: (motion.clone(), Instant::START),
            now: motion,
            limit: None,
            rotors: (Instant::START, Vector::zeros(), Vector::zeros()),
            body,
        };
        flow.write_state();
        flow
    }

    /// Writes the current state into that of the body, and the attitude of the hub.
    fn write_state(&mut self) {
        let SmallAngleState { angles, rates, modes } = &self.now.state;
        let state = &mut self.body.state;
        state.turn = self.body.rigid.start(self.target * rotation(angles), *rates);
        state.modes.clone_from(modes);
        self.hub = self.target * rotation(&(angles + self.body.modal_rotation(&self.hub_rotations)));
    }

    /// Returns the momentum of the rotors (N m s).
    fn stored(&self) -> Vector {
        let (since, momentum, rate) = self.rotors;
        momentum + rate * self.body.evaluated_at.since(since).seconds()
    }
}

impl Flow for SmallAnglesFlow {
    fn begin_segment(&mut self, wrench: &Wrench) {
        let now = self.body.evaluated_at;
        let sum = |of: fn(&Rotor) -> f64| -> Vector {
            wrench.rotors.iter().fold(Vector::zeros(), |sum, rotor| sum + rotor.axis * of(rotor))
        };
        self.rotors = (now, sum(|rotor| rotor.momentum), sum(|rotor| rotor.torque));
        // The torque that accelerates the rotors acts on the body with the opposite sign.
        let torque = wrench.torque + (Vector::from(wrench.hub) - self.rotors.2);
        let torque = self.disturbance.map_or(torque, |constant| torque + constant);
        self.segment.depart(&self.now.state, self.inverse_inertia * torque, &self.body.modal_forces(wrench));
        self.segment_start = now;
        // A crossing that was found in advance belongs to the previous motion.
        self.next_crossing.1 = Instant::START;
        self.limit = self.segment.first_limit(&self.limits).map(|(after, axis, is_rate)| ExceededLimit {
            at: now + Span::from_seconds(after),
            axis,
            is_rate,
            limit: if is_rate { self.limits.rate } else { self.limits.angle },
        });
    }

    fn advance(&mut self, now: Instant, record: &mut dyn Record) -> Result<Option<Instant>, RecordError> {
        record.poll()?;
        if self.body.evaluated_at == now {
            return Ok(None);
        }
        if self.next_crossing.1 == now {
            std::mem::swap(&mut self.now, &mut self.next_crossing.0);
        } else {
            let h = now.since(self.segment_start).seconds();
            self.now.sensed = self.segment.at(h, &mut self.now.state);
        }
        (self.body.evaluated_at, self.body.has_truth) = (now, false);
        self.write_state();
        Ok(None)
    }

    fn evaluate(&mut self, _now: Instant, truth: &mut Truth) -> bool {
        if self.body.has_truth {
            return true;
        }
        if !self.body.state.is_finite() || self.exceeded_limit().is_some() {
            return false;
        }
        let SmallAngleMotion { state, sensed } = &self.now;
        let angles = Vector::from(sensed.map(|sensed| sensed.angle));
        let elastic = self.body.elastic.rate_at(&self.body.sensor_rotations, &state.modes);
        truth.orientation = Orientation::Attitude(self.hub);
        // From the hub, so that a sensor reads the sum of the small rotations.
        truth.elastic = rotation_vector(&self.hub, &(self.target * rotation(&angles))).into();
        truth.rate = (state.rates + elastic).into();
        truth.rigid_rate = state.rates.into();
        truth.rate_integral = (angles - self.first_angles).into();
        self.body.rates = (state.rates, elastic);
        if let Some(around) = &self.surroundings {
            truth.environment = around.observation(self.body.evaluated_at.seconds());
        }
        self.body.has_truth = true;
        true
    }

    fn exceeded_limit(&self) -> Option<ExceededLimit> {
        self.limit.filter(|limit| limit.at < self.body.evaluated_at)
    }

    fn crossing(
        &mut self,
        guards: AxisGuards<'_>,
        horizon: Span,
        record: &mut dyn Record,
    ) -> Result<Option<GuardCrossing>, RecordError> {
        let about = |(axis, guards): (usize, &'_ &[_])| -> Vec<SmallAngleGuard> {
            let of = |(index, guard): (usize, &_)| SmallAngleGuard { axis, index, guard: *guard };
            guards.iter().enumerate().map(of).collect()
        };
        let guards: Vec<SmallAngleGuard> = guards.iter().enumerate().flat_map(about).collect();
        let state = &mut self.next_crossing.0.state;
        let trip = first_crossing(&self.segment, &guards, horizon, state, || record.poll())?;
        Ok(trip.map(|trip| {
            let at = self.segment_start + trip.after;
            (self.next_crossing.0.sensed, self.next_crossing.1) = (trip.observation, at);
            let SmallAngleGuard { axis, index, .. } = guards[trip.guard];
            GuardCrossing { at, axis, guard: index }
        }))
    }

    /// Returns the angles on which guards are tested: the target is the origin at every instant.
    fn sensed_angles(&self, _truth: &Truth, _origin: &Orientation) -> [f64; 3] {
        self.now.sensed.map(|sensed| sensed.angle)
    }

    fn about_axis(&self, axis: usize, target: &Orientation) -> Cow<'_, AxisState> {
        let rigid_angle = self.now.state.angles[axis];
        Cow::Owned(AxisState { rigid_angle, ..self.body.about_axis(axis, target) })
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

impl ThreeAxisQuantities for SmallAnglesFlow {
    fn body(&self) -> &ThreeAxisBody {
        &self.body
    }

    fn surroundings(&self) -> Option<&SurroundingsState> {
        self.surroundings.as_ref()
    }

    fn attitude(&self) -> &Quaternion<f64> {
        &self.hub
    }

    fn external_torque(&self) -> Option<Vector> {
        self.disturbance.or_else(|| self.surroundings.as_ref().map(|_| Vector::zeros()))
    }

    fn rotational_energy(&self) -> (f64, f64) {
        let rates = &self.now.state.rates;
        let momentum = self.body.rigid.inertia() * rates;
        (0.5 * momentum.dot(rates), (momentum + self.stored()).norm())
    }

    fn modal_energies(&self) -> Vec<f64> {
        self.body.elastic.energies(&self.body.state.modes).collect()
    }

    fn elastic_energies(&self) -> (f64, f64) {
        self.body.sum_energies(self.body.elastic.energies(&self.body.state.modes))
    }

    fn fastest_frequency(&self) -> f64 {
        self.body.elastic.fastest() + self.now.state.rates.norm()
    }
}
