//! Table of the variables of an FMU, which follows from the scenario and the part alone.

use flexsc_core::numerics::time::Span;
use flexsc_core::record::description::field_text;
use flexsc_core::{QuantityField, QuantityGroup, Scenario, Simulation, TelemetrySensor};

use crate::content::FmuPart;
use crate::parameters::numeric_keys;
use crate::variable::{Causality, ClockRole, Quantity, ValueKind, Variable, VariableStart};

/// Longest interval (s) that a clock can state as a fraction with the resolution of a femtosecond.
const LONGEST_INTERVAL_S: f64 = 9000.0;

/// Variables of an FMU.
#[derive(Clone, Debug, PartialEq)]
pub struct VariableTable {
    variables: Vec<Variable>,
    /// Number of axes.
    pub(crate) axes: usize,
    /// Number of values of the observation.
    pub(crate) observed: usize,
    /// Number of values of the estimates and references that laws read, of a plant.
    pub(crate) law_inputs: usize,
    /// True if the importer commands the torque.
    pub(crate) is_commanded: bool,
    /// Number of inputs.
    inputs: usize,
}

/// Returns the unit of a command of the scenario's actuator; empty for one in units of its own.
pub(crate) fn command_unit(scenario: &Scenario) -> &'static str {
    let is_torque = scenario.actuator.only_actuator().and_then(|kind| kind.command_gain()).is_none();
    if is_torque { scenario.model.commanded_quantity().1 } else { "" }
}

impl VariableTable {
    /// Creates the table for a part of a scenario, before or during a run.
    pub fn new(scenario: &Scenario, simulation: &Simulation, part: FmuPart) -> Self {
        let axes = scenario.axis_count();
        let is_commanded = part == FmuPart::Plant;
        let mut table = Self::empty(axes, axes * if is_commanded { 2 } else { 1 });
        table.is_commanded = is_commanded;
        table.push("time", "Time since the start".to_owned(), "s", Causality::Independent, Quantity::Time);
        let observed = simulation.observation_fields(scenario);
        table.add_observation(scenario, &observed);
        table.add_law_inputs(scenario, simulation, &observed);
        table.add_loop(scenario, simulation, part);
        table.add_counts();
        table.add_inputs(scenario);
        table.add_parameters(scenario);
        table.add_clocks(scenario, part);
        table
    }

    /// Creates a table without variables.
    pub(crate) fn empty(axes: usize, inputs: usize) -> Self {
        Self { variables: Vec::new(), axes, observed: 0, law_inputs: 0, is_commanded: true, inputs }
    }

    /// Returns all variables, in the order of their references.
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// Returns the variable of a reference.
    pub fn get(&self, reference: u32) -> Option<&Variable> {
        self.variables.get(reference as usize)
    }

    /// Returns the variable of a name.
    pub fn find(&self, name: &str) -> Option<&Variable> {
        self.variables.iter().find(|variable| variable.name == name)
    }

    /// Returns the number of inputs: of a spacecraft, external torques, then commands.
    pub(crate) fn input_count(&self) -> usize {
        self.inputs
    }

    pub(crate) fn push(
        &mut self,
        name: impl Into<String>,
        text: String,
        unit: &str,
        causality: Causality,
        quantity: Quantity,
    ) -> &mut Variable {
        let reference = self.variables.len() as u32;
        self.variables.push(Variable {
            reference,
            name: name.into(),
            text,
            unit: unit.to_owned(),
            kind: ValueKind::Float,
            causality,
            is_discrete: false,
            start: VariableStart::Float(0.0),
            quantity,
        });
        &mut self.variables[reference as usize]
    }

    /// Adds an integer that changes at events alone, or at each communication point.
    fn push_count(&mut self, name: &str, text: &str, unit: &str, quantity: Quantity) {
        let variable = self.push(name, text.to_owned(), unit, Causality::Output, quantity);
        variable.kind = ValueKind::Integer;
        variable.is_discrete = true;
    }

