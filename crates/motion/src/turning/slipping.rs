//! Which rotors slip and which stick: a linear complementarity problem at each instant at which that may change.
//!
//! A rotor at rest sticks if its bearing can give the torque with which it turns with the body, else it slips the way it is
//! driven. Rotors share the body that they turn against, so that all at rest are decided together: by changes of the first that
//! is wrong, which end for a positive definite problem (\[Murty74\]).

use super::bearing::{Borne, Slip, Spin};
use super::flow::{Acting, Turning};
use super::model::{Surroundings, tensor};
use super::rotation::Bend;
use super::state::TurningSight;
use crate::attitude::Vector;
use nalgebra::Matrix3;

/// A rotor's bearing holds this part of its breakaway torque: rounding at the instant at which it lets go is less.
const HOLDS: f64 = 1.0 - 1e-12;

/// A rotor slower than this is at rest (rad/s).
const AT_REST: f64 = 1e-12;

/// A rotor in a bearing, as seen at an instant.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct SlippedRotor {
    /// Absolute angular momentum about its axis (N m s).
    pub momentum: f64,
    /// Speed against the body (rad/s).
    pub speed: f64,
    /// Angle against the body since the start (rad).
    pub angle: f64,
    /// Friction, which takes from what its motor gives (N m).
    pub friction: f64,
    /// Heat of the friction since the start (J).
    pub heat: f64,
    /// Whether it slips.
    pub slip: Slip,
}

impl Turning {
    /// The rotors in bearings as they slip now.
    pub(super) fn borne_by<'a>(&'a self, slips: &'a [Slip]) -> Borne<'a> {
        let count = self.acting.rotors.len().min(self.bearings.len());
        Borne { bearings: &self.bearings[..count], rotors: &self.acting.rotors, slips: &slips[..count] }
    }

    /// Acceleration of the hub (rad/s²) at the instant seen last, if rotors slip so.
    pub(super) fn acceleration(&self, slips: &[Slip], around: Option<(&dyn Surroundings, f64)>) -> Vector {
        self.accelerated(slips, around).hub
    }

    /// Rotors and gimbals that were not there before bring their momenta with them.
    pub(super) fn take_on(&mut self, acting: &Acting) {
        let bent = self
            .here
            .modes
            .iter()
            .zip(&self.model.modes)
            .fold(Vector::zeros(), |sum, ([q, ..], mode)| sum + mode.rotation * *q);
        for (index, rotor) in acting.rotors.iter().enumerate().skip(self.acting.rotors.len()) {
            self.here.momentum += Bend::new(bent).forward(&(rotor.axis * rotor.momentum));
            if index < self.bearings.len() {
                self.slips[index] = self.first_slip(index, &rotor.axis, rotor.momentum);
                self.here.spins[index].sums.x = rotor.momentum;
            }
        }
        for gimbal in acting.gimbals.iter().skip(self.acting.gimbals.len()) {
            self.here.momentum += Bend::new(bent).forward(&gimbal.at(0.0).0);
        }
    }

    /// Decides about the rotors at rest, under what acts since the departure just now.
    pub fn settle(&mut self, around: Option<(&dyn Surroundings, f64)>) {
        if !self.watches() {
            return;
        }
        let borne = self.borne_by(&self.slips);
        let rate = self.seen.rate;
        let rests = |index: usize| {
            let slips = self.slips[index] != Slip::Stuck && !self.resting[index];
            self.bearings[index].grips() && !slips
        };
        let resting: Vec<usize> = (0..borne.rotors.len()).filter(|index| rests(*index)).collect();
        if resting.is_empty() {
            return;
        }
        let with_body =
            |index: usize| self.bearings[index].inertia * self.acting.rotors[index].axis.dot(&rate);
        let momenta: Vec<f64> = resting.iter().map(|index| with_body(*index)).collect();
        for (index, momentum) in resting.iter().zip(momenta) {
            let spin = &mut self.here.spins[*index];
            (spin.sums.x, spin.lost.x) = (momentum, 0.0);
            (self.slips[*index], self.resting[*index]) = (Slip::Stuck, false);
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

    /// What a rotor at rest does instead, if it cannot do this under such an acceleration of the hub (rad/s²).
    fn wrong(&self, index: usize, slip: Slip, acceleration: &Vector) -> Option<(usize, Slip)> {
        let (bearing, rotor) = (&self.bearings[index], &self.acting.rotors[index]);
        let along = rotor.axis.dot(acceleration);
        if slip == Slip::Stuck {
            let friction = rotor.torque - bearing.inertia * along;
            return (friction.abs() > bearing.breakaway * HOLDS).then(|| (index, Slip::of(friction)));
        }
        let torque = rotor.torque - bearing.friction(0.0, slip);
        let back = slip.sign() * (bearing.inertia * along - torque);
        (back > bearing.breakaway * (1.0 - HOLDS)).then_some((index, Slip::Stuck))
    }

    /// Whether a rotor of such a momentum (N m s) is at rest when it is there first, and how it slips.
    pub(super) fn first_slip(&self, index: usize, axis: &Vector, momentum: f64) -> Slip {
        let bearing = &self.bearings[index];
        let speed = momentum / bearing.inertia - axis.dot(&self.seen.rate);
        match () {
            () if !bearing.grips() => Slip::Forward,
            () if speed.abs() < AT_REST => Slip::Stuck,
            () => Slip::of(speed),
        }
    }

    /// How the rotors in bearings slip.
    pub fn slips(&self) -> &[Slip] {
        &self.slips
    }

    /// Heat of the friction of all of them since the start (J), if there are any.
    pub fn friction_heat(&self) -> Option<f64> {
        (!self.bearings.is_empty()).then(|| self.here.spins.iter().map(|spin| spin.sums.z).sum())
    }

    /// The rotors in bearings at the instant seen last.
    pub fn turned(&self, around: Option<(&dyn Surroundings, f64)>) -> Vec<SlippedRotor> {
        if self.bearings.is_empty() {
            return Vec::new();
        }
        let borne = self.borne_by(&self.slips);
        let acceleration =
            if borne.sticks() { self.acceleration(&self.slips, around) } else { Vector::zeros() };
        let of = |(index, spin): (usize, &Spin)| {
            let (bearing, rotor, slip) = (&self.bearings[index], &borne.rotors[index], borne.slips[index]);
            let (angle, heat) = (spin.sums.y + spin.lost.y, spin.sums.z);
            if slip == Slip::Stuck {
                let friction = rotor.torque - bearing.inertia * rotor.axis.dot(&acceleration);
                let momentum = bearing.inertia * rotor.axis.dot(&self.seen.rate);
                return SlippedRotor { momentum, speed: 0.0, angle, friction, heat, slip };
            }
            let speed = borne.speed(index, spin.sums.x, &self.seen.rate);
            SlippedRotor {
                momentum: spin.sums.x,
                speed,
                angle,
                friction: bearing.friction(speed, slip),
                heat,
                slip,
            }
        };
        self.here.spins.iter().enumerate().take(borne.rotors.len()).map(of).collect()
    }
}

/// What the modes change of the inertia (kg m²), and its rate (kg m²/s).
pub(super) fn shapes(turning: &Turning, seen: &TurningSight) -> (Matrix3<f64>, Matrix3<f64>) {
    let sum = |of: &[f64]| {
        let modes = turning.model.modes.iter().zip(of);
        modes.fold(Matrix3::zeros(), |sum: Matrix3<f64>, (mode, q)| sum + tensor(mode.moments) * *q)
    };
    (sum(&seen.displacements), sum(&seen.rates))
}
