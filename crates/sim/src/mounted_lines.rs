//! Errors of lines of sight: where instruments look, against their target directions.

use flexsc_numerics::attitude::{Vector, rotation_vector};
use flexsc_numerics::time::Instant;
use flexsc_spacecraft::environment::to_body;

use super::guidance::Guidance;
use super::plant::Plant;
use flexsc_scenario::{LineOfSight, LineSensitivity, Scenario};

/// All lines of sight of a scenario on their mounts.
#[derive(Clone, Debug, Default)]
pub struct MountedLines(Vec<MountedLine>);

/// Line of sight of an instrument on its mount.
#[derive(Clone, Debug)]
struct MountedLine {
    direction: Vector,
    /// Rotation of the point per unit of each mode, less that of the first sensor (rad/(m sqrt(kg))).
    offsets: Vec<Vector>,
    /// Effect of its optics; `None` if it turns with its point.
    optics: Option<LineSensitivity>,
}

impl MountedLine {
    /// Creates a line of sight of a scenario; `None` on a body with one axis.
    fn new(scenario: &Scenario, line: &LineOfSight) -> Option<Self> {
        let body = scenario.model.three_axis()?;
        let rotations = |point: &str| body.shapes(point).into_iter().map(|(_, rotation)| rotation);
        let sensor = rotations(scenario.study.sensor_points.first()?);
        Some(Self {
            direction: line.direction(),
            offsets: rotations(&line.point).zip(sensor).map(|(there, here)| there - here).collect(),
            optics: (!line.optics.is_empty()).then(|| line.sensitivity(body).besides_hub(body)),
        })
    }

    /// Returns the rotation (rad) from the target direction to the actual one; `None` on a body with one axis.
    fn error(&self, plant: &Plant, guidance: &Guidance, now: Instant) -> Option<Vector> {
        let (truth, body) = (plant.truth(), plant.quantities().three_axis()?.body());
        let target = guidance.origin(now).attitude()?;
        if let Some(optics) = &self.optics {
            // Optics off the boresight see the rotation about it too.
            let rigid = rotation_vector(&target, &truth.orientation.attitude()?);
            return Some(optics.rigid * rigid + body.modal_rotation(&optics.modes));
        }
        let bent = Vector::from(truth.elastic) + body.modal_rotation(&self.offsets);
        let instrument = truth.orientation.rotated_by(bent.into()).attitude()?;
        // Direction in the axes of the target.
        let seen: Vector = to_body(&(instrument.conjugate() * target), &self.direction);
        Some(rotation_between(&self.direction, &seen))
    }
}

impl MountedLines {
    /// Creates the lines of sight of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        Self(scenario.line_of_sight.iter().filter_map(|line| MountedLine::new(scenario, line)).collect())
    }

    /// Returns the rotation (rad) of a line of sight from its target direction, before a mirror; `None` on a body with one axis.
    pub fn error(&self, line: usize, plant: &Plant, guidance: &Guidance, now: Instant) -> Option<Vector> {
        self.0.get(line)?.error(plant, guidance, now)
    }
}

/// Returns the rotation vector (rad), perpendicular to both, from a unit vector to another.
fn rotation_between(from: &Vector, to: &Vector) -> Vector {
    let across = from.cross(to);
    let sine = across.norm();
    if sine == 0.0 {
        return if from.dot(to) < 0.0 { half_turn(from) } else { Vector::zeros() };
    }
    across * (libm::atan2(sine, from.dot(to)) / sine)
}

/// Returns the rotation vector of a half turn (rad) about an axis perpendicular to a unit vector.
fn half_turn(from: &Vector) -> Vector {
    let axis = from.iamin();
    from.cross(&Vector::ith(axis, 1.0)).normalize() * std::f64::consts::PI
}
