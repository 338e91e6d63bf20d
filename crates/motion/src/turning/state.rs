//! Where a turning body is, in mean axes, and what that looks like from the hub.

use nalgebra::{Matrix3, Quaternion};

use super::bearing::Spin;
use super::model::{Model, tensor};
use super::rotation::Bend;
use super::summed::{Summed, Summing};
use crate::attitude::{Vector, rotation};

/// The state that steps carry on.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct TurningState {
    /// Unit quaternion that turns vectors of the mean axes into inertial ones.
    pub attitude: Quaternion<f64>,
    /// Total angular momentum in mean axes (N m s), rotors included.
    pub momentum: Vector,
    /// What the body turned by as if it were rigid: the integral of J^-1 Gt (rad).
    pub turned: Vector,
    /// Where the centre of mass is, from where it was at the start (m), and how fast it moves (m/s), in inertial axes.
    pub moved: [Vector; 2],
    /// What rounding has left out of the three before.
    pub lost: (Quaternion<f64>, Vector, Vector),
    /// q and P/W of each mode (m sqrt(kg)), and what rounding has left out of both.
    pub modes: Vec<[f64; 4]>,
    /// Rotors in bearings.
    pub spins: Vec<Spin>,
}

impl TurningState {
    /// Takes over another state, without allocation.
    pub fn copy_from(&mut self, other: &Self) {
        let Self { attitude, momentum, turned, moved, lost, modes, spins } = self;
        (*attitude, *momentum, *turned, *lost) = (other.attitude, other.momentum, other.turned, other.lost);
        *moved = other.moved;
        modes.copy_from_slice(&other.modes);
        if !spins.is_empty() {
            spins.copy_from_slice(&other.spins);
        }
    }
}

/// A turning body as seen at an instant.
#[derive(Clone, Debug, PartialEq)]
pub struct TurningSight {
    /// Unit quaternion that turns vectors of the hub into inertial ones.
    pub attitude: Quaternion<f64>,
    /// The same of the mean axes, which no mode turns: the attitude as if the body were rigid.
    pub mean: Quaternion<f64>,
    /// Rates of the hub, in its axes (rad/s).
    pub rate: Vector,
    /// Rates of the body as if it were rigid (rad/s): those of the hub without their elastic part.
    pub rigid: Vector,
    /// Total angular momentum in the hub's axes (N m s), rotors included.
    pub momentum: Vector,
    /// Energy of the rotation as if the body were rigid and bent as it is (J), without rotors.
    pub rotational: f64,
    /// The integral of the rigid rates since the start (rad).
    pub turned: Vector,
    /// Where the centre of mass is, from where it was at the start (m), and how fast it moves (m/s), in inertial axes.
    pub moved: [Vector; 2],
    /// Displacements q of the modes (m sqrt(kg)).
    pub displacements: Vec<f64>,
    /// Their rates q' (m sqrt(kg)/s).
    pub rates: Vec<f64>,
    /// Of a body with drives, the frequencies of its modes (rad/s), which change.
    pub frequencies: Vec<f64>,
    /// Of such a body, by how much a unit of each turns the hub (rad/(m sqrt(kg))).
    pub rotations: Vec<Vector>,
    /// Of such a body by how much places of the hub are further from the centre of mass than at the start (m), and how fast that
    /// changes (m/s).
    pub shift: Option<[Vector; 2]>,
    /// Of such a body, its inertia as it is bent (kg m²).
    pub inertia: Option<Matrix3<f64>>,
    /// Angle (rad) and rate (rad/s) of each hinge.
    pub hinges: Vec<[f64; 2]>,
}

impl TurningSight {
    /// A view of so many modes, to be filled.
    pub(super) fn empty(modes: usize) -> Self {
        let (one, zero) = (Quaternion::identity(), Vector::zeros());
        Self {
            attitude: one,
            mean: one,
            rate: zero,
            rigid: zero,
            momentum: zero,
            rotational: 0.0,
            turned: zero,
            moved: [zero; 2],
            displacements: vec![0.0; modes],
            rates: vec![0.0; modes],
            frequencies: Vec::new(),
            rotations: Vec::new(),
            shift: None,
            inertia: None,
            hinges: Vec::new(),
        }
    }

    /// Looks at a state, in which rotors have this momentum (N m s), and those that are stuck add such a tensor to the inertia
    /// (kg m²).
    pub(super) fn look(
        &mut self,
        model: &Model,
        state: &TurningState,
        rotors: &Vector,
        locked: &Matrix3<f64>,
    ) {
        let Summed { bent, elastic, changed } = model.lanes.run(Summing { model, states: &state.modes });
        let bend = Bend::new(bent);
        let changed = tensor(changed);
        self.mean = state.attitude;
        self.attitude = state.attitude * rotation(&bent);
        self.momentum = bend.back(&state.momentum);
        let (turning, rate) = model.rates(&(self.momentum - rotors), &elastic, &(changed + locked));
        self.rate = rate;
        self.rigid = model.inverse * turning;
        self.rotational = 0.5 * (turning.dot(&self.rigid) + rate.dot(&(changed * rate)));
        self.turned = state.turned;
        self.moved = state.moved;
        for ((of, [q, p, ..]), (displacement, rate)) in
            model.modes.iter().zip(&state.modes).zip(self.displacements.iter_mut().zip(&mut self.rates))
        {
            *displacement = *q;
            *rate = of.frequency * p + of.rotation.dot(&turning);
        }
    }
}

/// The step that follows, and what happens on it.
#[derive(Clone, Debug)]
pub(super) struct Ahead {
    /// Seconds from the departure to the start of the step.
    pub from: f64,
    /// The state at its end.
    pub to: TurningState,
    /// The first instant since the departure (s) at which a rotor comes to rest or lets go, and which one.
    pub meets: Option<(f64, usize)>,
}
