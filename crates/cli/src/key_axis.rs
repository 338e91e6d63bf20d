//! Axes of figures along keys of a scenario, in the units in which people read them.

use flexsc_core::Scenario;
use flexsc_figure::{FigureAxis, name_and_unit};

/// Ends of the names of keys that are angular frequencies, and of those that are speeds of rotors.
const FREQUENCIES: [&str; 3] = ["frequency", "bandwidth", "corner"];
const SPEEDS: [&str; 3] = ["speed", "speeds", "speed_limit"];

/// Returns an axis around values of a key.
pub fn key_axis(scenario: Option<&Scenario>, key: &str, values: impl IntoIterator<Item = f64>) -> FigureAxis {
    let unit = scenario.and_then(|scenario| scenario.unit_of(key)).unwrap_or_default();
    let (name, unit) = name_and_unit(key, unit);
    let axis = FigureAxis::around(&name, unit, values);
    let own = key.rsplit('.').next().unwrap_or_default();
    let own = own.split('[').next().unwrap_or_default();
    if SPEEDS.contains(&own) {
        axis.in_rpm()
    } else if FREQUENCIES.contains(&own) {
        axis.in_hertz()
    } else {
        axis
    }
}
