//! Three-axis body at the current instant, and the quantities that each of its motions gives to the record.

use flexsc_control::sensor::{Orientation, Truth};
use flexsc_dynamics::flow::{ElasticModes, RigidBody, ThreeAxisState};
use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_dynamics::wrench::Wrench;
use flexsc_dynamics::{AxisState, ModeState};
use flexsc_numerics::attitude::{Vector, rotation_vector};
use flexsc_numerics::time::Instant;
use flexsc_spacecraft::environment::SurroundingsState;
use nalgebra::Quaternion;

use super::two_way_motion::TwoWaySegment;
use flexsc_scenario::ResolvedScenario;

/// A mode is visible to a sensor if it rotates the sensor by at least this fraction of the largest modal rotation
/// there.
const VISIBLE: f64 = 0.1;

/// Three-axis body at the current instant, with the rotations of its points by the modes.
#[derive(Clone, Debug)]
pub struct ThreeAxisBody {
    pub rigid: RigidBody,
    pub elastic: ElasticModes,
    /// Modal rotations at the first sensor, and (`torque_rotations`) at the point where torques act.
    pub sensor_rotations: Vec<Vector>,
    pub torque_rotations: Vec<Vector>,
    /// Differences of the modal rotations at each other sensor from those at the first.
    rotation_offsets: Vec<Vec<Vector>>,
    /// True for modes that are visible to the first sensor.
    visible: Vec<bool>,
    /// State at `evaluated_at`, seen from the mean axes, which no mode rotates.
    pub state: ThreeAxisState,
    pub evaluated_at: Instant,
    /// True if the true state at `evaluated_at` has been written.
    pub has_truth: bool,
    /// Rigid rates, and elastic part of the rates at the first sensor (rad/s), of the last true state.
    pub rates: (Vector, Vector),
}

/// Quantities of a three-axis motion for the record.
pub trait ThreeAxisQuantities {
    /// Returns the body at the current instant.
    fn body(&self) -> &ThreeAxisBody;

    /// Returns the environment of the body; `None` without one.
    fn surroundings(&self) -> Option<&SurroundingsState>;

    /// Returns the attitude of the hub.
    fn attitude(&self) -> &Quaternion<f64>;

    /// Returns the torque of the environment, magnetorquers included, and of the body's own disturbance, in body axes (N
    /// m); `None` if there is neither.
    fn external_torque(&self) -> Option<Vector>;

    /// Returns the energy of the rotation (J), and the angular momentum including rotors (N m s).
    fn rotational_energy(&self) -> (f64, f64);

    /// Returns the energy of each mode (J).
    fn modal_energies(&self) -> Vec<f64>;

    /// Returns the elastic energy (J) at the current instant: total, and of the modes visible to the first sensor. Slow
    /// modes with little rotation there are excluded, because no law can damp them.
    fn elastic_energies(&self) -> (f64, f64);

    /// Returns an upper bound on the frequencies in the motion (rad/s): the sum of the fastest mode and of all rates that
    /// rotate or drive the body, so that their products are included.
    fn fastest_frequency(&self) -> f64;

    /// Returns the motion whose modes act back on the rotation; `None` for another one.
    fn two_way(&self) -> Option<TwoWaySegment<'_>> {
        None
    }
}

impl ThreeAxisBody {
    /// Creates the body at the start.
    pub fn new(body: &ThreeAxisModel, study: &ResolvedScenario) -> Self {
        let rotations = |point: &str| -> Vec<Vector> {
            body.shapes(point).into_iter().map(|(_, rotation)| rotation).collect()
        };
        let (first, others) =
            study.sensor_points.split_first().map_or(("", &[][..]), |(first, others)| (first, others));
        let sensed = rotations(first);
        let beyond_first = |point: &String| -> Vec<Vector> {
            rotations(point).iter().zip(&sensed).map(|(there, first)| there - first).collect()
        };
        let rigid = RigidBody::new(body);
        let most = sensed.iter().map(Vector::norm).fold(0.0, f64::max);
        Self {
            elastic: ElasticModes::new(body, study.assessment_period.seconds()),
            torque_rotations: rotations(&study.torque_point),
            rotation_offsets: others.iter().map(beyond_first).collect(),
            visible: sensed.iter().map(|rotation| rotation.norm() >= VISIBLE * most).collect(),
            sensor_rotations: sensed,
            state: ThreeAxisState::start(body, &rigid),
            rigid,
            evaluated_at: Instant::START,
            has_truth: false,
            rates: (Vector::zeros(), Vector::zeros()),
        }
    }

