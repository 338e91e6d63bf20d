//! Rotors with friction in their bearings and imbalance: their motion and the forces they exert at the stages of a
//! step.
//!
//! A rotor of inertia I turns relative to the body at the speed Omega = h/I - a.w; its angle psi has the rate Omega. While the
//! rotor slips, the bearing subtracts the friction c Omega + t_c sgn Omega (viscous, Coulomb) from the motor torque. A stuck
//! rotor turns with the body, h = I a.w, and adds I a a' to the body's inertia.
//!
//! A rotor on a part that the modes turn by rho q against the hub exerts the torque h a x (w + rho q') there: on the hub h a x rho q' besides
//! the change of the stored momentum, and the forces rho' (h a x (w + rho q')) on the modes besides those of the hub's torque.

use flexsc_numerics::attitude::Vector;
use nalgebra::Matrix3;

use crate::three_axis::body::Rotor;

/// Bearing friction and imbalance of a rotor.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bearing {
    /// Moment of inertia of the rotor about its axis (kg m²).
    pub inertia: f64,
    /// Viscous friction (N m s/rad).
    pub viscous: f64,
    /// Coulomb friction (N m); 0 for none: such a rotor never sticks.
    pub coulomb: f64,
    /// Torque that a rotor at rest withstands before it slips (N m), at least the Coulomb friction.
    pub breakaway: f64,
    /// Harmonics of the imbalance.
    pub lines: Vec<HarmonicLine>,
    /// Rotation rho of the rotor against the hub per unit of each mode (rad/(m sqrt(kg))); empty for one on the hub.
    pub tilts: Vec<Vector>,
}

/// Harmonic of the imbalance: the load on the body is Omega² (c cos k psi + s sin k psi), where k is the order and psi the
/// angle of the rotor against the body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HarmonicLine {
    /// Order k: periods per revolution.
    pub order: f64,
    /// Coefficients c and s of the torque on the hub (kg m²).
    pub torque: [Vector; 2],
    /// Coefficients c and s of the force (kg m).
    pub force: [Vector; 2],
    /// Coefficients c and s of the modal forces other than phi' times the torque (sqrt(kg) m).
    pub forces: [Vec<f64>; 2],
}

/// Stick or slip state of a rotor in its bearing, with the direction of slip.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum SlipDirection {
    /// Slips towards positive speeds, or has no Coulomb friction.
    #[default]
    Forward,
    /// Slips towards negative speeds.
    Backward,
    /// At rest relative to the body.
    Stuck,
}

impl SlipDirection {
    /// Returns the slip state for the sign of a speed or a driving torque; `Stuck` at 0.
    pub fn from_speed(speed: f64) -> Self {
        if speed > 0.0 {
            Self::Forward
        } else if speed < 0.0 {
            Self::Backward
        } else {
            Self::Stuck
        }
    }

    /// Returns 1, -1, or 0 for a rotor that is stuck.
    pub fn sign(self) -> f64 {
        match self {
            Self::Forward => 1.0,
            Self::Backward => -1.0,
            Self::Stuck => 0.0,
        }
    }
}

impl Bearing {
    /// Returns the friction torque of a slipping rotor at a speed in rad/s (N m).
    pub fn friction(&self, speed: f64, slip: SlipDirection) -> f64 {
        self.viscous * speed + self.coulomb * slip.sign()
    }

    /// Returns the rate at which viscous friction slows the rotor (1/s).
    pub fn viscous_rate(&self) -> f64 {
        if self.viscous > 0.0 { self.viscous / self.inertia } else { 0.0 }
    }

    /// Returns true if the bearing can hold its rotor at rest.
    pub fn can_stick(&self) -> bool {
        self.breakaway > 0.0
    }

    /// Returns the largest rate at which whirl moves the modes for a momentum of the rotor (rad/s).
    pub fn whirl_rate(&self, momentum: f64) -> f64 {
        momentum.abs() * self.tilts.iter().map(Vector::norm_squared).sum::<f64>()
    }

    /// Returns the highest order of the imbalance; 0 without imbalance.
    pub fn highest_order(&self) -> f64 {
        self.lines.iter().map(|line| line.order).fold(0.0, f64::max)
    }
}

/// State of a rotor in a bearing.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct RotorState {
    /// Momentum (N m s), angle against the body since the start (rad) and friction heat (J).
    pub values: Vector,
    /// Rounding errors of `values` (compensated summation).
    pub rounding: Vector,
}

/// Rotors in bearings, each with its motor torque, its bearing and its slip state.
#[derive(Copy, Clone)]
pub struct BearingLoads<'a> {
    pub bearings: &'a [Bearing],
    pub rotors: &'a [Rotor],
    pub slips: &'a [SlipDirection],
}

/// Values of the rotors in bearings at the stages of a step.
#[derive(Clone, Debug, Default)]
pub struct RotorStage {
    /// Momentum, angle and heat of each rotor at the current stage.
    pub at: Vec<Vector>,
    /// Rates of `at` at the current stage.
    pub rates: Vec<Vector>,
    /// Rates of `at` at the nodes of the step.
    pub node_rates: Vec<[Vector; 3]>,
    /// Imbalance terms Omega² cos k psi and Omega² sin k psi of each harmonic of each rotor (rad²/s²).
    pub imbalance_terms: Vec<[f64; 2]>,
    /// Rates of the modes at the current stage (m sqrt(kg)/s), for rotors that tilt.
    pub modal_rates: Vec<f64>,
    /// Torque h a x (w + rho q') of each rotor that tilts, 0 of others (N m).
    pub whirl: Vec<Vector>,
}

