//! Scene of a run for viewers: its parts, its frames when they are due, its plumes when they change.

use flexsc_control::actuator::PulsedActuator;
use flexsc_numerics::time::Instant;
use flexsc_record::{Hinges, Record, RecordError, Sample};
use flexsc_spacecraft::flow::ThreeAxisState;

use super::journal_events::JournalEvents;
use crate::scenario::Scenario;
use crate::scene::{OneAxisPose, Scene};
use crate::sim::plant::Plant;
use crate::sim::run_view::RunView;

/// Scene of a run with the schedule of its frames.
#[derive(Clone, Debug, Default)]
pub struct SceneFrames {
    /// Scene of the run; `None` if it is not drawn.
    scene: Option<Box<Scene>>,
    next: Option<Instant>,
}

impl SceneFrames {
    /// Enables drawing of the scenario's scene.
    pub fn draw(&mut self, scenario: &Scenario) {
        self.scene = Some(Box::new(Scene::new(scenario)));
    }

    /// Returns true if the scene is drawn.
    pub fn is_drawn(&self) -> bool {
        self.scene.is_some()
    }

    /// Returns the instant at which frames are due next.
    pub fn due(&self) -> Option<Instant> {
        self.next
    }

    /// Records the parts of the scene; discards a scene that no record wants.
    pub fn record_scene(
        &mut self,
        now: Instant,
        journal: &JournalEvents,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        match &self.scene {
            Some(scene) if record.wants_scene() => {
                record.record(now, Sample::Row(&scene.parts(journal.stamp(now))))?;
                self.next = Some(now);
            }
            _ => self.scene = None,
        }
        Ok(())
    }

    /// Records the frames that are due and the plumes that have changed.
    pub fn record_due(
        &mut self,
        run: &RunView<'_>,
        journal: &JournalEvents,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        let now = run.now;
        let Some(scene) = &mut self.scene else { return Ok(()) };
        let stamp = journal.stamp(now);
        let frames = self.next == Some(now);
        if frames {
            self.next = Some(now + scene.period());
        }
        let truth = run.plant.truth();
        let plumes = match (&mut **scene, run.plant) {
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
                let torque = run.loads.actuator.response(now, 0, rates).applied;
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
                let cycle = run.loads.actuator.capabilities().pulses.map(PulsedActuator::cycle);
                let (burning, open) =
                    cycle.map_or(([0.0; 3], Vec::new()), |cycle| (cycle.burning, cycle.open));
                scene.plumes(stamp, burning, open)
            }
            _ => None,
        };
        plumes.map_or(Ok(()), |plumes| record.record(now, Sample::Row(&plumes)))
    }
}
