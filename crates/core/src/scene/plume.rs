//! Plumes: which thrusters burn, logged at each change and then whole.

use super::part::{PLUME, cone, entity};
use crate::attitude::Vector;
use crate::record::foxglove::{Deleted, Plumes, SceneEntityDeletion, SceneUpdate};
use crate::record::row::Stamp;

/// A nozzle: its frame, where its plume begins, and the direction in which it leaves.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenePlume {
    /// The frame to which it is fixed.
    pub frame: String,
    /// Its name.
    pub name: String,
    /// Where the plume begins (m).
    pub at: Vector,
    /// The direction of the plume, of length 1.
    pub direction: Vector,
}

/// The plumes of some nozzles at work.
#[derive(Clone, Debug)]
pub struct Burning {
    nozzles: Vec<ScenePlume>,
    /// Length of a full plume (m).
    length: f64,
    /// How much each nozzle gives, as a part of a full plume, as logged last.
    told: Option<Vec<f64>>,
}

impl Burning {
    /// Nozzles that have not been logged yet.
    pub fn new(nozzles: Vec<ScenePlume>, length: f64) -> Self {
        Self { nozzles, length, told: None }
    }

    /// The nozzles.
    pub fn nozzles(&self) -> &[ScenePlume] {
        &self.nozzles
    }

    /// Takes how much each nozzle gives from now on, from 0 to 1; returns the plumes if that is new.
    pub fn change(&mut self, stamp: Stamp, parts: Vec<f64>) -> Option<Plumes> {
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
