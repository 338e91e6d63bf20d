//! Mode of an appendage whose root is held, as a scenario or a file gives it.

use std::collections::BTreeMap;

use flexsc_formats::structure::Shape;
use flexsc_formats::structure::mode_table::{ModeCommon, ModeRow};
use flexsc_numerics::attitude::{Vector, tensor, vector};
use flexsc_numerics::quantity::{Finite, Frequency, NonNegative};
use nalgebra::Matrix3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A mass-normalised mode of an appendage clamped at its root: the integral of phi_i . phi_j dm is 1 for i = j, else 0.
///
/// Vectors are in the axes of the appendage, and r is the position from its root.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClampedMode {
    /// Natural frequency O with the root held (rad/s).
    pub frequency: Frequency,
    /// Damping ratio zeta with the root held: 0 undamped, 1 critical.
    #[serde(default)]
    pub damping: NonNegative,
    /// Participation in translation, the integral of phi dm (sqrt(kg)).
    #[serde(default)]
    pub translation: [Finite; 3],
    /// For a point mass, in place of `translation`: the direction in which all of its mass swings, of any length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub along: Option<[Finite; 3]>,
    /// Participation in rotation about the root, the integral of r x phi dm (sqrt(kg) m).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation: Option<[Finite; 3]>,
    /// First moments about the root, the integral of r phi' dm (sqrt(kg) m), row by row: rows along r, columns
    /// along phi. `rotation` follows from them, and is left out or agrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moments: Option<[[Finite; 3]; 3]>,
    /// Modal displacement at the start (m sqrt(kg)).
    #[serde(default)]
    pub displacement: Finite,
    /// Modal rate at the start (m sqrt(kg)/s).
    #[serde(default)]
    pub rate: Finite,
    /// Shape of the mode at each point of the appendage, relative to the fixed root, by the name of the point.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub shapes: BTreeMap<String, Shape>,
}

impl ClampedMode {
    /// Returns the participation in translation (sqrt(kg)) for an appendage of mass `mass` (kg).
    pub fn translation(&self, mass: f64) -> Vector {
        self.along
            .as_ref()
            .map_or_else(|| vector(&self.translation), |along| vector(along).normalize() * f64::sqrt(mass))
    }

    /// Returns the first moments, if they are given (sqrt(kg) m).
    pub fn moments(&self) -> Option<Matrix3<f64>> {
        self.moments.as_ref().map(tensor)
    }
}

/// Returns the integral of r x phi dm, which is the antisymmetric part of the first moments, the integral of r phi' dm.
pub fn antisymmetric_part(moments: &Matrix3<f64>) -> Vector {
    let n = moments;
    Vector::new(n[(1, 2)] - n[(2, 1)], n[(2, 0)] - n[(0, 2)], n[(0, 1)] - n[(1, 0)])
}

impl ModeRow for ClampedMode {
    const LIST: &'static str = "ClampedModes";
    const FILES: &'static str = ".csv, .f06, .frd, .dat or .flex";
    const EXTRA_COLUMNS: &'static [&'static str] =
        &["tx", "ty", "tz", "rx", "ry", "rz", "nxx", "nxy", "nxz", "nyx", "nyy", "nyz", "nzx", "nzy", "nzz"];

    fn from_frequency(frequency: Frequency) -> Self {
        Self {
            frequency,
            damping: NonNegative::default(),
            translation: <[Finite; 3]>::default(),
            along: None,
            rotation: None,
            moments: None,
            displacement: Finite::default(),
            rate: Finite::default(),
            shapes: BTreeMap::new(),
        }
    }

    fn common(&mut self) -> ModeCommon<'_> {
        ModeCommon {
            damping: &mut self.damping,
            displacement: &mut self.displacement,
            rate: &mut self.rate,
            shapes: &mut self.shapes,
        }
    }

    fn set_extra(&mut self, column: usize, value: Finite) {
        match column {
            0..3 => self.translation[column] = value,
            3..6 => self.rotation.get_or_insert_default()[column - 3] = value,
            _ => self.moments.get_or_insert_default()[(column - 6) / 3][column % 3] = value,
        }
    }
}
