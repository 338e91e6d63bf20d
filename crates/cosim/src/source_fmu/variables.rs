//! Variables of a control system that is exported as sources, each with the place of its first value.

use flexsc_export_c::control_system::{Channel, NumberKind};

use crate::units::BaseExponents;
use crate::variable::{Causality, Quantity, ValueKind, VariableStart};
use crate::variable_table::VariableTable;

/// Array of variables of one name.
#[derive(Clone, Debug)]
pub struct NamedValues<'a> {
    /// Name, without an index.
    pub name: String,
    /// Meaning.
    pub about: &'a str,
    /// Unit; empty without one.
    pub unit: &'a str,
    /// Number of values.
    pub count: usize,
    /// Values before the start; zeros if there are none.
    pub start: Vec<f64>,
}

impl<'a> NamedValues<'a> {
    /// Creates the variables of a channel.
    pub fn from_channel(name: String, channel: &'a Channel) -> Self {
        let unit = channel.unit_of_numbers();
        let start = match channel.kind {
            NumberKind::Real if channel.is_unit && channel.count == 4 => vec![1.0],
            _ => Vec::new(),
        };
        Self { name, about: &channel.about, unit, count: channel.count, start }
    }
}

/// Returns the value reference of the first variable of a name.
pub fn find(table: &VariableTable, name: &str) -> Option<usize> {
    let variables = table.variables();
    variables.iter().position(|of| {
        let rest = of.name.strip_prefix(name);
        rest.is_some_and(|rest| rest.is_empty() || rest == "[1]")
    })
}

/// Returns the value reference of the first of these variables, which are added if there are none of the name.
pub fn add(table: &mut VariableTable, values: &NamedValues<'_>, causality: Causality) -> usize {
    if let Some(known) = find(table, &values.name) {
        return known;
    }
    let first = table.variables().len();
    let unit = if BaseExponents::from_unit(values.unit).is_some() { values.unit } else { "" };
    for index in 0..values.count {
        let place = if values.count > 1 { format!("[{}]", index + 1) } else { String::new() };
        let quantity = match causality {
            Causality::Output => Quantity::LawOutput(first + index),
            _ => Quantity::Input(first + index),
        };
        let name = format!("{}{place}", values.name);
        let variable = table.push(name, values.about.to_owned(), unit, causality, quantity);
        variable.is_discrete = true;
        variable.start = VariableStart::Float(values.start.get(index).copied().unwrap_or(0.0));
    }
    first
}

/// Returns the value reference of the whole seconds of a sensor's time, which the femtoseconds follow; adds both if there are none.
pub fn add_time(table: &mut VariableTable, group: &str) -> usize {
    let name = format!("{group}.time_whole_s");
    if let Some(known) = find(table, &name) {
        return known;
    }
    let first = table.variables().len();
    let whole = "Whole seconds of the time at which the last reading became available; -1 before the first";
    let part = "Femtoseconds of that time past the whole second";
    for (name, text, unit, start) in [(name, whole, "s", -1), (format!("{group}.time_fs"), part, "", 0)] {
        let quantity = Quantity::Input(table.variables().len());
        let variable = table.push(name, text.to_owned(), unit, Causality::Input, quantity);
        (variable.kind, variable.is_discrete) = (ValueKind::Integer, true);
        variable.start = VariableStart::Integer(start);
    }
    first
}
