//! State of the integrator in mean axes, and the motion of the body derived from it in the hub's axes.

use flexsc_numerics::attitude::{Vector, rotation};
use flexsc_numerics::lanes::{LaneFloat, SimdTask};
use nalgebra::{Matrix3, Quaternion};

use super::constants::{BodyConstants, tensor};
use super::rotors::RotorState;
use super::small_rotation::SmallRotation;

/// Integrated state at an instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct IntegratorState {
    /// Unit quaternion that rotates vectors from the mean axes into inertial axes.
    pub mean_attitude: Quaternion<f64>,
    /// Total angular momentum in mean axes (N m s), rotors included.
    pub mean_momentum: Vector,
    /// Integral of the rigid rate J^-1 Gt (rad).
    pub rigid_angle: Vector,
    /// Displacement of the centre of mass since the start (m) and its velocity (m/s), in inertial axes.
    pub com: [Vector; 2],
    /// Rounding errors of `attitude`, `momentum` and `rigid_angle` (compensated summation).
    pub rounding: (Quaternion<f64>, Vector, Vector),
    /// q and P/W of each mode (m sqrt(kg)), and the rounding errors of both.
    pub modes: Vec<[f64; 4]>,
    /// Momentum, angle and friction heat of each rotor in a bearing.
    pub rotor_states: Vec<RotorState>,
}

