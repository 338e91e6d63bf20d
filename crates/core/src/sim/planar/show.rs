//! What a run of a body with one angle shows of its scene.

use super::{PlanarRun, SimulationError};
use crate::record::{Record, Sample};
use crate::scene::PlanarView;

impl PlanarRun {
    /// Tells what the scene consists of, or drops it where nobody looks.
    pub(super) fn set_the_scene(&mut self, record: &mut impl Record) -> Result<(), SimulationError> {
        match &self.scene {
            Some(scene) if record.scene() => {
                record.record(self.now, Sample::Scene(&scene.parts(self.journal.stamp(self.now))))?;
                self.next_frames = Some(self.now);
            }
            _ => self.scene = None,
        }
        Ok(())
    }

    /// Tells the frames of the scene when they are due, and its plumes when they are new.
    pub(super) fn show(&mut self, record: &mut impl Record) -> Result<(), SimulationError> {
        if self.scene.is_none() {
            return Ok(());
        }
        let (now, stamp) = (self.now, self.journal.stamp(self.now));
        let sight = self.view()?;
        let state = self.body.state();
        let torque = self.drive.torque(now, sight.rate, state.rigid_rate).applied_nm;
        let Some(scene) = &mut self.scene else { return Ok(()) };
        if self.next_frames == Some(now) {
            let sections = self.body.outputs().map_or_else(Vec::new, |outputs| outputs.outputs);
            let sections: Vec<f64> = sections.into_iter().map(|output| output.value).collect();
            let view = PlanarView {
                time: now.seconds(),
                angle: sight.angle,
                rigid_angle: state.rigid_angle,
                modes: &state.modes,
                sections: &sections,
            };
            record.record(now, Sample::Frames(scene.frames(stamp, view)))?;
            self.next_frames = Some(now + scene.period);
        }
        match scene.plumes(stamp, torque) {
            Some(plumes) => Ok(record.record(now, Sample::Plumes(&plumes))?),
            None => Ok(()),
        }
    }
}
