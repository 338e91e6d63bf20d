//! Axes of figures along keys of a scenario, in the units in which people read them.

use flexsc_core::Scenario;
use flexsc_core::formats::reader_units::ReaderUnits;
use flexsc_figure::{FigureAxis, name_and_unit};

/// Returns an axis around values of a key.
pub fn key_axis(scenario: Option<&Scenario>, key: &str, values: impl IntoIterator<Item = f64>) -> FigureAxis {
    let unit = scenario.and_then(|scenario| scenario.unit_of(key)).unwrap_or_default();
    let values: Vec<f64> = values.into_iter().collect();
    let largest = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let units = ReaderUnits::Engineering;
    let fitting = units.fitting(largest, unit);
    let own_unit =
        scenario.map_or_else(|| fitting.clone(), |scenario| scenario.reader_unit(key, largest, units));
    let (name, own) = name_and_unit(key, unit);
    let axis = FigureAxis::around(&name, own, values);
    if own_unit == fitting || own.is_empty() { axis } else { axis.in_unit(own_unit) }
}
