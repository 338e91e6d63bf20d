//! Thermal bending of an appendage in sunlight, as a deflection that its modes approach.

use flexsc_formats::count::counted;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{Finite, Positive};
use nalgebra::DMatrix;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Appendage;

/// Thermal bending.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Thermal {
    /// Steady displacement of each mode in sunlight relative to shadow (m sqrt(kg)).
    pub deflection: Vec<Finite>,
    /// Time constant of that displacement (s).
    pub time_constant: Positive,
}

/// Forces of thermal bending on free modes (N/sqrt(kg)), and their time constant (s).
#[derive(Clone, Debug, PartialEq)]
pub struct Bending {
    /// Steady force on each free mode in sunlight, relative to shadow (N/sqrt(kg)).
    pub forces: Vec<f64>,
    /// Time constant (s).
    pub time_constant: f64,
}

impl Thermal {
    /// Returns the key and the reason, if there is not one deflection for each mode.
    pub(super) fn fault(&self, modes: usize) -> Option<ConfigError> {
        let count = self.deflection.len();
        (count != modes).then(|| {
            ConfigError::new(
                "thermal.deflection",
                format!("must be one for each of {}, got {count}", counted(modes, "mode")),
            )
        })
    }
}

/// Returns the bending of each appendage that has any. `frequencies` (rad/s) are those of the clamped modes, and
/// `shapes` their parts in the free modes: a force O² eta on a clamped mode has the steady displacement eta.
pub(super) fn bendings(appendages: &[Appendage], frequencies: &[f64], shapes: &DMatrix<f64>) -> Vec<Bending> {
    let mut first = 0;
    let mut bendings = Vec::new();
    for appendage in appendages {
        if let Some(thermal) = &appendage.thermal {
            let force = |(index, eta): (usize, &Finite)| {
                let w = frequencies[first + index];
                w * w * eta.get()
            };
            let held: Vec<f64> = thermal.deflection.iter().enumerate().map(force).collect();
            let free_deflection = |column: usize| -> f64 {
                held.iter().enumerate().map(|(index, force)| shapes[(first + index, column)] * force).sum()
            };
            bendings.push(Bending {
                forces: (0..shapes.ncols()).map(free_deflection).collect(),
                time_constant: thermal.time_constant.get(),
            });
        }
        first += appendage.clamped_modes().len();
    }
    bendings
}
