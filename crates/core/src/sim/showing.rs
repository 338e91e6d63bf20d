//! Scene of a run for viewers: its parts, its frames when they are due, its plumes when they change.

use super::plant::Plant;
use super::{Simulation, SimulationError};
use crate::flow::SpatialState;
use crate::record::{Hinges, Record, Sample};
use crate::scenario::Scenario;
use crate::scene::{PlanarView, Scene};

impl Simulation {
    /// Enables drawing of the scene for records that want it; to be called before the run begins.
    pub fn draw(&mut self, scenario: &Scenario) {
        self.telling.draw(scenario);
    }

    /// Records the parts of the scene; discards a scene that no record wants.
    pub(super) fn set_the_scene(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let (now, telling) = (self.now, &mut self.telling);
        match &telling.scene {
            Some(scene) if record.scene() => {
                record.record(now, Sample::Scene(&scene.parts(telling.events.stamp(now))))?;
                telling.next_frames = Some(now);
            }
            _ => telling.scene = None,
        }
        Ok(())
    }

    /// Records the frames that are due and the plumes that have changed.
    pub(super) fn show(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        if self.telling.scene.is_none() {
            return Ok(());
        }
        let now = self.now;
        let stamp = self.telling.events.stamp(now);
        self.plant.view(now)?;
        let frames = self.telling.next_frames == Some(now);
        let Some(scene) = &mut self.telling.scene else { return Ok(()) };
        if frames {
            self.telling.next_frames = Some(now + scene.period());
        }
        let truth = self.plant.viewed();
        let plumes = match (&mut **scene, &self.plant) {
            (Scene::Planar(scene), Plant::Planar(plant)) => {
                let state = plant.state();
                if frames {
                    let sections = plant.outputs().map_or_else(Vec::new, |outputs| outputs.outputs);
                    let sections: Vec<f64> = sections.into_iter().map(|output| output.value).collect();
                    let view = PlanarView {
                        time: now.seconds(),
                        angle: truth.seen()[0],
                        rigid_angle: state.rigid_angle,
                        modes: &state.modes,
                        sections: &sections,
                    };
                    record.record(now, Sample::Frames(scene.frames(stamp, view)))?;
                }
                let torque = self.drive.actuator.applied(now, 0, [truth.rate[0], truth.rigid[0]]);
                scene.plumes(stamp, torque)
            }
            (Scene::Spatial(scene), Plant::Spatial(plant)) => {
                if frames {
                    let SpatialState { turn, modes } = plant.state();
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
                    record.record(now, Sample::Frames(frames))?;
                }
                let cycle = self.drive.actuator.cycle();
                let (burning, open) =
                    cycle.map_or(([0.0; 3], Vec::new()), |cycle| (cycle.burning, cycle.open));
                scene.plumes(stamp, burning, open)
            }
            _ => None,
        };
        Ok(plumes.map_or(Ok(()), |plumes| record.record(now, Sample::Plumes(&plumes)))?)
    }
}
