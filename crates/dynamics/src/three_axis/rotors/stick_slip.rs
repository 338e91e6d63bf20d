//! Stick-slip of the rotors: a linear complementarity problem at each instant at which rotors may stick or break
//! away.
//!
//! A rotor at rest sticks if its bearing can provide the torque with which it turns with the body; otherwise it slips
//! in the direction in which it is driven. All rotors at rest are coupled by the body and decided together: the first
//! that is inconsistent is changed, repeatedly, which terminates for a positive definite problem (\[Murty74\]).

use flexsc_numerics::attitude::Vector;
use nalgebra::Matrix3;

use super::bearing::{BearingLoads, RotorState, SlipDirection};
use crate::three_axis::constants::tensor;
use crate::three_axis::motion::ThreeAxisMotion;
use crate::three_axis::segment_loads::SegmentLoads;
use crate::three_axis::small_rotation::SmallRotation;
use crate::three_axis::state::BodyView;
use crate::three_axis::surroundings::TimedSurroundings;

/// Fraction of the breakaway torque up to which a rotor is held; the margin exceeds rounding at the instant of
/// breakaway.
const HOLDING_FRACTION: f64 = 1.0 - 1e-12;

/// Speed below which a rotor is at rest (rad/s).
const AT_REST: f64 = 1e-12;

/// Motion of a rotor in a bearing at an instant.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct RotorObservation {
    /// Absolute angular momentum of the rotor about its axis (N m s).
    pub momentum: f64,
    /// Speed relative to the body (rad/s).
    pub speed: f64,
    /// Angle relative to the body since the start (rad).
    pub angle: f64,
    /// Friction torque, opposing the motor torque (N m).
    pub friction: f64,
    /// Friction heat since the start (J).
    pub heat: f64,
    /// Stick or slip state.
    pub slip: SlipDirection,
}

