//! Lines of sight of a run: nothing in the loop reads them; their samples go to the record.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{
    FineMirrorAxis, FineMirrorSample, LineOfSightAxis, LineOfSightSample, Record, RecordError, Sample,
};

use crate::fine_mirrors::MirrorReading;
use crate::mounted_lines::MountedLines;
use crate::run_view::RunView;
use flexsc_scenario::{LineOfSight, Scenario};

/// Schedule of the samples of the lines of sight.
#[derive(Clone, Debug)]
pub struct LinesOfSight {
    lines: MountedLines,
    schedules: Vec<LineSchedule>,
}

/// Schedule of a line of sight, and the motion of its point.
#[derive(Clone, Debug)]
struct LineSchedule {
    period: Span,
    next: Instant,
    /// Rotation (rad/(m sqrt(kg))) and displacement (1/sqrt(kg)) of the point relative to the hub per unit of each mode.
    rotations: Vec<Vector>,
    displacements: Vec<Vector>,
}

impl LineSchedule {
    /// Creates the schedule of a line of sight, before its start; `None` on a body with one axis.
    fn new(scenario: &Scenario, line: &LineOfSight) -> Option<Self> {
        let body = scenario.model.three_axis()?;
        let rotations = |point: &str| body.shapes(point).into_iter().map(|(_, rotation)| rotation);
        let hub = body.points.first().map_or("", |point| &point.name);
        Some(Self {
            period: line.period,
            next: Instant::START,
            rotations: rotations(&line.point).zip(rotations(hub)).map(|(there, here)| there - here).collect(),
            displacements: body.displacements(&line.point, &Vector::zeros()),
        })
    }
}

impl LinesOfSight {
    /// Creates the schedule of a scenario, before its start.
    pub fn new(scenario: &Scenario) -> Self {
        let schedule = |line| LineSchedule::new(scenario, line);
        Self {
            lines: MountedLines::new(scenario),
            schedules: scenario.line_of_sight.iter().filter_map(schedule).collect(),
        }
    }

    /// Returns the next instant at which a line of sight is sampled.
    pub fn due(&self) -> Option<Instant> {
        self.schedules.iter().map(|line| line.next).min()
    }

    /// Returns the sample of the line of sight with this index, and that of its mirror if it has one; `None` on a body with one
    /// axis.
    fn sample(
        &self,
        index: usize,
        run: &RunView<'_>,
    ) -> Option<(LineOfSightSample, Option<FineMirrorSample>)> {
        let before = self.lines.error(index, run.plant, run.guidance, run.now)?;
        let mirror = run.mirrors.reading(index, run.now);
        let error = mirror.map_or(before, |mirror| before - mirror.angle);
        let body = run.plant.quantities().three_axis()?.body();
        let LineSchedule { rotations, displacements, .. } = &self.schedules[index];
        let (turned, moved) = (body.modal_rotation(rotations), body.modal_rotation(displacements));
        let axis = |axis: usize| LineOfSightAxis {
            error_rad: error[axis],
            rotation_rad: turned[axis],
            displacement_m: moved[axis],
        };
        let line = index as u64;
        let sample = LineOfSightSample { line, error_rad: error.norm(), axes: [0, 1, 2].map(axis).into() };
        let of_mirror = mirror.map(|MirrorReading { angle, command, limited }| {
            let axis = |axis: usize| FineMirrorAxis {
                before_rad: before[axis],
                angle_rad: angle[axis],
                command_rad: command[axis],
            };
            FineMirrorSample { line, limited, axes: [0, 1, 2].map(axis).into() }
        });
        Some((sample, of_mirror))
    }

    /// Records the samples that are due, after all parts have acted.
    pub fn record_due(&mut self, run: &RunView<'_>, record: &mut dyn Record) -> Result<(), RecordError> {
        for index in 0..self.schedules.len() {
            if self.schedules[index].next > run.now {
                continue;
            }
            self.schedules[index].next = run.now + self.schedules[index].period;
            if let Some((sample, mirror)) = self.sample(index, run) {
                record.record(run.now, Sample::Row(&sample))?;
                mirror.map_or(Ok(()), |mirror| record.record(run.now, Sample::Row(&mirror)))?;
            }
        }
        Ok(())
    }
}
