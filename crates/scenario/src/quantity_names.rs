//! Names of quantities of requirements with their arguments, as a scenario writes them.

use flexsc_control::operation::ModeQuantity;
use flexsc_control::sensor::SensorKind;

use super::Scenario;
use super::metric_descriptions;

impl Scenario {
    /// Returns the name of a quantity, such as `silent(star_tracker)`.
    pub fn quantity_name(&self, quantity: ModeQuantity) -> String {
        let argument = match quantity {
            ModeQuantity::Silent(index) | ModeQuantity::Blinded(index) => self.sensor_name(index),
            ModeQuantity::Elevation(index)
            | ModeQuantity::TrueElevation(index)
            | ModeQuantity::Entries(index)
            | ModeQuantity::Mode(index) => self.mode[index].name.clone(),
            ModeQuantity::LineOfSight(index) => self.line_of_sight[index].point.clone(),
            ModeQuantity::Fault(index) => self.fault[index].name.clone(),
            ModeQuantity::Metric(index, element) => {
                let element = element.map_or_else(String::new, |element| format!("[{element}]"));
                return format!("{}{element}", metric_descriptions::ALL[index].name);
            }
            _ => return quantity.word(),
        };
        format!("{}({argument})", quantity.word())
    }

    /// Returns the kind of a sensor, of several of its kind with its index among them.
    fn sensor_name(&self, index: usize) -> String {
        let kinds: Vec<&str> = self.sensor.iter().map(SensorKind::kind).collect();
        let kind = kinds[index];
        let before = kinds[..index].iter().filter(|own| **own == kind).count();
        if kinds.iter().filter(|own| **own == kind).count() > 1 {
            format!("{kind}[{before}]")
        } else {
            kind.to_owned()
        }
    }
}
