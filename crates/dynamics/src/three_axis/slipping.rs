//! Stick-slip of the rotors: a linear complementarity problem at each instant at which rotors may stick or break
//! away.
//!
//! A rotor at rest sticks if its bearing can provide the torque with which it turns with the body; otherwise it slips
//! in the direction in which it is driven. All rotors at rest are coupled by the body and decided together: the first
//! that is inconsistent is changed, repeatedly, which terminates for a positive definite problem (\[Murty74\]).

use flexsc_numerics::attitude::Vector;
use nalgebra::Matrix3;

use super::bearing::{BearingLoads, RotorState, SlipDirection};
use super::flow::{SegmentLoads, ThreeAxisMotion};
use super::model::{Surroundings, tensor};
use super::rotation::SmallRotation;
use super::state::BodyView;

/// Fraction of the breakaway torque up to which a rotor is held; the margin exceeds rounding at the instant of
/// breakaway.
const HOLDS: f64 = 1.0 - 1e-12;

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
    pub(super) fn current_bearings<'a>(&'a self, slips: &'a [SlipDirection]) -> BearingLoads<'a> {
        let count = self.acting.rotors.len().min(self.bearings.len());
        BearingLoads {
            bearings: &self.bearings[..count],
            rotors: &self.acting.rotors,
            slips: &slips[..count],
        }
    }

    /// Returns the acceleration of the hub (rad/s²) at the current instant for given slip states.
    pub(super) fn acceleration(
        &self,
        slips: &[SlipDirection],
        around: Option<(&dyn Surroundings, f64)>,
    ) -> Vector {
        self.accelerated(slips, around).hub
    }

    /// Adds the momenta of rotors and gimbals that were not present before.
    pub(super) fn add_rotors(&mut self, acting: &SegmentLoads) {
        let bent = self
            .here
            .modes
            .iter()
            .zip(&self.model.modes)
            .fold(Vector::zeros(), |sum, ([q, ..], mode)| sum + mode.rotation * *q);
        for (index, rotor) in acting.rotors.iter().enumerate().skip(self.acting.rotors.len()) {
            self.here.momentum += SmallRotation::new(bent).to_mean_axes(&(rotor.axis * rotor.momentum));
            if index < self.bearings.len() {
                self.slips[index] = self.initial_slip(index, &rotor.axis, rotor.momentum);
                self.here.spins[index].sums.x = rotor.momentum;
            }
        }
        for gimbal in acting.gimbals.iter().skip(self.acting.gimbals.len()) {
            self.here.momentum += SmallRotation::new(bent).to_mean_axes(&gimbal.at(0.0).0);
        }
    }

    /// Resolves stick or slip of the rotors at rest at the start of a segment, under its loads.
    pub fn resolve_stick_slip(&mut self, around: Option<(&dyn Surroundings, f64)>) {
        if !self.can_stick() {
            return;
        }
        let bearings_now = self.current_bearings(&self.slips);
        let rate = self.seen.rate;
        let rests = |index: usize| {
            let slips = self.slips[index] != SlipDirection::Stuck && !self.resting[index];
            self.bearings[index].can_stick() && !slips
        };
        let resting: Vec<usize> = (0..bearings_now.rotors.len()).filter(|index| rests(*index)).collect();
        if resting.is_empty() {
            return;
        }
        let with_body =
            |index: usize| self.bearings[index].inertia * self.acting.rotors[index].axis.dot(&rate);
        let momenta: Vec<f64> = resting.iter().map(|index| with_body(*index)).collect();
        for (index, momentum) in resting.iter().zip(momenta) {
            let spin = &mut self.here.spins[*index];
            (spin.sums.x, spin.lost.x) = (momentum, 0.0);
            (self.slips[*index], self.resting[*index]) = (SlipDirection::Stuck, false);
        }
        let mut slips = self.slips.clone();
        for _ in 0..1_usize << (resting.len() + 1).min(10) {
            let acceleration = self.acceleration(&slips, around);
            let wrong = resting.iter().find_map(|index| self.wrong(*index, slips[*index], &acceleration));
            let Some((index, slip)) = wrong else { break };
            slips[index] = slip;
        }
        self.slips = slips;
        self.departed.copy_from(&self.here);
        self.grid.copy_from(&self.here);
        self.move_on();
        self.look();
    }

    /// Returns the next slip state of a rotor at rest if `slip` is inconsistent with the hub's acceleration (rad/s²).
    fn wrong(
        &self,
        index: usize,
        slip: SlipDirection,
        acceleration: &Vector,
    ) -> Option<(usize, SlipDirection)> {
        let (bearing, rotor) = (&self.bearings[index], &self.acting.rotors[index]);
        let along = rotor.axis.dot(acceleration);
        if slip == SlipDirection::Stuck {
            let friction = rotor.torque - bearing.inertia * along;
            return (friction.abs() > bearing.breakaway * HOLDS)
                .then(|| (index, SlipDirection::from_speed(friction)));
        }
        let torque = rotor.torque - bearing.friction(0.0, slip);
        let back = slip.sign() * (bearing.inertia * along - torque);
        (back > bearing.breakaway * (1.0 - HOLDS)).then_some((index, SlipDirection::Stuck))
    }

    /// Returns the slip state of a new rotor of the given momentum (N m s).
    pub(super) fn initial_slip(&self, index: usize, axis: &Vector, momentum: f64) -> SlipDirection {
        let bearing = &self.bearings[index];
        let speed = momentum / bearing.inertia - axis.dot(&self.seen.rate);
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
        (!self.bearings.is_empty()).then(|| self.here.spins.iter().map(|spin| spin.sums.z).sum())
    }

    /// Returns the motion of the rotors in bearings at the current instant.
    pub fn rotor_observations(&self, around: Option<(&dyn Surroundings, f64)>) -> Vec<RotorObservation> {
        if self.bearings.is_empty() {
            return Vec::new();
        }
        let bearings_now = self.current_bearings(&self.slips);
        let acceleration =
            if bearings_now.sticks() { self.acceleration(&self.slips, around) } else { Vector::zeros() };
        let of = |(index, spin): (usize, &RotorState)| {
            let (bearing, rotor, slip) =
                (&self.bearings[index], &bearings_now.rotors[index], bearings_now.slips[index]);
            let (angle, heat) = (spin.sums.y + spin.lost.y, spin.sums.z);
            if slip == SlipDirection::Stuck {
                let friction = rotor.torque - bearing.inertia * rotor.axis.dot(&acceleration);
                let momentum = bearing.inertia * rotor.axis.dot(&self.seen.rate);
                return RotorObservation { momentum, speed: 0.0, angle, friction, heat, slip };
            }
            let speed = bearings_now.speed(index, spin.sums.x, &self.seen.rate);
            RotorObservation {
                momentum: spin.sums.x,
                speed,
                angle,
                friction: bearing.friction(speed, slip),
                heat,
                slip,
            }
        };
        self.here.spins.iter().enumerate().take(bearings_now.rotors.len()).map(of).collect()
    }
}

/// Returns the change of the inertia by the modes (kg m²) and its rate (kg m²/s).
pub(super) fn inertia_change(turning: &ThreeAxisMotion, seen: &BodyView) -> (Matrix3<f64>, Matrix3<f64>) {
    let sum = |of: &[f64]| {
        let modes = turning.model.modes.iter().zip(of);
        modes.fold(Matrix3::zeros(), |sum: Matrix3<f64>, (mode, q)| sum + tensor(mode.moments) * *q)
    };
    (sum(&seen.displacements), sum(&seen.rates))
}
