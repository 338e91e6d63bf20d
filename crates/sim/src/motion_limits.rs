//! Bounds on how fast a three-axis body can turn, and its modes with it, before its loads change.

use flexsc_dynamics::three_axis::Surroundings;
use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::Instant;
use flexsc_scenario::Scenario;

use super::plant::Plant;

/// Reserve in the bounds, for motions that the free modes at the start of a step do not describe: drives, hinges, gimbals,
/// and changes of the inertia.
pub const RESERVE: f64 = 2.0;

/// Constants of the body for the bounds of its rates.
#[derive(Copy, Clone, Debug, Default)]
pub struct MotionLimits {
    /// Inverse of the least moment of inertia (1/(kg m²)).
    inverse_inertia: f64,
    /// Norm of the modal rotations at the point where torques act (rad/(m sqrt(kg))).
    modal_torque: f64,
}

impl MotionLimits {
    /// Creates the limits of a scenario's body.
    pub fn new(scenario: &Scenario, body: &ThreeAxisModel) -> Self {
        let least = body.inertia.symmetric_eigenvalues().min();
        Self {
            inverse_inertia: 1.0 / least,
            modal_torque: modal_rotation(body, &scenario.study.torque_point),
        }
    }

    /// Returns a bound of the rate (rad/s) at which a point with this norm of its modal rotations turns with the modes, all in
    /// phase.
    pub fn elastic_rate(plant: &Plant, modal_rotation: f64) -> f64 {
        let motion = plant.quantities().three_axis();
        motion.map_or(0.0, |motion| modal_rotation * f64::sqrt(2.0 * motion.elastic_energies().0.max(0.0)))
    }

    /// Returns a bound of the growth (rad/s²) of the rate of such a point, under the torque of the loads (N m) and that of the
    /// environment.
    pub fn growth(&self, plant: &Plant, modal_rotation: f64, torque: f64) -> f64 {
        let Some(motion) = plant.quantities().three_axis() else { return 0.0 };
        let rate = Vector::from(plant.truth().rigid_rate).norm();
        let (_, momentum) = motion.rotational_energy();
        let torque = torque + motion.surroundings().map_or(0.0, Surroundings::bound);
        self.inverse_inertia * (torque + rate * momentum) + modal_rotation * self.modal_torque * torque
    }

    /// Returns a bound of the thermal forces on the modes (N/sqrt(kg)) up to an instant from the last one at which the light
    /// began to change, or ceased to: a level under steady light only rises or falls, and none is above 1.
    pub fn thermal_force(plant: &Plant, now: Instant, is_light_steady: bool) -> f64 {
        let around = plant.quantities().three_axis().and_then(|motion| motion.surroundings());
        let each = around.into_iter().flat_map(|around| {
            around.thermal_forces().iter().enumerate().map(move |(index, heated)| {
                let level =
                    if is_light_steady { around.thermal_level(index, now.seconds()).abs() } else { 1.0 };
                level * heated.forces.iter().map(|force| force * force).sum::<f64>().sqrt()
            })
        });
        each.sum()
    }

    /// Returns a bound of the second derivative (rad/s³) of the rigid rate under a constant torque (N m) and that of the
    /// environment, given bounds of the elastic rate (rad/s) and of the acceleration (rad/s²) of the hub.
    pub fn bend(&self, plant: &Plant, [elastic, acceleration]: [f64; 2], torque: f64, now: Instant) -> f64 {
        let Some(motion) = plant.quantities().three_axis() else { return 0.0 };
        let rate = Vector::from(plant.truth().rigid_rate).norm() + elastic;
        let (_, momentum) = motion.rotational_energy();
        let [environment, varies] = motion.surroundings().map_or([0.0; 2], |surroundings| {
            [surroundings.bound(), surroundings.frequency_at(now.seconds())]
        });
        self.inverse_inertia
            * (acceleration * momentum
                + rate * (torque + environment + rate * momentum)
                + environment * (varies + rate))
    }
}

/// Returns the norm of the modal rotations at a point (rad/(m sqrt(kg))).
pub fn modal_rotation(body: &ThreeAxisModel, point: &str) -> f64 {
    let squares = body.shapes(point).into_iter().map(|(_, rotation)| rotation.norm_squared());
    f64::sqrt(squares.sum())
}
