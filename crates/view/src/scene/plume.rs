//! Plumes of the firing thrusters, logged completely at each change.

use flexsc_core::numerics::attitude::Vector;
use flexsc_core::record::foxglove::{Deleted, Plumes, SceneEntityDeletion, SceneUpdate};
use flexsc_core::record::row::LogDate;

use super::primitives::{PLUME, cone, entity};

/// Nozzle: its frame, the origin of its plume, and the direction of the plume.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenePlume {
    /// Frame to which the nozzle is fixed.
    pub frame: String,
    /// Name of the nozzle.
    pub name: String,
    /// Origin of the plume (m).
    pub at: Vector,
    /// Direction of the plume, of length 1.
    pub direction: Vector,
}

/// Run-time state of the plumes of some nozzles.
#[derive(Clone, Debug)]
pub struct ActivePlumes {
    nozzles: Vec<ScenePlume>,
    /// Length of a full plume (m).
    length: f64,
    /// Level of each nozzle, as a fraction of a full plume, as logged last.
    told: Option<Vec<f64>>,
}

impl ActivePlumes {
    /// Creates the state of nozzles that have not been logged yet.
    pub fn new(nozzles: Vec<ScenePlume>, length: f64) -> Self {
        Self { nozzles, length, told: None }
    }

    /// Returns the nozzles.
    pub fn nozzles(&self) -> &[ScenePlume] {
        &self.nozzles
    }

    /// Returns the length of a full plume (m).
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Sets the level of each nozzle, from 0 to 1; returns the plumes if the levels have changed.
    pub fn change(&mut self, stamp: LogDate, parts: Vec<f64>) -> Option<Plumes> {
        if self.told.as_ref() == Some(&parts) {
            return None;
        }
        let mut update = SceneUpdate {
            deletions: vec![SceneEntityDeletion {
                timestamp: stamp,
                r#type: Deleted::All,
                id: String::new(),
            }],
            entities: Vec::new(),
        };
        for (nozzle, part) in self.nozzles.iter().zip(&parts).filter(|(_, part)| **part > 0.0) {
            let length = self.length * part;
            let end = nozzle.at + nozzle.direction * length;
            let mut plume = entity(stamp, &nozzle.frame, &nozzle.name);
            plume.cylinders.push(cone(nozzle.at, end, [0.06 * self.length, 0.3 * length], PLUME));
            update.entities.push(plume);
        }
        self.told = Some(parts);
        Some(Plumes(update))
    }
}