impl IntegratorState {
    /// Copies another state without allocation.
    pub fn copy_from(&mut self, other: &Self) {
        let Self { mean_attitude, mean_momentum, rigid_angle, com, rounding, modes, rotor_states } = self;
        (*mean_attitude, *mean_momentum, *rigid_angle, *rounding) =
            (other.mean_attitude, other.mean_momentum, other.rigid_angle, other.rounding);
        *com = other.com;
        modes.copy_from_slice(&other.modes);
        if !rotor_states.is_empty() {
            rotor_states.copy_from_slice(&other.rotor_states);
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
    pub mean_attitude: Quaternion<f64>,
    /// Angular rate of the hub in its axes (rad/s).
    pub rate: Vector,
    /// Rigid rate J^-1 Gt (rad/s): the hub's rate without its elastic part.
    pub rigid_rate: Vector,
    /// Total angular momentum in the hub's axes (N m s), rotors included.
    pub momentum: Vector,
    /// Rotational energy (J) of the body frozen in its present deformation, without rotors.
    pub rotational_energy: f64,
    /// Integral of the rigid rate since the start (rad).
    pub rigid_angle: Vector,
    /// Displacement of the centre of mass since the start (m) and its velocity (m/s), in inertial axes.
    pub com: [Vector; 2],
    /// Displacements q of the modes (m sqrt(kg)).
    pub displacements: Vec<f64>,
    /// Rates q' of the modes (m sqrt(kg)/s).
    pub rates: Vec<f64>,
    /// Present frequencies of the modes (rad/s) of a body with articulated appendages; empty otherwise.
    pub frequencies: Vec<f64>,
    /// Present hub rotation per unit of each mode (rad/(m sqrt(kg))) of a body with articulated appendages; empty otherwise.
    pub rotations: Vec<Vector>,
    /// Shift of the hub's points relative to the centre of mass since the start (m) and its rate (m/s), for a body
    /// with drives.
    pub shift: Option<[Vector; 2]>,
    /// Inertia tensor of the deformed body (kg m²), for a body with articulated appendages.
    pub inertia: Option<Matrix3<f64>>,
    /// Angle (rad) and rate (rad/s) of each hinge.
    pub hinges: Vec<[f64; 2]>,
    /// Centre of mass (m) from the body's origin, and rotation from the axes of each appendage to the body's, for a body with
    /// articulated appendages.
    pub panels: (Vector, Vec<Matrix3<f64>>),
}

impl BodyView {
    /// Creates a zero view for `modes` modes, to be filled by `compute`.
    pub(super) fn empty(modes: usize) -> Self {
        let (one, zero) = (Quaternion::identity(), Vector::zeros());
        Self {
            attitude: one,
            mean_attitude: one,
            rate: zero,
            rigid_rate: zero,
            momentum: zero,
            rotational_energy: 0.0,
            rigid_angle: zero,
            com: [zero; 2],
            displacements: vec![0.0; modes],
            rates: vec![0.0; modes],
            frequencies: Vec::new(),
            rotations: Vec::new(),
            shift: None,
            inertia: None,
            hinges: Vec::new(),
            panels: (zero, Vec::new()),
        }
    }

    /// Computes the view from a state, given the momentum of the rotors (N m s) and the inertia added by rotors that
    /// are stuck in their bearings (kg m²).
    pub(super) fn compute(
        &mut self,
        model: &BodyConstants,
        state: &IntegratorState,
        rotors: &Vector,
        stuck_inertia: &Matrix3<f64>,
    ) {
        let ModalSums { elastic_rotation, canonical_elastic_rate, inertia_change } =
            model.lanes.run(SumModes { model, states: &state.modes });
        let hub_to_mean = SmallRotation::new(elastic_rotation);
        let inertia_change = tensor(inertia_change);
        self.mean_attitude = state.mean_attitude;
        self.attitude = state.mean_attitude * rotation(&elastic_rotation);
        self.momentum = hub_to_mean.to_hub_axes(&state.mean_momentum);
        let (rigid_momentum, rate) = model.momentum_and_rate(
            &(self.momentum - rotors),
            &canonical_elastic_rate,
            &(inertia_change + stuck_inertia),
        );
        self.rate = rate;
        self.rigid_rate = model.inverse * rigid_momentum;
        self.rotational_energy =
            0.5 * (rigid_momentum.dot(&self.rigid_rate) + rate.dot(&(inertia_change * rate)));
        self.rigid_angle = state.rigid_angle;
        self.com = state.com;
        for ((of, [q, p, ..]), (displacement, rate)) in
            model.modes.iter().zip(&state.modes).zip(self.displacements.iter_mut().zip(&mut self.rates))
        {
            *displacement = *q;
            *rate = of.frequency * p + of.rotation.dot(&rigid_momentum);
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
    pub event: Option<(f64, usize)>,
}

/// SIMD task that sums the modes' contributions from their states.
pub(super) struct SumModes<'a> {
    pub model: &'a BodyConstants,
    /// q and P/W of each mode.
    pub states: &'a [[f64; 4]],
}

/// Modal sums: sum phi q (rad), sum phi P (rad/s), and the change of the inertia as xx, yy, zz, yz, zx and xy (kg
/// m²).
pub(super) struct ModalSums {
    pub elastic_rotation: Vector,
    pub canonical_elastic_rate: Vector,
    pub inertia_change: [f64; 6],
}

impl SimdTask for SumModes<'_> {
    type Output = ModalSums;

    #[inline(always)]
    fn run<R: LaneFloat>(self, kind: R) -> ModalSums {
        let Self { model, states } = self;
        let zero = kind.splat(0.0);
        let (mut elastic_rotation, mut canonical_elastic_rate, mut inertia_change) = (zero, zero, [zero; 2]);
        let count = model.padded.len().min(states.len());
        let (padded, states) = (&model.padded[..count], &states[..count]);
        for index in 0..count {
            let (of, [q, p, ..]) = (&padded[index], states[index]);
            let (rotation, [first, second]) = (kind.load(&of.rotation), &of.moments);
            elastic_rotation = elastic_rotation + rotation * q;
            canonical_elastic_rate = canonical_elastic_rate + rotation * (of.frequency * p);
            inertia_change =
                [inertia_change[0] + kind.load(first) * q, inertia_change[1] + kind.load(second) * q];
        }
        let mut kept = [[0.0; 4]; 4];
        elastic_rotation.store(&mut kept[0]);
        canonical_elastic_rate.store(&mut kept[1]);
        inertia_change[0].store(&mut kept[2]);
        inertia_change[1].store(&mut kept[3]);
        let [elastic_rotation, canonical_elastic_rate, first, second] = kept;
        ModalSums {
            elastic_rotation: Vector::new(elastic_rotation[0], elastic_rotation[1], elastic_rotation[2]),
            canonical_elastic_rate: Vector::new(
                canonical_elastic_rate[0],
                canonical_elastic_rate[1],
                canonical_elastic_rate[2],
            ),
            inertia_change: [first[0], first[1], first[2], first[3], second[0], second[1]],
        }
    }
}
