//! The wheel of a body with one angle: a disc that turns by its momentum.

use super::PlanarView;
use super::magnification::{rate, slowing};
use super::part::{MARK, WHEEL, cone, cube, entity};
use crate::attitude::Vector;
use crate::body::Planar;
use crate::record::foxglove::SceneEntity;
use crate::record::row::Stamp;
use crate::scenario::Scenario;
use crate::time::Span;

/// A wheel without a rotor of its own is drawn with this part of the body's inertia.
const ROTOR: f64 = 0.02;

/// A wheel: its speed at the start (rad/s), and how many times as much as the body it turns the other way.
#[derive(Clone, Debug)]
pub struct SceneWheel {
    speed: f64,
    ratio: f64,
    /// How many times slower it is drawn than it turns.
    pub slowed: f64,
    /// Angle and rate of the body at the start (rad, rad/s).
    from: (f64, f64),
}

impl SceneWheel {
    /// That of a scenario, if it has one, for frames with this period.
    pub fn of(scenario: &Scenario, body: &Planar, period: Span) -> Option<Self> {
        let (wheel, _) = scenario.actuator.wheel()?;
        let (speed, inertia) = match &wheel.rotor {
            Some(rotor) => (rotor.speed.get(), rotor.inertia.get()),
            None => (0.0, ROTOR * body.inertia.get()),
        };
        let from = (body.angle.get(), body.rate.get());
        let ratio = body.commanded_inertia() / inertia;
        let slowed = slowing((speed.abs() + ratio * rate(scenario, body)) * period.seconds());
        Some(Self { speed, ratio, slowed, from })
    }

    /// The angle by which it is drawn as turned (rad): the integral of its speed, which is what the body's momentum leaves it.
    pub fn angle(&self, view: PlanarView<'_>) -> f64 {
        let (angle, rate) = self.from;
        let turned = self.speed * view.time - self.ratio * (view.rigid_angle - angle - rate * view.time);
        turned / self.slowed
    }
}

/// A disc on a hub with this half edge (m), with a mark that shows how it turns.
pub fn disc(stamp: Stamp, half: f64) -> SceneEntity {
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
