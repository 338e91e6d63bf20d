//! Wheel of a one-axis body: a disc that rotates by its momentum.

use flexsc_core::Scenario;
use flexsc_core::dynamics::axis_model::AxisModel;
use flexsc_core::numerics::attitude::Vector;
use flexsc_core::numerics::time::Span;
use flexsc_core::record::OneAxisPose;
use flexsc_core::record::foxglove::SceneEntity;
use flexsc_core::record::row::LogDate;

use super::magnification::{expected_rate, slow_down_factor};
use super::primitives::{MARK, WHEEL, cone, cube, entity};

/// Inertia of a wheel without a rotor model, relative to the body's inertia, as drawn.
const ROTOR: f64 = 0.02;

/// Wheel: its initial speed (rad/s), and the ratio by which it rotates against the body.
#[derive(Clone, Debug)]
pub struct SceneWheel {
    speed: f64,
    ratio: f64,
    /// Factor by which the drawn rotation is slower than the true one.
    pub slowed: f64,
    /// Angle and rate of the body at the start (rad, rad/s).
    from: (f64, f64),
}

impl SceneWheel {
    /// Returns the wheel of a scenario for frames with a period; `None` without a wheel.
    pub fn from_scenario(scenario: &Scenario, body: &AxisModel, period: Span) -> Option<Self> {
        let (wheel, _) = scenario.actuator.flywheel()?;
        let (speed, inertia) = match &wheel.rotor {
            Some(rotor) => (rotor.speed.get(), rotor.inertia.get()),
            None => (0.0, ROTOR * body.inertia.get()),
        };
        let from = (body.angle.get(), body.rate.get());
        let ratio = body.commanded_inertia() / inertia;
        let slowed =
            slow_down_factor((speed.abs() + ratio * expected_rate(scenario, body)) * period.seconds());
        Some(Self { speed, ratio, slowed, from })
    }

    /// Returns the drawn angle of the wheel (rad): the integral of its speed, which follows from the body's momentum.
    pub fn angle(&self, view: OneAxisPose<'_>) -> f64 {
        let (angle, rate) = self.from;
        let turned = self.speed * view.time - self.ratio * (view.rigid_angle - angle - rate * view.time);
        turned / self.slowed
    }
}

/// Creates a disc on a hub with the half edge `half` (m), with a mark that shows the rotation.
pub fn disc(stamp: LogDate, half: f64) -> SceneEntity {
    let mut disc = entity(stamp, "wheel", "wheel");
    let (low, high) = (Vector::z() * (-0.15 * half), Vector::z() * (0.15 * half));
    disc.cylinders.push(cone(low, high, [2.6 * half; 2], WHEEL));
    disc.cubes.push(cube(
        Vector::new(0.65 * half, 0.0, 0.16 * half),
        Vector::new(1.25 * half, 0.18 * half, 0.08 * half),
        MARK,
    ));
    disc
}
