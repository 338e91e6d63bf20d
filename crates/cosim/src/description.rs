//! Model description of an FMU: `modelDescription.xml` of FMI 3.0 and of FMI 2.0.

use std::collections::BTreeSet;

use flexsc_core::Scenario;

use crate::fmi_version::FmiVersion;
use crate::units::{BASES, BaseExponents};
use crate::variable::{Causality, ClockRole, ValueKind, Variable, VariableStart};
use crate::variable_table::VariableTable;
use crate::xml::XmlWriter;

/// Femtoseconds in a second: the resolution of clocks.
const RESOLUTION: u64 = 1_000_000_000_000_000;

/// Category of all messages.
const LOG_CATEGORY: &str = "logStatusError";

/// Interface of an FMU's code.
#[derive(Debug)]
pub struct FmuInterface<'a> {
    /// Name of its library.
    pub identifier: &'a str,
    /// True if steps stop at events, in FMI 3.0.
    pub has_events: bool,
    /// Source files that an importer compiles; none of an FMU with libraries.
    pub sources: &'a [String],
}

/// Returns the model description of an FMU.
pub fn model_description(
    scenario: &Scenario,
    table: &VariableTable,
    token: &str,
    version: FmiVersion,
    interface: &FmuInterface<'_>,
) -> String {
    let writer = DescriptionWriter { table, version, interface, xml: XmlWriter::new() };
    writer.write(scenario, token)
}

/// Writer of a model description.
struct DescriptionWriter<'a> {
    table: &'a VariableTable,
    version: FmiVersion,
    interface: &'a FmuInterface<'a>,
    xml: XmlWriter,
}

/// Creates an attribute.
fn attribute(name: &'static str, value: impl Into<String>) -> (&'static str, String) {
    (name, value.into())
}

/// Returns a number with all its digits.
fn number(value: f64) -> String {
    format!("{value:?}")
}

