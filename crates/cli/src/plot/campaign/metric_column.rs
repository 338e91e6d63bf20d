//! Metrics of a campaign's runs as columns of numbers, and the requirements on them.

use flexsc_core::Scenario;
use flexsc_core::metrics::{MetricDescription, list_element};
use flexsc_core::scenario::{AssessedRequirement, RequirementSource};

use super::text_cells::TextCells;

/// Name of the list with the values of all requirements.
const VALUES: &str = flexsc_core::scenario::metric_descriptions::REQUIREMENT_VALUES.name;

/// Metric of the runs.
pub struct MetricColumn {
    pub meaning: &'static MetricDescription,
    /// Name of the metric, or of an element of it.
    pub name: String,
    /// Requirement whose values these are, of an element of the requirements' values.
    pub requirement: Option<RequirementLabel>,
    /// Values of the metric as in the table, and as numbers; NaN for a run without a value.
    pub texts: TextCells,
    pub values: Vec<f64>,
}

/// Name of a requirement, and the unit of its values.
#[derive(Clone)]
pub struct RequirementLabel {
    pub name: String,
    pub unit: &'static str,
}

impl MetricColumn {
    /// Returns the metric's value in a run as text; empty without a value.
    pub fn text(&self, index: usize) -> String {
        self.texts.formatted(index, self.values[index])
    }

    /// Returns the metric's existing values, sorted.
    pub fn sorted(&self) -> Vec<f64> {
        let mut values: Vec<f64> = self.values.iter().copied().filter(|value| value.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        values
    }

    /// Returns true if the metric differs between runs.
    pub fn varies(&self) -> bool {
        let sorted = self.sorted();
        sorted.first() != sorted.last()
    }

    /// Returns the name by which the metric is chosen and listed: that of its requirement, if it has one.
    pub fn title(&self) -> &str {
        self.requirement.as_ref().map_or(&self.name, |requirement| &requirement.name)
    }

    /// Returns the title as a part of a file's name.
    pub fn file_name(&self) -> String {
        let is_plain = |c: char| c.is_alphanumeric() || "-_.[]".contains(c);
        self.title().chars().map(|c| if is_plain(c) { c } else { '-' }).collect()
    }

    /// Returns true if the metric goes by a name.
    pub fn is_named(&self, name: &str) -> bool {
        self.name == name || self.title() == name || self.file_name() == name
    }

    /// Returns the metric's name in words, without the unit, and the unit.
    pub fn label(&self) -> (String, &'static str) {
        if let Some(RequirementLabel { name, unit }) = &self.requirement {
            return with_simple_unit(name.clone(), unit);
        }
        let unit = self.meaning.unit;
        let suffix = match unit {
            "rad" => "_rad",
            "rad/s" => "_rad_s",
            "s" => "_s",
            "J" => "_j",
            "kg" => "_kg",
            "N m" => "_nm",
            "N m s" => "_nm_s",
            _ => "",
        };
        let name = self.name.as_str();
        let named = name.strip_suffix(suffix).unwrap_or(name);
        // A body without inertia has accelerations as torques.
        let bare = named.strip_suffix("_nm").or_else(|| named.strip_suffix("_nm_s"));
        let name = bare.map_or_else(|| named.to_owned(), |bare| bare.replace("torque", "acceleration"));
        with_simple_unit(name.replace('_', " "), unit)
    }
}

/// Returns a name and its unit, which is in the name if SI prefixes do not fit it.
fn with_simple_unit(name: String, unit: &'static str) -> (String, &'static str) {
    if unit.contains('²') { (format!("{name} ({unit})"), "") } else { (name, unit) }
}

/// Returns the elements of lists to read: the values of each requirement, and the named ones.
pub fn elements(scenario: Option<&Scenario>, named: &[String]) -> Vec<String> {
    let count = scenario.map_or(0, |scenario| scenario.study.requirements.len());
    let mut elements: Vec<String> = (0..count).map(value_of_requirement).collect();
    let others = named.iter().filter(|name| list_element(name).is_some() && !elements.contains(name));
    let others: Vec<String> = others.cloned().collect();
    elements.extend(others);
    elements
}

pub fn value_of_requirement(index: usize) -> String {
    format!("{VALUES}[{index}]")
}

/// Returns the requirement whose values an element of a list has.
pub fn requirement_label(scenario: &Scenario, element: &str) -> Option<RequirementLabel> {
    let (list, index) = list_element(element)?;
    let requirement = scenario.study.requirements.get(index).filter(|_| list == VALUES)?;
    Some(RequirementLabel { name: requirement.name.clone(), unit: requirement.unit })
}

/// Returns the name of the metric that a requirement limits; `None` for a pointing index.
pub fn required_metric(requirement: &AssessedRequirement) -> Option<String> {
    match &requirement.source {
        RequirementSource::Metric(name, None) => Some(name.clone()),
        RequirementSource::Metric(name, Some(index)) => Some(format!("{name}[{index}]")),
        RequirementSource::Error(_) | RequirementSource::Formula(_) => None,
    }
}
