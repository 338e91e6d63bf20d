//! Lines of sight of a run: nothing in the loop reads them; their samples go to the record.

use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{LineOfSightAxis, LineOfSightSample, Record, RecordError, Sample};
use flexsc_spacecraft::environment::to_body;

use crate::guidance::Guidance;
use crate::plant::Plant;
use crate::run_view::RunView;
use flexsc_scenario::{LineOfSight, LineSensitivity, Scenario};
use nalgebra::Quaternion;

/// Run-time state of the lines of sight.
#[derive(Clone, Debug, Default)]
pub struct LinesOfSight(Vec<MountedLine>);

/// Line of sight of an instrument on its mount.
#[derive(Clone, Debug)]
struct MountedLine {
    direction: Vector,
    period: Span,
    next: Instant,
    /// Rotation of the point per unit of each mode, less that of the first sensor (rad/(m sqrt(kg))).
    offsets: Vec<Vector>,
    /// Rotation (rad/(m sqrt(kg))) and displacement (1/sqrt(kg)) of the point relative to the hub per unit of each mode.
    rotations: Vec<Vector>,
    displacements: Vec<Vector>,
    /// Effect of its optics; `None` if it turns with its point.
    optics: Option<LineSensitivity>,
}

impl MountedLine {
    /// Creates a line of sight of a scenario, before its start; `None` on a body with one axis.
    fn new(scenario: &Scenario, line: &LineOfSight) -> Option<Self> {
        let body = scenario.model.three_axis()?;
        let rotations = |point: &str| -> Vec<Vector> {
            body.shapes(point).into_iter().map(|(_, rotation)| rotation).collect()
        };
        let difference = |from: &str| -> Vec<Vector> {
            rotations(&line.point).iter().zip(rotations(from)).map(|(there, here)| there - here).collect()
        };
        let hub = body.points.first().map_or("", |point| &point.name);
        Some(Self {
            direction: line.direction(),
            period: line.period,
            next: Instant::START,
            offsets: difference(scenario.study.sensor_points.first()?),
            rotations: difference(hub),
            displacements: body.displacements(&line.point, &Vector::zeros()),
            optics: (!line.optics.is_empty()).then(|| of_hub(line.sensitivity(body), body)),
        })
    }

    /// Returns the rotation (rad) from the target direction to the actual one; `None` on a body with one axis.
    fn error(&self, plant: &Plant, guidance: &Guidance, now: Instant) -> Option<Vector> {
        let (truth, body) = (plant.truth(), plant.quantities().three_axis()?.body());
        let target = guidance.origin(now).attitude()?;
        // Rotation of the direction in the axes of the target.
        let turned = |instrument: Quaternion<f64>| {
            let seen: Vector = to_body(&(instrument.conjugate() * target), &self.direction);
            rotation_between(&self.direction, &seen)
        };
        if let Some(optics) = &self.optics {
            let rigid = turned(truth.orientation.attitude()?);
            return Some(optics.rigid * rigid + body.modal_rotation(&optics.modes));
        }
        let bent = Vector::from(truth.elastic) + body.modal_rotation(&self.offsets);
        Some(turned(truth.orientation.rotated_by(bent.into()).attitude()?))
    }

    /// Returns the sample of the line of sight with this index; `None` on a body with one axis.
    fn sample(&self, index: usize, run: &RunView<'_>) -> Option<LineOfSightSample> {
        let error = self.error(run.plant, run.guidance, run.now)?;
        let body = run.plant.quantities().three_axis()?.body();
        let sum = |shapes: &[Vector]| body.modal_rotation(shapes);
        let (turned, moved) = (sum(&self.rotations), sum(&self.displacements));
        let axis = |axis: usize| LineOfSightAxis {
            error_rad: error[axis],
            rotation_rad: turned[axis],
            displacement_m: moved[axis],
        };
        Some(LineOfSightSample {
            line: index as u64,
            error_rad: error.norm(),
            axes: [0, 1, 2].map(axis).into(),
        })
    }
}

impl LinesOfSight {
    /// Creates the lines of sight of a scenario, before its start.
    pub fn new(scenario: &Scenario) -> Self {
        Self(scenario.line_of_sight.iter().filter_map(|line| MountedLine::new(scenario, line)).collect())
    }

    /// Returns the rotation (rad) of a line of sight from its target direction; `None` on a body with one axis.
    pub fn error(&self, line: usize, plant: &Plant, guidance: &Guidance, now: Instant) -> Option<Vector> {
        self.0.get(line)?.error(plant, guidance, now)
    }

    /// Returns the next instant at which a line of sight is sampled.
    pub fn due(&self) -> Option<Instant> {
        self.0.iter().map(|line| line.next).min()
    }

    /// Records the samples that are due, after all parts have acted.
    pub fn record_due(&mut self, run: &RunView<'_>, record: &mut dyn Record) -> Result<(), RecordError> {
        for (index, line) in self.0.iter_mut().enumerate() {
            if line.next > run.now {
                continue;
            }
            line.next = run.now + line.period;
            if let Some(sample) = line.sample(index, run) {
                record.record(run.now, Sample::Row(&sample))?;
            }
        }
        Ok(())
    }
}

/// Returns a sensitivity to the rotation of the hub, whose attitude a run has, in place of that of the rigid body.
fn of_hub(mut sight: LineSensitivity, body: &ThreeAxisModel) -> LineSensitivity {
    let hub = body.coupling.as_ref().map_or(&[][..], |coupling| &coupling.rotations);
    for (mode, rotation) in sight.modes.iter_mut().zip(hub) {
        *mode -= sight.rigid * rotation;
    }
    sight
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
