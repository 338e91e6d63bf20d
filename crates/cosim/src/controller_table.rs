//! Table of the variables of an FMU that holds the laws of a scenario alone: the inputs and outputs of their flight code.

use flexsc_core::Scenario;
use flexsc_core::control::flight_quantity::FlightQuantity;
use flexsc_core::numerics::time::Span;
use flexsc_export_c::control_system::{CallLayout, Channel};

use crate::parameters::numeric_keys;
use crate::units::BaseExponents;
use crate::variable::{Causality, ClockRole, Quantity, ValueKind, VariableStart};
use crate::variable_table::{VariableTable, command_unit};

/// Returns the unit in the description of a channel; empty without one.
fn unit_of(channel: &Channel) -> &str {
    let unit = channel.about.rsplit_once('(').and_then(|(_, unit)| unit.strip_suffix(')'));
    unit.filter(|unit| BaseExponents::from_unit(unit).is_some()).unwrap_or_default()
}

/// Prefix of the keys that are parameters.
const LAW_KEYS: &str = "law.";

impl VariableTable {
    /// Creates the table of laws with these inputs and outputs, which decide at a period.
    pub(crate) fn for_laws(scenario: &Scenario, layout: &CallLayout, period: Span) -> Self {
        let inputs = layout.inputs.iter().map(|channel| channel.count).sum();
        let mut table = Self::empty(scenario.axis_count(), inputs);
        table.push("time", "Time since the start".to_owned(), "s", Causality::Independent, Quantity::Time);
        let mut outputs = 0;
        for channel in &layout.outputs {
            let is_torque = channel.quantity == Some(FlightQuantity::Torque);
            let unit = if is_torque { command_unit(scenario) } else { unit_of(channel) };
            table
                .push_channel(channel, unit, Causality::Output, |index| Quantity::LawOutput(outputs + index));
            outputs += channel.count;
        }
        table.add_counts();
        let mut inputs = 0;
        for channel in &layout.inputs {
            let unit = unit_of(channel);
            table.push_channel(channel, unit, Causality::Input, |index| Quantity::Input(inputs + index));
            inputs += channel.count;
        }
        table.add_grid();
        for key in numeric_keys(&scenario.to_table()) {
            if key.path.starts_with(LAW_KEYS) {
                let unit = scenario.unit_of(&key.path).unwrap_or_default();
                let (name, text) =
                    (format!("parameter.{}", key.path), format!("Key `{}` of the scenario", key.path));
                let variable = table.push(name, text, unit, Causality::Parameter, Quantity::Key(key.path));
                variable.start = VariableStart::Float(key.value);
            }
        }
        let role = ClockRole::Periodic(period);
        let text = "Period of the decisions of the law".to_owned();
        let clock = table.push("deciding", text, "", Causality::Input, Quantity::Clock(role));
        (clock.kind, clock.is_discrete) = (ValueKind::Clock(role), true);
        table
    }

    /// Adds a variable for each number of a channel.
    fn push_channel(
        &mut self,
        channel: &Channel,
        unit: &str,
        causality: Causality,
        quantity: impl Fn(usize) -> Quantity,
    ) {
        // A plant has outputs and inputs of the same names.
        let name = channel.quantity.map_or_else(|| channel.name.clone(), FlightQuantity::path);
        for index in 0..channel.count {
            let place = if channel.count > 1 { format!("[{}]", index + 1) } else { String::new() };
            let (name, text) = (format!("{name}{place}"), channel.about.clone());
            let variable = self.push(name, text, unit, causality, quantity(index));
            variable.is_discrete = true;
        }
    }
}