    /// Adds the state, the measurements and the estimates.
    fn add_observation(&mut self, scenario: &Scenario, fields: &[QuantityField]) {
        let is_sampled = scenario.study.sample_period.is_some();
        for field in fields {
            let is_discrete = is_sampled && field.group != QuantityGroup::True;
            for index in 0..field.width() {
                let quantity = Quantity::Observed(self.observed);
                self.push_component(field, index, quantity).is_discrete = is_discrete;
                self.observed += 1;
            }
        }
    }

    /// Adds a component of a quantity of the run.
    fn push_component(&mut self, field: &QuantityField, index: usize, quantity: Quantity) -> &mut Variable {
        let place = field.shape.count().map_or(String::new(), |_| format!("[{}]", index + 1));
        let name = format!("{}{place}", field.path());
        self.push(name, field.description(index), field.unit, Causality::Output, quantity)
    }

    /// Adds the quantities of the closed loop.
    fn add_loop(&mut self, scenario: &Scenario, simulation: &Simulation, part: FmuPart) {
        if part == FmuPart::Plant {
            return;
        }
        let path = if self.axes > 1 { "torques/axes/feedback_nm" } else { "torque/feedback_nm" };
        let text = field_text(path).unwrap_or_default();
        for axis in 0..self.axes {
            let name = self.about_axis("command", axis);
            let unit = scenario.model.torque_unit();
            self.push(name, text.clone(), unit, Causality::Output, Quantity::Commanded(axis));
        }
        if simulation.window_mean().is_some() {
            let text = field_text("envelope_mean/mean_rad").unwrap_or_default();
            let variable = self.push("window_mean", text, "rad", Causality::Output, Quantity::WindowMean);
            variable.is_discrete = true;
        }
    }

    /// Adds the estimates and references that laws read, of a plant, as far as they are not outputs already.
    fn add_law_inputs(&mut self, scenario: &Scenario, simulation: &Simulation, observed: &[QuantityField]) {
        if !self.is_commanded {
            return;
        }
        let telemetry = simulation.telemetry_layout(scenario);
        self.add_readings(&telemetry.sensors);
        for field in &telemetry.law_inputs {
            // The readings of conditions are NaN but at their tests.
            let is_known = observed.iter().any(|known| known.path() == field.path());
            let is_new = !is_known && field.path() != "conditions.readings";
            for index in 0..field.width() {
                let quantity = Quantity::LawInput(self.law_inputs);
                self.law_inputs += 1;
                if is_new {
                    self.push_component(field, index, quantity);
                }
            }
        }
        if self.axes > 1 {
            for axis in 0..3 {
                let text = "Absolute momentum stored in the rotors, body axes".to_owned();
                let name = format!("stored_momentum[{}]", axis + 1);
                self.push(name, text, "N m s", Causality::Output, Quantity::StoredMomentum(axis));
            }
        }
    }

    /// Adds the last reading of each sensor with its time, of a plant.
    fn add_readings(&mut self, sensors: &[TelemetrySensor]) {
        for (place, sensor) in sensors.iter().enumerate() {
            let group = &sensor.group;
            let text =
                "Whole seconds of the time at which the last reading became available; -1 before the first";
            self.push_count(&format!("{group}.time_whole_s"), text, "s", Quantity::ReadingWhole(place));
            let text = "Femtoseconds of that time past the whole second";
            self.push_count(&format!("{group}.time_fs"), text, "", Quantity::ReadingFemtoseconds(place));
            let mut value = 0;
            for field in &sensor.fields {
                for index in 0..field.width() {
                    let component = field.shape.count().map_or(String::new(), |_| format!("[{}]", index + 1));
                    let (name, mut text) = (format!("{group}.{}{component}", field.name), field.text(index));
                    text[..1].make_ascii_uppercase();
                    let quantity = Quantity::Reading(place, value);
                    self.push(name, text, field.unit, Causality::Output, quantity).is_discrete = true;
                    value += 1;
                }
            }
        }
    }

