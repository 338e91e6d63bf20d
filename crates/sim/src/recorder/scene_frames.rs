//! Scene of a run for viewers: its parts, its frames when they are due, its plumes when they change.

use flexsc_control::actuator::PulsedActuator;
use flexsc_dynamics::flow::ThreeAxisState;
use flexsc_numerics::time::Instant;
use flexsc_record::{
    Hinges, OneAxisPose, Record, RecordError, Sample, ScenePose, SceneSource, SceneThrust, ThreeAxisPose,
};

use super::journal_events::JournalEvents;
use crate::plant::FlowQuantities;
use crate::run_view::RunView;

/// Scene of a run with the schedule of its frames.
#[derive(Clone, Debug, Default)]
pub struct SceneFrames {
    /// Scene of the run; `None` if the record supplies none.
    scene: Option<Box<dyn SceneSource>>,
    next: Option<Instant>,
}

impl SceneFrames {
    /// Returns true if the scene is drawn.
    pub fn is_drawn(&self) -> bool {
        self.scene.is_some()
    }

    /// Returns the instant at which frames are due next.
    pub fn due(&self) -> Option<Instant> {
        self.next
    }

    /// Records the parts of the scene that the record supplies, if any.
    pub fn record_scene(
        &mut self,
        now: Instant,
        journal: &JournalEvents,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        self.scene = record.scene();
        if let Some(scene) = &self.scene {
            record.record(now, Sample::Row(&scene.parts(journal.stamp(now))))?;
            self.next = Some(now);
        }
        Ok(())
    }

    /// Records the frames that are due and the plumes that have changed.
    #[inline]
    pub fn record_due(
        &mut self,
        run: &RunView<'_>,
        journal: &JournalEvents,
        record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        if self.scene.is_none() { Ok(()) } else { self.record_frames(run, journal, record) }
    }

    /// Records the frames and plumes of a scene that is drawn.
    fn record_frames(
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
        let thrust = match run.plant.quantities() {
            FlowQuantities::OneAxis(motion) => {
                let state = &motion.body().state;
                if frames {
                    let sections = motion.output_row().map_or_else(Vec::new, |outputs| outputs.outputs);
                    let sections: Vec<f64> = sections.into_iter().map(|output| output.value).collect();
                    let pose = OneAxisPose {
                        time: now.seconds(),
                        angle: truth.sensor_angles()[0],
                        rigid_angle: state.rigid_angle,
                        modes: &state.modes,
                        sections: &sections,
                    };
                    record.record(now, Sample::Row(scene.frames(stamp, ScenePose::OneAxis(pose))))?;
                }
                let rates = [truth.rate[0], truth.rigid_rate[0]];
                SceneThrust::Torque(run.loads.actuator.response(now, 0, rates).applied)
            }
            FlowQuantities::ThreeAxis(motion) => {
                if frames {
                    let ThreeAxisState { turn, modes } = &motion.body().state;
                    let drives = motion.drives().map_or_else(Vec::new, |of| of.drives);
                    let mut angles: Vec<f64> = drives.iter().map(|drive| drive.angle_rad).collect();
                    // Hinges move by any angle; with hinges, modes are not drawn.
                    let (attitude, modes) = match motion.hinges() {
                        Some(Hinges { hinges }) => {
                            angles.extend(hinges.iter().map(|hinge| hinge.angle_rad));
                            (motion.attitude(), &[][..])
                        }
                        None => (&turn.attitude, &modes[..]),
                    };
                    let pose = ScenePose::ThreeAxis(ThreeAxisPose { attitude, modes, angles: &angles });
                    record.record(now, Sample::Row(scene.frames(stamp, pose)))?;
                }
                let cycle = run.loads.actuator.capabilities().pulses.map(PulsedActuator::cycle);
                let (signs, open) = cycle.map_or(([0.0; 3], Vec::new()), |cycle| (cycle.burning, cycle.open));
                SceneThrust::Jets { signs, open }
            }
        };
        let plumes = scene.plumes(stamp, thrust);
        plumes.map_or(Ok(()), |plumes| record.record(now, Sample::Row(&plumes)))
    }
}
