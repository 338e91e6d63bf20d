//! Scene of a run for viewers: its parts, its frames when they are due, its plumes when they change.

use flexsc_record::{Hinges, OneAxisPose, Record, Sample, ScenePose, SceneThrust, ThreeAxisPose};
use flexsc_spacecraft::flow::ThreeAxisState;

use super::plant::Plant;
use super::{Simulation, SimulationError};

impl Simulation {
    /// Records the parts of the scene that the record supplies, if any.
    pub(super) fn record_scene(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let (now, telling) = (self.now, &mut self.recorder);
        telling.scene = record.scene();
        if let Some(scene) = &telling.scene {
            record.record(now, Sample::Scene(&scene.parts(telling.events.stamp(now))))?;
            telling.next_frames = Some(now);
        }
        Ok(())
    }

    /// Records the frames that are due and the plumes that have changed.
    pub(super) fn record_frames(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        if self.recorder.scene.is_none() {
            return Ok(());
        }
        let now = self.now;
        let stamp = self.recorder.events.stamp(now);
        self.plant.evaluate(now)?;
        let frames = self.recorder.next_frames == Some(now);
        let Some(scene) = &mut self.recorder.scene else { return Ok(()) };
        if frames {
            self.recorder.next_frames = Some(now + scene.period());
        }
        let truth = self.plant.truth();
        let thrust = match &self.plant {
            Plant::OneAxis(plant) => {
                let state = plant.state();
                if frames {
                    let sections = plant.outputs().map_or_else(Vec::new, |outputs| outputs.outputs);
                    let sections: Vec<f64> = sections.into_iter().map(|output| output.value).collect();
                    let pose = OneAxisPose {
                        time: now.seconds(),
                        angle: truth.sensor_angles()[0],
                        rigid_angle: state.rigid_angle,
                        modes: &state.modes,
                        sections: &sections,
                    };
                    record.record(now, Sample::Frames(scene.frames(stamp, ScenePose::OneAxis(pose))))?;
                }
                let rates = [truth.rate[0], truth.rigid[0]];
                SceneThrust::Torque(self.loads.actuator.applied_torque(now, 0, rates))
            }
            Plant::ThreeAxis(plant) => {
                if frames {
                    let ThreeAxisState { turn, modes } = plant.state();
                    let drives = plant.drives().map_or_else(Vec::new, |of| of.drives);
                    let mut angles: Vec<f64> = drives.iter().map(|drive| drive.angle_rad).collect();
                    // Hinges move by any angle; with hinges, modes are not drawn.
                    let (attitude, modes) = match plant.hinges() {
                        Some(Hinges { hinges }) => {
                            angles.extend(hinges.iter().map(|hinge| hinge.angle_rad));
                            (plant.attitude(), &[][..])
                        }
                        None => (&turn.attitude, &modes[..]),
                    };
                    let pose = ScenePose::ThreeAxis(ThreeAxisPose { attitude, modes, angles: &angles });
                    record.record(now, Sample::Frames(scene.frames(stamp, pose)))?;
                }
                let cycle = self.loads.actuator.jet_cycle();
                let (signs, open) = cycle.map_or(([0.0; 3], Vec::new()), |cycle| (cycle.burning, cycle.open));
                SceneThrust::Jets { signs, open }
            }
        };
        let plumes = scene.plumes(stamp, thrust);
        Ok(plumes.map_or(Ok(()), |plumes| record.record(now, Sample::Plumes(&plumes)))?)
    }
}
