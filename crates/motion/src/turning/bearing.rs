//! Rotors as they are: friction in their bearings, imbalance, and what both exert at the stages of a step.
//!
//! A rotor turns against the body at Omega = h/I - a.w by th' = Omega. Its bearing takes c Omega + t sgn Omega from the torque of
//! its motor while it slips; a rotor that is stuck turns with the body, h = I a.w, and adds I a a' to its inertia.

use nalgebra::Matrix3;

use super::model::Rotor;
use crate::attitude::Vector;

/// What holds a rotor, and how well it is balanced.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bearing {
    /// Moment of inertia of the rotor about its axis (kg m²).
    pub inertia: f64,
    /// Viscous friction (N m s/rad).
    pub viscous: f64,
    /// Coulomb friction (N m); 0 for none: such a rotor never sticks.
    pub coulomb: f64,
    /// What a rotor at rest bears before it slips (N m), at least the Coulomb friction.
    pub breakaway: f64,
    /// The imbalance.
    pub lines: Vec<HarmonicLine>,
}

/// A harmonic of the imbalance: the body feels Omega² (c cos k th + s sin k th), k being its order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HarmonicLine {
    /// Periods in a turn.
    pub order: f64,
    /// c and s of the torque on the hub (kg m²).
    pub torque: [Vector; 2],
    /// c and s of the force (kg m).
    pub force: [Vector; 2],
    /// c and s of the force on each mode, beside phi' times the torque (sqrt(kg) m).
    pub forces: [Vec<f64>; 2],
}

/// Whether a rotor slips in its bearing, and which way.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum Slip {
    /// To positive speeds, or without Coulomb friction.
    #[default]
    Forward,
    /// To negative speeds.
    Backward,
    /// It is at rest in the body.
    Stuck,
}

impl Slip {
    /// Which way a rotor slips at a speed, or by a torque: not at all at 0.
    pub fn of(speed: f64) -> Self {
        if speed > 0.0 {
            Self::Forward
        } else if speed < 0.0 {
            Self::Backward
        } else {
            Self::Stuck
        }
    }

    /// 1, -1, or 0 of one that is stuck.
    pub fn sign(self) -> f64 {
        match self {
            Self::Forward => 1.0,
            Self::Backward => -1.0,
            Self::Stuck => 0.0,
        }
    }
}

impl Bearing {
    /// The friction at a speed (rad/s) of a rotor that slips (N m).
    pub fn friction(&self, speed: f64, slip: Slip) -> f64 {
        self.viscous * speed + self.coulomb * slip.sign()
    }

    /// Whether it can hold its rotor.
    pub fn grips(&self) -> bool {
        self.breakaway > 0.0
    }

    /// The highest order of its imbalance; 0 without any.
    pub fn highest(&self) -> f64 {
        self.lines.iter().map(|line| line.order).fold(0.0, f64::max)
    }
}

/// A rotor's momentum (N m s), its angle against the body since the start (rad) and the heat of its friction (J), and what
/// rounding has left out of them.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub(super) struct Spin {
    pub sums: Vector,
    pub lost: Vector,
}

/// Rotors in bearings, from a departure on.
#[derive(Copy, Clone)]
pub(super) struct Borne<'a> {
    pub bearings: &'a [Bearing],
    pub rotors: &'a [Rotor],
    pub slips: &'a [Slip],
}

/// What rotors are at a stage, and what they exert there.
#[derive(Clone, Debug, Default)]
pub(super) struct Spun {
    /// Momentum, angle and heat of each.
    pub at: Vec<Vector>,
    /// Their rates.
    pub now: Vec<Vector>,
    /// The same at the nodes of the step.
    pub rates: Vec<[Vector; 3]>,
    /// Omega² cos k th and Omega² sin k th of each line of each rotor.
    pub waves: Vec<[f64; 2]>,
}