    /// Adds the exact times and the counts.
    pub(crate) fn add_counts(&mut self) {
        self.push_count("time_whole_s", "Whole seconds of the exact time", "s", Quantity::TimeWhole);
        let text = "Femtoseconds of the exact time past the whole second";
        self.push_count("time_fs", text, "", Quantity::TimeFemtoseconds);
        let text = "Whole seconds of the exact time of the last event";
        self.push_count("event_whole_s", text, "s", Quantity::EventWhole);
        let text = "Femtoseconds of the exact time of the last event past the whole second";
        self.push_count("event_fs", text, "", Quantity::EventFemtoseconds);
        let text = "Number of events since the start: samples, decisions, changes of loads";
        self.push_count("events", text, "", Quantity::Events);
        if !self.is_commanded {
            let text = "Number of instants since the start at which a law has switched";
            self.push_count("switchings", text, "", Quantity::Switchings);
        }
    }

    /// Adds the external torque, and the commands of a plant.
    fn add_inputs(&mut self, scenario: &Scenario) {
        for axis in 0..self.axes {
            let name = self.about_axis("disturbance_torque", axis);
            let text = "External torque on the body in addition to all other loads".to_owned();
            self.push(name, text, scenario.model.torque_unit(), Causality::Input, Quantity::Input(axis));
        }
        if !self.is_commanded {
            return;
        }
        let unit = command_unit(scenario);
        for axis in 0..self.axes {
            let name = self.about_axis("command", axis);
            let text = "Command that the actuator executes".to_owned();
            self.push(name, text, unit, Causality::Input, Quantity::Input(self.axes + axis));
        }
    }

    /// Adds the grid of communication points, the seed, and the numbers of the scenario.
    fn add_parameters(&mut self, scenario: &Scenario) {
        self.add_grid();
        let text = "Seed of all random numbers".to_owned();
        let seed = self.push("seed", text, "", Causality::Parameter, Quantity::Seed);
        (seed.kind, seed.start) = (ValueKind::Integer, VariableStart::Integer(scenario.seed as i64));
        for key in numeric_keys(&scenario.to_table()) {
            let unit = scenario.unit_of(&key.path).unwrap_or_default();
            let (name, text) =
                (format!("parameter.{}", key.path), format!("Key `{}` of the scenario", key.path));
            let variable = self.push(name, text, unit, Causality::Parameter, Quantity::Key(key.path));
            variable.start = VariableStart::Float(key.value);
        }
    }

    /// Adds the grid of communication points.
    pub(crate) fn add_grid(&mut self) {
        let text = "Grid (ns) to which communication points are rounded; 0 for none".to_owned();
        let grid = self.push("snap_ns", text, "", Causality::Parameter, Quantity::Grid);
        (grid.kind, grid.start) = (ValueKind::Structural, VariableStart::Integer(0));
    }

    /// Adds the clocks.
    fn add_clocks(&mut self, scenario: &Scenario, part: FmuPart) {
        let mut push = |name: &str, text: &str, causality, role| {
            let variable = self.push(name, text.to_owned(), "", causality, Quantity::Clock(role));
            (variable.kind, variable.is_discrete) = (ValueKind::Clock(role), true);
        };
        if scenario.study.sample_period.is_some() {
            push("sampled", "Ticks when a sensor samples", Causality::Output, ClockRole::Sampled);
        }
        if part == FmuPart::Loop {
            push("switched", "Ticks when a law switches", Causality::Output, ClockRole::Switched);
        }
        let is_short = |period: &Span| period.seconds() < LONGEST_INTERVAL_S;
        let periods = [
            ("sampling", "Sampling period of the sensors", scenario.study.sample_period),
            ("deciding", "Period of the decisions of the law", scenario.study.law_period),
        ];
        for (name, text, period) in periods {
            if let Some(period) = period.filter(is_short) {
                push(name, text, Causality::Input, ClockRole::Periodic(period));
            }
        }
    }

    /// Returns the name of a quantity about an axis: with an index if there are three.
    fn about_axis(&self, name: &str, axis: usize) -> String {
        if self.axes > 1 { format!("{name}[{}]", axis + 1) } else { name.to_owned() }
    }
}
