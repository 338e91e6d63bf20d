//! Variables of a control system's functions: which value each input reads, and which one each output sets.

use flexsc_core::control::flight_quantity::FlightQuantity;
use flexsc_core::control::operation::{ModeQuantity, ModeReading};
use flexsc_core::{Scenario, Simulation, TelemetrySensor};
use flexsc_export_c::control_system::{CallLayout, Channel, ControlSystem, ReadingFormula};
use flexsc_export_c::package::ControlSources;

use super::variables::{NamedValues, add, add_time, find};
use crate::variable::{Causality, Quantity};
use crate::variable_table::{VariableTable, command_unit};

/// Source of an input.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum InputSource {
    /// Values from this reference on.
    Values(usize),
    /// True if the sensor at this index has a new reading.
    IsNew(usize),
    /// Values of a sensor from this reference on; NaN before its first reading.
    Reading(usize, usize),
    /// Rate of change of the field from this reference on; NaN while it is unknown.
    FieldRate(usize, usize),
    /// Time since the last reading of the sensor at this index.
    Silence(usize),
}

/// Function with its variables.
#[derive(Clone, Debug)]
pub struct BoundCall {
    /// Function.
    pub layout: CallLayout,
    /// Source of each input.
    pub inputs: Vec<InputSource>,
    /// First reference of each output; `None` of one that the FMU uses itself.
    pub outputs: Vec<Option<usize>>,
}

/// Sensor whose new readings are taken.
#[derive(Clone, Debug)]
pub struct BoundSensor {
    /// Index in the scenario.
    sensor: usize,
    /// Reference of the whole seconds of its time.
    pub time: usize,
}

/// Variables and functions of the FMU.
#[derive(Debug)]
pub struct SourceModel {
    /// Variables.
    pub table: VariableTable,
    /// Functions, without those for programs that act at events.
    pub calls: Vec<BoundCall>,
    /// Sensors.
    pub sensors: Vec<BoundSensor>,
    /// Index of the magnetometer whose readings the B-dot law takes, among these sensors.
    pub magnetometer: Option<usize>,
    /// Parameters: their first reference.
    pub parameters: usize,
}

/// Builder of the inputs.
struct InputBinder<'a> {
    exported: &'a ControlSources,
    telemetry: Vec<TelemetrySensor>,
    /// Index of the magnetometer in the scenario.
    field_source: Option<usize>,
    table: VariableTable,
    sensors: Vec<BoundSensor>,
}

/// Returns the name of the variable of an output of a function; `None` of one that the FMU uses itself.
fn output_name(call: &str, channel: &Channel) -> Option<String> {
    if let Some(quantity) = channel.quantity {
        return Some(quantity.path());
    }
    let name = channel.name.as_str();
    match call {
        "start" | "sample" | "shift" => Some(format!("estimate.{name}")),
        "supervise" => matches!(name, "mode" | "is_chattering").then(|| name.to_owned()),
        "poll" => Some("command".to_owned()),
        _ => Some(name.to_owned()),
    }
}

impl SourceModel {
    /// Creates the model of a control system.
    pub fn new(scenario: &Scenario, exported: &ControlSources) -> Self {
        let mut table = VariableTable::empty(scenario.axis_count(), 0);
        table.push("time", "Time since the start".to_owned(), "s", Causality::Independent, Quantity::Time);
        // A relay is polled; its decisions at events have guards.
        let calls: Vec<CallLayout> =
            exported.calls.iter().filter(|call| call.name != "decide").cloned().collect();
        let mut outputs = Vec::new();
        for call in &calls {
            let mut own = Vec::new();
            for channel in &call.outputs {
                own.push(output_name(call.name, channel).map(|name| {
                    let unit =
                        if name == "command" { command_unit(scenario) } else { channel.unit_of_numbers() };
                    let values = NamedValues { unit, ..NamedValues::from_channel(name, channel) };
                    add(&mut table, &NamedValues { start: Vec::new(), ..values }, Causality::Output)
                }));
            }
            outputs.push(own);
        }
        table.add_counts();
        let layout = Simulation::new(scenario, 0).telemetry_layout(scenario);
        let field_source = scenario.sensor.field_source(scenario.study.law_period).map(|(sensor, _)| sensor);
        let telemetry = layout.sensors;
        let mut binder = InputBinder { exported, telemetry, field_source, table, sensors: Vec::new() };
        let inputs: Vec<Vec<InputSource>> = calls
            .iter()
            .map(|call| call.inputs.iter().map(|channel| binder.source(call, channel)).collect())
            .collect();
        let has_field = calls.iter().any(|call| call.name == "field");
        let magnetometer = field_source.filter(|_| has_field).map(|sensor| binder.sensor(sensor));
        let parameters = binder.table.variables().len();
        binder.add_parameters();
        let calls = calls
            .into_iter()
            .zip(inputs)
            .zip(outputs)
            .map(|((layout, inputs), outputs)| BoundCall { layout, inputs, outputs })
            .collect();
        Self { table: binder.table, calls, sensors: binder.sensors, magnetometer, parameters }
    }

    /// Returns a function by its name.
    pub fn call(&self, name: &str) -> Option<&BoundCall> {
        self.calls.iter().find(|call| call.layout.name == name)
    }
}