impl ThreeAxisMotion {
    /// Returns the rotors in bearings with the given slip states.
    pub(in crate::three_axis) fn current_bearings<'a>(
        &'a self,
        slips: &'a [SlipDirection],
    ) -> BearingLoads<'a> {
        let count = self.loads.rotors.len().min(self.bearings.len());
        BearingLoads { bearings: &self.bearings[..count], rotors: &self.loads.rotors, slips: &slips[..count] }
    }

    /// Returns the acceleration of the hub (rad/s²) at the current instant for given slip states.
    pub(in crate::three_axis) fn acceleration(
        &self,
        slips: &[SlipDirection],
        surroundings: TimedSurroundings,
    ) -> Vector {
        self.accelerations_with(slips, surroundings).hub
    }

    /// Adds the momenta of rotors and gimbals that were not present before.
    pub(in crate::three_axis) fn add_rotors(&mut self, loads: &SegmentLoads) {
        let elastic_rotation = self
            .current
            .modes
            .iter()
            .zip(&self.model.modes)
            .fold(Vector::zeros(), |sum, ([q, ..], mode)| sum + mode.rotation * *q);
        for (index, rotor) in loads.rotors.iter().enumerate().skip(self.loads.rotors.len()) {
            self.current.mean_momentum +=
                SmallRotation::new(elastic_rotation).to_mean_axes(&(rotor.axis * rotor.momentum));
            if index < self.bearings.len() {
                self.slips[index] = self.initial_slip(index, &rotor.axis, rotor.momentum);
                self.current.rotor_states[index].values.x = rotor.momentum;
            }
        }
        for gimbal in loads.gimbals.iter().skip(self.loads.gimbals.len()) {
            self.current.mean_momentum +=
                SmallRotation::new(elastic_rotation).to_mean_axes(&gimbal.at(0.0).0);
        }
    }

    /// Resolves stick or slip of the rotors at rest at the start of a segment, under its loads.
    pub fn resolve_stick_slip(&mut self, surroundings: TimedSurroundings) {
        if !self.can_stick() {
            return;
        }
        let bearings_now = self.current_bearings(&self.slips);
        let rate = self.view.rate;
        let rests = |index: usize| {
            let slips = self.slips[index] != SlipDirection::Stuck && !self.at_event[index];
            self.bearings[index].can_stick() && !slips
        };
        let stopped: Vec<usize> = (0..bearings_now.rotors.len()).filter(|index| rests(*index)).collect();
        if stopped.is_empty() {
            return;
        }
        let with_body =
            |index: usize| self.bearings[index].inertia * self.loads.rotors[index].axis.dot(&rate);
        let momenta: Vec<f64> = stopped.iter().map(|index| with_body(*index)).collect();
        for (index, momentum) in stopped.iter().zip(momenta) {
            let rotor_state = &mut self.current.rotor_states[*index];
            (rotor_state.values.x, rotor_state.rounding.x) = (momentum, 0.0);
            (self.slips[*index], self.at_event[*index]) = (SlipDirection::Stuck, false);
        }
        let mut slips = self.slips.clone();
        for _ in 0..1_usize << (stopped.len() + 1).min(10) {
            let acceleration = self.acceleration(&slips, surroundings);
            let inconsistent =
                stopped.iter().find_map(|index| self.inconsistent_slip(*index, slips[*index], &acceleration));
            let Some((index, slip)) = inconsistent else { break };
            slips[index] = slip;
        }
        self.slips = slips;
        self.initial.copy_from(&self.current);
        self.grid.copy_from(&self.current);
        self.invalidate_step();
        self.update_view();
    }

    /// Returns the next slip state of a rotor at rest if `slip` is inconsistent with the hub's acceleration (rad/s²).
    fn inconsistent_slip(
        &self,
        index: usize,
        slip: SlipDirection,
        acceleration: &Vector,
    ) -> Option<(usize, SlipDirection)> {
        let (bearing, rotor) = (&self.bearings[index], &self.loads.rotors[index]);
        let along = rotor.axis.dot(acceleration);
        if slip == SlipDirection::Stuck {
            let friction = rotor.torque - bearing.inertia * along;
            return (friction.abs() > bearing.breakaway * HOLDING_FRACTION)
                .then(|| (index, SlipDirection::from_speed(friction)));
        }
        let torque = rotor.torque - bearing.friction(0.0, slip);
        let reversal = slip.sign() * (bearing.inertia * along - torque);
        (reversal > bearing.breakaway * (1.0 - HOLDING_FRACTION)).then_some((index, SlipDirection::Stuck))
    }

    /// Returns the slip state of a new rotor of the given momentum (N m s).
    pub(in crate::three_axis) fn initial_slip(
        &self,
        index: usize,
        axis: &Vector,
        momentum: f64,
    ) -> SlipDirection {
        let bearing = &self.bearings[index];
        let speed = momentum / bearing.inertia - axis.dot(&self.view.rate);
        match () {
            () if !bearing.can_stick() => SlipDirection::Forward,
            () if speed.abs() < AT_REST => SlipDirection::Stuck,
            () => SlipDirection::from_speed(speed),
        }
    }

    /// Returns the slip states of the rotors in bearings.
    pub fn slip_states(&self) -> &[SlipDirection] {
        &self.slips
    }

    /// Returns the total friction heat since the start (J); `None` without bearings.
    pub fn friction_heat(&self) -> Option<f64> {
        (!self.bearings.is_empty())
            .then(|| self.current.rotor_states.iter().map(|rotor| rotor.values.z).sum())
    }

    /// Returns the motion of the rotors in bearings at the current instant.
    pub fn rotor_observations(&self, surroundings: TimedSurroundings) -> Vec<RotorObservation> {
        if self.bearings.is_empty() {
            return Vec::new();
        }
        let bearings_now = self.current_bearings(&self.slips);
        let acceleration = if bearings_now.sticks() {
            self.acceleration(&self.slips, surroundings)
        } else {
            Vector::zeros()
        };
        let of = |(index, rotor_state): (usize, &RotorState)| {
            let (bearing, rotor, slip) =
                (&self.bearings[index], &bearings_now.rotors[index], bearings_now.slips[index]);
            let (angle, heat) = (rotor_state.values.y + rotor_state.rounding.y, rotor_state.values.z);
            if slip == SlipDirection::Stuck {
                let friction = rotor.torque - bearing.inertia * rotor.axis.dot(&acceleration);
                let momentum = bearing.inertia * rotor.axis.dot(&self.view.rate);
                return RotorObservation { momentum, speed: 0.0, angle, friction, heat, slip };
            }
            let speed = bearings_now.speed(index, rotor_state.values.x, &self.view.rate);
            RotorObservation {
                momentum: rotor_state.values.x,
                speed,
                angle,
                friction: bearing.friction(speed, slip),
                heat,
                slip,
            }
        };
        self.current.rotor_states.iter().enumerate().take(bearings_now.rotors.len()).map(of).collect()
    }
}

/// Returns the change of the inertia by the modes (kg m²) and its rate (kg m²/s).
pub fn change_of_inertia(motion: &ThreeAxisMotion, view: &BodyView) -> (Matrix3<f64>, Matrix3<f64>) {
    let sum = |of: &[f64]| {
        let modes = motion.model.modes.iter().zip(of);
        modes.fold(Matrix3::zeros(), |sum: Matrix3<f64>, (mode, q)| sum + tensor(mode.moments) * *q)
    };
    (sum(&view.displacements), sum(&view.rates))
}
