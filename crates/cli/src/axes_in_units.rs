//! Axes of figures in units that were asked for.

use flexsc_core::formats::reader_units::ReaderUnits;
use flexsc_figure::Figure;

/// Units of axes, and which of those that were asked for an axis is in.
pub struct AxesInUnits {
    units: ReaderUnits,
    /// Units in which axes would be otherwise.
    usual: Vec<String>,
    /// Units that were asked for in which no axis is yet.
    unused: Vec<&'static str>,
}

impl AxesInUnits {
    pub fn new(units: ReaderUnits) -> Self {
        let unused = match units {
            ReaderUnits::Chosen(chosen) => chosen.names().to_vec(),
            ReaderUnits::Engineering | ReaderUnits::Si => Vec::new(),
        };
        Self { units, usual: Vec::new(), unused }
    }

    /// Shows the axes of a figure in the units.
    pub fn show(&mut self, figure: &mut Figure) {
        for axis in figure.panels.iter_mut().flat_map(|panel| [&mut panel.x, &mut panel.y]) {
            let usual = axis.reader_unit();
            if let Some(unit) = self.units.in_place_of(&usual, axis.unit) {
                self.unused.retain(|name| *name != unit.name);
                *axis = axis.clone().in_unit(unit);
            }
            if !usual.name.is_empty() && self.usual.iter().all(|own| *own != *usual.name) {
                self.usual.push(usual.name.into_owned());
            }
        }
    }

    /// Returns an error if a unit that was asked for is that of no axis.
    pub fn finish(self) -> Result<(), String> {
        let Some(unused) = self.unused.first() else { return Ok(()) };
        let hint = if self.usual.is_empty() {
            "the axes have no units".to_owned()
        } else {
            format!("the axes are in {}, or in other units of these quantities", self.usual.join(", "))
        };
        Err(format!("--units: no axis can be in `{unused}`\n\nhint: {hint}"))
    }
}
