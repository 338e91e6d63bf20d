//! Rows of the motion of a three-axis body, joined from the body, its loads, sensors and estimates.

use flexsc_record::{AxisRate, Rates, ThreeAxisMotionSample, Torque, Torques, Wheels};

use super::bearing_rows::bearing_rows;
use crate::sim::plant::ThreeAxisPlant;
use crate::sim::run_view::RunView;

/// Returns the rows of a three-axis motion at the current instant; `jets_only` if jets are the only actuator.
pub fn spatial_motion(run: &RunView<'_>, plant: &ThreeAxisPlant, jets_only: bool) -> ThreeAxisMotionSample {
    let (now, actuator) = (run.now, &run.loads.actuator);
    let truth = run.plant.truth();
    let (rigid, elastic) = plant.rates();
    let axis = |axis: usize| AxisRate {
        rate_rad_s: rigid[axis] + elastic[axis],
        rigid_rad_s: rigid[axis],
        elastic_rad_s: elastic[axis],
        measured_rad_s: run.sensors.measured[axis][1],
        believed_rad_s: run.estimation.estimates[axis].rate,
    };
    let (around, magnetic) = (plant.environment_torque(), plant.magnetic_torque());
    let torque = |axis: usize| Torque {
        feedforward_nm: 0.0,
        feedback_nm: actuator.demanded_torque(axis),
        applied_nm: magnetic[axis]
            + actuator.applied_torque(now, axis, [rigid[axis] + elastic[axis], rigid[axis]]),
        disturbance_nm: {
            let others = run.loads.disturbance(now, axis);
            around.map_or(others, |around| others + around[axis])
        },
    };
    let wheels = actuator.wheels(now, (rigid + elastic).into());
    // If only jets act, the torques follow from the recorded pulses.
    let alone = jets_only && !plant.has_environment();
    let torques = (!alone).then(|| Torques { axes: [0, 1, 2].map(torque).into() });
    ThreeAxisMotionSample {
        pointing: plant.pointing(truth.orientation.error_from(&run.guidance.origin(now))),
        rates: Rates { axes: [0, 1, 2].map(axis).into() },
        vibrations: plant.vibrations(),
        energy: plant.energy(),
        position: plant.position(),
        torques,
        wheels: (!wheels.is_empty()).then_some(Wheels { wheels }),
        gimbals: actuator.gimbal_row(now),
        orbit: plant.orbit(),
        magnetorquers: actuator.magnetorquer_row(),
        envelope: run.estimation.monitor.as_ref().map(|monitor| monitor.envelope(now)),
        bearings: bearing_rows(run),
        drives: plant.drives(),
        hinges: plant.hinges(),
    }
}
