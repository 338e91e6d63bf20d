//! Rows of a log from which the scene of a run is drawn again.

use flexsc_core::Scenario;
use flexsc_core::dynamics::ModeState;
use flexsc_core::numerics::attitude::{Vector, rotation};
use flexsc_core::record::foxglove::FrameTransforms;
use flexsc_core::record::row::LogDate;
use flexsc_core::record::{OneAxisPose, ScenePose, SceneSource, ThreeAxisPose};
use flexsc_core::spacecraft::body::Body;
use flexsc_view::scene::Scene;
use nalgebra::Quaternion;

use crate::error::HandoverError;
use crate::motion_rows::{
    RunLog, check_finite, check_order, check_unit, motion, nanoseconds, nested, numbers,
};

/// Motion of the hub as it is drawn.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum HubMotion {
    /// One-axis body: angle, elastic part included, and rigid angle (rad).
    OneAxis { angle: f64, rigid_angle: f64 },
    /// Three-axis body: attitude of the mean axes.
    ThreeAxis(Quaternion<f64>),
}

/// State of a scene at an instant.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneRow {
    /// Time since the start (ns).
    pub time_ns: u64,
    /// Motion of the hub.
    pub hub: HubMotion,
    /// Modal displacements; rad of a one-axis body, m sqrt(kg) of a three-axis body.
    pub modes: Vec<f64>,
    /// Angles of the drives and then of the hinges (rad).
    pub angles: Vec<f64>,
}

impl SceneRow {
    /// Returns the state with other modal displacements.
    pub fn with_modes(&self, modes: Vec<f64>) -> Self {
        Self { modes, ..self.clone() }
    }

    /// Returns the frames of a scene in this state. `sections` has the weights of the modes in the angle of each section
    /// of a panel, for bodies that have them.
    pub fn draw<'a>(&self, scene: &'a mut Scene, sections: &[Vec<f64>]) -> &'a FrameTransforms {
        let states = |of: &[f64]| -> Vec<ModeState> {
            of.iter().map(|x| ModeState { displacement: *x, quadrature: 0.0 }).collect()
        };
        let modes = states(&self.modes);
        match &self.hub {
            HubMotion::OneAxis { angle, rigid_angle } => {
                let section = |weights: &Vec<f64>| weights.iter().zip(&self.modes).map(|(w, x)| w * x).sum();
                let sections: Vec<f64> = sections.iter().map(section).collect();
                let pose = OneAxisPose {
                    time: self.time_ns as f64 / 1e9,
                    angle: *angle,
                    rigid_angle: *rigid_angle,
                    modes: &modes,
                    sections: &sections,
                };
                scene.frames(LogDate::default(), ScenePose::OneAxis(pose))
            }
            HubMotion::ThreeAxis(attitude) => {
                let pose = ThreeAxisPose { attitude, modes: &modes, angles: &self.angles };
                scene.frames(LogDate::default(), ScenePose::ThreeAxis(pose))
            }
        }
    }
}

/// Returns the weights of the modes in the angle of each section of `[body.panels]`; empty for other bodies.
pub fn section_weights(scenario: &Scenario) -> Vec<Vec<f64>> {
    let (Some(Body::Panels(_)), Some(body)) = (&scenario.body, scenario.model.one_axis()) else {
        return Vec::new();
    };
    body.outputs.iter().map(|output| output.modes.iter().map(|weight| weight.get()).collect()).collect()
}