    /// Returns the true state at a sensor other than the first, where it is `first`.
    pub fn truth_at_sensor(&self, first: &Truth, sensor: usize) -> Truth {
        let shapes = &self.rotation_offsets[sensor - 1];
        let (angle, rate) = (self.modal_rotation(shapes), self.elastic.rate_at(shapes, &self.state.modes));
        Truth {
            elastic: (Vector::from(first.elastic) + angle).into(),
            rate: (Vector::from(first.rate) + rate).into(),
            rate_integral: (Vector::from(first.rate_integral) + angle).into(),
            ..*first
        }
    }

    /// Returns the rotation of a point by all modes (rad).
    pub fn modal_rotation(&self, shapes: &[Vector]) -> Vector {
        let displacements = self.state.modes.iter().map(|phase| phase.displacement);
        displacements.zip(shapes).fold(Vector::zeros(), |sum, (q, shape)| sum + shape * q)
    }

    /// Returns the motion about an axis as if that axis were alone, with the angle counted from `target` and the modes
    /// by their angles at the first sensor.
    pub fn about_axis(&self, axis: usize, target: &Orientation) -> AxisState {
        let Orientation::Attitude(goal) = target else { return AxisState::default() };
        let phase = |(phase, shape): (&ModeState, &Vector)| ModeState {
            displacement: shape[axis] * phase.displacement,
            quadrature: shape[axis] * phase.quadrature,
        };
        AxisState {
            rigid_angle: rotation_vector(goal, &self.state.turn.attitude)[axis],
            rigid_rate: self.rigid.rate(&self.state.turn)[axis],
            modes: self.state.modes.iter().zip(&self.sensor_rotations).map(phase).collect(),
        }
    }

    /// Returns the free modes, scaled to the size of their rotations of the first sensor (rad).
    pub fn modal_state(&self) -> AxisState {
        let phase = |(phase, shape): (&ModeState, &Vector)| {
            let size = shape.norm();
            ModeState { displacement: size * phase.displacement, quadrature: size * phase.quadrature }
        };
        let modes = self.state.modes.iter().zip(&self.sensor_rotations).map(phase).collect();
        AxisState { modes, ..AxisState::default() }
    }

    /// Returns the modal forces of an actuator's wrench (N/sqrt(kg)).
    pub fn modal_forces(&self, wrench: &Wrench) -> Vec<f64> {
        let change = wrench.rotors.iter().fold(Vector::zeros(), |sum, of| sum + of.axis * of.torque);
        let hub = Vector::from(wrench.hub) - change;
        let given = wrench.forces.iter().copied().chain(std::iter::repeat(0.0));
        self.torque_rotations.iter().zip(given).map(|(shape, force)| force + shape.dot(&hub)).collect()
    }

    /// Returns the rates of the modes (m sqrt(kg)/s).
    pub fn mode_rates(&self) -> impl Iterator<Item = f64> {
        self.elastic.rates(&self.state.modes)
    }

    /// Returns the sum of the energies of the modes (J), and that of the modes visible to the first sensor.
    pub fn sum_energies(&self, energies: impl Iterator<Item = f64>) -> (f64, f64) {
        energies.zip(&self.visible).fold((-0.0, -0.0), |(all, visible), (energy, is_visible)| {
            (all + energy, if *is_visible { visible + energy } else { visible })
        })
    }
}
