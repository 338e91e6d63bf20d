//! Thermal bending of an appendage in sunlight, as the deflection that its modes approach.

use nalgebra::DMatrix;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Appendage;
use crate::count::counted;
use crate::document::Fault;
use crate::quantity::{Finite, Positive};

/// Thermal bending.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Thermal {
    /// Steady displacement of each mode in sunlight relative to shadow (m sqrt(kg)).
    pub deflection: Vec<Finite>,
    /// Time constant of that displacement (s).
    pub time_constant: Positive,
}

/// The forces of thermal bending on free modes (N/sqrt(kg)), and its time constant (s).
#[derive(Clone, Debug, PartialEq)]
pub struct Bending {
    /// The forces in sunlight beyond the shadow, in the end.
    pub forces: Vec<f64>,
    /// Time constant (s).
    pub time_constant: f64,
}

impl Thermal {
    /// A deflection that is not one of each mode: the key, and why.
    pub(super) fn fault(&self, modes: usize) -> Option<Fault> {
        let given = self.deflection.len();
        (given != modes).then(|| {
            Fault::new(
                "thermal.deflection",
                format!("must be one for each of {}, got {given}", counted(modes, "mode")),
            )
        })
    }
}

/// The bending of each appendage that has any, where its clamped modes, of these frequencies (rad/s), make these parts of the free
/// ones: a force O² eta on a clamped mode has the displacement eta in the end.
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
            let of_free = |column: usize| -> f64 {
                held.iter().enumerate().map(|(index, force)| shapes[(first + index, column)] * force).sum()
            };
            bendings.push(Bending {
                forces: (0..shapes.ncols()).map(of_free).collect(),
                time_constant: thermal.time_constant.get(),
            });
        }
        first += appendage.clamped_modes().len();
    }
    bendings
}