impl InputBinder<'_> {
    /// Returns the index of a sensor of the scenario among those that are taken.
    fn sensor(&mut self, sensor: usize) -> usize {
        if let Some(known) = self.sensors.iter().position(|known| known.sensor == sensor) {
            return known;
        }
        let group = self.group(sensor);
        let time = add_time(&mut self.table, &group);
        self.sensors.push(BoundSensor { sensor, time });
        self.sensors.len() - 1
    }

    /// Returns the name of a sensor in telemetry and plant FMUs.
    fn group(&self, sensor: usize) -> String {
        let known = self.telemetry.iter().find(|known| known.index == sensor);
        known.map_or_else(|| format!("sensor_{sensor}"), |known| known.group.clone())
    }

    /// Returns the first reference of a reading: a quantity of the sensor by its name, or its first one.
    fn reading(&mut self, sensor: usize, name: Option<&str>, channel: &Channel) -> usize {
        let _ = self.sensor(sensor);
        let own = self.telemetry.iter().find(|known| known.index == sensor);
        let first = own.and_then(|known| known.fields.first()).map(|field| field.name);
        let name = name.or(first).unwrap_or("value");
        let path = format!("{}.{name}", self.group(sensor));
        add(&mut self.table, &NamedValues::from_channel(path, channel), Causality::Input)
    }

    /// Returns the source of a function's input.
    fn source(&mut self, call: &CallLayout, channel: &Channel) -> InputSource {
        let of_sensor = match call.name {
            "sample" => self.sample(channel),
            "supervise" => self.silence(channel),
            _ => None,
        };
        if let Some(source) = of_sensor {
            return source;
        }
        match (channel.quantity, self.field_source) {
            (Some(FlightQuantity::Field), Some(sensor)) => {
                let first = self.reading(sensor, None, channel);
                return InputSource::Reading(self.sensor(sensor), first);
            }
            (Some(quantity @ FlightQuantity::FieldRate), Some(sensor)) => {
                if let Some(first) = find(&self.table, &quantity.path()) {
                    return InputSource::FieldRate(self.sensor(sensor), first);
                }
            }
            _ => {}
        }
        let (causality, prefix) = match call.name {
            "start" => (Causality::Parameter, "start."),
            "enter" => (Causality::Input, "enter."),
            "sample" => (Causality::Input, "sample."),
            _ => (Causality::Input, ""),
        };
        let name = match (call.name, channel.quantity) {
            // At a change the target of the mode before is compared, and that of the next one is pursued.
            ("supervise", Some(FlightQuantity::TargetAttitude)) => "conditions.attitude".to_owned(),
            ("supervise", Some(FlightQuantity::ReferenceRate)) => "conditions.rate".to_owned(),
            (_, Some(quantity)) => quantity.path(),
            (_, None) => format!("{prefix}{}", channel.name),
        };
        let mut values = NamedValues::from_channel(name, channel);
        match (call.name, channel.name.as_str()) {
            ("start", own) => values.start = self.run_start(call, own),
            ("enter", _) => values.start = vec![-1.0],
            (_, "is_measured") => values.start = vec![1.0],
            _ => {}
        }
        InputSource::Values(add(&mut self.table, &values, causality))
    }

    /// Returns the source of an input of an attitude filter's sample.
    fn sample(&mut self, channel: &Channel) -> Option<InputSource> {
        let unit = self.exported.system.estimator()?;
        let gyro = std::iter::once((unit.gyro.0, "gyro"));
        let sensors: Vec<_> =
            gyro.chain(unit.correctors.iter().map(|own| (own.sensor, own.name.as_str()))).collect();
        sensors.into_iter().find_map(|(sensor, name)| {
            let rest = channel.name.strip_prefix(name)?.strip_prefix('_')?;
            match rest {
                "is_valid" => Some(InputSource::IsNew(self.sensor(sensor))),
                "vector" => Some(InputSource::Values(self.reading(sensor, None, channel))),
                "rate" | "attitude" | "reference" => {
                    Some(InputSource::Values(self.reading(sensor, Some(rest), channel)))
                }
                _ => None,
            }
        })
    }

    /// Returns the source of the time since a reading, of a condition of modes.
    fn silence(&mut self, channel: &Channel) -> Option<InputSource> {
        let ControlSystem::Modes(modes) = &self.exported.system else { return None };
        let readings = modes.tables.readings.iter().zip(&modes.inputs.formulas);
        let sensor = readings.into_iter().find_map(|(reading, formula)| match (reading, formula) {
            (ModeReading::Known(ModeQuantity::Silent(sensor)), ReadingFormula::Input(name))
                if *name == channel.name =>
            {
                Some(*sensor)
            }
            _ => None,
        })?;
        Some(InputSource::Silence(self.sensor(sensor)))
    }

    /// Returns the numbers with which an input of the start begins run 0.
    fn run_start(&self, call: &CallLayout, name: &str) -> Vec<f64> {
        let before = call.inputs.iter().take_while(|own| own.name != name).map(|own| own.count).sum();
        let words = self.exported.run_start.iter().skip(before);
        let count = call.inputs.iter().find(|own| own.name == name).map_or(0, |own| own.count);
        words.take(count).map(|word| f64::from_bits(*word)).collect()
    }

    /// Adds the numbers that are tuned in flight.
    fn add_parameters(&mut self) {
        for own in &self.exported.parameters {
            let channel = Channel::real(&own.name, &own.about, 1, 1.0);
            let name = format!("parameter.{}", own.name);
            let values = NamedValues { start: vec![own.value], ..NamedValues::from_channel(name, &channel) };
            add(&mut self.table, &values, Causality::Parameter);
        }
    }
}
