//! State of the integrator in mean axes, and the motion of the body derived from it in the hub's axes.

use flexsc_numerics::attitude::{Vector, rotation};
use nalgebra::{Matrix3, Quaternion};

use super::bearing::RotorState;
use super::model::{BodyConstants, tensor};
use super::rotation::SmallRotation;
use super::summed::{ModalSumsResult, SumModes};

/// Integrated state at an instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct IntegratorState {
    /// Unit quaternion that rotates vectors from the mean axes into inertial axes.
    pub attitude: Quaternion<f64>,
    /// Total angular momentum in mean axes (N m s), rotors included.
    pub momentum: Vector,
    /// Integral of the rigid rate J^-1 Gt (rad).
    pub turned: Vector,
    /// Displacement of the centre of mass since the start (m) and its velocity (m/s), in inertial axes.
    pub moved: [Vector; 2],
    /// Rounding errors of `attitude`, `momentum` and `turned` (compensated summation).
    pub lost: (Quaternion<f64>, Vector, Vector),
    /// q and P/W of each mode (m sqrt(kg)), and the rounding errors of both.
    pub modes: Vec<[f64; 4]>,
    /// Momentum, angle and friction heat of each rotor in a bearing.
    pub spins: Vec<RotorState>,
}

impl IntegratorState {
    /// Copies another state without allocation.
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

/// Motion of the body at an instant, as observed from the hub.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyView {
    /// Unit quaternion that rotates vectors from the hub's axes into inertial axes.
    pub attitude: Quaternion<f64>,
    /// Unit quaternion that rotates vectors from the mean axes into inertial axes: the attitude of the body without
    /// its elastic part.
    pub mean: Quaternion<f64>,
    /// Angular rate of the hub in its axes (rad/s).
    pub rate: Vector,
    /// Rigid rate J^-1 Gt (rad/s): the hub's rate without its elastic part.
    pub rigid: Vector,
    /// Total angular momentum in the hub's axes (N m s), rotors included.
    pub momentum: Vector,
    /// Rotational energy (J) of the body frozen in its present deformation, without rotors.
    pub rotational: f64,
    /// Integral of the rigid rate since the start (rad).
    pub turned: Vector,
    /// Displacement of the centre of mass since the start (m) and its velocity (m/s), in inertial axes.
    pub moved: [Vector; 2],
    /// Displacements q of the modes (m sqrt(kg)).
    pub displacements: Vec<f64>,
    /// Rates q' of the modes (m sqrt(kg)/s).
    pub rates: Vec<f64>,
    /// Present frequencies of the modes (rad/s) of a body with drives; empty otherwise.
    pub frequencies: Vec<f64>,
    /// Present hub rotation per unit of each mode (rad/(m sqrt(kg))) of a body with drives; empty otherwise.
    pub rotations: Vec<Vector>,
    /// Shift of the hub's points relative to the centre of mass since the start (m) and its rate (m/s), for a body
    /// with drives.
    pub shift: Option<[Vector; 2]>,
    /// Inertia tensor of the deformed body (kg m²), for a body with drives.
    pub inertia: Option<Matrix3<f64>>,
    /// Angle (rad) and rate (rad/s) of each hinge.
    pub hinges: Vec<[f64; 2]>,
}

impl BodyView {
    /// Creates a zero view for `modes` modes, to be filled by `look`.
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

    /// Computes the view from a state, given the momentum of the rotors (N m s) and the inertia added by rotors that
    /// are stuck in their bearings (kg m²).
    pub(super) fn compute(
        &mut self,
        model: &BodyConstants,
        state: &IntegratorState,
        rotors: &Vector,
        locked: &Matrix3<f64>,
    ) {
        let ModalSumsResult { bent, elastic, changed } =
            model.lanes.run(SumModes { model, states: &state.modes });
        let bend = SmallRotation::new(bent);
        let changed = tensor(changed);
        self.mean = state.attitude;
        self.attitude = state.attitude * rotation(&bent);
        self.momentum = bend.to_hub_axes(&state.momentum);
        let (turning, rate) =
            model.momentum_and_rate(&(self.momentum - rotors), &elastic, &(changed + locked));
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

/// Next step of the grid, computed in advance to search it for stick-slip events.
#[derive(Clone, Debug)]
pub(super) struct NextStep {
    /// Time of the start of the step since the start of the segment (s).
    pub from: f64,
    /// State at the end of the step.
    pub to: IntegratorState,
    /// Time since the start of the segment (s) of the first stick-slip event (a rotor stops or breaks away), and the
    /// rotor's index.
    pub meets: Option<(f64, usize)>,
}
