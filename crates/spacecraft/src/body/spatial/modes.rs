//! Modes of a spatial body as rows of a table.

use std::collections::BTreeMap;

use flexsc_formats::structure::mode_table::{ModeCommon, ModeRow, ModeTable};
use flexsc_numerics::quantity::{Finite, Frequency, NonNegative};

use super::SpatialMode;

/// Modes of a spatial body, which dereference to a slice; those of a file once it is read.
pub type SpatialModes = ModeTable<SpatialMode>;

impl ModeRow for SpatialMode {
    const LIST: &'static str = "SpatialModes";
    const FILES: &'static str = ".csv";
    const EXTRA_COLUMNS: &'static [&'static str] = &[];

    fn from_frequency(frequency: Frequency) -> Self {
        Self {
            frequency,
            damping: NonNegative::default(),
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

    fn set_extra(&mut self, _column: usize, _value: Finite) {}
}
