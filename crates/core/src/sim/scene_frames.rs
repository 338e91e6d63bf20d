//! Scene of a run for viewers: its parts, its frames when they are due, its plumes when they change.

use flexsc_control::actuator::PulsedActuator;
use flexsc_record::{Hinges, Record, Sample};
use flexsc_spacecraft::flow::ThreeAxisState;

use super::plant::Plant;
use super::{Simulation, SimulationError};
use crate::scenario::Scenario;
use crate::scene::{OneAxisPose, Scene};

impl Simulation {
    /// Enables drawing of the scene for records that want it; to be called before the run begins.
    pub fn enable_scene(&mut self, scenario: &Scenario) {
        self.recorder.draw(scenario);
    }

    /// Records the parts of the scene; discards a scene that no record wants.
    pub(super) fn record_scene(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let (now, telling) = (self.now, &mut self.recorder);
        match &telling.scene {
            Some(scene) if record.wants_scene() => {
                record.record(now, Sample::Row(&scene.parts(telling.events.stamp(now))))?;
                telling.next_frames = Some(now);
            }
            _ => telling.scene = None,
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
        let plumes = match (&mut **scene, &self.plant) {
            (Scene::Planar(scene), Plant::OneAxis(plant)) => {
                let state = plant.state();
                if frames {
                    let sections = plant.outputs().map_or_else(Vec::new, |outputs| outputs.outputs);
                    let sections: Vec<f64> = sections.into_iter().map(|output| output.value).collect();
                    let view = OneAxisPose {
                        time: now.seconds(),
                        angle: truth.sensor_angles()[0],
                        rigid_angle: state.rigid_angle,
                        modes: &state.modes,
                        sections: &sections,
                    };
                    record.record(now, Sample::Row(scene.frames(stamp, view)))?;
                }
                let rates = [truth.rate[0], truth.rigid[0]];
                let torque = self.loads.actuator.response(now, 0, rates).applied;
                scene.plumes(stamp, torque)
            }
            (Scene::Spatial(scene), Plant::ThreeAxis(plant)) => {
                if frames {
                    let ThreeAxisState { turn, modes } = plant.state();
                    let mut angles: Vec<f64> = plant
                        .drives()
                        .map_or_else(Vec::new, |of| of.drives.iter().map(|drive| drive.angle_rad).collect());
                    let frames = match plant.hinges() {
                        // Hinges move by any angle; with hinges, modes are not drawn.
                        Some(Hinges { hinges }) => {
                            angles.extend(hinges.iter().map(|hinge| hinge.angle_rad));
                            scene.frames(stamp, plant.attitude(), &[], &angles)
                        }
                        None => scene.frames(stamp, &turn.attitude, modes, &angles),
                    };
                    record.record(now, Sample::Row(frames))?;
                }
                let cycle = self.loads.actuator.capabilities().pulses.map(PulsedActuator::cycle);
                let (burning, open) =
                    cycle.map_or(([0.0; 3], Vec::new()), |cycle| (cycle.burning, cycle.open));
                scene.plumes(stamp, burning, open)
            }
            _ => None,
        };
        Ok(plumes.map_or(Ok(()), |plumes| record.record(now, Sample::Row(&plumes)))?)
    }
}