impl DescriptionWriter<'_> {
    fn write(mut self, scenario: &Scenario, token: &str) -> String {
        let is_3 = self.version == FmiVersion::V3;
        let mut attributes = vec![
            attribute("fmiVersion", if is_3 { "3.0" } else { "2.0" }),
            attribute("modelName", &scenario.name),
            attribute(if is_3 { "instantiationToken" } else { "guid" }, token),
            attribute("version", env!("CARGO_PKG_VERSION")),
            attribute("license", "MIT OR Apache-2.0"),
            attribute("generationTool", concat!("flexsc ", env!("CARGO_PKG_VERSION"))),
            attribute("variableNamingConvention", "structured"),
        ];
        if !scenario.about.is_empty() {
            attributes.insert(3, attribute("description", &scenario.about));
        }
        self.xml.open("fmiModelDescription", &attributes);
        self.write_interface();
        self.write_units();
        self.xml.open("LogCategories", &[]);
        let text = "Errors";
        self.xml.empty("Category", &[attribute("name", LOG_CATEGORY), attribute("description", text)]);
        self.xml.close();
        let stop = attribute("stopTime", number(scenario.duration.seconds()));
        self.xml.empty("DefaultExperiment", &[attribute("startTime", "0"), stop]);
        self.xml.open("ModelVariables", &[]);
        for variable in self.table.variables() {
            if is_3 {
                self.write_variable_3(variable);
            } else if !variable.is_clock() {
                self.write_variable_2(variable);
            }
        }
        self.xml.close();
        self.write_structure();
        self.xml.finish()
    }

    fn write_interface(&mut self) {
        let mut attributes = vec![attribute("modelIdentifier", self.interface.identifier)];
        let states = match self.version {
            FmiVersion::V3 => ["canGetAndSetFMUState", "canSerializeFMUState"],
            FmiVersion::V2 => ["canGetAndSetFMUstate", "canSerializeFMUstate"],
        };
        let mut names = Vec::from(states);
        names.push("canHandleVariableCommunicationStepSize");
        if self.interface.has_events && self.version == FmiVersion::V3 {
            names.extend(["mightReturnEarlyFromDoStep", "hasEventMode"]);
        }
        attributes.extend(names.iter().map(|name| attribute(name, "true")));
        if self.version == FmiVersion::V3 || self.interface.sources.is_empty() {
            self.xml.empty("CoSimulation", &attributes);
            return;
        }
        self.xml.open("CoSimulation", &attributes);
        self.xml.open("SourceFiles", &[]);
        for source in self.interface.sources {
            self.xml.empty("File", &[attribute("name", source)]);
        }
        self.xml.close();
        self.xml.close();
    }

    fn write_units(&mut self) {
        let units: BTreeSet<&str> = self.table.variables().iter().map(|of| of.unit.as_str()).collect();
        self.xml.open("UnitDefinitions", &[]);
        for unit in units.into_iter().filter(|unit| !unit.is_empty()) {
            self.xml.open("Unit", &[attribute("name", unit)]);
            if let Some(found) = BaseExponents::from_unit(unit) {
                let powers = BASES.into_iter().zip(found.of_base).filter(|(_, power)| *power != 0);
                let powers: Vec<_> = powers.map(|(base, power)| attribute(base, power.to_string())).collect();
                self.xml.empty("BaseUnit", &powers);
            }
            self.xml.close();
        }
        self.xml.close();
    }

    fn write_variable_3(&mut self, variable: &Variable) {
        let element = match variable.kind {
            ValueKind::Float => "Float64",
            ValueKind::Integer => "Int64",
            ValueKind::Structural => "UInt64",
            ValueKind::Clock(_) => "Clock",
        };
        let causality = match variable.causality {
            Causality::Independent => "independent",
            Causality::Output => "output",
            Causality::Input => "input",
            Causality::Parameter if variable.kind == ValueKind::Structural => "structuralParameter",
            Causality::Parameter => "parameter",
        };
        let mut attributes = vec![
            attribute("name", &variable.name),
            attribute("valueReference", variable.reference.to_string()),
            attribute("description", &variable.text),
            attribute("causality", causality),
            attribute("variability", variability(variable)),
        ];
        if variable.kind == ValueKind::Float && !variable.unit.is_empty() {
            attributes.push(attribute("unit", &variable.unit));
        }
        if let ValueKind::Clock(role) = variable.kind {
            clock_attributes(role, &mut attributes);
        } else {
            attributes.extend(start(variable));
        }
        self.xml.empty(element, &attributes);
    }

    /// Writes a variable of FMI 2.0, which has no integers of 64 bits: all are reals, exact up to 2^53.
    fn write_variable_2(&mut self, variable: &Variable) {
        let causality = match variable.causality {
            Causality::Independent => "independent",
            Causality::Output => "output",
            Causality::Input => "input",
            Causality::Parameter => "parameter",
        };
        let mut attributes = vec![
            attribute("name", &variable.name),
            attribute("valueReference", variable.reference.to_string()),
            attribute("description", &variable.text),
            attribute("causality", causality),
            attribute("variability", variability(variable)),
        ];
        match variable.causality {
            Causality::Output => attributes.push(attribute("initial", "calculated")),
            Causality::Parameter => attributes.push(attribute("initial", "exact")),
            Causality::Independent | Causality::Input => {}
        }
        self.xml.open("ScalarVariable", &attributes);
        let mut real = Vec::new();
        if !variable.unit.is_empty() {
            real.push(attribute("unit", &variable.unit));
        }
        real.extend(start(variable));
        self.xml.empty("Real", &real);
        self.xml.close();
    }

    fn write_structure(&mut self) {
        let is_output = |of: &&Variable| of.causality == Causality::Output;
        let outputs: Vec<&Variable> = self.table.variables().iter().filter(is_output).collect();
        self.xml.open("ModelStructure", &[]);
        if self.version == FmiVersion::V3 {
            for element in ["Output", "InitialUnknown"] {
                for output in &outputs {
                    self.xml.empty(element, &[attribute("valueReference", output.reference.to_string())]);
                }
            }
            return;
        }
        for element in ["Outputs", "InitialUnknowns"] {
            self.xml.open(element, &[]);
            for output in outputs.iter().filter(|output| !output.is_clock()) {
                // Clocks are the last variables: the index of the others is the same without them.
                self.xml.empty("Unknown", &[attribute("index", (output.reference + 1).to_string())]);
            }
            self.xml.close();
        }
    }
}

fn variability(variable: &Variable) -> &'static str {
    match (variable.is_parameter(), variable.is_discrete) {
        (true, _) => "fixed",
        (false, true) => "discrete",
        (false, false) => "continuous",
    }
}

/// Returns the start value of an input or a parameter.
fn start(variable: &Variable) -> Option<(&'static str, String)> {
    let is_set = matches!(variable.causality, Causality::Input | Causality::Parameter);
    is_set.then(|| match variable.start {
        VariableStart::Float(value) => attribute("start", number(value)),
        VariableStart::Integer(value) => attribute("start", value.to_string()),
    })
}

fn clock_attributes(role: ClockRole, attributes: &mut Vec<(&'static str, String)>) {
    let ClockRole::Periodic(interval) = role else {
        attributes.push(attribute("intervalVariability", "triggered"));
        return;
    };
    attributes.extend([
        attribute("intervalVariability", "constant"),
        attribute("intervalDecimal", number(interval.seconds())),
        attribute("supportsFraction", "true"),
        attribute("resolution", RESOLUTION.to_string()),
        attribute("intervalCounter", interval.leading_femtoseconds().to_string()),
    ]);
}