impl RotorStage {
    /// Stores the current rates as those at a node of a step of `h` (s); returns the relative change of the momenta.
    pub fn set_rates(&mut self, node: usize, h: f64) -> f64 {
        let mut change = 0.0_f64;
        for ((nodes, rate), at) in self.node_rates.iter_mut().zip(&self.rates).zip(&self.at) {
            let size = at.x.abs() + h * rate.x.abs();
            if size > 0.0 {
                change = change.max((rate.x - nodes[node].x).abs() * h / size);
            }
            nodes[node] = *rate;
        }
        change
    }
}

impl BearingLoads<'_> {
    /// Returns the momentum of the rotors that slip (N m s).
    pub fn stored(&self, momenta: impl Iterator<Item = f64>) -> Vector {
        let rotors = self.rotors.iter().zip(self.slips).zip(momenta);
        rotors
            .filter(|((_, slip), _)| **slip != SlipDirection::Stuck)
            .fold(Vector::zeros(), |sum, ((rotor, _), momentum)| sum + rotor.axis * momentum)
    }

    /// Returns true if any rotor is stuck.
    pub fn sticks(&self) -> bool {
        self.slips.contains(&SlipDirection::Stuck)
    }

    /// Returns the inertia that stuck rotors add to the body (kg m²).
    pub fn stuck_inertia(&self) -> Matrix3<f64> {
        let stuck = self.rotors.iter().zip(self.bearings).zip(self.slips);
        stuck
            .filter(|(_, slip)| **slip == SlipDirection::Stuck)
            .fold(Matrix3::zeros(), |sum, ((rotor, of), _)| {
                sum + rotor.axis * rotor.axis.transpose() * of.inertia
            })
    }

    /// Returns the speed of a rotor of the given momentum (N m s) relative to a body with the angular rate `rate`
    /// (rad/s).
    pub fn speed(&self, index: usize, momentum: f64, rate: &Vector) -> f64 {
        momentum / self.bearings[index].inertia - self.rotors[index].axis.dot(rate)
    }

    /// Updates the rates of all rotors from `stage.at`, the imbalance terms and the whirl, for a body with the angular rate
    /// `rate` (rad/s); returns the torque of imbalance and whirl on the hub (N m).
    pub fn update_rates(&self, rate: &Vector, stage: &mut RotorStage) -> Vector {
        let mut torque = Vector::zeros();
        stage.imbalance_terms.clear();
        stage.whirl.clear();
        if self.has_tilts() {
            for (index, (bearing, rotor)) in self.bearings.iter().zip(self.rotors).enumerate() {
                let momentum = rotor.axis * stage.at[index].x;
                let modes = bearing.tilts.iter().zip(&stage.modal_rates);
                let tilting = modes.fold(Vector::zeros(), |sum, (tilt, modal_rate)| sum + tilt * *modal_rate);
                torque += momentum.cross(&tilting);
                let is_carried = !bearing.tilts.is_empty();
                stage.whirl.push(if is_carried {
                    momentum.cross(&(rate + tilting))
                } else {
                    Vector::zeros()
                });
            }
        }
        for (index, (bearing, rotor)) in self.bearings.iter().zip(self.rotors).enumerate() {
            let (at, slip) = (stage.at[index], self.slips[index]);
            let stuck = slip == SlipDirection::Stuck;
            let speed = if stuck { 0.0 } else { self.speed(index, at.x, rate) };
            let friction = bearing.friction(speed, slip);
            stage.rates[index] = if stuck {
                Vector::zeros()
            } else {
                Vector::new(rotor.torque - friction, speed, friction * speed)
            };
            for line in &bearing.lines {
                let (sin, cos) = libm::sincos(line.order * at.y);
                let wave = [speed * speed * cos, speed * speed * sin];
                torque += line.torque[0] * wave[0] + line.torque[1] * wave[1];
                stage.imbalance_terms.push(wave);
            }
        }
        torque
    }

    /// Returns the force of imbalance and whirl on a mode (N/sqrt(kg)).
    pub fn force(&self, mode: usize, stage: &RotorStage) -> f64 {
        let lines = self.bearings.iter().flat_map(|bearing| &bearing.lines);
        let force = lines
            .zip(&stage.imbalance_terms)
            .map(|(line, [c, s])| line.forces[0][mode] * c + line.forces[1][mode] * s)
            .sum();
        let carried = self
            .bearings
            .iter()
            .zip(&stage.whirl)
            .filter_map(|(of, torque)| Some((of.tilts.get(mode)?, torque)));
        carried.fold(force, |force, (tilt, torque)| force + tilt.dot(torque))
    }

    /// Returns the force of the imbalance on the body (N).
    pub fn imbalance_force(&self, imbalance_terms: &[[f64; 2]]) -> Vector {
        let lines = self.bearings.iter().flat_map(|bearing| &bearing.lines);
        lines
            .zip(imbalance_terms)
            .fold(Vector::zeros(), |sum, (line, [c, s])| sum + line.force[0] * *c + line.force[1] * *s)
    }

    /// Returns true if any rotor exerts forces on the modes.
    pub fn has_forces(&self) -> bool {
        self.has_tilts() || self.bearings.iter().any(|bearing| !bearing.lines.is_empty())
    }

    /// Returns true if the modes turn any rotor against the hub.
    pub fn has_tilts(&self) -> bool {
        self.bearings.iter().any(|bearing| !bearing.tilts.is_empty())
    }
}