impl Spun {
    /// Takes over the rates now as those at a node of a step of `h` seconds; tells by which part of the momenta they changed.
    pub fn take_over(&mut self, node: usize, h: f64) -> f64 {
        let mut change = 0.0_f64;
        for ((rates, now), at) in self.rates.iter_mut().zip(&self.now).zip(&self.at) {
            let size = at.x.abs() + h * now.x.abs();
            if size > 0.0 {
                change = change.max((now.x - rates[node].x).abs() * h / size);
            }
            rates[node] = *now;
        }
        change
    }
}

impl Borne<'_> {
    /// Momentum of the rotors that slip (N m s).
    pub fn stored(&self, spins: impl Iterator<Item = f64>) -> Vector {
        let rotors = self.rotors.iter().zip(self.slips).zip(spins);
        rotors
            .filter(|((_, slip), _)| **slip != Slip::Stuck)
            .fold(Vector::zeros(), |sum, ((rotor, _), momentum)| sum + rotor.axis * momentum)
    }

    /// Whether any rotor is stuck.
    pub fn sticks(&self) -> bool {
        self.slips.contains(&Slip::Stuck)
    }

    /// What those that are stuck add to the body's inertia (kg m²).
    pub fn locked(&self) -> Matrix3<f64> {
        let stuck = self.rotors.iter().zip(self.bearings).zip(self.slips);
        stuck.filter(|(_, slip)| **slip == Slip::Stuck).fold(Matrix3::zeros(), |sum, ((rotor, of), _)| {
            sum + rotor.axis * rotor.axis.transpose() * of.inertia
        })
    }

    /// The speed of a rotor of this momentum (N m s) against a body that turns at this rate (rad/s).
    pub fn speed(&self, index: usize, momentum: f64, rate: &Vector) -> f64 {
        momentum / self.bearings[index].inertia - self.rotors[index].axis.dot(rate)
    }

    /// Fills the rates of all rotors where `spun.at` says they are, and their waves, on a body that turns at this rate (rad/s);
    /// tells the torque of the imbalance on the hub (N m).
    pub fn feel(&self, rate: &Vector, spun: &mut Spun) -> Vector {
        let mut torque = Vector::zeros();
        spun.waves.clear();
        for (index, (bearing, rotor)) in self.bearings.iter().zip(self.rotors).enumerate() {
            let (at, slip) = (spun.at[index], self.slips[index]);
            let stuck = slip == Slip::Stuck;
            let speed = if stuck { 0.0 } else { self.speed(index, at.x, rate) };
            let friction = bearing.friction(speed, slip);
            spun.now[index] = if stuck {
                Vector::zeros()
            } else {
                Vector::new(rotor.torque - friction, speed, friction * speed)
            };
            for line in &bearing.lines {
                let (sin, cos) = libm::sincos(line.order * at.y);
                let wave = [speed * speed * cos, speed * speed * sin];
                torque += line.torque[0] * wave[0] + line.torque[1] * wave[1];
                spun.waves.push(wave);
            }
        }
        torque
    }

    /// The force of the imbalance on a mode (N/sqrt(kg)).
    pub fn force(&self, mode: usize, waves: &[[f64; 2]]) -> f64 {
        let lines = self.bearings.iter().flat_map(|bearing| &bearing.lines);
        lines.zip(waves).map(|(line, [c, s])| line.forces[0][mode] * c + line.forces[1][mode] * s).sum()
    }

    /// The force of the imbalance (N).
    pub fn shaking(&self, waves: &[[f64; 2]]) -> Vector {
        let lines = self.bearings.iter().flat_map(|bearing| &bearing.lines);
        lines
            .zip(waves)
            .fold(Vector::zeros(), |sum, (line, [c, s])| sum + line.force[0] * *c + line.force[1] * *s)
    }

    /// Whether any rotor is out of balance.
    pub fn shakes(&self) -> bool {
        self.bearings.iter().any(|bearing| !bearing.lines.is_empty())
    }
}