impl RunLog<'_> {
    /// Returns the states of the scene at the rows of the motion, in order, at least `spacing` (ns) apart apart from the
    /// last.
    ///
    /// # Errors
    /// A log without the motion, or with values that are no numbers.
    pub fn scene_rows(&self, spacing: u64) -> Result<Vec<SceneRow>, HandoverError> {
        let rows = if self.scenario.model.one_axis().is_some() {
            self.one_axis_scene(spacing)
        } else {
            self.three_axis_scene(spacing)
        }?;
        check_order(rows.iter().map(|row| row.time_ns))?;
        for row in &rows {
            let angles = match &row.hub {
                HubMotion::OneAxis { angle, rigid_angle } => [*angle, *rigid_angle],
                HubMotion::ThreeAxis(attitude) => {
                    check_unit(row.time_ns, attitude)?;
                    [0.0; 2]
                }
            };
            let numbers = row.modes.iter().chain(&row.angles).copied();
            check_finite(row.time_ns, numbers.chain(angles))?;
        }
        Ok(rows)
    }

    fn one_axis_scene(&self, spacing: u64) -> Result<Vec<SceneRow>, HandoverError> {
        let [attitude, modes] = self.tables(["/attitude", "/modes"])?;
        let attitude = motion(attitude)?;
        let (angles, rigid) = (numbers(&attitude, "angle_rad")?, numbers(&attitude, "rigid_rad")?);
        let count = self.scenario.mode_count();
        let modal = modes.as_ref().map(|of| nested(of, "modes", "displacement_rad", count)).transpose()?;
        let modal = modal.unwrap_or_default();
        let row = |index: usize, time_ns: u64| SceneRow {
            time_ns,
            hub: HubMotion::OneAxis { angle: angles[index], rigid_angle: rigid[index] },
            modes: nested_values(modal, index, count),
            angles: Vec::new(),
        };
        Ok(spaced(numbers(&attitude, "time_s")?, spacing).map(|(index, time)| row(index, time)).collect())
    }

    fn three_axis_scene(&self, spacing: u64) -> Result<Vec<SceneRow>, HandoverError> {
        let [pointing, vibrations, drives, hinges] =
            self.tables(["/pointing", "/vibrations", "/drives", "/hinges"])?;
        let pointing = motion(pointing)?;
        let [w, x, y, z] = ["q_w", "q_x", "q_y", "q_z"].map(|name| numbers(&pointing, name));
        let (w, x, y, z) = (w?, x?, y?, z?);
        let count = self.scenario.mode_count();
        // With hinges, which move by any angle, a scene has no modes.
        let vibrating = vibrations.as_ref().filter(|_| hinges.is_none());
        let modal = vibrating.map(|of| nested(of, "modes", "displacement", count)).transpose()?;
        let modal = modal.unwrap_or_default();
        let parts = self.scenario.study.drives.as_ref();
        let driven = parts.map_or(0, |drives| drives.driven.drives());
        let hinged =
            parts.map_or(0, |drives| drives.driven.panels.iter().filter(|of| of.hinge.is_some()).count());
        let drive = drives.as_ref().map(|of| nested(of, "drives", "angle_rad", driven)).transpose()?;
        let hinge = hinges.as_ref().map(|of| nested(of, "hinges", "angle_rad", hinged)).transpose()?;
        let (drive, hinge) = (drive.unwrap_or_default(), hinge.unwrap_or_default());
        let hub = self.hub_rotations().filter(|_| hinges.is_none());
        let row = |index: usize, time_ns: u64| {
            let modes = nested_values(modal, index, count);
            let logged = Quaternion::new(w[index], x[index], y[index], z[index]);
            let bent = hub.iter().flatten().zip(&modes);
            let bent = bent.fold(Vector::zeros(), |sum, (shape, x)| sum + shape * *x);
            let mut angles = nested_values(drive, index, driven);
            angles.extend(nested_values(hinge, index, hinged));
            SceneRow { time_ns, hub: HubMotion::ThreeAxis(logged * rotation(&-bent)), modes, angles }
        };
        Ok(spaced(numbers(&pointing, "time_s")?, spacing).map(|(index, time)| row(index, time)).collect())
    }
}

/// Returns the values of the nested rows at a row, of equal widths: zeros past the end of a topic, and none if the log does
/// not have it.
fn nested_values(values: &[f64], row: usize, width: usize) -> Vec<f64> {
    match values.get(row * width..(row + 1) * width) {
        Some(values) => values.to_vec(),
        None if values.is_empty() => Vec::new(),
        None => vec![0.0; width],
    }
}

/// Returns the indices and times (ns) of rows at least `spacing` apart, and of the last.
fn spaced(times: &[f64], spacing: u64) -> impl Iterator<Item = (usize, u64)> + '_ {
    let mut next = 0;
    times.iter().enumerate().filter_map(move |(index, time)| {
        let time = nanoseconds(*time);
        let is_due = time >= next || (index + 1 == times.len() && time.saturating_add(spacing) > next);
        if is_due {
            next = time.saturating_add(spacing.max(1));
        }
        is_due.then_some((index, time))
    })
}
