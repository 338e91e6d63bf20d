//! Modes of an appendage from a Craig-Bampton model.

use std::path::Path;

use flexsc_formats::document::ConfigError;
use flexsc_formats::structure::Matrix;
use flexsc_formats::structure::fe::{FileResults, craig_bampton_modes};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Craig-Bampton model of an appendage, as its supplier hands it over: `MXX` and `KXX` of Nastran.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CraigBampton {
    /// Reduced mass matrix: rows of the root's displacements and rotations, and of modes that are clamped there.
    pub mass: Matrix,
    /// Reduced stiffness matrix, in the same order.
    pub stiffness: Matrix,
    /// Rows of the root, from 0: displacements along x, y and z, rotations about them.
    #[serde(default = "first")]
    pub interface: [usize; 6],
}

fn first() -> [usize; 6] {
    [0, 1, 2, 3, 4, 5]
}

impl CraigBampton {
    /// Returns the `keep` lowest modes, from files relative to `directory`.
    ///
    /// # Errors
    /// The key, and the reason.
    pub(super) fn results(
        &mut self,
        directory: &Path,
        keep: Option<usize>,
    ) -> Result<FileResults, ConfigError> {
        self.mass.locate(directory);
        self.stiffness.locate(directory);
        let mass = self.mass.read().map_err(|fault| fault.within("mass"))?;
        let stiffness = self.stiffness.read().map_err(|fault| fault.within("stiffness"))?;
        craig_bampton_modes(&mass, &stiffness, &self.interface, keep)
            .map_err(|(key, why)| ConfigError::new(key, why))
    }
}
